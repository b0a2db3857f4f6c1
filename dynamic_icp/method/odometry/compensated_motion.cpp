// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/compensated_motion.hpp"

#include <cmath>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr double kUnknown_mps = 30.0;
constexpr double kStationary_mps = 0.5;

}  // namespace

std::string compensated_doppler_note() {
  return "the Doppler is compensated: it shows what moves, but not the velocity of the sensor, which is that of the "
         "alignment";
}

ego_motion::EgoVelocity static_frame(const Scan& scan) {
  ego_motion::EgoVelocity ego;
  double squares = 0.0;
  for (const double doppler : scan.doppler()) {
    if (std::abs(doppler) < kStationary_mps) {
      squares += doppler * doppler;
      ++ego.inliers;
    }
  }
  ego.points = scan.size();
  ego.inlier_rms_mps = ego.inliers > 0 ? std::sqrt(squares / static_cast<double>(ego.inliers)) : 0.0;
  return ego;
}

ego_motion::EgoVelocity unknown_velocity() {
  ego_motion::EgoVelocity ego;
  ego.covariance = kUnknown_mps * kUnknown_mps * Eigen::Matrix3d::Identity();
  ego.joint_covariance = ego_motion::EgoPrior::default_covariance();
  ego.joint_covariance.topLeftCorner<3, 3>() = ego.covariance;
  return ego;
}

}  // namespace dynamic_icp::odometry
