// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/figures/shown_scan.hpp"

namespace dynamic_icp::report {

/// The bytes of a scan as docs/report.md lays them down, before compression. Rows stay in their order: one in which
/// neighbours follow each other makes them small. Points must not be farther than kFarthestShown_m.
std::string scan_bytes(const figures::ShownScan& scan);

/// The bytes of a static map, m in the world frame of the run, the same.
std::string map_bytes(const std::vector<Eigen::Vector3d>& points);

/// Compressed and as text.
std::string blob(const std::string& bytes);

}  // namespace dynamic_icp::report
