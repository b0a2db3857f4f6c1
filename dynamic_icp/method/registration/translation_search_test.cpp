// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/translation_search.hpp"

#include <array>
#include <cmath>

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

TEST(TranslationSearch, FindsATranslationOfSeveralMetres) {
  const Corner before(0.0);
  const Corner after(3.3);
  const InitialTranslation found =
      search_translation(before.scan, after.target(), 0.1, {.axes = {Eigen::Vector3d::UnitX()}}, Workers(2));
  EXPECT_NEAR(found.T_target_source.translation().x(), -3.3, 0.01);
  EXPECT_LT(found.cost, 0.01);
  EXPECT_TRUE(found.is_unambiguous);
}

TEST(TranslationSearch, LooksAsFarAsAVehicleDrivesWithinItsBounds) {
  const Corner before(0.0);
  const Corner after(6.4);
  const auto finds = [&](double dt_s, double min_m, double max_m) {
    const TranslationSearch search{{Eigen::Vector3d::UnitX()}, min_m, max_m};
    const InitialTranslation found = search_translation(before.scan, after.target(), dt_s, search, Workers(2));
    return found.cost < 0.01 && std::abs(found.T_target_source.translation().x() + 6.4) < 0.01;
  };
  EXPECT_TRUE(finds(0.15, 0.8, 10.0)) << "6.75 m at 45 m/s";
  EXPECT_FALSE(finds(0.05, 0.8, 10.0)) << "2.25 m";
  EXPECT_TRUE(finds(0.05, 7.0, 10.0)) << "at least 7 m";
  EXPECT_FALSE(finds(0.15, 0.8, 3.0)) << "at most 3 m";
}

TEST(TranslationSearch, AWallAlongTheTranslationLeavesItAmbiguous) {
  Corner before(0.0);
  Corner after(0.5);
  for (Corner* corner : {&before, &after}) {
    for (std::size_t i = 0; i < corner->valid.size(); i += 3) {
      corner->valid[i] = 0;  // the wall across
    }
  }
  const TranslationSearch search{.axes = {Eigen::Vector3d::UnitX()}};
  EXPECT_FALSE(search_translation(before.scan, after.target(), 0.1, search, Workers(1)).is_unambiguous);
}

TEST(TranslationSearch, WithoutAxesNothingIsFound) {
  const Corner corner(0.0);
  const InitialTranslation none =
      search_translation(corner.scan, corner.target(), 0.1, TranslationSearch{.axes = {}}, Workers(1));
  EXPECT_EQ(none.cost, 1.0);
  EXPECT_FALSE(none.is_unambiguous);
}

TEST(PlaneDistance, IsSignedAndOnlyKnownNearPointsWithANormal) {
  Corner corner(0.0);
  const Eigen::Vector3d point = corner.scan.points()[0] + Eigen::Vector3d(0.05, 0.0, 0.0);
  ASSERT_TRUE(plane_distance(corner.target(), point, 1.0).has_value());
  EXPECT_NEAR(*plane_distance(corner.target(), point, 1.0), 0.05, 1e-12);
  EXPECT_FALSE(plane_distance(corner.target(), point, 0.01).has_value());
  corner.valid.assign(corner.valid.size(), 0);
  EXPECT_FALSE(plane_distance(corner.target(), point, 1.0).has_value());
}

TEST(TranslationSearch, MisfitIsTheShareThatLiesOnNoPlane) {
  const Corner corner(0.0);
  EXPECT_EQ(misfit(corner.scan, corner.target(), Eigen::Isometry3d::Identity(), Workers(1)), 0.0);
  Eigen::Isometry3d ahead = Eigen::Isometry3d::Identity();
  ahead.translation().x() = 0.1;  // half the width of the wall across, none of the others
  EXPECT_NEAR(misfit(corner.scan, corner.target(), ahead, Workers(1)), 0.334 * 0.25, 1e-3);
  ahead.translation().x() = 500.0;
  EXPECT_EQ(misfit(corner.scan, corner.target(), ahead, Workers(1)), 1.0);
  EXPECT_EQ(misfit(Scan(), corner.target(), ahead, Workers(1)), 1.0);
}

TEST(TranslationSearch, ThinsEvenly) {
  const Corner corner(0.0);
  const Scan few = evenly_thinned(corner.scan, 300);
  EXPECT_EQ(few.size(), 250u);
  EXPECT_EQ(few.records()[1], 4u);
  EXPECT_EQ(evenly_thinned(corner.scan, 5000).size(), 1000u);
}

}  // namespace
}  // namespace dynamic_icp::registration
