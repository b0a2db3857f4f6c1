// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/odometry.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/method/odometry/dynamic_icp.hpp"
#include "dynamic_icp/method/odometry/kiss_icp.hpp"
#include "dynamic_icp/method/odometry/scan_to_scan_icp.hpp"
#include "dynamic_icp/method/odometry/window_odometry.hpp"

namespace dynamic_icp::odometry {

std::string Odometry::save() {
  StateArchive archive;
  all_state(archive);
  return archive.take();
}

void Odometry::load(std::string_view bytes) {
  StateArchive archive(bytes);
  all_state(archive);
  archive.end();
}

/// What must be the same comes first.
void Odometry::all_state(StateArchive& archive) {
  const auto agree = [&](std::string_view what, const std::string& own) {
    std::string other = own;
    archive(other);
    if (other != own) {
      throw DataError(fmt::format("the state was saved with {} {}, this is {}", what, other, own));
    }
  };
  agree("version", std::string(version()));
  Config config = configuration();
  const auto* const icp = std::get_if<ScanToScanIcpConfig>(&config);
  agree("pipeline", fmt::format("{}.{}", config.index(), icp != nullptr ? static_cast<int>(icp->geometry) : 0));
  for (const ConfigField& field : fields(config)) {
    agree(field.key, value_text(field));
  }
  state(archive);
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

struct Maker {
  const SensorContext& context;
  int threads;

  std::unique_ptr<Odometry> operator()(const WindowOdometryConfig& config) const {
    return std::make_unique<WindowOdometry>(config, context, threads);
  }
  std::unique_ptr<Odometry> operator()(const PaperConfig& config) const {
    return std::make_unique<DynamicIcp>(config, threads, context.doppler_kind);
  }
  std::unique_ptr<Odometry> operator()(const ScanToScanIcpConfig& config) const {
    return std::make_unique<ScanToScanIcp>(config, threads);
  }
  std::unique_ptr<Odometry> operator()(const DopplerIcpConfig& config) const {
    return std::make_unique<ScanToScanIcp>(config, context, threads);
  }
  std::unique_ptr<Odometry> operator()(const KissIcpConfig& config) const {
    return std::make_unique<KissIcp>(config, threads);
  }
};

}  // namespace

std::unique_ptr<Odometry> make_odometry(const Config& config, const SensorContext& context, int threads) {
  if (context.T_vehicle_sensor) {
    check_mounting(*context.T_vehicle_sensor);
  }
  if (context.calibration && !std::holds_alternative<WindowOdometryConfig>(config)) {
    throw UsageError(
        "a calibration of the sensor is for preset 'default' of dynamic-icp alone: no other method learns one");
  }
  return std::visit(Maker{context, threads}, config);
}

}  // namespace dynamic_icp::odometry
