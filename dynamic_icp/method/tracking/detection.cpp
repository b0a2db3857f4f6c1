// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/detection.hpp"

#include <algorithm>
#include <cstddef>

namespace dynamic_icp::tracking {
namespace {

constexpr double kLookBelow_m = 0.4;  // at least
constexpr double kNearer_m = 1.0;     // what hides something is so much nearer

}  // namespace

Eigen::Vector3d mean_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    sum += point;
  }
  return sum / static_cast<double>(points.size());
}

void make_detection(const Scan& scan, std::span<const double> radial, std::span<const std::uint32_t> rows,
                    const SensorMotion& sensor, const GroundHeights& heights, const RangeImage* view,
                    Detection& detection) {
  const std::size_t stride = std::max<std::size_t>(1, (rows.size() + kMaxDetectionPoints - 1) / kMaxDetectionPoints);
  // All at once, so that no later detection asks for memory.
  detection.points.reserve(kMaxDetectionPoints);
  detection.directions.reserve(kMaxDetectionPoints);
  detection.radial.reserve(kMaxDetectionPoints);
  detection.times.reserve(kMaxDetectionPoints);
  detection.levers.reserve(scan.is_of_rig() ? kMaxDetectionPoints : 0);
  detection.points.clear();
  detection.directions.clear();
  detection.radial.clear();
  detection.times.clear();
  detection.levers.clear();
  detection.mean_time_s = 0.0;
  for (std::size_t i = 0; i < rows.size(); i += stride) {
    const std::uint32_t row = rows[i];
    const double time = scan.has_times() ? scan.times()[row] : 0.0;
    detection.points.push_back(sensor.T_world_sensor * scan.points()[row]);
    detection.directions.push_back(sensor.direction_world(scan.directions()[row], time));
    detection.radial.push_back(radial[row]);
    detection.times.push_back(time);
    if (scan.is_of_rig()) {
      const Eigen::Isometry3d& mounting = scan.mountings()[scan.channels().sensor[row]];
      detection.levers.push_back(sensor.T_world_sensor.linear() * mounting.translation());
    }
    detection.mean_time_s += time;
  }
  detection.mean_time_s /= static_cast<double>(detection.points.size());
  detection.sensor = sensor.position(detection.mean_time_s);
  detection.T_sensor_world = sensor.pose(detection.mean_time_s).inverse();
  const Eigen::Vector3d up = heights.up();
  const Eigen::Vector3d* lowest = &detection.points.front();
  double lowest_m = up.dot(*lowest);
  for (const Eigen::Vector3d& point : detection.points) {
    if (const double height_m = up.dot(point); height_m < lowest_m) {
      lowest = &point;
      lowest_m = height_m;
    }
  }
  // What stands behind something else is seen from some height on.
  const double step_m = std::max(kLookBelow_m, 3.0 * RangeImage::cell_width() * (*lowest - detection.sensor).norm());
  const bool is_hidden_below =
      view != nullptr && view->hides(detection.T_sensor_world * (*lowest - step_m * up), kNearer_m);
  detection.ground = heights.below(*lowest, is_hidden_below);
  detection.motion.reset();
  detection.view = view;
}

std::pmr::vector<double> radial_at_sensor(const Detection& detection, double yaw_rate_rps, DetectionMemory& memory) {
  std::pmr::vector<double> radial(detection.radial.begin(), detection.radial.end(), memory.resource());
  for (std::size_t i = 0; i < detection.levers.size(); ++i) {
    radial[i] -= yaw_rate_rps * detection.directions[i].dot(detection.ground.up().cross(detection.levers[i]));
  }
  return radial;
}

void fit_motion(double sigma_mps, Detection& detection) {
  if (detection.levers.empty()) {
    detection.motion = fit_cluster_velocity(detection.directions, detection.radial, sigma_mps);
  }
}

ClusterVelocity motion_of(const Detection& detection, double yaw_rate_rps, double sigma_mps) {
  if (detection.motion) {
    return *detection.motion;
  }
  DetectionMemory memory;
  return fit_cluster_velocity(detection.directions, radial_at_sensor(detection, yaw_rate_rps, memory), sigma_mps);
}

std::pmr::vector<Eigen::Vector3d> points_at_mean_time(const Detection& detection, const Eigen::Vector3d& velocity,
                                                      DetectionMemory& memory) {
  std::pmr::vector<Eigen::Vector3d> points(detection.points.begin(), detection.points.end(), memory.resource());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] += (detection.mean_time_s - detection.times[i]) * velocity;
  }
  return points;
}

}  // namespace dynamic_icp::tracking
