// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/estimation/normal_equations.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

// The error of the Doppler by moving bodies.
namespace dynamic_icp::window {
namespace {

// Of the azimuths of a sensor. Where less is hidden, the static scene shows more, and bodies, which take time, are not
// asked.
constexpr double kMuchHidden = 0.3;

// A velocity of the sensor that is known so well gains nothing.
constexpr double kKnown_mps = 0.02;

}  // namespace

bool WindowEstimator::asks_bodies() const {
  return field_ && config_.learn_field && config_.use_doppler &&
         std::ranges::any_of(hidden_azimuths_, [](double hidden) { return hidden >= kMuchHidden; });
}

void WindowEstimator::learn_from(std::vector<SeenBody> bodies, const Workers& workers) {
  Matrix6d of_velocity = Matrix6d::Zero();
  of_velocity.topLeftCorner<3, 3>() = twist_.covariance.bottomRightCorner<3, 3>();
  const double known_mps = std::sqrt(estimation::symmetric_eigen(of_velocity).values.maxCoeff());
  const std::optional<double> sigma_mps = point_noise();
  if (!asks_bodies() || !sigma_mps || known_mps < kKnown_mps) {
    bodies_.remember(std::move(bodies));
    return;
  }
  if (const std::optional<FieldInformation> told =
          bodies_.compare(std::move(bodies), theta_, *sigma_mps, config_.max_noise_share, workers)) {
    quadratic_->add_field(told->H, told->g);
  }
}

}  // namespace dynamic_icp::window
