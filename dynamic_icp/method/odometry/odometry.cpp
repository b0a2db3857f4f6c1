// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/odometry.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/dynamic_icp.hpp"
#include "dynamic_icp/method/odometry/kiss_icp.hpp"
#include "dynamic_icp/method/odometry/map_odometry.hpp"
#include "dynamic_icp/method/odometry/scan_to_scan_icp.hpp"

namespace dynamic_icp::odometry {

std::vector<std::string_view> method_names() {
  return {"dynamic-icp", "doppler-icp", "point-to-point", "point-to-plane", "gicp", "kiss-icp"};
}

void check_method(std::string_view name) {
  const std::vector<std::string_view> known = method_names();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw UsageError(fmt::format("unknown method '{}'; known are: {}", name, fmt::join(known, ", ")));
  }
}

bool needs_doppler(std::string_view method) { return method == "dynamic-icp" || method == "doppler-icp"; }

namespace {

constexpr double kMaxLeverArm_m = 1000.0;
constexpr double kOrthogonal = 1e-6;

/// A rigid motion of a length that a vehicle has.
void check_mounting(const Eigen::Isometry3d& T_vehicle_sensor) {
  const Eigen::Matrix3d R = T_vehicle_sensor.linear();
  const bool is_rotation = (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() <= kOrthogonal;
  if (!is_rotation || !(T_vehicle_sensor.translation().norm() <= kMaxLeverArm_m)) {
    throw UsageError(fmt::format(
        "the mounting of the sensor (T_vehicle_sensor) must be a rotation and a translation of at most {} m",
        kMaxLeverArm_m));
  }
}

}  // namespace

std::unique_ptr<Odometry> make_odometry(std::string_view method, const Config& config, const Surroundings& surroundings,
                                        int threads) {
  check_method(method);
  if (surroundings.T_vehicle_sensor) {
    check_mounting(*surroundings.T_vehicle_sensor);
  }
  const auto scan_to_scan = [&](ScanToScanMethod kind) {
    return std::make_unique<ScanToScanIcp>(kind, config, surroundings, threads);
  };
  if (method == "dynamic-icp") {
    if (config.scan_to_scan) {
      return std::make_unique<DynamicIcp>(config, threads, surroundings.doppler_kind);
    }
    return std::make_unique<MapOdometry>(config, threads, surroundings.doppler_kind);
  }
  if (method == "doppler-icp") {
    return scan_to_scan(ScanToScanMethod::kDopplerIcp);
  }
  if (method == "point-to-point") {
    return scan_to_scan(ScanToScanMethod::kPointToPoint);
  }
  if (method == "point-to-plane") {
    return scan_to_scan(ScanToScanMethod::kPointToPlane);
  }
  if (method == "gicp") {
    return scan_to_scan(ScanToScanMethod::kGicp);
  }
  return std::make_unique<KissIcp>(config, threads);
}

}  // namespace dynamic_icp::odometry
