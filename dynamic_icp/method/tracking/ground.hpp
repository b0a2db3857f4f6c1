// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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

/// How far above or below that plane the ground is from place to place: roads bend, and planes are fitted to much of
/// them.
class GroundHeights {
 public:
  /// A plane.
  explicit GroundHeights(const Ground& ground = {}) : ground_(ground) {}

  /// From the static points near the plane (m, sensor frame; `is_moving` has one flag per point).
  GroundHeights(const Ground& ground, std::span<const Eigen::Vector3d> points, std::span<const std::uint8_t> is_moving,
                const Eigen::Isometry3d& T_world_sensor);

  [[nodiscard]] Eigen::Vector3d up() const { return ground_.up(); }

  /// The ground below something whose lowest point seen is `lowest` (m, world). Where none is seen near by it is that
  /// of the whole scan, unless that lies far below or above the point.
  [[nodiscard]] Ground below(const Eigen::Vector3d& lowest) const;

 private:
  static constexpr int kCells = 32;  // in each direction
  static constexpr int kBins = 24;   // of heights
  using Histogram = std::array<std::uint16_t, kBins>;

  static constexpr std::size_t kBinBlock = 512;

  /// Where some points belong.
  struct Bins {
    std::array<int, kBinBlock> cell;  ///< -1: nowhere
    std::array<int, kBinBlock> bin;
  };

  static void find_bins(const Eigen::Vector3d* points, std::size_t stride, std::size_t count,
                        const Eigen::Matrix3d& R_level_sensor, double plane_z, Bins& bins);

  [[nodiscard]] std::optional<std::size_t> cell_of(const Eigen::Vector3d& from_sensor) const;
  [[nodiscard]] Eigen::Vector3d in_level(const Eigen::Vector3d& point_world) const;

  Ground ground_;
  Eigen::Vector3d sensor_world_ = Eigen::Vector3d::Zero();
  std::array<Histogram, static_cast<std::size_t>(kCells* kCells)> cells_{};
};

}  // namespace dynamic_icp::tracking
