// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/way_search.hpp"

#include <array>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::registration {
namespace {

/// A wall across, a wall along and the ground, seen from a sensor at `x`, with their normals.
struct Corner {
  explicit Corner(double x) : scan(points(x)), tree(scan.points()), valid(scan.size(), 1) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      normals.emplace_back(Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i % 3)));
    }
  }

  static Scan points(double x) {
    RawScan raw;
    const RandomSource random(7);
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const double along = random.uniform(2 * i, -8.0, 8.0);
      const double up = random.uniform(2 * i + 1, -2.0, 2.0);
      const std::array<Eigen::Vector3d, 3> at = {Eigen::Vector3d(20.0, along, up),
                                                 Eigen::Vector3d(12.0 + along, 6.0, up),
                                                 Eigen::Vector3d(12.0 + along, 3.0 * up, -2.0)};
      raw.points.emplace_back(at.at(i % 3) - x * Eigen::Vector3d::UnitX());
      raw.doppler.push_back(0.0);
    }
    return Scan::from_raw(raw);
  }

  [[nodiscard]] Target target() const { return {scan, tree, normals, valid}; }

  Scan scan;
  spatial::KdTree tree;
  std::vector<Eigen::Vector3d> normals;
  std::vector<std::uint8_t> valid;
};

TEST(WaySearch, FindsAWayOfSeveralMetres) {
  const Corner before(0.0);
  const Corner after(3.3);
  const std::array axes = {Eigen::Vector3d(Eigen::Vector3d::UnitX())};
  const std::vector<WayCandidate> candidates = search_ways(before.scan, after.target(), axes, 4.5, Workers(2));
  EXPECT_EQ(candidates.size(), 11u) << "every 0.8 m from -4 to 4 m";
  const WayCandidate& best = best_way(candidates);
  EXPECT_NEAR(best.T_target_source.translation().x(), -3.3, 0.01);
  EXPECT_LT(best.cost, 0.01);
  EXPECT_TRUE(is_clear(candidates));
}

TEST(WaySearch, AWallAlongTheWayLeavesItOpen) {
  Corner before(0.0);
  Corner after(0.5);
  for (Corner* corner : {&before, &after}) {
    for (std::size_t i = 0; i < corner->valid.size(); i += 3) {
      corner->valid[i] = 0;  // the wall across
    }
  }
  const std::array axes = {Eigen::Vector3d(Eigen::Vector3d::UnitX())};
  EXPECT_FALSE(is_clear(search_ways(before.scan, after.target(), axes, 4.5, Workers(1))));
}

TEST(WaySearch, MisfitIsTheShareThatLiesOnNoPlane) {
  const Corner corner(0.0);
  EXPECT_EQ(misfit(corner.scan, corner.target(), Eigen::Isometry3d::Identity(), Workers(1)), 0.0);
  Eigen::Isometry3d ahead = Eigen::Isometry3d::Identity();
  ahead.translation().x() = 0.1;  // half the width of the wall across, none of the others
  EXPECT_NEAR(misfit(corner.scan, corner.target(), ahead, Workers(1)), 0.334 * 0.25, 1e-3);
  ahead.translation().x() = 500.0;
  EXPECT_EQ(misfit(corner.scan, corner.target(), ahead, Workers(1)), 1.0);
  EXPECT_EQ(misfit(Scan(), corner.target(), ahead, Workers(1)), 1.0);
}

TEST(WaySearch, ThinsEvenly) {
  const Corner corner(0.0);
  const Scan few = evenly_thinned(corner.scan, 300);
  EXPECT_EQ(few.size(), 250u);
  EXPECT_EQ(few.records()[1], 4u);
  EXPECT_EQ(evenly_thinned(corner.scan, 5000).size(), 1000u);
}

}  // namespace
}  // namespace dynamic_icp::registration
