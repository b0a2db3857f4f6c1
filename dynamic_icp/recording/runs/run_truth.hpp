// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/scan_range.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::runs {

/// The ground truth that a run is compared with.
struct RunTruth {
  std::filesystem::path file;      ///< empty: none
  formats::Trajectory trajectory;  ///< T_world_sensor
  std::string warning;             ///< why that of the recording is not used; empty where it is or there is none
};

/// The ground truth in the file `stated` by the user, or that of the recording where it is empty, looked at before any
/// scan is processed. Throws DataError naming the file where the user's own cannot be read or has no pose at the time
/// of a single scan; the recording's own is left out then, with a warning.
RunTruth truth_for_run(const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                       const std::filesystem::path& stated);

}  // namespace dynamic_icp::runs
