// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/map_alignment.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/mapping/rotation_search.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/one_thread.hpp"

namespace dynamic_icp::mapping {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// Points on the inner faces of a box-shaped hall, or of a tunnel: a hall without its ends.
struct Hall {
  bool has_ends = true;
  double noise_m = 0.01;

  [[nodiscard]] std::vector<Vector3d> points(unsigned seed, std::size_t count) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::normal_distribution<double> normal(0.0, noise_m);
    std::vector<Vector3d> result;
    while (result.size() < count) {
      const Vector3d half(25.0, 8.3, 3.1);
      Vector3d point = half.cwiseProduct(Vector3d(uniform(random), uniform(random), uniform(random)));
      const int face = static_cast<int>(result.size() % (has_ends ? 6 : 4));
      const int axis = 2 - face / 2;
      point[axis] = (face % 2 == 0 ? 1.0 : -1.0) * half[axis] + normal(random);
      result.push_back(point);
    }
    return result;
  }

  [[nodiscard]] PlaneMap map() const {
    PlaneMap result({});
    result.add(points(1, 40000), Vector3d::Zero(), kOneThread);
    return result;
  }

  /// What a sensor at T_map_sensor measures that moves like `sweep` while it looks around; all at once without times.
  [[nodiscard]] Scan scan(const Eigen::Isometry3d& T_map_sensor, const motion::SweepMotion& sweep, bool with_times,
                          unsigned seed = 2) const {
    RawScan raw;
    raw.stamp = Stamp{0};
    const std::vector<Vector3d> seen = points(seed, 6000);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double azimuth = std::atan2(seen[i].y(), seen[i].x());
      const double tau = with_times ? 0.1 * (azimuth + pi) / (2.0 * pi) : 0.0;
      raw.points.push_back((T_map_sensor * sweep.pose(tau)).inverse() * seen[i]);
      raw.doppler.push_back(0.0);
      if (with_times) {
        raw.times.push_back(tau);
      }
    }
    return Scan::from_raw(raw);
  }
};

Eigen::Isometry3d pose(const Vector3d& rotation, const Vector3d& translation) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(rotation);
  T.translation() = translation;
  return T;
}

/// A prior that is off by the standard deviations it states.
MotionPrior prior_around(const Eigen::Isometry3d& truth, const Vector3d& rotation_off, const Vector3d& position_off) {
  MotionPrior prior;
  prior.R_map_sensor = exp_so3(rotation_off) * truth.linear();
  prior.displacement_fixed = truth.translation() + position_off;
  prior.covariance.setZero();
  prior.covariance.diagonal().head<3>().setConstant(std::pow(std::max(1e-3, rotation_off.norm()), 2));
  prior.covariance.diagonal().segment<3>(3).setConstant(0.25);
  prior.covariance.diagonal().tail<3>().setConstant(1.0);
  prior.translation_covariance = std::pow(std::max(1e-3, position_off.norm()), 2) * Eigen::Matrix3d::Identity();
  return prior;
}

double rotation_error(const MapAlignment& found, const Eigen::Isometry3d& truth) {
  return rotation_angle(found.T_map_sensor.linear().transpose() * truth.linear());
}

TEST(AlignToMap, FindsThePoseInAHall) {
  const Hall hall;
  const Eigen::Isometry3d truth = pose({0.02, -0.03, 0.3}, {2.0, -1.0, 0.4});
  const MapAlignment found = align_to_map(hall.scan(truth, {}, false), hall.map(),
                                          prior_around(truth, {0.01, 0.02, -0.03}, {0.2, 0.1, -0.2}), {}, kOneThread);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(rotation_error(found, truth), 2e-4);
  EXPECT_LT((found.T_map_sensor.translation() - truth.translation()).norm(), 2e-3);
  EXPECT_GT(found.matched, 0.8 * static_cast<double>(found.points));
  EXPECT_NEAR(found.chi, 0.8, 0.15) << "the noise model is right, less what the kernel holds back";
}

TEST(AlignToMap, LeavesToTheDopplerWhatATunnelLeavesOpen) {
  Hall tunnel;
  tunnel.has_ends = false;
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.02}, {1.0, 0.2, 0.1});
  MotionPrior prior = prior_around(truth, {0.01, 0.0, 0.01}, {0.0, 0.1, 0.1});
  const double deviation_m = 0.002;  // along the tunnel
  prior.translation_covariance(0, 0) = deviation_m * deviation_m;
  const MapAlignment found = align_to_map(tunnel.scan(truth, {}, false), tunnel.map(), prior, {}, kOneThread);
  EXPECT_LT((found.T_map_sensor.translation() - truth.translation()).norm(), 2e-3);
  EXPECT_NEAR(std::sqrt(found.covariance(3, 3)), deviation_m, 0.2 * deviation_m) << "known from the Doppler alone";
  EXPECT_LT(std::sqrt(found.covariance(4, 4)), 1e-3) << "the walls hold it across";
}

TEST(AlignToMap, TurnsTheDisplacementWithTheScan) {
  // The prior is turned by 0.1 rad, and so is the displacement it expects; in a tunnel only the rotation found can mend
  // it.
  Hall tunnel;
  tunnel.has_ends = false;
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.05}, {2.0, 0.0, 0.0});
  MotionPrior prior = prior_around(truth, {0.0, 0.0, 0.1}, Vector3d::Zero());
  prior.displacement_fixed.setZero();
  prior.displacement_rotated = truth.linear().transpose() * truth.translation();
  const MapAlignment found = align_to_map(tunnel.scan(truth, {}, false), tunnel.map(), prior, {}, kOneThread);
  EXPECT_LT((found.T_map_sensor.translation() - truth.translation()).norm(), 1e-3);
}

TEST(AlignToMap, FindsTheTurnWithinASweep) {
  const Hall hall;
  motion::SweepMotion sweep;
  sweep.omega = {0.05, -0.1, 0.5};
  sweep.alpha = {0.3, -0.2, 0.5};
  sweep.velocity = {15.0, 0.3, -0.1};
  const Eigen::Isometry3d truth = pose({0.01, 0.0, 0.1}, {-3.0, 0.5, 0.2});
  MotionPrior prior = prior_around(truth, {0.01, 0.01, 0.01}, {0.05, 0.05, 0.0});
  prior.sweep.velocity = sweep.velocity;
  const MapAlignment found = align_to_map(hall.scan(truth, sweep, true), hall.map(), prior, {}, kOneThread);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(rotation_error(found, truth), 5e-4);
  EXPECT_LT((found.T_map_sensor.translation() - truth.translation()).norm(), 5e-3);
  EXPECT_LT((found.sweep.omega - sweep.omega).norm(), 0.02);
  // The change of the rotation within one sweep is hardly seen: it is as far off as the covariance says.
  const Vector3d alpha_error = found.sweep.alpha - sweep.alpha;
  EXPECT_LT(dense::normalised_squared(alpha_error, found.covariance.block<3, 3>(9, 9)), 16.0);
  EXPECT_LT(alpha_error.norm(), 0.5);
}

TEST(AlignToMap, StatesErrorsAsLargeAsTheyAre) {
  // Over many scans the squared error over its covariance averages to its number of dimensions.
  const Hall hall;
  const PlaneMap map = hall.map();
  MapAlignConfig exact;
  exact.model_sigma_m = 0.0;  // these are planes
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto vector = [&](double scale) -> Vector3d {
    return scale * Vector3d(normal(random), normal(random), normal(random));
  };
  double sum = 0.0;
  constexpr int kScans = 40;
  for (int k = 0; k < kScans; ++k) {
    const Eigen::Isometry3d truth = pose(vector(0.05), vector(1.0));
    const MapAlignment found = align_to_map(hall.scan(truth, {}, false, 100U + static_cast<unsigned>(k)), map,
                                            prior_around(truth, vector(0.01), vector(0.1)), exact, kOneThread);
    Vector6d e;
    e << log_so3(found.T_map_sensor.linear() * truth.linear().transpose()),
        found.T_map_sensor.translation() - truth.translation();
    sum += dense::normalised_squared(e, found.covariance.topLeftCorner<6, 6>());
  }
  // All scans share the errors of one map, so the scatter of this mean is wider than that of independent draws.
  EXPECT_GT(sum / kScans, 2.0);
  EXPECT_LT(sum / kScans, 12.0);
}

TEST(AlignToMap, WithoutAMapKeepsThePrior) {
  const Hall hall;
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.1}, {1.0, 0.0, 0.0});
  const MotionPrior prior = prior_around(truth, {0.01, 0.0, 0.0}, {0.1, 0.0, 0.0});
  const MapAlignment found = align_to_map(hall.scan(truth, {}, false), PlaneMap({}), prior, {}, kOneThread);
  EXPECT_EQ(found.matched, 0.0);
  EXPECT_LT((found.T_map_sensor.linear() - prior.R_map_sensor).norm(), 1e-12);
  EXPECT_LT((found.T_map_sensor.translation() - prior.displacement_fixed).norm(), 1e-12);
  EXPECT_LT((found.covariance.block<3, 3>(3, 3) - prior.translation_covariance).norm(), 1e-9);
}

TEST(SearchAndAlign, FindsATurnThatAlignmentAloneMisses) {
  const Hall hall;
  const PlaneMap map = hall.map();
  for (const Vector3d& off : {Vector3d(0.0, 0.0, 0.2), Vector3d(0.0, -0.15, 0.0), Vector3d(0.15, 0.0, 0.0)}) {
    const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.1}, {1.0, 0.5, 0.0});
    const MapAlignment found =
        search_and_align(hall.scan(truth, {}, false), map, prior_around(truth, off, Vector3d::Zero()), {}, kOneThread);
    EXPECT_LT(rotation_error(found, truth), 5e-4) << off.transpose();
  }
}

TEST(AlignToMap, DoesNotDependOnTheThreads) {
  const Hall hall;
  const PlaneMap map = hall.map();
  const Eigen::Isometry3d truth = pose({0.0, 0.0, 0.1}, {1.0, 0.0, 0.0});
  motion::SweepMotion sweep;
  sweep.omega = {0.0, 0.0, 0.3};
  const Scan scan = hall.scan(truth, sweep, true);
  const MotionPrior prior = prior_around(truth, {0.01, 0.0, 0.02}, {0.1, 0.0, 0.0});
  const Workers three(3);
  const MapAlignment a = align_to_map(scan, map, prior, {}, kOneThread);
  const MapAlignment b = align_to_map(scan, map, prior, {}, three);
  EXPECT_EQ(a.T_map_sensor.matrix(), b.T_map_sensor.matrix());
  EXPECT_EQ(a.covariance, b.covariance);
}

}  // namespace
}  // namespace dynamic_icp::mapping
