// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <span>

#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

namespace dynamic_icp::conversion {

void write_npz_scan(const std::filesystem::path& folder, const std::string& stem, const ScanToWrite& scan,
                    Notes& notes) {
  const std::string bytes = formats::npz_bytes(scan_table(scan, true, notes));
  formats::write_bytes(folder / (stem + ".npz"), std::as_bytes(std::span(bytes)));
}

}  // namespace dynamic_icp::conversion
