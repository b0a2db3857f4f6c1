// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/rig_doppler.hpp"

#include <cstdint>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr double kUnknownVelocity_mps = 30.0;
constexpr double kStartRotation_rad_s = 0.5;  // of a vehicle at its first scan

}  // namespace

std::vector<std::vector<std::uint32_t>> rows_by_sensor(const Scan& scan) {
  std::vector<std::vector<std::uint32_t>> rows(scan.mountings().size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    rows[scan.channels().sensor[i]].push_back(static_cast<std::uint32_t>(i));
  }
  return rows;
}

void take_out_lever_arms(Scan& scan, const Eigen::Vector3d& omega, const Workers& workers, double sign) {
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    const std::uint8_t k = scan.channels().sensor[i];
    const Eigen::Vector3d of_lever_arm = omega.cross(scan.mountings()[k].translation());
    scan.shift_doppler(i, sign * scan.directions()[i].dot(of_lever_arm));
  });
}

AngularVelocity rig_angular_velocity(std::span<const Eigen::Isometry3d> mountings,
                                     std::span<const EgoVelocity> of_sensors) {
  Matrix6d information = Matrix6d::Zero();
  information.topLeftCorner<3, 3>().diagonal().setConstant(1.0 / (kUnknownVelocity_mps * kUnknownVelocity_mps));
  information.bottomRightCorner<3, 3>().diagonal().setConstant(1.0 / (kStartRotation_rad_s * kStartRotation_rad_s));
  Vector6d right = Vector6d::Zero();
  for (std::size_t k = 0; k < of_sensors.size(); ++k) {
    const Eigen::Matrix3d weight = of_sensors[k].covariance.inverse();
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -skew(mountings[k].translation());
    information += J.transpose() * weight * J;
    right += J.transpose() * weight * of_sensors[k].velocity_sensor;
  }
  const Matrix6d covariance = information.ldlt().solve(Matrix6d::Identity());
  return {(covariance * right).tail<3>(), covariance.bottomRightCorner<3, 3>()};
}

AngularVelocity rig_angular_velocity(const Scan& scan, const ConsensusRegressionConfig& config,
                                     const Workers& workers) {
  std::vector<EgoVelocity> of_sensors;
  for (const std::vector<std::uint32_t>& rows : rows_by_sensor(scan)) {
    of_sensors.push_back(estimate_velocity(scan.select(rows), EgoPrior{}, config, workers));
  }
  return rig_angular_velocity(scan.mountings(), of_sensors);
}

}  // namespace dynamic_icp::ego_motion
