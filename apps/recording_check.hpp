// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/datasets/input_settings.hpp"

namespace dynamic_icp::apps {

/// Asks the doctor about the first of the scans [begin, end), before a run. Returns what seems wrong, in sentences.
/// Throws DataError where the Doppler has the wrong sign or is of the other kind than is said: every result would be
/// wrong. What the user said of sign or kind is believed. `threads` = 0 takes as many as the machine has.
std::vector<std::string> check_recording(const datasets::Dataset& dataset, const datasets::InputSettings& settings,
                                         std::size_t begin, std::size_t end, int threads);

}  // namespace dynamic_icp::apps
