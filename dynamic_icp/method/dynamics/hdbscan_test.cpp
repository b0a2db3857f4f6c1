// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/hdbscan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/dynamics/condensed_tree.hpp"

#include "testing/random_points.hpp"

namespace dynamic_icp::dynamics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(Hdbscan, FewPointsAreNoise) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}, {5, 5, 6}};
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Points some(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(n));
    for (const HdbscanConfig config : {HdbscanConfig{6, 1, true}, {2, 5, true}}) {
      const HdbscanResult result = hdbscan(some, config, Workers(1));
      EXPECT_EQ(result.labels, std::vector<std::int32_t>(n, -1));
      EXPECT_EQ(result.probabilities, std::vector<double>(n, 0.0));
      EXPECT_EQ(result.cluster_count, 0);
      EXPECT_TRUE(result.stabilities.empty());
    }
  }
}

TEST(Hdbscan, TwoClearBlobsAreTwoClustersNumberedFromTheSmallestPoint) {
  std::mt19937 random(3);
  Points points;
  for (int i = 0; i < 200; ++i) {
    points.push_back(gaussian(random) + Eigen::Vector3d(i < 80 ? 100.0 : -100.0, 0.0, 0.0));
  }
  const HdbscanResult result = hdbscan(points, HdbscanConfig{}, Workers(1));
  ASSERT_EQ(result.cluster_count, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(result.labels[i], i < 80 ? 1 : 0);
  }
}

TEST(Hdbscan, PermutedPointsHavePermutedLabels) {
  std::mt19937 random(4);
  Points grid;
  for (int i = 0; i < 400; ++i) {
    grid.emplace_back(i % 20 + (i % 20 > 11 ? 1.5 : 0.0), i / 20, i % 3);
  }
  for (const Points& points : {grid, with_duplicates(random, 500), blobs(random, 500), lines(random, 400)}) {
    const HdbscanConfig config{.min_cluster_size = 10, .min_samples = 4};
    const HdbscanResult expected = hdbscan(points, config, Workers(1));
    for (int repeat = 0; repeat < 5; ++repeat) {
      std::vector<std::size_t> rows(points.size());
      std::iota(rows.begin(), rows.end(), std::size_t{0});
      std::shuffle(rows.begin(), rows.end(), random);
      Points permuted;
      for (const std::size_t row : rows) {
        permuted.push_back(points[row]);
      }
      const HdbscanResult result = hdbscan(permuted, config, Workers(1));
      for (std::size_t i = 0; i < rows.size(); ++i) {
        ASSERT_EQ(result.labels[i], expected.labels[rows[i]]);
        ASSERT_EQ(result.probabilities[i], expected.probabilities[rows[i]]);
      }
      EXPECT_EQ(result.stabilities, expected.stabilities);
    }
  }
}

// A selected cluster and the points that it keeps to the end have the largest probability there is.
TEST(Hdbscan, TheTreeIsInTheOrderOfThePoints) {
  std::mt19937 random(5);
  Points points = blobs(random, 400);
  std::shuffle(points.begin(), points.end(), random);
  CondensedTree tree;
  const HdbscanConfig config{.min_cluster_size = 10, .min_samples = 4};
  const HdbscanResult result = hdbscan(points, config, Workers(2), &tree);
  ASSERT_EQ(tree.point_cluster.size(), points.size());
  const std::vector<bool> selected = select_by_excess_of_mass(tree, false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint32_t cluster = tree.point_cluster[i];
    const std::uint32_t last = cluster;
    while (cluster != 0 && !selected[cluster]) {
      cluster = tree.clusters[cluster].parent;
    }
    EXPECT_EQ(result.labels[i] == -1, cluster == 0) << i;
    if (cluster != 0 && cluster == last) {
      EXPECT_EQ(result.probabilities[i], tree.point_lambda[i] / tree.clusters[cluster].death) << i;
    }
  }
  hdbscan(Points{{0, 0, 0}}, config, Workers(1), &tree);
  EXPECT_TRUE(tree.clusters.empty() && tree.point_cluster.empty());
}

TEST(Hdbscan, AnyNumberOfThreadsGivesTheSameBits) {
  std::mt19937 random(5);
  Points grid;
  for (int i = 0; i < 3000; ++i) {
    grid.emplace_back(i % 20 + (i % 20 > 11 ? 1.5 : 0.0), i / 20 % 10, i / 200);
  }
  for (const Points& points : {grid, blobs(random, 4000), with_duplicates(random, 3000)}) {
    const HdbscanResult expected = hdbscan(points, HdbscanConfig{}, Workers(1));
    for (const int threads : {2, 7}) {
      const HdbscanResult result = hdbscan(points, HdbscanConfig{}, Workers(threads));
      EXPECT_EQ(result.labels, expected.labels);
      EXPECT_EQ(result.probabilities, expected.probabilities);
      EXPECT_EQ(result.stabilities, expected.stabilities);
    }
  }
}

void expect_sound(const HdbscanResult& result, std::size_t n) {
  ASSERT_EQ(result.labels.size(), n);
  ASSERT_EQ(result.probabilities.size(), n);
  ASSERT_EQ(result.stabilities.size(), static_cast<std::size_t>(result.cluster_count));
  std::vector<int> sizes(static_cast<std::size_t>(result.cluster_count), 0);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_GE(result.labels[i], -1);
    ASSERT_LT(result.labels[i], result.cluster_count);
    ASSERT_TRUE(result.probabilities[i] >= 0.0 && result.probabilities[i] <= 1.0);
    if (result.labels[i] >= 0) {
      ++sizes[static_cast<std::size_t>(result.labels[i])];
    }
  }
  EXPECT_TRUE(std::all_of(sizes.begin(), sizes.end(), [](int size) { return size > 0; }));
  for (const double stability : result.stabilities) {
    EXPECT_TRUE(stability >= 0.0 && stability <= 1.0 + 1e-12) << stability;
  }
}

TEST(Hdbscan, AllPointsIdentical) {
  for (const std::size_t n : {31u, 100u, 100'000u}) {
    const Points points(n, Eigen::Vector3d(3.0, -1.0, 0.5));
    HdbscanResult result = hdbscan(points, HdbscanConfig{}, Workers(2));
    expect_sound(result, n);
    EXPECT_EQ(result.labels, std::vector<std::int32_t>(n, -1));
    result = hdbscan(points, HdbscanConfig{.allow_single_cluster = true}, Workers(2));
    expect_sound(result, n);
    EXPECT_EQ(result.labels, std::vector<std::int32_t>(n, 0));
    EXPECT_EQ(result.probabilities, std::vector<double>(n, 1.0));
  }
}

TEST(Hdbscan, HeapsOfIdenticalPointsAreClustersWithFiniteNumbers) {
  Points points(40, Eigen::Vector3d(0.0, 0.0, 0.0));
  points.insert(points.end(), 50, Eigen::Vector3d(1.0, 0.0, 0.0));
  points.emplace_back(0.1, 0.0, 0.0);
  points.emplace_back(50.0, 0.0, 0.0);
  const HdbscanResult result = hdbscan(points, HdbscanConfig{}, Workers(1));
  expect_sound(result, points.size());
  ASSERT_EQ(result.cluster_count, 2);
  EXPECT_EQ(result.stabilities, (std::vector<double>{1.0, 1.0}));
  for (std::size_t i = 0; i < 90; ++i) {
    EXPECT_EQ(result.labels[i], i < 40 ? 0 : 1);
    EXPECT_EQ(result.probabilities[i], 1.0);
  }
  // Beside points of infinite density any other is infinitely loose.
  EXPECT_EQ(result.labels[90], 0);
  EXPECT_EQ(result.probabilities[90], 0.0);
  EXPECT_EQ(result.labels[91], -1);
}

TEST(Hdbscan, ManyCollinearPoints) {
  const std::size_t n = 100'000;
  std::mt19937 random(6);
  Points even;
  Points doubling;  // each gap a little wider than the last: the single linkage tree is one long chain
  Points uneven;
  for (std::size_t i = 0; i < n; ++i) {
    even.emplace_back(static_cast<double>(i), 0.0, 0.0);
    doubling.emplace_back(std::exp(1e-4 * static_cast<double>(i)), 0.0, 0.0);
    uneven.emplace_back(uniform(random, 0.0, 1e4), 0.0, 0.0);
  }
  for (const Points& points : {even, doubling, uneven}) {
    expect_sound(hdbscan(points, HdbscanConfig{}, Workers(2)), n);
  }
}

TEST(Hdbscan, ManyPointsInSpace) {
  std::mt19937 random(7);
  Points points = blobs(random, 25'000);
  for (int i = 0; i < 25'000; ++i) {
    points.push_back(1e5 * Eigen::Vector3d::Ones() + gaussian(random));
  }
  expect_sound(hdbscan(points, HdbscanConfig{}, Workers(2)), points.size());
}

TEST(Hdbscan, ExtremeScalesStayFinite) {
  std::mt19937 random(8);
  for (const double scale : {1e-200, 1e-150, 1e-6, 1e6, 1e140}) {
    Points points = blobs(random, 200);
    for (Eigen::Vector3d& p : points) {
      p *= scale;
    }
    expect_sound(hdbscan(points, HdbscanConfig{10, 5, false}, Workers(1)), points.size());
  }
}

TEST(Hdbscan, PlaneIsSpaceAtHeightZero) {
  std::mt19937 random(9);
  const Points points = flat(blobs(random, 400));
  std::vector<Eigen::Vector2d> plane;
  for (const Eigen::Vector3d& p : points) {
    plane.push_back(p.head<2>());
  }
  const HdbscanResult expected = hdbscan(points, HdbscanConfig{}, Workers(1));
  const HdbscanResult result = hdbscan(plane, HdbscanConfig{}, Workers(1));
  EXPECT_EQ(result.labels, expected.labels);
  EXPECT_EQ(result.probabilities, expected.probabilities);
}

TEST(Hdbscan, RefusesWrongConfigurationsAndPoints) {
  Points points(50, Eigen::Vector3d::Zero());
  EXPECT_THROW(hdbscan(points, HdbscanConfig{1, 10, false}, Workers(1)), UsageError);
  EXPECT_THROW(hdbscan(points, HdbscanConfig{30, 0, false}, Workers(1)), UsageError);
  EXPECT_THROW(hdbscan(Points(), HdbscanConfig{0, 10, false}, Workers(1)), UsageError);
  for (const double bad : {kNever, std::numeric_limits<double>::quiet_NaN(), 1e160}) {
    points[17].y() = bad;
    EXPECT_THROW(hdbscan(points, HdbscanConfig{}, Workers(1)), DataError);
  }
}

}  // namespace
}  // namespace dynamic_icp::dynamics
