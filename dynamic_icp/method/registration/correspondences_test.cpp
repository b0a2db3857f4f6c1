// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/correspondences.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::registration {
namespace {

using Eigen::Vector3d;

Scan scan_of(const std::vector<Vector3d>& points) {
  RawScan raw;
  raw.points = points;
  raw.doppler.assign(points.size(), 0.0);
  return Scan::from_raw(raw);
}

struct TargetParts {
  explicit TargetParts(const std::vector<Vector3d>& points)
      : scan(scan_of(points)),
        tree(scan.points()),
        normals(points.size(), Vector3d::UnitZ()),
        has_normal(points.size(), 1) {}
  [[nodiscard]] Target target() const { return {scan, tree, normals, has_normal}; }

  Scan scan;
  spatial::KdTree tree;
  std::vector<Vector3d> normals;
  std::vector<std::uint8_t> has_normal;
};

Correspondences find_once(const Scan& source, const Target& target, const Eigen::Isometry3d& T, double gate) {
  const Workers workers(2);
  return CorrespondenceSearch(source, target, Gate{gate}, true, workers).find(T);
}

// A walk of small and large steps, on a grid full of equal distances and on random points within `size` metres.
void expect_remembered_like_fresh(double size) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Vector3d> target;
  for (int i = 0; i < 1000; ++i) {
    target.emplace_back(i % 10 * 0.25, i / 10 % 10 * 0.25, i / 100 * 0.25);
    target.emplace_back(uniform(random), uniform(random), uniform(random));
  }
  std::vector<Vector3d> points(800);
  for (Vector3d& p : points) {
    p = {uniform(random), uniform(random), uniform(random)};
  }
  const Scan source = scan_of(points);
  const TargetParts parts(target);
  const Workers workers(2);
  CorrespondenceSearch search(source, parts.target(), Gate{0.3}, true, workers);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (const double step :
       {0.0, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 1e-2, 0.03, 0.03, 0.05, 0.1, 1.0, 0.2, 1e-3, 1e-5, 0.0}) {
    Vector6d xi;
    for (int k = 0; k < 6; ++k) {
      xi[k] = step * uniform(random) / size;
    }
    T = exp_se3(xi) * T;
    const Correspondences remembered = search.find(T);
    const Correspondences fresh = find_once(source, parts.target(), T, 0.3);
    ASSERT_EQ(remembered.pairs.size(), fresh.pairs.size()) << "step " << step;
    EXPECT_GT(fresh.pairs.size(), 50u);
    for (std::size_t k = 0; k < fresh.pairs.size(); ++k) {
      ASSERT_EQ(remembered.pairs[k].source, fresh.pairs[k].source);
      ASSERT_EQ(remembered.pairs[k].target, fresh.pairs[k].target);
      ASSERT_EQ(remembered.pairs[k].squared_distance, fresh.pairs[k].squared_distance);
    }
    EXPECT_EQ(remembered.inlier_rmse, fresh.inlier_rmse);
  }
}

TEST(Correspondences, RememberedAnswersAreThoseOfAFreshSearch) {
  expect_remembered_like_fresh(3.0);  // so sparse that the search finds fewer than it may keep
  expect_remembered_like_fresh(1.0);  // so dense that it finds more
}

TEST(Correspondences, TheGateGrowsWithTheDistanceFromTheSensor) {
  // Each point 0.5 m from its partner, at 10 m and at 30 m.
  const Scan source = scan_of({{10.0, 0.0, 0.0}, {30.0, 0.0, 0.0}});
  const TargetParts parts({{10.0, 0.5, 0.0}, {30.0, 0.5, 0.0}});
  const Workers workers(1);
  const auto pairs = [&](double per_range) {
    return CorrespondenceSearch(source, parts.target(), {0.3, per_range}, true, workers)
        .find(Eigen::Isometry3d::Identity())
        .pairs;
  };
  EXPECT_TRUE(pairs(0.0).empty());
  ASSERT_EQ(pairs(0.01).size(), 1u);
  EXPECT_EQ(pairs(0.01).front().source, 1u);
  EXPECT_EQ(pairs(0.03).size(), 2u);
}

TEST(Correspondences, EqualBruteForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-5.0, 5.0);
  std::vector<Vector3d> source(400);
  std::vector<Vector3d> target(500);
  for (Vector3d& p : source) {
    p = {uniform(random), uniform(random), uniform(random)};
  }
  for (Vector3d& q : target) {
    q = {uniform(random), uniform(random), uniform(random)};
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({0.1, -0.2, 0.3});
  T.translation() = Vector3d(0.5, 0.0, -0.2);
  TargetParts parts(target);
  for (std::size_t j = 0; j < target.size(); j += 7) {
    parts.has_normal[j] = 0;
  }
  constexpr double kGate = 0.6;
  const Correspondences found = find_once(scan_of(source), parts.target(), T, kGate);
  std::size_t next = 0;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    std::size_t best = 0;
    for (std::size_t j = 1; j < target.size(); ++j) {
      if ((T * source[i] - target[j]).norm() < (T * source[i] - target[best]).norm()) {
        best = j;
      }
    }
    const double distance = (T * source[i] - target[best]).norm();
    if (distance <= kGate && best % 7 != 0) {
      ASSERT_LT(next, found.pairs.size());
      EXPECT_EQ(found.pairs[next].source, i);
      EXPECT_EQ(found.pairs[next].target, best);
      EXPECT_NEAR(found.pairs[next].squared_distance, distance * distance, 1e-12);
      sum += distance * distance;
      ++next;
    }
  }
  EXPECT_GT(next, 50u);
  EXPECT_EQ(found.pairs.size(), next);
  EXPECT_NEAR(found.fitness, static_cast<double>(next) / 400.0, 1e-15);
  EXPECT_NEAR(found.inlier_rmse, std::sqrt(sum / static_cast<double>(next)), 1e-12);
}

TEST(Correspondences, OfEmptyScansAreEmptyNotUndefined) {
  const TargetParts parts({{1, 0, 0}});
  const TargetParts nothing((std::vector<Vector3d>()));
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (const Correspondences& found :
       {find_once(Scan{}, parts.target(), T, 1.0), find_once(scan_of({{1, 0, 0}}), nothing.target(), T, 1.0),
        find_once(scan_of({{5, 0, 0}}), parts.target(), T, 1.0)}) {
    EXPECT_TRUE(found.pairs.empty());
    EXPECT_EQ(found.fitness, 0.0);
    EXPECT_EQ(found.inlier_rmse, 0.0);
  }
}

// The last group of four has lanes without a point, whatever the pose: none of them may be looked up.
TEST(Correspondences, APoseThatIsNotFinitePairsNothing) {
  const double kBad[] = {std::nan(""), std::numeric_limits<double>::infinity(), 1e300};
  for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 4095u}) {
    const Scan source = scan_of(std::vector<Vector3d>(size, Vector3d(1.0, 2.0, 3.0)));
    const TargetParts parts({{1, 2, 3}, {4, 5, 6}});
    const Workers workers(1);
    CorrespondenceSearch search(source, parts.target(), Gate{1.0}, true, workers);
    EXPECT_EQ(search.find(Eigen::Isometry3d::Identity()).pairs.size(), size);
    for (const double bad : kBad) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.translation().x() = bad;
      EXPECT_TRUE(search.find(T).pairs.empty()) << size << " points at " << bad;
    }
    EXPECT_EQ(search.find(Eigen::Isometry3d::Identity()).pairs.size(), size);
  }
}

}  // namespace
}  // namespace dynamic_icp::registration
