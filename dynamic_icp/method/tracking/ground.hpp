// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// What objects stand on.
struct Ground {
  /// Columns: two directions in the ground and its upward normal, axes of the world.
  Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  std::optional<double> offset_m;  ///< points x on the ground have up . x = offset; empty: not seen

  [[nodiscard]] Eigen::Vector3d up() const { return level.col(2); }
};

/// The ground from scan to scan. Scans may take something else for it, an embankment for instance: direction and height
/// are the medians over those of the last ones that show the plane nearest to the sensor.
class GroundFilter {
 public:
  /// The ground where a scan from `sensor_world` (m) shows a plane of points x with `normal` . x = `offset_m` (world).
  /// What is steep against the last ground is a wall: the ground stays what it was.
  const Ground& update(const Eigen::Vector3d& normal, double offset_m, const Eigen::Vector3d& sensor_world);

  [[nodiscard]] const Ground& ground() const { return ground_; }

  void state(StateArchive& archive);

 private:
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double height_m = 0.0;  ///< of the sensor above it
  };

  std::vector<Plane> last_;  ///< a few, the newest anywhere
  std::size_t next_ = 0;
  Ground ground_;
};

}  // namespace dynamic_icp::tracking
