// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

// Recordings of files whose columns have names, one a scan: archives of NumPy arrays (*.npz), PCD or PLY. Which column
// says what is found by its name (field_names.hpp), once for all scans, as is the unit of the times of points
// (point_times.hpp), for which opening reads one scan. Stamps are in the names of the files (scan_stamps.hpp), ground
// truth is looked for beside them (truth_search.hpp). What is called compensated holds compensated Doppler.

/// The file or the folder of such files that the input is, or that lies up to three levels below it; else empty. Throws
/// DataError that lists them when there are several.
std::filesystem::path find_npz(const std::filesystem::path& input);  ///< or pairs <name>.npy and <name>_dop.npy
std::filesystem::path find_pcd(const std::filesystem::path& input);
std::filesystem::path find_ply(const std::filesystem::path& input);

/// Opens one of them. Throws DataError naming file, place and what was expected; UsageError for sensors, which such
/// files do not have, and for unknown fields.
std::unique_ptr<Dataset> open_npz(const std::filesystem::path& found, const OpenOptions& options = {});
std::unique_ptr<Dataset> open_pcd(const std::filesystem::path& found, const OpenOptions& options = {});
std::unique_ptr<Dataset> open_ply(const std::filesystem::path& found, const OpenOptions& options = {});

}  // namespace dynamic_icp::datasets
