// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/tracking/articulation.hpp"
#include "dynamic_icp/method/tracking/detection.hpp"
#include "dynamic_icp/method/tracking/track.hpp"
#include "dynamic_icp/method/tracking/track_merging.hpp"
#include "dynamic_icp/method/tracking/tracked_object.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// What all velocities over ground share.
struct EgoError {
  Eigen::Vector3d sensor_world = Eigen::Vector3d::Zero();  ///< m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of the velocity of the sensor, (m/s)^2, world
};

/// A track with what is known of it besides its motion: who it is, when it was seen, and how long it lives. Its memory
/// is used again by another one.
struct TrackRecord {
  std::int64_t id = 0;
  Track track;                             ///< at the mean time of its last detection
  Track predicted;                         ///< at the stamp of the present scan, with what that scan shows
  BoxEstimate now = {};                    ///< of the latter
  std::optional<double> predicted_s = {};  ///< that stamp
  std::int64_t divided_from = 0;           ///< id of the track that it was part of; 0: none
  bool confirmed = false;
  bool has_moved = false;  ///< beyond doubt
  double moved_s = 0.0;    ///< when it moved last
  int age = 0;
  int seen = 0;
  int missed = 0;
  std::vector<std::uint32_t> members = {};  ///< rows of the present scan
  std::optional<Joint> joint = {};          ///< of these, if they are two bodies

  // For their memory
  Track other;
  Detection detection = {};
  std::vector<std::uint32_t> static_rows = {};
  std::vector<std::uint32_t> merged = {};

  TrackRecord();

  /// The track at the stamp of a scan. It is asked for several times a scan.
  void predict(double stamp_s, const VehicleSizes& sizes, const TrackConfig& config);

  /// Whether the velocity is worth reporting: known well enough, or as well as it will be.
  [[nodiscard]] bool is_credible(const EgoError& ego, const TrackerConfig& config) const;

  /// Remembers that it moves in the present scan, if it does.
  void note_motion(double stamp_s, const TrackerConfig& config);

  /// Whether nothing is to be expected of it any more.
  [[nodiscard]] bool is_over(double stamp_s, const TrackerConfig& config) const;

  /// Tells what it measures if it was seen whole in the present scan: others resemble it.
  void note_size(VehicleSizes& sizes) const;

  /// Goes on as the older one of two that turned out to be one object.
  void take_name_of(const TrackRecord& older);

  /// What is said of it; `ego_covariance`: of the velocity of the sensor, (m/s)^2, sensor frame; `up`: world.
  void report(const Eigen::Isometry3d& T_world_sensor, const Eigen::Matrix3d& ego_covariance, const Eigen::Vector3d& up,
              const VehicleSizes& sizes, const TrackerConfig& config, TrackedObject& object);

  /// Where it will be `after_s` after the present scan, world; of the covariance of the velocity nothing is said.
  [[nodiscard]] BoxEstimate forecast(double after_s, const VehicleSizes& sizes, const TrackConfig& config);

  /// Whether they are known to be two bodies.
  [[nodiscard]] bool was_divided_from(const TrackRecord& another) const {
    return divided_from == another.id || another.divided_from == id;
  }

  [[nodiscard]] SeenTrack seen_track() const {
    const bool may_have_drifted = missed == 0 && age > 1;
    return {predicted, now, members.size(), may_have_drifted ? detection.points : std::span<const Eigen::Vector3d>()};
  }

  /// What is known between two scans.
  void state(StateArchive& archive);
};

}  // namespace dynamic_icp::tracking
