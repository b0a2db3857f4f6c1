// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/moving_cells.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"
#include "dynamic_icp/method/tracking/range_image.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"
#include "dynamic_icp/method/tracking/track.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp::tracking {

/// The least `distance_ratio` of points where a body is likely but was not seen yet.
inline constexpr double kUnseenRatio = 0.9;

/// What a track expects of its points in one scan; everything in world axes.
struct Expectation {
  OrientedBox box;               ///< what was seen of it, at the stamp
  OrientedBox whole;             ///< with what is likely beyond
  Eigen::Vector3d velocity;      ///< m/s, of the centre
  Eigen::Vector3d W;             ///< m/s: its points have the radial velocities u . W
  Eigen::Matrix3d W_covariance;  ///< (m/s)^2
  double gate_m = 0.0;           ///< distance from the box at which points may still be its own
  double max_width_m = 0.0;      ///< of what was seen and what is added to it, as far as its place is known
  double gate_mps = 0.0;         ///< difference of their radial velocities, beyond the uncertainty of W

  /// `predicted` is the track at the stamp, `estimate` what it says; `is_hidden`: it was not seen at last.
  Expectation(const Track& predicted, const BoxEstimate& estimate, const SensorMotion& sensor,
              const TrackerConfig& config, bool is_hidden = false);

  /// Distance from the box of a point measured `time_s` after the stamp.
  [[nodiscard]] double outside(const Eigen::Vector3d& point_world, double time_s) const;

  /// The same as a share of what is allowed. Within what is likely of the body it is allowed whatever the distance.
  [[nodiscard]] double distance_ratio(const Eigen::Vector3d& point_world, double time_s) const;

  /// The width of what was seen of the body together with the point.
  [[nodiscard]] double width_with(const Eigen::Vector3d& point_world, double time_s) const;

  /// Standard deviation of the radial velocity that is expected, m/s.
  [[nodiscard]] double radial_sigma(const Eigen::Vector3d& direction_world) const;

  /// Deviation of a radial velocity from the expected one as a share of what is allowed.
  [[nodiscard]] double gate_ratio(const Eigen::Vector3d& direction_world, double radial_mps) const;

  /// Whether a point that stands cannot be part of the body: it should move, by more than so much, and does not.
  [[nodiscard]] bool excludes(const Eigen::Vector3d& direction_world, double radial_mps,
                              double same_velocity_mps) const;

  /// The box without its lowest part, where the ground may be.
  [[nodiscard]] OrientedBox box_above_ground() const;

  /// Whether some of its points may be as slow along the line of sight as what stands, though it moves.
  [[nodiscard]] bool may_appear_static(const Eigen::Vector3d& sensor_world, double slow_mps) const;
};

/// One scan, prepared for tracking.
struct TrackingInput {
  const Scan& scan;
  std::span<const double> radial;           ///< m/s over ground, for each row
  std::span<const std::uint8_t> is_moving;  ///< for each row
  SensorMotion sensor;
  double stamp_s = 0.0;  ///< since the first scan
  const MovingCells& moving;
  std::span<const std::uint32_t> groups;             ///< of the cells
  std::span<const Eigen::Vector3d> cell_points;      ///< their centroids, world
  std::span<const Eigen::Vector3d> cell_directions;  ///< their lines of sight, world
  const RangeImage& view;
  const GroundHeights& heights;
  const ScanPatches& patches;

  [[nodiscard]] double time_s(std::size_t row) const { return scan.has_times() ? scan.times()[row] : 0.0; }
  [[nodiscard]] Eigen::Vector3d direction_world(std::size_t row) const {
    return sensor.direction_world(scan.directions()[row], time_s(row));
  }
};

}  // namespace dynamic_icp::tracking
