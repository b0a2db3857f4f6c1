// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/scan_look.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/rig_doppler.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kStaticSigmas = 4.0;
constexpr double kMinStill_mps = 0.3;
constexpr double kMinStaticShare = 0.2;
constexpr double kMaxDeviation_mps = 1.0;

void look_at_times(const RawScan& raw, ScanLook& look) {
  bool any = false;
  for (const double time : raw.times) {
    if (std::isfinite(time)) {
      look.first_time_s = any ? std::min(look.first_time_s, time) : time;
      look.last_time_s = any ? std::max(look.last_time_s, time) : time;
      any = true;
    }
  }
  look.has_times = any;
}

void look_at_columns(const Scan& scan, ScanLook& look) {
  std::vector<double> ranges;
  std::vector<double> speeds;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    ranges.push_back(scan.points()[i].norm());
    speeds.push_back(std::abs(scan.doppler()[i]));
    look.look_direction += scan.directions()[i];
    squares += scan.directions()[i].cwiseAbs2();
  }
  const double count = std::max(1.0, static_cast<double>(scan.size()));
  look.look_direction /= count;
  look.look_spread = (squares / count).cwiseSqrt();
  look.far_m = quantile(std::move(ranges), kNearlyAll);
  look.fast_mps = quantile(std::move(speeds), kNearlyAll);
}

bool is_velocity(const ego_motion::EgoVelocity& ego, double static_share) {
  const bool found = ego.status == ego_motion::EgoVelocityStatus::kConverged ||
                     ego.status == ego_motion::EgoVelocityStatus::kIterationLimit;
  return found && static_share >= kMinStaticShare && ego.covariance.trace() < kMaxDeviation_mps * kMaxDeviation_mps;
}

DopplerValues doppler_values(const std::vector<double>& doppler, const std::vector<double>& residuals) {
  DopplerValues values;
  values.count = doppler.size();
  for (const double value : doppler) {
    values.negative += value < 0.0 ? 1 : 0;
    values.positive += value > 0.0 ? 1 : 0;
  }
  values.median = quantile(doppler, 0.5);
  values.scatter = scatter_of(doppler);
  values.scatter_left = scatter_of(residuals);
  return values;
}

/// Of a rig whose rotation nobody knows yet.
void take_out_lever_arms(Scan& scan, ScanLook& look, const Workers& workers) {
  look.mountings = scan.mountings();
  if (scan.is_of_rig() && scan.doppler_kind() == DopplerKind::kRelative) {
    look.sensors = look_at_sensors(scan, workers);
    std::vector<ego_motion::EgoVelocity> velocities;
    for (const SensorLook& sensor : look.sensors) {
      velocities.push_back(sensor.ego);
    }
    const Eigen::Vector3d omega = ego_motion::rig_angular_velocity(look.mountings, velocities).omega;
    ego_motion::take_out_lever_arms(scan, omega, workers);
  }
}

}  // namespace

double scatter_of(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) {
    value = std::abs(value - middle);
  }
  return median(std::move(values));
}

double median_error(const std::vector<double>& values) {
  constexpr double kErrorPerMad =
      kSigmaPerMad * 1.2533;  // of the median of normal numbers, times the root of their count
  return values.empty() ? 0.0 : kErrorPerMad * scatter_of(values) / std::sqrt(static_cast<double>(values.size()));
}

bool DopplerFit::has_velocity() const { return is_velocity(ego, static_share); }

bool ScanLook::has_velocity() const { return is_velocity(ego, static_share); }

DopplerFit fit_doppler(const Scan& scan, const Workers& workers) {
  DopplerFit fit;
  fit.ego = ego_motion::estimate_velocity(scan, ego_motion::EgoPrior{}, {}, workers);
  ego_motion::compensated_doppler(scan, fit.ego, workers, fit.residuals);
  std::size_t near = 0;
  const double width = std::max(kMinStill_mps, kStaticSigmas * fit.ego.inlier_rms_mps);
  for (std::uint32_t row = 0; row < fit.residuals.size(); ++row) {
    const double residual = std::abs(fit.residuals[row]);
    near += residual < kFitting_mps ? 1 : 0;
    if (residual < width) {
      fit.static_rows.push_back(row);
    }
  }
  fit.static_share = scan.empty() ? 0.0 : static_cast<double>(near) / static_cast<double>(scan.size());
  return fit;
}

ScanLook look_at(const RawScan& raw, const Workers& workers, Scan* still) {
  ScanLook look;
  look.stamp = raw.stamp;
  look.points = raw.points.size();
  look_at_times(raw, look);
  Scan scan = Scan::from_raw(raw, {}, workers, &look.dropped);
  look_at_columns(scan, look);
  take_out_lever_arms(scan, look, workers);
  const DopplerFit fit = fit_doppler(scan, workers);
  look.ego = fit.ego;
  look.static_share = fit.static_share;
  look.values = doppler_values(scan.doppler(), fit.residuals);
  if (still != nullptr) {
    *still = look.has_velocity() ? scan.select(fit.static_rows) : std::move(scan);
  }
  return look;
}

}  // namespace dynamic_icp::diagnosis
