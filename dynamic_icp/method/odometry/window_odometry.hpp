// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"
#include "dynamic_icp/method/ego_motion/support_plane.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/motion/sweep_motion.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/tracking/object_tracker.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

namespace dynamic_icp::odometry {

/// Preset `default` of Dynamic-ICP: one estimator of trajectory, error field of the Doppler and map error, from Doppler
/// and planes together (window_estimator.hpp). A consensus regression finds what is static; moving objects are tracked
/// beside it.
///
/// The same scans give the same bits for any number of threads.
class WindowOdometry final : public Odometry {
 public:
  /// `threads` = 0 takes as many as the machine has. Throws UsageError when the configuration or the calibration is out
  /// of range.
  explicit WindowOdometry(const WindowOdometryConfig& config, const SensorContext& context = {}, int threads = 0);

  Frame process(const ScanView& raw) override;

  [[nodiscard]] std::vector<std::string> assumptions() const override;
  [[nodiscard]] std::optional<window::SensorCalibration> calibration() const override;

 private:
  /// Traffic that most of a scan shows is followed as if it stood, and then prefers itself: so many scans must be clear
  /// before a motion counts as that of the sensor.
  static constexpr int kClearScans = 5;

  /// Of the scan at hand. The memory is used again for the next one.
  struct ScanMemory {
    Scan whole;  ///< what is in range; Doppler without the error that is known, as far as a sensor may err
    std::vector<double> times;
    std::vector<std::uint32_t> thinned;
    std::vector<double> measured;  ///< m/s, Doppler of each point as measured
    window::FieldErrors errors;    ///< as known before the scan
    std::vector<double> predicted;
    std::vector<double> radial;
    std::vector<std::uint8_t> is_moving;
    std::vector<std::uint8_t> may_be_object;  ///< of these, those that the tracker is to look at
    tracking::ScanPatches patches;            ///< of `whole` before it is deskewed
    ego_motion::DopplerRows rows;
    ego_motion::DopplerRows voting_rows;  ///< of these
    preprocess::VoxelMemory voxels;
    spatial::CellOrder sort;
  };

  [[nodiscard]] ScanView with_mountings(ScanView raw) const;
  void thin_and_sort(const ScanView& raw, Frame& frame);
  [[nodiscard]] tracking::SensorMotion predicted_motion(const Eigen::Vector3d& velocity_sensor) const;
  [[nodiscard]] const ego_motion::DopplerRows& rows_to_vote();
  void separate_static_points();
  [[nodiscard]] double noise_for(const ego_motion::EgoVelocity& ego) const;
  [[nodiscard]] ego_motion::VelocityFilterConfig filter_for(const ego_motion::EgoVelocity& ego) const;
  [[nodiscard]] window::WindowScan scan_at(double stamp_s) const;
  void take_out_lever_arms();
  [[nodiscard]] ego_motion::EgoPrior ego_prior() const;
  [[nodiscard]] ego_motion::EgoVelocity velocity_before() const;
  void begin(const window::WindowScan& now, const Eigen::Isometry3d& T_map_sensor, const window::StartOmega& omega);
  [[nodiscard]] bool was_misled() const;
  void begin_again(const window::WindowScan& now, Frame& frame);
  void update(const window::WindowScan& now, Frame& frame);
  void set_lost(const window::TrajectoryPoint& last, double dt_s, Frame& frame) const;
  [[nodiscard]] window::StartOmega start_omega() const;
  [[nodiscard]] std::optional<Eigen::Isometry3d> search_second(const window::WindowScan& now) const;
  [[nodiscard]] bool is_borne_out(const window::WindowScan& now) const;
  void renew_bent_map(const window::WindowScan& now, bool is_second, const Frame& frame);
  void describe(const window::WindowMotion& motion, double dt_s, Frame& frame) const;
  void predict_only(double stamp_s, FrameStatus status, Frame& frame) const;
  void judge_points(const window::WindowScan& now);
  void track_objects(const window::WindowScan& now, Frame& frame);
  [[nodiscard]] std::vector<window::SeenBody> measured_bodies(std::span<const tracking::TrackedObject> objects,
                                                              const motion::SweepMotion& sweep,
                                                              const Eigen::Isometry3d& T_world_sensor) const;
  [[nodiscard]] motion::SweepMotion sweep_of(const window::WindowScan& now) const;
  [[nodiscard]] Config configuration() const override { return config_; }
  void state(StateArchive& archive) override;

  WindowOdometryConfig config_;
  Workers workers_;
  DopplerKind expected_;
  ScanMemory memory_;
  std::optional<ego_motion::SupportPlane> support_;  ///< what carries the scene, in the scan at hand
  Scan static_points_;
  ego_motion::EgoVelocity ego_;
  ego_motion::AngularVelocity rig_rotation_;        ///< of a rig, by its Doppler alone
  std::vector<Eigen::Isometry3d> mountings_;        ///< of a rig, as its last scan has them
  std::optional<Eigen::Vector3d> lever_arm_omega_;  ///< rad/s: with it the lever arms are out of the Doppler
  mapping::PlaneMap map_;
  window::WindowEstimator estimator_;
  Scan first_points_;  ///< the only scan in the map, until the next one shows how it turned
  tracking::ObjectTracker tracker_;
  ScanStream stream_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
  double stamp_s_ = 0.0;
  double usual_match_ = 0.0;
  bool is_map_bent_ = false;     ///< its first scan was laid down without knowing how it turned
  bool is_map_renewed_ = false;  ///< it began anew for that
  int clear_scans_;              ///< since two motions explained the Doppler equally well
};

}  // namespace dynamic_icp::odometry
