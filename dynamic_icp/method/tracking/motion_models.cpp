// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/motion_models.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kLasting_s = 5.0;       // of one way to move
constexpr double kStanding_mps = 0.1;    // standard deviation of the velocity of what stands ...
constexpr double kStraight_rps = 0.01;   // ... and of the yaw rate of what does not turn
constexpr double kUnlikely = 1e-6;       // no model is less likely: each may come back
constexpr double kLargestRatio = 100.0;  // of likelihoods of one scan: it errs in more ways than the filter knows

/// Logarithm of the density at zero of a Gaussian, but for a constant.
double log_density_at_zero(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  const auto L = llt.matrixL();
  return -0.5 * L.solve(mean).squaredNorm() - llt.matrixLLT().diagonal().array().log().sum();
}

double log_density_of_no_turn(const BodyFilter& body) {
  const double variance = body.covariance()(BodyFilter::kYawRate, BodyFilter::kYawRate) + kStraight_rps * kStraight_rps;
  return -0.5 * body.yaw_rate() * body.yaw_rate() / variance - 0.5 * std::log(variance);
}

double log_density_of_no_motion(const BodyFilter& body) {
  Eigen::Matrix<double, 3, BodyFilter::kStates> H = Eigen::Matrix<double, 3, BodyFilter::kStates>::Zero();
  H.block<2, 3>(0, BodyFilter::kVelocity) = body.level().leftCols<2>().transpose();
  H(2, BodyFilter::kYawRate) = 1.0;
  const Eigen::Vector3d variances(kStanding_mps * kStanding_mps, kStanding_mps * kStanding_mps,
                                  kStraight_rps * kStraight_rps);
  Eigen::Matrix3d covariance = H * body.covariance() * H.transpose();
  covariance.diagonal() += variances;
  return log_density_at_zero(H * body.state(), covariance);
}

double likelihood_ratio(double log_ratio) {
  return std::clamp(std::exp(log_ratio), 1.0 / kLargestRatio, kLargestRatio);
}

}  // namespace

void MotionModels::predict(double dt_s) {
  const double kept = std::exp(-std::abs(dt_s) / kLasting_s);
  const auto mix = [kept](double& probability) {
    probability = kept * probability + 0.5 * (1.0 - kept) * (1.0 - probability);
  };
  mix(probabilities_.standing);
  mix(probabilities_.straight);
  mix(probabilities_.turning);
}

void MotionModels::correct(const BodyFilter& before, const BodyFilter& after) {
  const double no_motion = log_density_of_no_motion(after) - log_density_of_no_motion(before);
  const double no_turn = log_density_of_no_turn(after) - log_density_of_no_turn(before);
  double standing = std::max(kUnlikely, probabilities_.standing * likelihood_ratio(no_motion));
  double straight = std::max(kUnlikely, probabilities_.straight * likelihood_ratio(no_turn));
  double turning = std::max(kUnlikely, probabilities_.turning);
  const double sum = standing + straight + turning;
  probabilities_ = {standing / sum, straight / sum, turning / sum};
}

void MotionModels::state(StateArchive& archive) {
  archive(probabilities_.standing, probabilities_.straight, probabilities_.turning);
  const auto is_share = [](double p) { return p >= 0.0 && p <= 1.0; };
  archive.require(
      is_share(probabilities_.standing) && is_share(probabilities_.straight) && is_share(probabilities_.turning),
      "the motion of an object");
}

void constrain(MotionModel model, BodyFilter& body) {
  if (model == MotionModel::kTurning) {
    return;
  }
  body.correct_yaw_rate(0.0, kStraight_rps * kStraight_rps);
  if (model == MotionModel::kStanding) {
    body.stop(kStanding_mps * kStanding_mps);
  }
}

MotionNoise noise_under(MotionModel model, const MotionNoise& noise) {
  MotionNoise result = noise;
  if (model != MotionModel::kTurning) {
    result.yaw_rate_rps = 0.0;
  }
  if (model == MotionModel::kStanding) {
    result.along_mps = result.across_mps = result.acceleration_mps2 = 0.0;
  }
  return result;
}

}  // namespace dynamic_icp::tracking
