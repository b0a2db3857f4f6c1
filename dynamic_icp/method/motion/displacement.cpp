// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/displacement.hpp"

#include <cmath>

#include <Eigen/LU>

namespace dynamic_icp::motion {
namespace {

// Times that nearly coincide make weights that cancel and amplify every error. For equal steps they sum to 1.2 times
// the interval.
constexpr double kMaxWeight = 10.0;

double absolute_sum(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double weight : weights) {
    sum += std::abs(weight);
  }
  return sum;
}

}  // namespace

std::vector<double> quadrature_weights(std::span<const double> times_s, double begin_s, double end_s) {
  const auto count = static_cast<Eigen::Index>(times_s.size());
  const double middle = 0.5 * (begin_s + end_s);
  const double half = 0.5 * (end_s - begin_s);
  Eigen::MatrixXd powers(count, count);
  Eigen::VectorXd integrals(count);
  for (Eigen::Index degree = 0; degree < count; ++degree) {
    for (Eigen::Index j = 0; j < count; ++j) {
      powers(degree, j) = std::pow((times_s[static_cast<std::size_t>(j)] - middle) / half, static_cast<double>(degree));
    }
    // Over [-1, 1] the odd powers integrate to zero.
    integrals[degree] = degree % 2 == 0 ? 2.0 * half / static_cast<double>(degree + 1) : 0.0;
  }
  const Eigen::VectorXd weights = powers.partialPivLu().solve(integrals);
  return {weights.begin(), weights.end()};
}

Displacement displacement_between(std::span<const VelocitySample> samples, double begin_s, double end_s) {
  std::vector<double> times_s;
  for (const VelocitySample& sample : samples) {
    times_s.push_back(sample.time_s);
  }
  std::vector<double> weights = quadrature_weights(times_s, begin_s, end_s);
  while (samples.size() > 1 && !(absolute_sum(weights) <= kMaxWeight * (end_s - begin_s))) {
    samples = samples.subspan(1);
    times_s.erase(times_s.begin());
    weights = quadrature_weights(times_s, begin_s, end_s);
  }
  Displacement result;
  result.last_weight_s = weights.back();
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const VelocitySample& sample = samples[j];
    if (j + 1 < samples.size()) {
      result.fixed_map += weights[j] * (sample.R_map_sensor * sample.velocity_sensor);
    }
    result.covariance_map +=
        weights[j] * weights[j] * sample.R_map_sensor * sample.covariance * sample.R_map_sensor.transpose();
  }
  return result;
}

}  // namespace dynamic_icp::motion
