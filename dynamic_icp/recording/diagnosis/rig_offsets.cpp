// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/rig_offsets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/diagnosis/judging.hpp"

namespace dynamic_icp::diagnosis {
namespace {

// Angles that are never told, known or not: what mountings are calibrated to, and how beams point.
constexpr double kCalibrated_rad = 0.5 * kDegree;

// Of an error by direction, velocity and bias hide about as much as they leave; in simulated units with the errors of
// real ones the hidden part is up to four times what the part that is left could pretend.
constexpr double kHidden = 1.5;

constexpr double kKnownRotation_rps = 0.02;   // of a stretch by its ends
constexpr double kUnknownRotation_rps = 0.3;  // vehicles in bends

// Ground truth drifts, and its poses have noise; a vehicle drives ahead but for side slip and bumps.
constexpr double kTruthDirection = 0.03;
constexpr double kTruth_mps = 0.1;
constexpr double kAheadDirection = 0.05;

Eigen::Matrix3d squared(double deviation) { return deviation * deviation * Eigen::Matrix3d::Identity(); }

VelocityEstimate sensor_estimate(const SensorLook& sensor, const Eigen::Isometry3d& T_scan_sensor) {
  VelocityEstimate estimate;
  estimate.velocity = sensor.ego.velocity_sensor;
  estimate.lever_arm = T_scan_sensor.translation();
  estimate.covariance = sensor.ego.covariance;
  estimate.lasting = kHidden * kHidden * sensor.pretended;
  estimate.is_known = sensor.has_velocity();
  return estimate;
}

/// The mean velocity of a stretch, in the axes of its middle.
VelocityEstimate truth_estimate(const Motion& motion) {
  VelocityEstimate estimate;
  const Eigen::Vector3d velocity = motion.T_from_to.translation() / motion.dt_s;
  estimate.velocity = exp_so3(-0.5 * log_so3(motion.T_from_to.linear())) * velocity;
  estimate.lasting = squared(kTruthDirection * velocity.norm() + kTruth_mps);
  estimate.is_known = velocity.norm() > kDirectionKnown_mps;
  return estimate;
}

VelocityEstimate ahead_estimate(double speed_mps) {
  VelocityEstimate estimate;
  estimate.velocity = speed_mps * Eigen::Vector3d::UnitX();
  estimate.lasting = squared(kAheadDirection * speed_mps);
  estimate.is_known = true;
  return estimate;
}

/// That of most sensors: a narrow one may take an error for a speed.
double speed_of_most(const std::vector<VelocityEstimate>& estimates) {
  std::vector<double> speeds;
  for (const VelocityEstimate& estimate : estimates) {
    if (estimate.is_known) {
      speeds.push_back(estimate.velocity.norm());
    }
  }
  return quantile(std::move(speeds), 0.25);
}

/// Columns: ahead, to the left, up.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& velocity) {
  const Eigen::Vector3d ahead = velocity.normalized();
  const Eigen::Vector3d z = std::abs(ahead.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d axes;
  axes.col(0) = ahead;
  axes.col(1) = z.cross(ahead).normalized();
  axes.col(2) = ahead.cross(axes.col(1));
  return axes;
}

double left_of(const Eigen::Vector3d& v) { return std::atan2(v.y(), v.x()); }
double up_of(const Eigen::Vector3d& v) { return std::atan2(v.z(), v.head<2>().norm()); }

/// Sums over the looks, in axes ahead, left and up of where estimate `to` is expected to move.
struct Sums {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  std::map<std::size_t, Eigen::Vector3d> of_stretch;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  Eigen::Vector3d lasting = Eigen::Vector3d::Zero();  ///< m/s, not squared
  double speed = 0.0;
  double looks = 0.0;
};

/// Standard error of an angle of the mean direction, by how the stretches scatter about it.
template <class Angle>
double scatter(const Sums& sums, const Angle& angle) {
  double squares = 0.0;
  for (const auto& [stretch, velocity] : sums.of_stretch) {
    const double off = std::remainder(angle(velocity) - angle(sums.velocity), 2.0 * std::numbers::pi);
    squares += off * off;
  }
  const auto count = static_cast<double>(sums.of_stretch.size());
  return count > 1.0 ? std::sqrt(squares / (count * (count - 1.0))) : 0.0;
}

}  // namespace

std::vector<RigLook> rig_looks_of(const Evidence& evidence, std::size_t sensors) {
  std::vector<RigLook> rig_looks;
  for (std::size_t i = 0; i < evidence.looks.size(); ++i) {
    const ScanLook& look = evidence.looks[i];
    if (look.sensors.size() != sensors) {
      continue;
    }
    RigLook rig_look;
    rig_look.stretch = i / kLooksOfStretch;
    for (std::size_t k = 0; k < sensors; ++k) {
      rig_look.estimates.push_back(sensor_estimate(look.sensors[k], look.mountings[k]));
    }
    const double speed_mps = speed_of_most(rig_look.estimates);
    if (speed_mps < kDirectionKnown_mps) {
      continue;
    }
    const Probe probe = rig_look.stretch < evidence.probes.size() ? evidence.probes[rig_look.stretch] : Probe{};
    const std::optional<Motion>& motion = probe.by_matching ? probe.by_matching : probe.by_truth;
    const bool is_known = motion && motion->dt_s > 0.0;
    const ScanLook& first = evidence.looks[rig_look.stretch * kLooksOfStretch];
    if (is_known && seconds_between(first.stamp, look.stamp) > 1.1 * motion->dt_s) {
      continue;  // the rotation is another by now
    }
    rig_look.omega = is_known ? log_so3(motion->T_from_to.linear()) / motion->dt_s : Eigen::Vector3d::Zero().eval();
    rig_look.omega_sigma = is_known ? kKnownRotation_rps : kUnknownRotation_rps;
    const bool has_truth = probe.by_truth && probe.by_truth->dt_s > 0.0;
    rig_look.has_truth = has_truth;
    rig_look.estimates.push_back(has_truth ? truth_estimate(*probe.by_truth) : ahead_estimate(speed_mps));
    rig_looks.push_back(std::move(rig_look));
  }
  return rig_looks;
}

bool Offset::contradicts() const {
  return is_known && (std::abs(left_rad) > left_limit_rad || std::abs(up_rad) > up_limit_rad);
}

double Offset::angle_rad() const { return std::acos(std::cos(left_rad) * std::cos(up_rad)); }

double Offset::limit_rad() const {
  return std::abs(left_rad) - left_limit_rad > std::abs(up_rad) - up_limit_rad ? left_limit_rad : up_limit_rad;
}

Offset offset(const std::vector<RigLook>& rig_looks, std::size_t from, std::size_t to, const Remounting& remounting) {
  const auto as_if = [&](std::size_t k) {
    return k < remounting.size() ? remounting[k] : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  };
  const Eigen::Matrix3d Q_from = as_if(from);
  const Eigen::Matrix3d Q_to = as_if(to);
  Offset offset;
  Sums sums;
  for (const RigLook& rig_look : rig_looks) {
    const VelocityEstimate& a = rig_look.estimates[from];
    const VelocityEstimate& b = rig_look.estimates[to];
    const Eigen::Vector3d arm = b.lever_arm - a.lever_arm;
    const Eigen::Vector3d expected = Q_from * a.velocity + rig_look.omega.cross(arm);
    if (!a.is_known || !b.is_known || expected.norm() < kDirectionKnown_mps) {
      continue;
    }
    const Eigen::Matrix3d axes = axes_of(expected);
    const auto variances = [&](const Eigen::Matrix3d& of_a, const Eigen::Matrix3d& of_b) {
      const Eigen::Matrix3d sum = Q_from * of_a * Q_from.transpose() + Q_to * of_b * Q_to.transpose();
      return Eigen::Vector3d((axes.transpose() * sum * axes).diagonal());
    };
    const Eigen::Vector3d velocity = axes.transpose() * Q_to * b.velocity;
    const Eigen::Vector3d of_rotation = Eigen::Vector3d::Constant(rig_look.omega_sigma * arm.norm());
    sums.velocity += velocity;
    sums.of_stretch.try_emplace(rig_look.stretch, Eigen::Vector3d::Zero()).first->second += velocity;
    sums.variance += variances(a.covariance, b.covariance);
    sums.lasting += (variances(a.lasting, b.lasting) + of_rotation.cwiseAbs2()).cwiseSqrt();
    sums.speed += expected.norm();
    sums.looks += 1.0;
    offset.axes = axes;
  }
  if (sums.looks == 0.0) {
    return offset;
  }
  offset.is_known = true;
  offset.left_rad = left_of(sums.velocity);
  offset.up_rad = up_of(sums.velocity);
  const auto limit = [&](Eigen::Index axis, double scattered) {
    const auto stretches = static_cast<double>(sums.of_stretch.size());
    const double speed = sums.speed / sums.looks;
    const double stated = std::sqrt(sums.variance[axis] / sums.looks / stretches) / speed;
    const double lasting = sums.lasting[axis] / sums.looks / speed;
    return kCalibrated_rad + kCertain * std::hypot(std::max(stated, scattered), lasting);
  };
  offset.left_limit_rad = limit(1, scatter(sums, left_of));
  offset.up_limit_rad = limit(2, scatter(sums, up_of));
  return offset;
}

}  // namespace dynamic_icp::diagnosis
