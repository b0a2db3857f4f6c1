// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <span>

#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/pcd.hpp"

namespace dynamic_icp::conversion {

void write_pcd_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  const std::string bytes = formats::pcd_table_bytes(scan_table(scan, false, notes));
  formats::write_bytes(folder / (stem + ".pcd"), std::as_bytes(std::span(bytes)));
}

}  // namespace dynamic_icp::conversion
