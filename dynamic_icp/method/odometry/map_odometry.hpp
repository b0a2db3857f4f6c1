// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_filter.hpp"
#include "dynamic_icp/method/mapping/map_alignment.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/motion/displacement.hpp"
#include "dynamic_icp/method/motion/rotation_filter.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/method/odometry/rig_velocity.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/tracking/object_tracker.hpp"

namespace dynamic_icp::odometry {

/// Preset `fast` of Dynamic-ICP. The Doppler of the static scene gives the velocity, and the velocities of three
/// scans the translation from one to the next; the static points, aligned to a local map of planes, give the turn and
/// hold the position. Moving objects are tracked beside it. See docs/method.md, "Beyond the paper".
///
/// The same scans give the same bits for any number of threads.
class MapOdometry final : public Odometry {
 public:
  /// `threads` = 0 takes as many as the machine has; `expected` is what the Doppler will be, for `assumptions`. Throws
  /// UsageError when the configuration is out of range.
  explicit MapOdometry(const MapOdometryConfig& config, int threads = 0, DopplerKind expected = DopplerKind::kRelative);

  Frame process(const ScanView& raw) override;

  [[nodiscard]] std::vector<std::string> assumptions() const override;

 private:
  /// A scan at hand, with its times.
  struct ScanState {
    Scan static_points;       ///< its static points, thinned
    double stamp_s = 0.0;     ///< after the first scan
    double middle_s = 0.0;    ///< of the sweep, after the stamp
    double duration_s = 0.0;  ///< of the sweep
    bool is_relative = true;  ///< the Doppler shows the sensor's motion; else `ego` is that of the alignments before
    ego_motion::EgoVelocity ego;
    ego_motion::EgoVelocity filtered;  ///< the same as the filter carries it on, see average_over_bias_models
    std::optional<ego_motion::AngularInformation> rotation;  ///< what the Doppler of a rig says of it
  };

  /// What is known of the sensor at the last usable scan.
  struct State {
    double stamp_s = 0.0;
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();   ///< m^2, against the map
    Eigen::Matrix3d position_information = Eigen::Matrix3d::Zero();  ///< 1/m^2, from the points of the scan
    motion::SweepMotion sweep;
    motion::RotationState rotation;
    std::vector<motion::VelocitySample> velocities;  ///< of the last scans, at most three
    ego_motion::EgoVelocity filtered;
    double usual_match = 0.0;    ///< share of the points that agree with the map, as it was lately
    double model_sigma_m = 0.0;  ///< of patches from planes, as the last scans show it
    int scans_in_map = 0;
    ScanState first;  ///< the only scan in the map, until the next one shows how it turned; then empty
  };

  /// Of the scan at hand. The memory is used again for the next one: the system would clear each page of it anew.
  struct ScanMemory {
    Scan whole;                          ///< what is in range; once it is aligned, as seen at the stamp
    std::vector<double> times;           ///< s after the stamp, where they are declared
    std::vector<std::uint32_t> thinned;  ///< the rows that the voxel grid keeps
    ego_motion::DopplerRows rows;
    std::vector<double> radial;           ///< m/s, Doppler of each point without the sensor's motion
    std::vector<std::uint8_t> is_moving;  ///< each point
    preprocess::VoxelMemory voxels;
    spatial::CellOrder sort;
  };

  Frame process_at_middle(const ScanView& raw);
  void thin_and_sort(const ScanView& raw, Frame& frame);
  [[nodiscard]] ScanState separate_static_points();
  [[nodiscard]] ego_motion::EgoVelocity estimate_ego(double stamp_s) const;
  [[nodiscard]] ego_motion::RigEstimate estimate_rig(double stamp_s);
  void begin(const ScanState& now, const Eigen::Isometry3d& T_map_sensor);
  void update(const ScanState& now, Frame& frame);
  void mark_lost(const ScanState& now, const mapping::MotionPrior& prior, Frame& frame);
  void predict_only(double stamp_s, FrameStatus status, Frame& frame) const;
  void describe(const mapping::MotionPrior& prior, const mapping::MapAlignment& found, const Eigen::Matrix3d& observed,
                const Eigen::Matrix3d& rotation_covariance, double length_m, Frame& frame) const;
  [[nodiscard]] std::vector<motion::VelocitySample> velocities_with(const ScanState& now) const;
  [[nodiscard]] mapping::MotionPrior motion_prior(const ScanState& now) const;
  [[nodiscard]] ego_motion::EgoVelocity first_velocity(const ScanState& now) const;
  void predict_constant_velocity(const ScanState& now, mapping::MotionPrior& prior) const;
  [[nodiscard]] mapping::MapAlignment align_with_found_velocity(const ScanState& now, mapping::MotionPrior prior,
                                                                const mapping::MapAlignConfig& config) const;
  [[nodiscard]] Eigen::Matrix3d observed_position_information(const ScanState& now,
                                                              const mapping::MapAlignment& found) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> unobservable_directions(const Eigen::Matrix3d& observed) const;
  void keep_predicted_where_unobservable(const mapping::MotionPrior& prior, const Eigen::Matrix3d& observed,
                                         mapping::MapAlignment& found) const;
  [[nodiscard]] ego_motion::EgoVelocity found_velocity(const ScanState& now, const mapping::MapAlignment& found,
                                                       const Eigen::Matrix3d& observed) const;
  [[nodiscard]] Eigen::Isometry3d motion_to(const mapping::MapAlignment& found) const;
  [[nodiscard]] mapping::MapAlignment align_second(const ScanState& now, const mapping::MotionPrior& prior);
  std::vector<Eigen::Vector3d> add_to_map(const ScanState& now);
  void track_objects(Frame& frame);

  MapOdometryConfig config_;
  Workers workers_;
  DopplerKind expected_;
  ScanMemory memory_;
  mapping::PlaneMap map_;
  tracking::ObjectTracker tracker_;
  ScanStream stream_;
  RigVelocity rig_;
  std::optional<Eigen::Vector3d> middle_;  ///< m, of the sensors of a rig, as its first scan has it: see rig_origin.hpp
  std::optional<State> state_;             ///< empty before the first usable scan
};

}  // namespace dynamic_icp::odometry
