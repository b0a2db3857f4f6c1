// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/sensor_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/ego_motion/rig_doppler.hpp"
#include "dynamic_icp/recording/diagnosis/scan_look.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kSectorAzimuth_rad = 0.1;
constexpr double kSectorElevation_rad = 0.05;
constexpr double kMinSectorPoints = 10.0;
constexpr double kSmallestError_mps = 0.005;  // by surfaces and grazing beams, where noise hides it
constexpr double kSmallestSpread = 1e-6;      // of lines of sight, squared: nothing sees less
constexpr double kMinShareOfSensor = 0.2;

/// Residuals of the neighbouring lines of sight.
struct Sector {
  double count = 0.0;
  double sum = 0.0;
  double squares = 0.0;
};

/// Mean square of what neighbours have in common: the mean of each sector without what noise makes of it.
double squared_direction_error(const Scan& scan, const DopplerFit& fit) {
  std::map<std::pair<int, int>, Sector> sectors;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (std::abs(fit.residuals[i]) < kFitting_mps) {
      const Eigen::Vector3d& u = scan.directions()[i];
      Sector& sector = sectors[{static_cast<int>(std::floor(std::atan2(u.y(), u.x()) / kSectorAzimuth_rad)),
                                static_cast<int>(std::floor(u.z() / kSectorElevation_rad))}];
      sector.count += 1.0;
      sector.sum += fit.residuals[i];
      sector.squares += fit.residuals[i] * fit.residuals[i];
    }
  }
  double points = 0.0;
  double in_common = 0.0;
  for (const auto& [place, sector] : sectors) {
    if (sector.count >= kMinSectorPoints) {
      const double mean = sector.sum / sector.count;
      const double of_noise = (sector.squares / sector.count - mean * mean) / (sector.count - 1.0);
      points += sector.count;
      in_common += sector.count * (mean * mean - of_noise);
    }
  }
  return std::max(kSmallestError_mps * kSmallestError_mps, points > 0.0 ? in_common / points : 0.0);
}

/// Covariance of the lines of sight of what is static.
Eigen::Matrix3d view(const Scan& scan, const DopplerFit& fit) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const std::uint32_t row : fit.static_rows) {
    mean += scan.directions()[row];
    squares += scan.directions()[row] * scan.directions()[row].transpose();
  }
  const double count = std::max(1.0, static_cast<double>(fit.static_rows.size()));
  return squares / count - mean * mean.transpose() / (count * count);
}

}  // namespace

bool SensorLook::has_velocity() const {
  const bool found = ego.status == ego_motion::EgoVelocityStatus::kConverged ||
                     ego.status == ego_motion::EgoVelocityStatus::kIterationLimit;
  return found && static_share >= kMinShareOfSensor;
}

std::vector<SensorLook> look_at_sensors(const Scan& scan, const Workers& workers) {
  std::vector<SensorLook> looks;
  for (const std::vector<std::uint32_t>& rows : ego_motion::rows_by_sensor(scan)) {
    const Scan part = scan.select(rows);
    const DopplerFit fit = fit_doppler(part, workers);
    SensorLook look;
    look.ego = fit.ego;
    look.static_share = fit.static_share;
    const double squared = squared_direction_error(part, fit);
    look.direction_error_mps = std::sqrt(squared);
    const Eigen::Matrix3d seen = view(part, fit) + kSmallestSpread * Eigen::Matrix3d::Identity();
    look.pretended = squared * seen.ldlt().solve(Eigen::Matrix3d::Identity());
    looks.push_back(look);
  }
  return looks;
}

}  // namespace dynamic_icp::diagnosis
