// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/object_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/estimation/velocity_regression.hpp"

namespace dynamic_icp::dynamics {
namespace {

using Rows = std::vector<std::uint32_t>;

constexpr std::size_t kUnknowns = 3;

// The velocity gate of an object at rest would have no width: allow for rounding.
constexpr double kSmallestGate = 1e-12;

struct Conditioning {
  double smallest = 0.0;
  double largest = 0.0;

  [[nodiscard]] bool good(const ObjectVelocityConfig& config) const {
    return smallest >= config.min_singular_value && largest <= config.max_condition_number * smallest;
  }
};

/// The extreme singular values of the lines of sight of some rows, stacked: square roots of eigenvalues of U^T U.
Conditioning conditioning(const Scan& scan, const Rows& rows) {
  Eigen::Matrix3d UtU = Eigen::Matrix3d::Zero();
  for (const std::uint32_t row : rows) {
    UtU += scan.directions()[row] * scan.directions()[row].transpose();
  }
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(UtU, Eigen::EigenvaluesOnly).eigenvalues();
  return {std::sqrt(std::max(0.0, values[0])), std::sqrt(std::max(0.0, values[2]))};
}

/// Least squares or, with a threshold, Huber regression of the velocity of some rows.
estimation::VelocityRegression regress(const Scan& scan, std::span<const double> compensated, const Rows& rows,
                                       const ObjectVelocityConfig& config) {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> range_rates;
  directions.reserve(rows.size());
  range_rates.reserve(rows.size());
  for (const std::uint32_t row : rows) {
    directions.push_back(scan.directions()[row]);
    range_rates.push_back(compensated[row]);
  }
  const bool robust = config.huber_delta_mps > 0.0;
  return estimation::regress_velocity(
      directions, range_rates, std::nullopt,
      {.huber_delta_mps = robust ? config.huber_delta_mps : std::numeric_limits<double>::infinity(),
       .rank = estimation::Rank::kFull},
      Workers(1));
}

/// The rows of each label, in scan order.
std::vector<Rows> rows_of_labels(std::span<const std::int32_t> labels) {
  std::vector<Rows> rows;
  for (std::uint32_t row = 0; row < labels.size(); ++row) {
    if (labels[row] >= 0) {
      const auto label = static_cast<std::size_t>(labels[row]);
      if (label >= rows.size()) {
        rows.resize(label + 1);
      }
      rows[label].push_back(row);
    }
  }
  return rows;
}

void measure_box(const Scan& scan, ObjectEstimate& object) {
  Eigen::Vector3d low = scan.points()[object.members.front()];
  Eigen::Vector3d high = low;
  for (const std::uint32_t row : object.members) {
    const Eigen::Vector3d& point = scan.points()[row];
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  object.centroid = 0.5 * (low + high);
  object.extent = high - low;
}

double largest_deviation(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(
      0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[2]));
}

ObjectEstimate reconstruct(const Scan& scan, std::span<const double> compensated, const Rows& rows,
                           const ObjectVelocityConfig& config) {
  ObjectEstimate object;
  if (rows.size() < kUnknowns) {
    object.verdict = ClusterVerdict::kTooFewPoints;
    return object;
  }
  const Conditioning all = conditioning(scan, rows);
  object.smallest_singular_value = all.smallest;
  object.condition_number = all.smallest > 0.0 ? all.largest / all.smallest : 0.0;
  if (!all.good(config)) {
    object.verdict = ClusterVerdict::kIllConditioned;
    return object;
  }
  const estimation::VelocityRegression estimate = regress(scan, compensated, rows, config);
  object.velocity_sensor = estimate.velocity;
  object.covariance = estimate.covariance;
  // The paper writes the threshold with a vector; it is read as lambda times the speed of the cluster.
  const double tau_v = std::max(config.lambda * object.velocity_sensor.norm(), kSmallestGate);
  Rows inliers;
  for (const std::uint32_t row : rows) {
    if (std::abs(scan.directions()[row].dot(object.velocity_sensor) - compensated[row]) <= tau_v) {
      inliers.push_back(row);
    }
  }
  object.inlier_fraction = static_cast<double>(inliers.size()) / static_cast<double>(rows.size());
  if (object.inlier_fraction < config.min_inlier_fraction) {
    object.verdict = ClusterVerdict::kTooFewInliers;
  } else if (inliers.size() < kUnknowns || !conditioning(scan, inliers).good(config)) {
    object.verdict = ClusterVerdict::kInliersIllConditioned;
  } else if (config.max_deviation_mps > 0.0 && largest_deviation(object.covariance) > config.max_deviation_mps) {
    object.verdict = ClusterVerdict::kUncertain;
  } else {
    object.verdict = ClusterVerdict::kAccepted;
    object.members = std::move(inliers);
    measure_box(scan, object);
  }
  return object;
}

}  // namespace

ConfigFields fields(ObjectVelocityConfig& config) {
  return {
      {"lambda", &config.lambda, 0.0, 10.0, "",
       "points of an object deviate from its velocity by at most lambda * speed"},
      {"min_inlier_fraction", &config.min_inlier_fraction, 0.0, 1.0, "",
       "share of a cluster's points that must agree with its velocity (phi_min)"},
      {"min_singular_value", &config.min_singular_value, 1e-12, 1e3, "",
       "smallest allowed singular value of a cluster's lines of sight (sigma_min)"},
      {"max_condition_number", &config.max_condition_number, 1.0, 1e9, "",
       "largest allowed condition number of a cluster's lines of sight"},
      {"huber_delta_mps", &config.huber_delta_mps, 0.0, 100.0, "m/s",
       "threshold of Huber regression of an object's velocity; 0 is ordinary least squares, as in the paper"},
      {"max_sigma_mps", &config.max_deviation_mps, 0.0, 1000.0, "m/s",
       "objects whose velocity has a larger standard deviation in some direction are rejected; 0 switches this off"},
  };
}

std::string_view to_string(ClusterVerdict verdict) {
  switch (verdict) {
    case ClusterVerdict::kNotRun:
      return "not_run";
    case ClusterVerdict::kAccepted:
      return "accepted";
    case ClusterVerdict::kTooFewPoints:
      return "too_few_points";
    case ClusterVerdict::kIllConditioned:
      return "ill_conditioned";
    case ClusterVerdict::kTooFewInliers:
      return "too_few_inliers";
    case ClusterVerdict::kInliersIllConditioned:
      return "inliers_ill_conditioned";
    case ClusterVerdict::kUncertain:
      return "uncertain";
  }
  return "unknown";
}

std::vector<ObjectEstimate> reconstruct_velocities(const Scan& scan, std::span<const double> compensated,
                                                   std::span<const std::int32_t> labels,
                                                   const ObjectVelocityConfig& config) {
  std::vector<ObjectEstimate> objects;
  for (const Rows& rows : rows_of_labels(labels)) {
    objects.push_back(reconstruct(scan, compensated, rows, config));
  }
  return objects;
}

}  // namespace dynamic_icp::dynamics
