// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/recording/conversion/scan_table.hpp"

// One function a layout to write, each in the file of its name: writes one scan into `folder`; `stem` is the file's
// name without its ending. What the layout cannot hold is noted. Throws DataError when the machine fails.
namespace dynamic_icp::conversion {

void write_dicp_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                     Notes& notes);
void write_npz_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes);
void write_pcd_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes);
void write_ply_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes);

}  // namespace dynamic_icp::conversion
