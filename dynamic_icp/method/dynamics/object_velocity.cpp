// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/object_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::dynamics {
namespace {

using Rows = std::vector<std::uint32_t>;

constexpr std::size_t kUnknowns = 3;

constexpr int kMaxIterations = 50;
constexpr double kStepTolerance = 1e-6;  // m/s

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

/// Covariance of the M-estimate, [sum psi^2 / (n - 3)] / [mean psi']^2 (U^T U)^-1; zero for three points or fewer.
Eigen::Matrix3d residual_covariance(const Scan& scan, std::span<const double> compensated, const Rows& rows,
                                    double delta, const Eigen::Vector3d& velocity) {
  Eigen::Matrix3d UtU = Eigen::Matrix3d::Zero();
  double psi_squared = 0.0;
  double inliers = 0.0;
  for (const std::uint32_t row : rows) {
    const Eigen::Vector3d& u = scan.directions()[row];
    const double e = u.dot(velocity) - compensated[row];
    const double psi = estimation::huber_weight(e, delta) * e;
    UtU += u * u.transpose();
    psi_squared += psi * psi;
    inliers += std::abs(e) <= delta ? 1.0 : 0.0;
  }
  const auto n = static_cast<double>(rows.size());
  if (rows.size() <= kUnknowns || inliers == 0.0) {
    return Eigen::Matrix3d::Zero();
  }
  const double inlier_share = inliers / n;
  return psi_squared / (n - kUnknowns) / (inlier_share * inlier_share) * UtU.inverse();
}

struct Velocity {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Minimises sum rho(u_i . v - s~_i): the square for delta = infinity, which takes one step, else Huber's loss.
Velocity regress(const Scan& scan, std::span<const double> compensated, const Rows& rows, double delta) {
  Velocity result;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const std::uint32_t row : rows) {
      const Eigen::Vector3d& u = scan.directions()[row];
      const double e = u.dot(result.velocity) - compensated[row];
      // The first step starts from nowhere, so its residuals say nothing yet.
      const double w = iteration == 0 ? 1.0 : estimation::huber_weight(e, delta);
      H += w * u * u.transpose();
      b += w * e * u;
    }
    const Eigen::Vector3d step = -H.ldlt().solve(b);
    result.velocity += step;
    if (std::isinf(delta) || step.norm() < kStepTolerance) {
      break;
    }
  }
  result.covariance = residual_covariance(scan, compensated, rows, delta, result.velocity);
  return result;
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
  object.cluster_points = rows.size();
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
  const double delta = config.huber_delta_mps > 0.0 ? config.huber_delta_mps : std::numeric_limits<double>::infinity();
  const Velocity estimate = regress(scan, compensated, rows, delta);
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
       "threshold of Huber regression of an object's velocity; 0 is ordinary least squares, the paper's way"},
      {"max_deviation_mps", &config.max_deviation_mps, 0.0, 1000.0, "m/s",
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
