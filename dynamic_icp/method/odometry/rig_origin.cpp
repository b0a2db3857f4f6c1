// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/rig_origin.hpp"

namespace dynamic_icp::odometry {
namespace {

/// X T X^-1 with X = (I, middle), the motion of the origin.
Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Eigen::Vector3d& middle) {
  Eigen::Isometry3d result = T;
  result.translation() += middle - T.linear() * middle;
  return result;
}

/// The adjoint of X: [omega; rho] -> [omega; rho + middle x omega], for perturbations and twists.
Matrix6d adjoint(const Eigen::Vector3d& middle) {
  Matrix6d Ad = Matrix6d::Identity();
  Ad.bottomLeftCorner<3, 3>() = skew(middle);
  return Ad;
}

void move_alignment(registration::Alignment& alignment, const Eigen::Vector3d& middle) {
  const Matrix6d Ad = adjoint(middle);
  alignment.T_target_source = moved(alignment.T_target_source, middle);
  if (alignment.covariance) {
    alignment.covariance = Ad * *alignment.covariance * Ad.transpose();
  }
  for (estimation::DegenerateDirection& weak : alignment.degenerate) {
    weak.direction.tail<3>() += middle.cross(weak.direction.head<3>() / alignment.length_m);
    weak.direction.normalize();
  }
}

}  // namespace

Eigen::Vector3d middle_of_sensors(const Scan& scan) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& T_scan_sensor : scan.mountings()) {
    sum += T_scan_sensor.translation();
  }
  return sum / static_cast<double>(scan.mountings().size());
}

Frame seen_from_origin(Frame frame, const Eigen::Vector3d& middle) {
  frame.T_world_sensor = moved(frame.T_world_sensor, middle);
  frame.T_target_source = moved(frame.T_target_source, middle);
  move_alignment(frame.alignment, middle);
  if (frame.twist) {
    const Eigen::Matrix3d lever = skew(middle);
    const Matrix6d Ad = adjoint(middle);
    frame.ego.velocity_sensor += middle.cross(frame.twist->angular);
    frame.ego.covariance += lever * frame.twist->covariance.topLeftCorner<3, 3>() * lever.transpose();
    frame.twist->linear += middle.cross(frame.twist->angular);
    frame.twist->covariance = Ad * frame.twist->covariance * Ad.transpose();
  }
  for (dynamics::ObjectEstimate& cluster : frame.clusters) {
    cluster.centroid += middle;
  }
  for (tracking::TrackedObject& object : frame.tracked) {
    object.centroid += middle;
    object.box.centre += middle;
  }
  for (Eigen::Vector3d& point : frame.static_points) {
    point += middle;
  }
  return frame;
}

}  // namespace dynamic_icp::odometry
