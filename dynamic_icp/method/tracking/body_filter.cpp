// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/body_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Measurements more than this many standard deviations off count as if they were just so many off (Huber's influence).
constexpr double kLargestInnovation = 3.0;
constexpr double kWorstSquare = 16.0;     // of a normalised residual, for the likelihood: all may happen
constexpr double kMinInformation = 1e-4;  // (s/m)^2: a standard deviation of 100 m/s
constexpr double kClimb_s = 1.0;          // how long vertical velocities last
constexpr double kAcceleration_s = 2.0;   // how long accelerations last
constexpr double kFaceWalk_m = 0.02;      // per square root of a second: bodies are no boxes

/// Covariance of the velocity's random walk over one second, in the ground: along and across the motion.
Matrix3d velocity_noise(const Vector3d& velocity, const Matrix3d& level, double along_mps, double across_mps) {
  const Vector3d up = level.col(2);
  const Vector3d horizontal = velocity - up.dot(velocity) * up;
  const double speed = horizontal.norm();
  const Vector3d along = speed > 0.0 ? Vector3d(horizontal / speed) : Vector3d(level.col(0));
  const Vector3d across = up.cross(along);
  return along_mps * along_mps * along * along.transpose() + across_mps * across_mps * across * across.transpose();
}

/// What accelerations that last tau add over t to the covariance of way, speed and acceleration, per (m/s^2)^2 of their
/// variance: 2 / tau int_0^t h h' ds, with h = (tau s - tau g, g, exp(-s / tau)) and g = tau (1 - exp(-s / tau)).
Matrix3d singer_noise(double t_s) {
  constexpr double tau = kAcceleration_s;
  const double u = t_s / tau;
  const double k = std::exp(-u);
  const double speed = tau * (1.0 - k);
  const double way = tau * (t_s - speed);
  const double ways = 2.0 * tau * tau * tau * tau * (u * u * u / 3.0 - u * u + u - 2.0 * u * k + 0.5 * (1.0 - k * k));
  const double speeds = tau * tau * (2.0 * u - 3.0 + 4.0 * k - k * k);
  const double way_and_rate = tau * tau * (1.0 - k * k - 2.0 * u * k);
  return Matrix3d{{ways, way * way / tau, way_and_rate},
                  {way * way / tau, speeds, speed * speed / tau},
                  {way_and_rate, speed * speed / tau, 1.0 - k * k}};
}

}  // namespace

ConfigFields fields(MotionNoise& noise) {
  return {
      {"along_mps", &noise.along_mps, 0.01, 100.0, "m/s/sqrt(s)",
       "random walk of the speed of an object without heading, along its motion"},
      {"across_mps", &noise.across_mps, 0.01, 100.0, "m/s/sqrt(s)",
       "random walk of its velocity, beyond what yaw rate and acceleration explain"},
      {"vertical_mps", &noise.vertical_mps, 0.01, 100.0, "m/s", "typical vertical velocity, which lasts a second"},
      {"yaw_rate_rps", &noise.yaw_rate_rps, 0.001, 100.0, "rad/s/sqrt(s)", "random walk of its yaw rate"},
      {"acceleration_mps2", &noise.acceleration_mps2, 0.0, 100.0, "m/s^2",
       "typical acceleration of an object with heading, which lasts two seconds"},
      {"slope", &noise.slope, 0.0, 1.0, "m/m", "slopes of roads: so much of its speed may be vertical, too"},
  };
}

double BodyFilter::yaw_sigma() const { return std::sqrt(P_(kYaw, kYaw)); }

Matrix3d BodyFilter::axes() const { return level_ * upright_axes(yaw()); }

/// Of a body that brakes; no time else. Nothing brakes beyond it.
double BodyFilter::time_to_stop_s() const {
  const double speed = axes().col(0).dot(velocity());
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!(speed * acceleration() < 0.0)) {
    return kNever;
  }
  const double left = 1.0 - std::abs(speed / acceleration()) / kAcceleration_s;
  return left > 0.0 ? -kAcceleration_s * std::log(left) : kNever;
}

void BodyFilter::predict(double dt_s, const MotionNoise& noise) {
  if (const double stop_s = time_to_stop_s(); stop_s < dt_s) {
    move(stop_s, noise);
    x_[kAcceleration] = 0.0;
    dt_s -= stop_s;
  }
  move(dt_s, noise);
}

void BodyFilter::move(double dt_s, const MotionNoise& noise) {
  const double t = std::abs(dt_s);
  const double sign = dt_s < 0.0 ? -1.0 : 1.0;
  const Vector3d v = velocity();
  const Matrix3d turn = exp_so3(up() * (yaw_rate() * dt_s));
  const Matrix3d half_turn = exp_so3(up() * (0.5 * yaw_rate() * dt_s));
  // Vertical velocities come back to zero with the time constant tau: an Ornstein-Uhlenbeck process.
  const Matrix3d vertical = up() * up().transpose();
  const double kept = std::exp(-t / kClimb_s);
  const double climbing_s = kClimb_s * (1.0 - kept);  // the way for each m/s
  const Matrix3d velocity_after = turn - (1.0 - kept) * vertical;
  const Matrix3d way = dt_s * half_turn + (sign * climbing_s - dt_s) * vertical;
  // So do accelerations: speed and way for each m/s^2.
  const double lasting = std::exp(-t / kAcceleration_s);
  const double accelerating_s = kAcceleration_s * (1.0 - lasting);
  const double speed_gain = sign * accelerating_s;
  const double way_gain = kAcceleration_s * (t - accelerating_s);
  const Vector3d ahead = half_turn * axes().col(0);
  const Vector3d left = up().cross(ahead);
  Eigen::Matrix<double, kFirstFace, kFirstFace> F = Eigen::Matrix<double, kFirstFace, kFirstFace>::Identity();
  F.block<3, 3>(0, kVelocity) = way;
  F.block<3, 1>(0, kYaw) = way_gain * acceleration() * left;
  F.block<3, 1>(0, kYawRate) = 0.5 * dt_s * (dt_s * up().cross(half_turn * v) + way_gain * acceleration() * left);
  F.block<3, 1>(0, kAcceleration) = way_gain * ahead;
  F.block<3, 3>(kVelocity, kVelocity) = velocity_after;
  F.block<3, 1>(kVelocity, kYaw) = speed_gain * acceleration() * left;
  F.block<3, 1>(kVelocity, kYawRate) = dt_s * (up().cross(turn * v) + 0.5 * speed_gain * acceleration() * left);
  F.block<3, 1>(kVelocity, kAcceleration) = speed_gain * ahead;
  F(kYaw, kYawRate) = dt_s;
  F(kAcceleration, kAcceleration) = lasting;
  x_.head<3>() += way * v + way_gain * acceleration() * ahead;
  x_.segment<3>(kVelocity) = velocity_after * v + speed_gain * acceleration() * ahead;
  x_[kYaw] += dt_s * yaw_rate();
  x_[kAcceleration] *= lasting;
  P_.topRows<kFirstFace>() = F.lazyProduct(P_.topRows<kFirstFace>()).eval();
  P_.leftCols<kFirstFace>() = P_.leftCols<kFirstFace>().lazyProduct(F.transpose()).eval();
  // White noise of the accelerations over t.
  const Matrix3d q = velocity_noise(v, level_, has_heading() ? noise.across_mps : noise.along_mps, noise.across_mps);
  const Matrix3d climb =
      (noise.vertical_mps * noise.vertical_mps + noise.slope * noise.slope * v.squaredNorm()) * vertical;
  const Matrix3d shared = sign * (t * t / 2.0 * q + climbing_s * climbing_s / kClimb_s * climb);
  P_.block<3, 3>(0, 0) += t * t * t / 3.0 * q + (2.0 * kClimb_s * (t - climbing_s) - climbing_s * climbing_s) * climb;
  P_.block<3, 3>(0, kVelocity) += shared;
  P_.block<3, 3>(kVelocity, 0) += shared;
  P_.block<3, 3>(kVelocity, kVelocity) += t * q + (1.0 - kept * kept) * climb;
  if (has_heading()) {
    const double turning = noise.yaw_rate_rps * noise.yaw_rate_rps;
    P_(kYaw, kYaw) += t * t * t / 3.0 * turning;
    P_(kYaw, kYawRate) += sign * t * t / 2.0 * turning;
    P_(kYawRate, kYaw) += sign * t * t / 2.0 * turning;
    P_(kYawRate, kYawRate) += t * turning;
    Eigen::Matrix<double, kFirstFace, 3> moved = Eigen::Matrix<double, kFirstFace, 3>::Zero();
    moved.block<3, 1>(0, 0) = ahead;
    moved.block<3, 1>(kVelocity, 1) = sign * ahead;
    moved(kAcceleration, 2) = 1.0;
    P_.topLeftCorner<kFirstFace, kFirstFace>() +=
        moved * (noise.acceleration_mps2 * noise.acceleration_mps2 * singer_noise(t)) * moved.transpose();
  }
  P_.diagonal().tail<kStates - kFirstFace>().array() += t * kFaceWalk_m * kFaceWalk_m;
}

double BodyFilter::correct(const Row& H, double residual, double variance) {
  const Vector PHt = P_ * H.transpose();
  const double predicted = H * PHt;
  double S = predicted + variance;
  const double log_likelihood = -0.5 * std::min(residual * residual / S, kWorstSquare) - 0.5 * std::log(S / variance);
  const double excess = std::abs(residual) / (kLargestInnovation * std::sqrt(S));
  if (excess > 1.0) {
    variance = excess * S - predicted;
    S = predicted + variance;
  }
  const Vector K = PHt / S;
  x_ += K * residual;
  P_.noalias() -= K * PHt.transpose();
  return log_likelihood;
}

BodyFilter::Row BodyFilter::face_jacobian(Face face, const Vector3d& seen) const {
  const Matrix3d box = axes();
  const int axis = axis_of(face);
  Row H = Row::Zero();
  H.head<3>() = side_of(face) * box.col(axis).transpose();
  H[index(face)] = 1.0;
  if (axis < 2) {
    const Vector3d turned = side_of(face) * (axis == 0 ? Vector3d(box.col(1)) : Vector3d(-box.col(0)));
    H[kYaw] = -turned.dot(seen - position());
  }
  return H;
}

double BodyFilter::beyond(Face face, const Vector3d& seen) const {
  return side_of(face) * axes().col(axis_of(face)).dot(seen - position()) - distance(face);
}

double BodyFilter::beyond_sigma(Face face, const Vector3d& seen) const {
  const Row H = face_jacobian(face, seen);
  return std::sqrt(H * P_ * H.transpose());
}

double BodyFilter::correct_face(Face face, const Vector3d& seen, double variance) {
  return correct(face_jacobian(face, seen), beyond(face, seen), variance);
}

void BodyFilter::forget_face(Face face, double variance) {
  P_.row(index(face)).setZero();
  P_.col(index(face)).setZero();
  P_(index(face), index(face)) = variance;
}

double BodyFilter::correct_position(int axis, const Vector3d& seen, double variance) {
  const Vector3d direction = axes().col(axis);
  Row H = Row::Zero();
  H.head<3>() = direction.transpose();
  return correct(H, direction.dot(seen - position()), variance);
}

double BodyFilter::correct_yaw(double yaw_rad, double variance) {
  Row H = Row::Zero();
  H[kYaw] = 1.0;
  return correct(H, std::remainder(yaw_rad - yaw(), 2.0 * std::numbers::pi), variance);
}

double BodyFilter::correct_yaw_rate(double yaw_rate_rps, double variance) {
  Row H = Row::Zero();
  H[kYawRate] = 1.0;
  return correct(H, yaw_rate_rps - yaw_rate(), variance);
}

void BodyFilter::stop(double variance) {
  Row H = Row::Zero();
  for (const int axis : {0, 1}) {
    H.segment<3>(kVelocity) = level_.col(axis).transpose();
    correct(H, -level_.col(axis).dot(velocity()), variance);
  }
  x_[kAcceleration] = 0.0;
  P_.row(kAcceleration).setZero();
  P_.col(kAcceleration).setZero();
}

double BodyFilter::correct_sideslip(double variance) {
  const Matrix3d box = axes();
  const double ahead = 0.5 * (distance(Face::kFront) - distance(Face::kRear));
  Row H = Row::Zero();
  H.segment<3>(kVelocity) = box.col(1).transpose();
  H[kYaw] = -box.col(0).dot(velocity());
  H[kYawRate] = ahead;
  H[index(Face::kFront)] = 0.5 * yaw_rate();
  H[index(Face::kRear)] = -0.5 * yaw_rate();
  return correct(H, -box.col(1).dot(velocity()) - yaw_rate() * ahead, variance);
}

Vector3d BodyFilter::doppler_velocity(const Vector3d& sensor_world) const {
  return velocity() - yaw_rate() * up().cross(position() - sensor_world);
}

Eigen::Matrix<double, 3, BodyFilter::kStates> BodyFilter::doppler_jacobian(const Vector3d& sensor_world) const {
  Eigen::Matrix<double, 3, kStates> H = Eigen::Matrix<double, 3, kStates>::Zero();
  H.leftCols<3>() = -yaw_rate() * skew(up());
  H.middleCols<3>(kVelocity).setIdentity();
  H.col(kYawRate) = -up().cross(position() - sensor_world);
  return H;
}

Matrix3d BodyFilter::doppler_covariance(const Vector3d& sensor_world) const {
  const Eigen::Matrix<double, 3, kStates> H = doppler_jacobian(sensor_world);
  return H * P_ * H.transpose();
}

Vector3d BodyFilter::velocity_at(const Vector3d& from_reference) const {
  return velocity() + yaw_rate() * up().cross(axes() * from_reference);
}

Matrix3d BodyFilter::velocity_covariance_at(const Vector3d& from_reference) const {
  const Vector3d r = axes() * from_reference;
  Eigen::Matrix<double, 3, kStates> H = Eigen::Matrix<double, 3, kStates>::Zero();
  H.middleCols<3>(kVelocity).setIdentity();
  H.col(kYawRate) = up().cross(r);
  H.col(kYaw) = yaw_rate() * up().cross(up().cross(r));
  return H * P_ * H.transpose();
}

double BodyFilter::correct_doppler(const ClusterVelocity& measured, const Vector3d& sensor_world, const Matrix3d& floor,
                                   double beam_sigma_mps) {
  double log_likelihood = 0.0;
  // The parts along the eigenvectors are independent of each other; those without information drop out.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(measured.information);
  for (int i = 2; i >= 0; --i) {
    const double information = eigen.eigenvalues()[i];
    if (information < kMinInformation) {
      continue;
    }
    const Vector3d e = eigen.eigenvectors().col(i);
    const Row H = e.transpose() * doppler_jacobian(sensor_world);
    const double residual = e.dot(measured.W - doppler_velocity(sensor_world));
    const double of_beams = beam_sigma_mps * beam_sigma_mps * eigen.eigenvalues()[2] / information;
    log_likelihood += correct(H, residual, 1.0 / information + of_beams + e.dot(floor * e));
  }
  return log_likelihood;
}

void BodyFilter::turn_around() {
  x_[kYaw] += std::numbers::pi;
  x_[kAcceleration] = -x_[kAcceleration];
  P_.row(kAcceleration) = -P_.row(kAcceleration);
  P_.col(kAcceleration) = -P_.col(kAcceleration);
  for (const Face face : {Face::kFront, Face::kLeft}) {
    const int i = index(face);
    std::swap(x_[i], x_[i + 1]);
    P_.row(i).swap(P_.row(i + 1));
    P_.col(i).swap(P_.col(i + 1));
  }
}

void BodyFilter::state(StateArchive& archive) {
  archive(x_, P_, level_);
  constexpr double kFarthest_m = 1e7;  // of a place of the world
  constexpr double kFastest = 1e6;     // m/s and rad/s, and turns in rad
  constexpr double kLargest_m = 1e4;   // of a body
  archive.require(position().cwiseAbs().maxCoeff() <= kFarthest_m &&
                      x_.segment<kFirstFace - kVelocity>(kVelocity).cwiseAbs().maxCoeff() <= kFastest &&
                      x_.tail<kStates - kFirstFace>().cwiseAbs().maxCoeff() <= kLargest_m,
                  "the state of an object");
}

}  // namespace dynamic_icp::tracking
