// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::preprocess {

struct RangeCropConfig {
  double min_range_m = 0.2;
  double max_range_m = 400.0;
};

ConfigFields fields(RangeCropConfig& config);

/// The rows whose distance from the sensor lies in [min_range_m, max_range_m], in scan order.
Scan crop_range(const Scan& scan, const RangeCropConfig& config);

}  // namespace dynamic_icp::preprocess
