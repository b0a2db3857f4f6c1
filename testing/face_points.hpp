// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::testing {

constexpr double kFaceStep_m = 0.1;

/// Points `kFaceStep_m` apart from one corner to the other of a face, m.
inline std::vector<Eigen::Vector3d> face_points(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::vector<Eigen::Vector3d> points;
  for (double x = low.x(); x <= high.x() + 1e-9; x += kFaceStep_m) {
    for (double y = low.y(); y <= high.y() + 1e-9; y += kFaceStep_m) {
      for (double z = low.z(); z <= high.z() + 1e-9; z += kFaceStep_m) {
        points.emplace_back(x, y, z);
      }
    }
  }
  return points;
}

}  // namespace dynamic_icp::testing
