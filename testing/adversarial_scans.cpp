// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "testing/adversarial_scans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::adversarial {
namespace {

using Eigen::Vector3d;
using Limits = std::numeric_limits<double>;

constexpr double kYawRate_rps = 0.3;
constexpr double kRadius_m = 8.0;
constexpr double kSweep_s = 0.08;
const Vector3d kHallHalf_m(30.0, 20.0, 3.0);

/// T_hall_sensor of a drive in a circle.
Eigen::Isometry3d pose_at(double time_s) {
  const double yaw = kYawRate_rps * time_s;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = kRadius_m * Vector3d(std::sin(yaw), -std::cos(yaw), 0.0);
  return T;
}

/// Where a ray from inside meets the walls of the hall, m.
double range_to_walls(const Vector3d& origin, const Vector3d& direction) {
  double range = 1e3;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] != 0.0) {
      const double wall = std::copysign(kHallHalf_m[axis], direction[axis]);
      range = std::min(range, (wall - origin[axis]) / direction[axis]);
    }
  }
  return range;
}

void add_row(RawScan& raw, const Vector3d& point, double doppler) {
  raw.points.push_back(point);
  raw.doppler.push_back(doppler);
}

}  // namespace

ScanGenerator::ScanGenerator(std::uint64_t seed, std::span<const std::uint8_t> script)
    : random_(seed), script_(script), rig_(seed % 3 == 2) {
  swept_ = one_in(2);
  kind_ = one_in(5) ? DopplerKind::kCompensated : DopplerKind::kRelative;
  constexpr std::int64_t kFar = std::int64_t{1} << 62;
  constexpr std::array<std::int64_t, 4> kStarts = {0, 1'700'000'000'000'000'000, -kFar - 1, kFar + 1};
  stamp_.ns = kStarts.at(choose(kStarts.size()));
}

std::uint64_t ScanGenerator::bits() {
  if (script_.empty()) {
    return random_.bits(drawn_++);
  }
  const std::uint64_t byte = script_.front();
  script_ = script_.subspan(1);
  return byte << 56;  // choices and uniform numbers are made of the highest bits
}

std::size_t ScanGenerator::choose(std::size_t count) {
  return static_cast<std::size_t>(uniform(0.0, static_cast<double>(count)));
}

double ScanGenerator::uniform(double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(bits() >> 11), -53);
}

double ScanGenerator::special_number() {
  constexpr std::array kNumbers = {0.0,
                                   -0.0,
                                   Limits::denorm_min(),
                                   1e-300,
                                   1e-12,
                                   1.0,
                                   10.0,
                                   300.0,
                                   kMaxDoppler_mps,
                                   kMaxCoordinate_m,
                                   2.0 * kMaxCoordinate_m,
                                   1e9,
                                   1e30,
                                   3.4e38,
                                   1e150,
                                   1e155,
                                   1e200,
                                   Limits::max(),
                                   Limits::infinity(),
                                   Limits::quiet_NaN()};
  return (one_in(2) ? -1.0 : 1.0) * kNumbers.at(choose(kNumbers.size()));
}

Stamp ScanGenerator::next_stamp() {
  constexpr std::int64_t kSecond = 1'000'000'000;
  constexpr std::array<std::int64_t, 10> kSteps = {
      0, 1, 1'000, 999'999, 1'000'000, 10'000'000, kSecond, 2 * kSecond, 90 * kSecond, 400'000'000 * kSecond};
  const std::int64_t step = one_in(6) ? kSteps.at(choose(kSteps.size())) : kSecond / 10;
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  stamp_.ns = stamp_.ns > kMax - step ? kMax : stamp_.ns + step;
  return stamp_;
}

void ScanGenerator::fill_hall(RawScan& raw, std::size_t size) {
  const double begin_s = 0.1 * scans_;
  for (std::size_t i = 0; i < size; ++i) {
    const double time_s = swept_ ? kSweep_s * static_cast<double>(i) / static_cast<double>(size) : 0.0;
    const Eigen::Isometry3d T_hall_sensor = pose_at(begin_s + time_s);
    const double azimuth = uniform(-1.0, 1.0) * std::numbers::pi / 3.0;
    const Vector3d u = Vector3d(std::cos(azimuth), std::sin(azimuth), uniform(-0.3, 0.3)).normalized();
    const Vector3d velocity = kRadius_m * kYawRate_rps * Vector3d::UnitX();  // of the sensor, in its own axes
    const bool on_box = std::abs(azimuth - 0.2) < 0.1;
    const double range = on_box ? 7.0 : range_to_walls(T_hall_sensor.translation(), T_hall_sensor.linear() * u);
    const double object = on_box ? 4.0 * u.x() : 0.0;
    add_row(raw, range * u, object - (kind_ == DopplerKind::kRelative ? u.dot(velocity) : 0.0) + uniform(-0.05, 0.05));
    if (swept_) {
      raw.times.push_back(time_s);
    }
  }
}

void ScanGenerator::fill_shape(RawScan& raw, std::size_t size) {
  constexpr std::array kScales = {1e-13, 1e-3, 1.0, 100.0, 1e4, kMaxCoordinate_m, 1e7, 1e30};
  const double scale = kScales.at(choose(kScales.size()));
  const std::size_t shape = choose(6);
  const double speed = one_in(3) ? 0.0 : std::abs(special_number());
  for (std::size_t i = 0; i < size; ++i) {
    const double a = uniform(-1.0, 1.0);
    const double b = uniform(-1.0, 1.0);
    const std::array<Vector3d, 6> places = {Vector3d(1.0, 0.5, 0.1),  // one point
                                            Vector3d(a, 0.0, 0.0),    // a line through the sensor
                                            Vector3d(a, 0.3, 0.1),    // a line beside it
                                            Vector3d(std::cos(3.0 * a), std::sin(3.0 * a), 0.0),  // a ring
                                            Vector3d(a, b, -0.2),                                 // a plane
                                            Vector3d(a, b, uniform(-1.0, 1.0))};                  // a cloud
    add_row(raw, scale * places.at(shape), speed * uniform(-1.0, 1.0));
    if (swept_) {
      raw.times.push_back(uniform(0.0, kSweep_s));
    }
  }
}

/// One column as a whole: what it should not be.
void ScanGenerator::replace_column(RawScan& raw) {
  const double number = special_number();
  switch (choose(6)) {
    case 0:
      raw.doppler.assign(raw.doppler.size(), number);
      break;
    case 1:
      std::ranges::generate(raw.doppler, [&] { return number * uniform(-1.0, 1.0); });
      break;
    case 2:
      raw.times.resize(raw.points.size());
      std::ranges::generate(raw.times, [&] { return number * uniform(0.0, 1.0); });
      break;
    case 3:
      raw.directions.assign(raw.points.size(), Vector3d(0.0, 0.0, number));
      break;
    case 4:
      raw.directions = raw.points;
      break;
    default:
      raw.times.clear();
  }
}

/// A few numbers anywhere.
void ScanGenerator::damage(RawScan& raw) {
  const std::size_t count = one_in(2) ? 1 : 1 + raw.points.size() / 10;
  for (std::size_t k = 0; k < count && !raw.points.empty(); ++k) {
    const std::size_t row = choose(raw.points.size());
    switch (choose(raw.times.empty() ? 2 : 3)) {
      case 0:
        raw.points[row][static_cast<Eigen::Index>(choose(3))] = special_number();
        break;
      case 1:
        raw.doppler[row] = special_number();
        break;
      default:
        raw.times[row] = special_number();
    }
  }
}

RawScan ScanGenerator::next() {
  constexpr std::array<std::size_t, 8> kSizes = {0, 1, 5, 7, 45, 200, 600, 1001};
  RawScan raw;
  raw.stamp = next_stamp();
  raw.doppler_kind = kind_;
  const std::size_t size = one_in(4) ? kSizes.at(choose(kSizes.size())) : 600;
  if (one_in(5)) {
    fill_shape(raw, size);
  } else {
    fill_hall(raw, size);
  }
  if (one_in(8)) {
    replace_column(raw);
  }
  if (one_in(3)) {
    damage(raw);
  }
  if (rig_) {
    make_rig(raw);
  }
  ++scans_;
  return raw;
}

/// Says that sensors in several places measured the points, which the Doppler contradicts.
void ScanGenerator::make_rig(RawScan& raw) const {
  const std::size_t sensors = 1 + static_cast<std::size_t>(scans_) / 7 % 4;
  for (std::size_t k = 0; k < sensors; ++k) {
    raw.mountings.push_back(
        Eigen::Isometry3d(Eigen::Translation3d(static_cast<double>(k), 0.3, scans_ == 17 ? 1e5 : 2.0)));
  }
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    raw.channels.sensor.push_back(static_cast<std::uint8_t>(i * i % sensors));
  }
}

std::optional<std::string> fault_of(const odometry::Frame& frame, const RawScan& raw, double dt_s) {
  const auto is_rotation = [](const Eigen::Matrix3d& R) {
    return (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-6;  // false for NaN
  };
  const auto is_motion = [&](const Eigen::Isometry3d& T) {
    return T.translation().allFinite() && is_rotation(T.linear());
  };
  if (!is_motion(frame.T_world_sensor) || !is_motion(frame.T_target_source)) {
    return "a pose is not a rigid motion";
  }
  if (!frame.ego.velocity_sensor.allFinite() || !frame.ego.covariance.allFinite()) {
    return "the ego velocity is not finite";
  }
  if (frame.twist &&
      !(frame.twist->linear.allFinite() && frame.twist->angular.allFinite() && frame.twist->covariance.allFinite())) {
    return "the twist is not finite";
  }
  if (frame.alignment.covariance && !frame.alignment.covariance->allFinite()) {
    return "the covariance of the motion is not finite";
  }
  if (!std::isfinite(frame.alignment.fitness) || !std::isfinite(frame.alignment.inlier_rmse) ||
      !std::isfinite(frame.alignment.information_ratio)) {
    return "a figure of the alignment is not finite";
  }
  for (const dynamics::ObjectEstimate& object : frame.clusters) {
    if (!object.velocity_sensor.allFinite() || !object.covariance.allFinite() || !object.centroid.allFinite()) {
      return "a cluster is not finite";
    }
  }
  for (const tracking::TrackedObject& object : frame.tracked) {
    if (!object.velocity_sensor.allFinite() || !object.covariance.allFinite() || !object.centroid.allFinite() ||
        !object.extent.allFinite() || !std::isfinite(object.yaw_rate_rps)) {
      return "a track is not finite";
    }
  }
  if (!std::ranges::all_of(frame.static_points, [](const Vector3d& point) { return point.allFinite(); })) {
    return "a static point is not finite";
  }
  if (frame.sweep && frame.sweep->duration_s && !(*frame.sweep->duration_s <= 2.0 * kMaxPointTime_s)) {
    return "the sweep takes absurdly long";
  }
  if (frame.labels.size() != raw.points.size() || frame.dropped.total() + frame.points_used > raw.points.size()) {
    return "points are lost";
  }
  const bool has_moved =
      frame.status == odometry::FrameStatus::kConverged || frame.status == odometry::FrameStatus::kIterationLimit;
  if (has_moved && frame.T_target_source.translation().norm() > kMaxDoppler_mps * std::max(dt_s, 0.1)) {
    return "ok, but moved absurdly far";
  }
  return std::nullopt;
}

}  // namespace dynamic_icp::adversarial
