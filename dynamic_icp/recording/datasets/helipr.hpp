// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// The folder of a recording of HeLiPR, up to three levels below `input`; empty when there is none or it is of
/// HeRCULES, which lies in the same folders.
std::filesystem::path find_helipr(const std::filesystem::path& input);

/// HeLiPR, in any spelling of upper and lower case:
///   LiDAR/Aeva/<stamp_ns>.bin    records of 25 bytes up to a recorder's change in August 2023, of 29 bytes after it
///                                (formats::kAeva25, kAeva29): by the stamp, and by the content of a file whose size
///                                contradicts it
///   LiDAR_GT/Aeva_gt.txt         optional, or global_Aeva_gt.txt: poses of the sensor, TUM columns with whole ns
/// Whether the Doppler is relative or compensated is not settled: relative here, with a sentence that says so.
std::unique_ptr<Dataset> open_helipr(const std::filesystem::path& folder, const OpenOptions& options = {});

}  // namespace dynamic_icp::datasets
