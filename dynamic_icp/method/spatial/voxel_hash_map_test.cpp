// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

Points random_points(std::size_t count, double half_width, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-half_width, half_width);
  Points points(count);
  for (Vector3d& point : points) {
    point = {uniform(random), uniform(random), 0.3 * uniform(random)};
  }
  return points;
}

std::array<long, 3> cell_of(const Vector3d& point, double size) {
  return {std::lround(std::floor(point.x() / size)), std::lround(std::floor(point.y() / size)),
          std::lround(std::floor(point.z() / size))};
}

/// The definition of the map: points by voxel, voxels in the order in which they were first seen.
struct DirectMap {
  double size;
  std::size_t capacity;
  std::vector<std::pair<std::array<long, 3>, Points>> voxels;

  void add(const Points& points) {
    for (const Vector3d& point : points) {
      const std::array<long, 3> cell = cell_of(point, size);
      auto at = std::find_if(voxels.begin(), voxels.end(), [&](const auto& voxel) { return voxel.first == cell; });
      if (at == voxels.end()) {
        at = voxels.insert(voxels.end(), {cell, {}});
      }
      if (at->second.size() < capacity) {
        at->second.push_back(point);
      }
    }
  }

  void remove_far(const Vector3d& position, double distance) {
    std::erase_if(voxels, [&](const auto& voxel) { return (voxel.second.front() - position).norm() > distance; });
  }

  [[nodiscard]] Points points() const {
    Points all;
    for (const auto& [cell, inside] : voxels) {
      all.insert(all.end(), inside.begin(), inside.end());
    }
    return all;
  }

  /// The least distance among the 27 voxels; infinite when they are empty.
  [[nodiscard]] double nearest_distance(const Vector3d& query) const {
    const std::array<long, 3> centre = cell_of(query, size);
    double best = std::numeric_limits<double>::infinity();
    for (const auto& [cell, inside] : voxels) {
      if (std::abs(cell[0] - centre[0]) <= 1 && std::abs(cell[1] - centre[1]) <= 1 &&
          std::abs(cell[2] - centre[2]) <= 1) {
        for (const Vector3d& point : inside) {
          best = std::min(best, (point - query).norm());
        }
      }
    }
    return best;
  }
};

void expect_same_search(const VoxelHashMap& map, const DirectMap& direct, const Points& queries, double gate) {
  for (const Vector3d& query : queries) {
    const double expected = direct.nearest_distance(query);
    const std::optional<Neighbour> found = map.nearest(query, gate);
    ASSERT_EQ(found.has_value(), expected <= gate) << query.transpose();
    if (found) {
      EXPECT_NEAR(std::sqrt(found->squared_distance), expected, 1e-12);
      EXPECT_NEAR((map.point(found->index) - query).norm(), expected, 1e-12);
    }
  }
}

TEST(VoxelHashMap, HoldsNothingAtFirst) {
  const VoxelHashMap map(1.0, 20);
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.size(), 0u);
  EXPECT_TRUE(map.points().empty());
  EXPECT_FALSE(map.nearest({0, 0, 0}, 100.0));
}

TEST(VoxelHashMap, KeepsTheFirstPointsOfAVoxel) {
  VoxelHashMap map(1.0, 2);
  map.add(Points{{0.1, 0.1, 0.1}, {1.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}, {-0.1, 0.1, 0.1}});
  const Points expected = {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {1.1, 0.1, 0.1}, {-0.1, 0.1, 0.1}};
  EXPECT_EQ(map.points(), expected) << "the third of the first voxel is left out; -0.1 lies in a voxel of its own";
  EXPECT_EQ(map.size(), 4u);
  map.add(Points{{0.9, 0.9, 0.9}});
  EXPECT_EQ(map.size(), 4u) << "a full voxel stays as it is";
}

TEST(VoxelHashMap, FindsTheNearestOfTheVoxelsAround) {
  VoxelHashMap map(1.0, 20);
  map.add(Points{{0.05, 0.5, 0.5}, {1.2, 0.5, 0.5}, {3.5, 0.5, 0.5}});
  const std::optional<Neighbour> across = map.nearest({0.9, 0.5, 0.5}, 5.0);
  ASSERT_TRUE(across);
  EXPECT_EQ(map.point(across->index), Vector3d(1.2, 0.5, 0.5)) << "nearer than the one in the same voxel";
  EXPECT_NEAR(across->squared_distance, 0.09, 1e-15);
  EXPECT_FALSE(map.nearest({0.9, 0.5, 0.5}, 0.29)) << "beyond the gate";
  EXPECT_FALSE(map.nearest({5.0, 0.5, 0.5}, 5.0)) << "1.5 m away, but two voxels";
}

TEST(VoxelHashMap, OfEquallyNearPointsTheOldestIsFound) {
  VoxelHashMap map(1.0, 20);
  map.add(Points{{1.75, 0.5, 0.5}, {0.75, 0.5, 0.5}, {1.25, 0.25, 0.5}, {1.25, 0.75, 0.5}});
  const std::optional<Neighbour> found = map.nearest({1.25, 0.5, 0.5}, 5.0);
  ASSERT_TRUE(found);
  EXPECT_EQ(map.point(found->index), Vector3d(1.25, 0.25, 0.5));
  const std::optional<Neighbour> two_voxels = map.nearest({1.25, 0.5, 0.5 + 1e-9}, 0.2);
  EXPECT_FALSE(two_voxels);
  VoxelHashMap pair(1.0, 20);
  pair.add(Points{{1.25, 0.5, 0.5}, {0.75, 0.5, 0.5}});
  const std::optional<Neighbour> older = pair.nearest({1.0, 0.5, 0.5}, 5.0);
  ASSERT_TRUE(older);
  EXPECT_EQ(pair.point(older->index), Vector3d(1.25, 0.5, 0.5));
}

TEST(VoxelHashMap, RemovesVoxelsByTheirFirstPoint) {
  VoxelHashMap map(1.0, 20);
  map.add(Points{{10.9, 0, 0}, {10.1, 0, 0}, {5.1, 0, 0}, {5.9, 0, 0}, {-4.9, 0, 0}});
  map.remove_far({0, 0, 0}, 10.5);
  const Points expected = {{5.1, 0, 0}, {5.9, 0, 0}, {-4.9, 0, 0}};
  EXPECT_EQ(map.points(), expected) << "10.1 goes with the first point of its voxel";
  map.remove_far({0, 0, 0}, 5.5);
  EXPECT_EQ(map.points(), expected) << "5.9 stays with the first point of its voxel";
  EXPECT_FALSE(map.nearest({10.1, 0, 0}, 1.0));
  ASSERT_TRUE(map.nearest({-4.9, 0, 0.1}, 1.0));
  map.remove_far({1000, 0, 0}, 10.0);
  EXPECT_TRUE(map.empty());
  map.add(Points{{10.1, 0, 0}});
  EXPECT_EQ(map.size(), 1u);
}

TEST(VoxelHashMap, EqualsTheDirectDefinitionWhilePointsComeAndGo) {
  for (const double size : {0.5, 1.0, 2.7}) {
    VoxelHashMap map(size, 3);
    DirectMap direct{size, 3, {}};
    for (unsigned round = 0; round < 6; ++round) {
      Points points = random_points(700, 8.0, round);
      const Vector3d centre(3.0 * round, -1.5 * round, 0.0);
      for (Vector3d& point : points) {
        point += centre;
      }
      map.add(points);
      direct.add(points);
      map.remove_far(centre, 9.0);
      direct.remove_far(centre, 9.0);
      ASSERT_EQ(map.points(), direct.points());
      Points queries = random_points(200, 12.0, 100 + round);
      for (Vector3d& query : queries) {
        query += centre;
      }
      expect_same_search(map, direct, queries, 1.2);
      expect_same_search(map, direct, queries, 6.0);
    }
  }
}

TEST(VoxelHashMap, RefusesWhatItCannotHold) {
  EXPECT_THROW(VoxelHashMap(0.0, 20), std::invalid_argument);
  EXPECT_THROW(VoxelHashMap(std::nan(""), 20), std::invalid_argument);
  EXPECT_THROW(VoxelHashMap(1.0, 0), std::invalid_argument);
  VoxelHashMap map(1.0, 20);
  map.add(Points{{2e9, 0, 0}, {std::nan(""), 0, 0}});
  EXPECT_EQ(map.size(), 0u);
  EXPECT_FALSE(map.nearest({std::nan(""), 0, 0}, 1.0));
  EXPECT_FALSE(map.nearest({0, 0, 0}, -1.0));
}

}  // namespace
}  // namespace dynamic_icp::spatial
