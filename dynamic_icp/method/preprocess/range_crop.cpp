// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/range_crop.hpp"

namespace dynamic_icp::preprocess {

ConfigFields fields(RangeCropConfig& config) {
  return {{"min_range_m", &config.min_range_m, 0.0, 1000.0, "m", "points nearer to the sensor are left out"},
          {"max_range_m", &config.max_range_m, 1.0, 10000.0, "m", "points farther from the sensor are left out"}};
}

Scan crop_range(const Scan& scan, const RangeCropConfig& config) {
  std::vector<std::uint32_t> kept;
  kept.reserve(scan.size());
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    const double range = scan.points()[i].norm();
    if (range >= config.min_range_m && range <= config.max_range_m) {
      kept.push_back(i);
    }
  }
  return scan.select(kept);
}

}  // namespace dynamic_icp::preprocess
