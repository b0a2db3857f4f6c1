// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/deskew.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::preprocess {

Scan deskew(const Scan& scan, const Eigen::Isometry3d& T_begin_end) {
  Scan result = scan;
  if (scan.empty() || !scan.has_times()) {
    return result;
  }
  const auto [first, last] = std::minmax_element(scan.times().begin(), scan.times().end());
  const double duration_s = *last - *first;
  if (!(duration_s > 0.0)) {
    return result;
  }
  const Vector6d twist = log_se3(T_begin_end);
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const double s = (scan.times()[row] - *first) / duration_s;
    const Eigen::Vector3d& point = scan.points()[row];
    result.displace(row, exp_se3((s - 0.5) * twist) * point - point);
  }
  return result;
}

}  // namespace dynamic_icp::preprocess
