// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/recording/formats/result_kind.hpp"
#include "dynamic_icp/tools/simulation/sequence_writer.hpp"

namespace dynamic_icp::simulation {

/// Writes all scans of a drive with their truth and a picture, overview.svg, into a folder that exists and is empty.
/// `progress` is called after each scan of all sensors. Throws as SequenceWriter does.
SequenceCounts write_sequence(const Simulation& simulation, const SequenceOptions& options,
                              const std::filesystem::path& folder, const Workers& workers,
                              const std::function<void()>& progress = {});

/// The files of such a folder in all layouts, with the folders of its sensors: what may be replaced.
formats::ResultKind sequence_result();

}  // namespace dynamic_icp::simulation
