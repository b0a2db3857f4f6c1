// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/motion_by_geometry.hpp"

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/registration/translation_search.hpp"

namespace dynamic_icp::odometry {
namespace {

// m, for a first motion of which nothing is known.
constexpr double kWideGates_m[] = {1.0, 0.5};

}  // namespace

void MotionByGeometry::update(const Frame& frame, double dt_s) {
  if (is_aligned(frame.status) || twist_) {
    twist_ = log_se3(frame.T_target_source) / dt_s;
  }
}

registration::Alignment MotionByGeometry::align(const Scan& source, const registration::Target& target,
                                                const Eigen::Isometry3d& T_start, double dt_s,
                                                registration::AlignConfig config, const Workers& workers) const {
  config.doppler_weight = 0.0;
  if (twist_) {
    return registration::align(source, target, T_start, config, workers);
  }
  const double gate_m = config.max_correspondence_distance_m;
  Eigen::Isometry3d T_found = registration::search_translation(source, target, dt_s, {}, workers).T_target_source;
  for (const double wide_gate_m : kWideGates_m) {
    config.max_correspondence_distance_m = wide_gate_m;
    T_found = registration::align(source, target, T_found, config, workers).T_target_source;
  }
  config.max_correspondence_distance_m = gate_m;
  return registration::align(source, target, T_found, config, workers);
}

ego_motion::EgoVelocity MotionByGeometry::velocity(const Eigen::Vector3d& velocity_sensor) const {
  ego_motion::EgoVelocity ego = static_frame(Scan());
  if (twist_) {
    ego.status = ego_motion::EgoVelocityStatus::kFromMotion;
    ego.velocity_sensor = velocity_sensor;
  }
  return ego;
}

void MotionByGeometry::state(StateArchive& archive) { archive(twist_); }

}  // namespace dynamic_icp::odometry
