// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/spline_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

constexpr std::size_t kOrder = 4;

std::array<double, 4> weights(double x) {
  const double y = 1.0 - x;
  return {y * y * y / 6.0, (x * x * (3.0 * x - 6.0) + 4.0) / 6.0, (x * (x * (3.0 - 3.0 * x) + 3.0) + 1.0) / 6.0,
          x * x * x / 6.0};
}

std::array<double, 4> slopes(double x) {
  return {-0.5 * (1.0 - x) * (1.0 - x), 0.5 * x * (3.0 * x - 4.0), 0.5 * (x * (2.0 - 3.0 * x) + 1.0), 0.5 * x * x};
}

}  // namespace

void SplineTrajectory::begin(double time_s, double until_s, const Eigen::Isometry3d& T_map_sensor,
                             const Eigen::Vector3d& velocity, const Eigen::Vector3d& omega) {
  T_map_reference_ = T_map_sensor;
  first_ = static_cast<long>(std::floor(time_s / h_));
  c_.clear();
  const auto count = static_cast<std::size_t>(std::floor(until_s / h_)) - static_cast<std::size_t>(first_) + kOrder;
  for (std::size_t k = 0; k < count; ++k) {
    // The coefficient of a straight line is its value in the middle of the four intervals that it acts upon.
    const double t = (static_cast<double>(first_) + static_cast<double>(k) - 1.0) * h_ - time_s;
    Vector6d c;
    c << omega * t, velocity * t;
    c_.push_back(c);
  }
  v_.assign(c_.size(), Vector6d::Zero());
}

void SplineTrajectory::set_constant_twist(double time_s, const Eigen::Vector3d& velocity,
                                          const Eigen::Vector3d& omega) {
  const TrajectoryPoint from = at(time_s);
  Eigen::Isometry3d T_reference_from = Eigen::Isometry3d::Identity();
  T_reference_from.linear() = from.R;
  T_reference_from.translation() = from.p;
  Vector6d twist;
  twist << omega, velocity;
  for (std::size_t k = 0; k < c_.size(); ++k) {
    const double t = interval_begin(k) - h_ - time_s;
    const Eigen::Isometry3d T = T_reference_from * exp_se3(t * twist);
    c_[k] << log_so3(T.linear()), T.translation();
  }
  v_.assign(c_.size(), Vector6d::Zero());
}

std::size_t SplineTrajectory::extend(double until_s, double memory_s) {
  const std::size_t before = c_.size();
  const auto back = std::min<std::size_t>(before - 1, static_cast<std::size_t>(std::max(1.0, memory_s / h_ + 0.5)));
  const Vector6d step = (c_[before - 1] - c_[before - 1 - back]) / static_cast<double>(back);
  while (interval_begin(c_.size() - kOrder + 1) <= until_s) {
    c_.push_back(c_.back() + step);
  }
  v_.resize(c_.size(), Vector6d::Zero());
  return c_.size() - before;
}

std::size_t SplineTrajectory::drop_before(double time_s) {
  const std::size_t count = interval(time_s);
  c_.erase(c_.begin(), c_.begin() + static_cast<std::ptrdiff_t>(count));
  v_.erase(v_.begin(), v_.begin() + static_cast<std::ptrdiff_t>(count));
  first_ += static_cast<long>(count);
  return count;
}

std::vector<Matrix6d> SplineTrajectory::move_reference(double time_s) {
  const TrajectoryPoint to = at(time_s);
  std::vector<Matrix6d> changes;
  changes.reserve(c_.size());
  for (Vector6d& c : c_) {
    const Eigen::Matrix3d J_before = right_jacobian_so3(c.head<3>());
    c.head<3>() = log_so3(to.R.transpose() * exp_so3(c.head<3>()));
    c.tail<3>() = to.R.transpose() * (c.tail<3>() - to.p);
    Matrix6d A = Matrix6d::Zero();
    A.topLeftCorner<3, 3>() = J_before.inverse() * right_jacobian_so3(c.head<3>());
    A.bottomRightCorner<3, 3>() = to.R;
    changes.push_back(A);
  }
  for (std::size_t k = 0; k < v_.size(); ++k) {
    v_[k] = changes[k].partialPivLu().solve(v_[k]).eval();
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = to.R;
  T.translation() = to.p;
  T_map_reference_ = T_map_reference_ * T;
  T_map_reference_.linear() = Eigen::Quaterniond(T_map_reference_.linear()).normalized().toRotationMatrix();
  return changes;
}

std::size_t SplineTrajectory::interval(double time_s) const {
  const long number = static_cast<long>(std::floor(time_s / h_)) - first_;
  return static_cast<std::size_t>(std::clamp(number, 0L, static_cast<long>(c_.size() - kOrder)));
}

double SplineTrajectory::interval_begin(std::size_t interval) const {
  return static_cast<double>(first_ + static_cast<long>(interval)) * h_;
}

TrajectoryPoint SplineTrajectory::at(double time_s) const {
  TrajectoryPoint point;
  point.first = interval(time_s);
  const double x = (time_s - interval_begin(point.first)) / h_;
  point.weight = weights(x);
  point.slope = slopes(x);
  Vector6d value = Vector6d::Zero();
  Vector6d rate = Vector6d::Zero();
  for (std::size_t k = 0; k < kOrder; ++k) {
    point.slope[k] /= h_;
    value += point.weight[k] * c_[point.first + k];
    rate += point.slope[k] * c_[point.first + k];
  }
  point.R = exp_so3(value.head<3>());
  point.p = value.tail<3>();
  point.J = right_jacobian_so3(value.head<3>());
  point.velocity = point.R.transpose() * rate.tail<3>();
  point.omega = point.J * rate.head<3>();
  return point;
}

Eigen::Isometry3d SplineTrajectory::pose(double time_s) const {
  const TrajectoryPoint point = at(time_s);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = point.R;
  T.translation() = point.p;
  return T_map_reference_ * T;
}

Eigen::Vector3d TrajectoryPoint::place(const Eigen::Vector3d& x, double step_s) const {
  return R * (x + step_s * (omega.cross(x) + velocity)) + p;
}

bool SampledMotion::is_near(const SampledMotion& other, double velocity_mps, double omega_rad_s) const {
  if (velocity_.size() != other.velocity_.size()) {
    return false;
  }
  for (std::size_t k = 0; k < velocity_.size(); ++k) {
    if ((velocity_[k] - other.velocity_[k]).norm() > velocity_mps ||
        (omega_[k] - other.omega_[k]).norm() > omega_rad_s) {
      return false;
    }
  }
  return true;
}

SampledMotion::SampledMotion(const SplineTrajectory& trajectory, double first_s, double last_s)
    : first_s_(first_s), per_step_(kSlices / trajectory.knot_spacing()) {
  const auto steps = static_cast<std::size_t>(std::ceil(std::max(0.0, last_s - first_s) * per_step_));
  for (std::size_t k = 0; k <= steps; ++k) {
    const TrajectoryPoint at = trajectory.at(first_s + static_cast<double>(k) / per_step_);
    velocity_.push_back(at.velocity);
    omega_.push_back(at.omega);
  }
}

void SplineTrajectory::state(StateArchive& archive) {
  archive(first_, T_map_reference_, c_, v_);
  constexpr double kLongest_s = 1e9;
  archive.require(c_.size() == v_.size() && (c_.empty() || c_.size() >= kOrder), "the length of the trajectory");
  archive.require(std::abs(static_cast<double>(first_)) * h_ < kLongest_s, "the time of the trajectory");
}

bool SplineTrajectory::spans(double from_s, double to_s) const {
  constexpr double kSlack = 2.0;  // knot intervals, for the error of stamps
  return c_.size() >= kOrder && interval_begin(0) <= from_s + kSlack * h_ &&
         interval_begin(c_.size() - kOrder + 1) >= to_s - kSlack * h_;
}

}  // namespace dynamic_icp::window
