// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"

namespace dynamic_icp::runs {

/// What the diagnosis of a recording says.
struct RecordingCheck {
  double period_s = 0.0;              ///< from scan to scan, median; 0 of one scan
  std::string doppler;                ///< kind and sign, in words
  std::vector<std::string> warnings;  ///< what seems wrong, in sentences
};

/// Diagnoses the first of the scans [begin, end), before a run. Throws DataError where the Doppler has the
/// wrong sign or is of the other kind than is said, or where there is none and the method needs it: every result would
/// be wrong. What the user said of sign or kind is believed. `threads` = 0 takes as many as the machine has.
RecordingCheck check_recording(const datasets::Dataset& dataset, const datasets::InputSettings& settings,
                               std::size_t begin, std::size_t end, bool needs_doppler, int threads);

}  // namespace dynamic_icp::runs
