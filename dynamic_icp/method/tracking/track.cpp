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
constexpr double kLogHopeless = -8.0;    // relative to the best hypothesis
constexpr int kDecisionDetections = 10;  // after so many the best hypothesis stays alone

}  // namespace

Track::Track(const Detection& detection, double stamp_s, const TrackConfig& config)
    : time_s_(stamp_s + detection.mean_time_s) {
  hypotheses_.emplace_back(detection, std::nullopt, config);
  const Detection now = at_mean_time(detection, motion().velocity());
  if (const std::optional<double> yaw = fit_yaw(now.points, 0.0, 0.5 * kQuarterTurn)) {
    hypotheses_.emplace_back(detection, *yaw, config);
    hypotheses_.emplace_back(detection, *yaw + kQuarterTurn, config);
  }
  evaluate();
}

void Track::predict(double time_s, const TrackConfig& config) {
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.predict(time_s - time_s_, config);
  }
  time_s_ = time_s;
}

void Track::correct(const Detection& detection, double stamp_s, const TrackConfig& config) {
  predict(stamp_s + detection.mean_time_s, config);
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.correct(detection, config);
  }
  ++detections_;
  evaluate();
}

void Track::evaluate() {
  const auto better = [](const BoxFilter& a, const BoxFilter& b) { return a.log_likelihood() < b.log_likelihood(); };
  const BoxFilter best = *std::max_element(hypotheses_.begin(), hypotheses_.end(), better);
  if (detections_ >= kDecisionDetections) {
    hypotheses_ = {best};
  }
  std::erase_if(hypotheses_, [&](const BoxFilter& hypothesis) {
    return hypothesis.log_likelihood() - best.log_likelihood() < kLogHopeless;
  });
  best_ =
      static_cast<std::size_t>(std::max_element(hypotheses_.begin(), hypotheses_.end(), better) - hypotheses_.begin());
}

Eigen::Matrix3d Track::velocity_covariance() const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double weights = 0.0;
  for (const BoxFilter& hypothesis : hypotheses_) {
    const double weight = std::exp(hypothesis.log_likelihood() - best().log_likelihood());
    const Eigen::Vector3d difference = hypothesis.motion().velocity() - motion().velocity();
    sum += weight * (hypothesis.motion().covariance().block<3, 3>(3, 3) + difference * difference.transpose());
    weights += weight;
  }
  return sum / weights;
}

}  // namespace dynamic_icp::tracking
