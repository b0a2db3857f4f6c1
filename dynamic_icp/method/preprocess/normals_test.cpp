// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/normals.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::preprocess {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Normals normals_of(const Points& points, const NormalsConfig& config = {}, int threads = 1) {
  return estimate_normals(points, spatial::KdTree(points), config, Workers(threads));
}

Points random_points(unsigned seed, std::size_t n, const Eigen::Vector3d& size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Points points(n);
  for (Eigen::Vector3d& point : points) {
    point = size.cwiseProduct(Eigen::Vector3d(uniform(random), uniform(random), uniform(random)));
  }
  return points;
}

TEST(Normals, OfAPlaneIsItsNormal) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, -2.0, 3.0).normalized();
  const Eigen::Quaterniond R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  Points points = random_points(1, 500, {5.0, 5.0, 0.0});
  for (Eigen::Vector3d& point : points) {
    point = R * point + Eigen::Vector3d(10.0, 0.0, 0.0);
  }
  const Normals normals = normals_of(points);
  EXPECT_EQ(normals.count(), points.size());
  for (const Eigen::Vector3d& estimate : normals.vectors) {
    EXPECT_NEAR(std::abs(estimate.dot(normal)), 1.0, 1e-12);
    EXPECT_NEAR(estimate.norm(), 1.0, 1e-15);
  }
}

TEST(Normals, EqualTheSingularVectorOfTheNearestPoints) {
  const Points points = random_points(2, 300, {4.0, 4.0, 1.0});
  const NormalsConfig config{.radius_m = 1.5, .max_neighbours = 12};
  const Normals normals = normals_of(points, config);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The definition, slowly: sort all points by distance, cut, singular value decomposition.
    Points sorted = points;
    std::sort(sorted.begin(), sorted.end(), [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return (a - points[i]).norm() < (b - points[i]).norm();
    });
    Eigen::Index count = 0;
    while (count < config.max_neighbours && (sorted[static_cast<std::size_t>(count)] - points[i]).norm() <= 1.5) {
      ++count;
    }
    ASSERT_EQ(normals.has(i), count >= 3);
    if (normals.has(i)) {
      Eigen::Matrix3Xd centred = Eigen::Map<const Eigen::Matrix3Xd>(sorted.front().data(), 3, count);
      centred.colwise() -= Eigen::Vector3d(centred.rowwise().mean());
      const Eigen::Vector3d least = dense::left_singular_vectors(centred).col(2);
      EXPECT_NEAR(std::abs(least.dot(normals.vectors[i])), 1.0, 1e-9);
    }
  }
}

TEST(Normals, PointsWithoutAPlaneAreMarked) {
  // A line, a pair and a single point, each far from the others.
  Points points;
  for (int i = 0; i < 10; ++i) {
    points.emplace_back(0.1 * i, 0.2 * i, 5.0);
  }
  points.emplace_back(100.0, 0.0, 0.0);
  points.emplace_back(100.1, 0.0, 0.0);
  points.emplace_back(0.0, 300.0, 0.0);
  const Normals normals = normals_of(points);
  EXPECT_EQ(normals.count(), 0u);
  for (const Eigen::Vector3d& vector : normals.vectors) {
    EXPECT_TRUE(vector.isZero(0.0));
  }
  EXPECT_EQ(normals_of({}).count(), 0u);
  EXPECT_EQ(normals_of(Points(50, Eigen::Vector3d(1, 2, 3))).count(), 0u) << "one place repeated is no plane";
}

TEST(Normals, SameBitsForAnyNumberOfThreads) {
  const Points points = random_points(3, 4000, {20.0, 20.0, 2.0});
  const Normals one = normals_of(points, {}, 1);
  for (const int threads : {2, 7}) {
    const Normals several = normals_of(points, {}, threads);
    EXPECT_EQ(one.vectors, several.vectors);
    EXPECT_EQ(one.valid, several.valid);
  }
}

}  // namespace
}  // namespace dynamic_icp::preprocess
