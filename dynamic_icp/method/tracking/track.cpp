// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

namespace dynamic_icp::tracking {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kLogHopeless = -8.0;   // relative to the best opinion
constexpr int kDecisionSightings = 10;  // after so many the best opinion stays alone

}  // namespace

Track::Track(const Sighting& sighting, double stamp_s, const TrackConfig& config)
    : time_s_(stamp_s + sighting.mean_time_s) {
  opinions_.emplace_back(sighting, std::nullopt, config);
  const Sighting now = at_mean_time(sighting, motion().velocity());
  if (const std::optional<double> yaw = fit_yaw(now.points, 0.0, 0.5 * kQuarterTurn)) {
    opinions_.emplace_back(sighting, *yaw, config);
    opinions_.emplace_back(sighting, *yaw + kQuarterTurn, config);
  }
  judge();
}

void Track::predict(double time_s, const TrackConfig& config) {
  for (BoxFilter& opinion : opinions_) {
    opinion.predict(time_s - time_s_, config);
  }
  time_s_ = time_s;
}

void Track::correct(const Sighting& sighting, double stamp_s, const TrackConfig& config) {
  predict(stamp_s + sighting.mean_time_s, config);
  for (BoxFilter& opinion : opinions_) {
    opinion.correct(sighting, config);
  }
  ++sightings_;
  judge();
}

void Track::judge() {
  const auto better = [](const BoxFilter& a, const BoxFilter& b) { return a.log_likelihood() < b.log_likelihood(); };
  const BoxFilter best = *std::max_element(opinions_.begin(), opinions_.end(), better);
  if (sightings_ >= kDecisionSightings) {
    opinions_ = {best};
  }
  std::erase_if(opinions_, [&](const BoxFilter& opinion) {
    return opinion.log_likelihood() - best.log_likelihood() < kLogHopeless;
  });
  best_ = static_cast<std::size_t>(std::max_element(opinions_.begin(), opinions_.end(), better) - opinions_.begin());
}

Eigen::Matrix3d Track::velocity_covariance() const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double weights = 0.0;
  for (const BoxFilter& opinion : opinions_) {
    const double weight = std::exp(opinion.log_likelihood() - best().log_likelihood());
    const Eigen::Vector3d difference = opinion.motion().velocity() - motion().velocity();
    sum += weight * (opinion.motion().covariance().block<3, 3>(3, 3) + difference * difference.transpose());
    weights += weight;
  }
  return sum / weights;
}

}  // namespace dynamic_icp::tracking
