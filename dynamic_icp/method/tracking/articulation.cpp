// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/articulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// What is smaller has no joint, and what is smaller is no part.
struct MinSize {
  double whole_m;
  double part_m;
};
constexpr MinSize kMinLength = {5.0, 1.5};  // a car; a cab
constexpr MinSize kMinWidth = {2.8, 0.0};   // no vehicle is so wide; the side of one beside another is flat

constexpr double kStep_m = 0.5;           // between the places that are tried
constexpr double kMinPartPoints = 20.0;   // of a part
constexpr double kPrior_mps = 30.0;       // standard deviation of what the motion of a part differs from that of all
constexpr double kEvidence = 40.0;        // F of two bodies
constexpr double kByDirection_mps = 0.3;  // so much errors of the Doppler change over a radian: root mean square
constexpr double kGross_mps = 1.5;        // parts differ by less than such errors
constexpr std::size_t kMaxSteps = 64;

/// The normal equations of what a part of the body moves otherwise than the whole: A dW = b.
struct PartSums {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double squares = 0.0;  ///< of the residuals to the whole
  double weights = 0.0;

  void add(const Vector3d& direction, double residual, double weight) {
    A += weight * direction * direction.transpose();
    b += weight * residual * direction;
    squares += weight * residual * residual;
    weights += weight;
  }
  PartSums& operator+=(const PartSums& other) {
    A += other.A;
    b += other.b;
    squares += other.squares;
    weights += other.weights;
    return *this;
  }
  PartSums& operator-=(const PartSums& other) {
    A -= other.A;
    b -= other.b;
    squares -= other.squares;
    weights -= other.weights;
    return *this;
  }

  /// What remains of the squares when the part moves as it fits best.
  [[nodiscard]] double least_squares(double sigma_mps) const {
    const double ridge = sigma_mps * sigma_mps / (kPrior_mps * kPrior_mps);
    return squares - b.dot((A + ridge * Eigen::Matrix3d::Identity()).ldlt().solve(b));
  }
};

using Sums = std::array<PartSums, kMaxSteps>;

/// Of the points between each two of the places that are tried.
Sums sum_between(const Detection& detection, const Vector3d& along, double rear_m, double yaw_rate_rps,
                 double sigma_mps) {
  const ClusterVelocity whole = motion_of(detection, yaw_rate_rps, sigma_mps);
  const double scale = std::max(kGross_mps, estimation::kTukeyTuning * std::max(sigma_mps, whole.spread_mps));
  DetectionMemory memory;
  const std::pmr::vector<double> radial = radial_at_sensor(detection, yaw_rate_rps, memory);
  Sums sums{};
  for (std::size_t i = 0; i < radial.size(); ++i) {
    const double residual = radial[i] - detection.directions[i].dot(whole.W);
    sums[static_cast<std::size_t>((along.dot(detection.points[i]) - rear_m) / kStep_m)].add(
        detection.directions[i], residual, estimation::tukey_weight(residual, scale));
  }
  return sums;
}

/// Along a direction: where two bodies explain what one does not.
std::optional<Joint> joint_along(const Detection& detection, const Vector3d& along, const MinSize& min,
                                 double yaw_rate_rps, double sigma_mps) {
  const auto is_behind = [&](const Vector3d& a, const Vector3d& b) { return along.dot(a) < along.dot(b); };
  const auto [rearmost, foremost] = std::minmax_element(detection.points.begin(), detection.points.end(), is_behind);
  const double rear = along.dot(*rearmost);
  const double front = along.dot(*foremost);
  const auto steps = static_cast<std::size_t>((front - rear) / kStep_m) + 1;
  if (front - rear < min.whole_m || steps > kMaxSteps) {
    return std::nullopt;
  }
  const Sums sums = sum_between(detection, along, rear, yaw_rate_rps, sigma_mps);
  PartSums ahead = std::accumulate(sums.begin(), sums.end(), PartSums{}, [](PartSums sum, const PartSums& part) {
    sum += part;
    return sum;
  });
  PartSums behind;
  const double points = ahead.weights;
  const double by_one = ahead.least_squares(sigma_mps);
  const double noise = points * sigma_mps * sigma_mps;  // what looks better is so by chance
  const double by_direction_mps =
      kByDirection_mps *
      ((*foremost - detection.sensor).normalized() - (*rearmost - detection.sensor).normalized()).norm();
  const double least_gain = points * by_direction_mps * by_direction_mps;
  Joint joint{.direction = along, .evidence = kEvidence};
  for (std::size_t k = 0; k < steps; ++k) {
    behind += sums[k];
    ahead -= sums[k];
    const double cut = rear + kStep_m * static_cast<double>(k + 1);
    if (cut - rear < min.part_m || front - cut < min.part_m ||
        !(std::min(behind.weights, ahead.weights) > kMinPartPoints)) {
      continue;
    }
    const double by_two = behind.least_squares(sigma_mps) + ahead.least_squares(sigma_mps);
    const double evidence = (by_one - by_two) / 3.0 * (points - 6.0) / std::max(by_two, noise);
    if (evidence > joint.evidence && by_one - by_two > least_gain) {
      joint.evidence = evidence;
      joint.place_m = cut;
    }
  }
  return joint.evidence > kEvidence ? std::optional(joint) : std::nullopt;
}

}  // namespace

std::optional<Joint> find_joint(const Detection& detection, const Eigen::Matrix3d& axes, double yaw_rate_rps,
                                double sigma_mps) {
  const std::optional<Joint> along = joint_along(detection, axes.col(0), kMinLength, yaw_rate_rps, sigma_mps);
  std::optional<Joint> across = joint_along(detection, axes.col(1), kMinWidth, yaw_rate_rps, sigma_mps);
  if (across && !(along && along->evidence > across->evidence)) {
    across->is_across = true;
    return across;
  }
  return along;
}

}  // namespace dynamic_icp::tracking
