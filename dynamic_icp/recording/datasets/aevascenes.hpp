// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// The sequence of AevaScenes that the input is or that lies up to three levels below it: the folder with sequence.json
/// beside pointcloud_compensated/ or pointcloud_raw/, or one of these two where that is the input itself; else empty.
/// Throws DataError that lists the sequences when there are several.
std::filesystem::path find_aevascenes(const std::filesystem::path& input);

/// Opens a sequence, release v0.x or v2.
///
/// The LiDARs of the options (without: front_wide_lidar and front_narrow_lidar, those of them there are, else the
/// first) are merged into the vehicle's frame, where each point keeps the line of sight it had from its own LiDAR. One
/// LiDAR alone stays in its own frame; poses and boxes are in the same frame as the points. Where both folders exist
/// the raw one is taken, unless the input is the other: its Doppler is taken as relative, that of
/// pointcloud_compensated/ as compensated. Labels as text are left out, those as numbers are a column.
///
/// Throws DataError naming file, place and what was expected; UsageError for unknown LiDARs, naming those there are,
/// and for fields, whose names are known here.
std::unique_ptr<Dataset> open_aevascenes(const std::filesystem::path& found, const OpenOptions& options = {});

}  // namespace dynamic_icp::datasets
