// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/range_surfaces.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::diagnosis {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// What rays over a field of view, in radians to each side and up and down, meet of a box around the sensor: the inside
/// of a tube, or of a room.
Points inside_of_a_box(double half_azimuth, double half_elevation, const Eigen::Vector3d& half_size) {
  constexpr int kColumns = 300;
  constexpr int kRows = 80;
  Points points;
  for (int i = 0; i < kColumns; ++i) {
    for (int k = 0; k < kRows; ++k) {
      const double azimuth = half_azimuth * ((2.0 * i + 1.0) / kColumns - 1.0);
      const double elevation = half_elevation * ((2.0 * k + 1.0) / kRows - 1.0);
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      points.push_back((half_size.array() / ray.array().abs()).minCoeff() * ray);
    }
  }
  return points;
}

/// Azimuth, elevation and range.
Points to_angles(const Points& points, double per_radian) {
  Points angles;
  for (const Eigen::Vector3d& p : points) {
    angles.emplace_back(per_radian * std::atan2(p.y(), p.x()), per_radian * std::atan2(p.z(), p.head<2>().norm()),
                        p.norm());
  }
  return angles;
}

/// x as a range, y and z as angles: what metres look like that are taken for radians.
Points in_turn(const Points& points) {
  Points turned;
  for (const Eigen::Vector3d& p : points) {
    turned.emplace_back(p.y(), p.z(), p.x());
  }
  return turned;
}

TEST(RangeSurfaces, AnglesShowThemAndCoordinatesDoNot) {
  const Points street = inside_of_a_box(1.0, 0.2, {80.0, 9.0, 2.0});
  EXPECT_TRUE(shows_surfaces(to_angles(street, 180.0 / std::numbers::pi)));
  EXPECT_FALSE(shows_surfaces(in_turn(street)));
  EXPECT_FALSE(shows_surfaces({})) << "no points tell nothing";
  EXPECT_FALSE(contradicts_surfaces(to_angles(street, 180.0 / std::numbers::pi)));
  EXPECT_TRUE(contradicts_surfaces(in_turn(street)));
  EXPECT_FALSE(contradicts_surfaces({}));
}

TEST(RangeSurfaces, RadiansAreToldFromMetres) {
  for (const Eigen::Vector3d& size : {Eigen::Vector3d(80.0, 9.0, 2.0), {120.0, 20.0, 1.8}, {60.0, 5.0, 3.0}}) {
    const Points radians = to_angles(inside_of_a_box(1.0, 0.2, size), 1.0);
    EXPECT_TRUE(are_radians_with_ranges(radians, radians)) << size.transpose();
    Points with_holes = radians;
    with_holes.front().setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE(are_radians_with_ranges(with_holes, with_holes)) << size.transpose();
  }
}

TEST(RangeSurfaces, MetresInASlabAsNarrowAsAnglesStayMetres) {
  struct Place {
    const char* name;
    Points points;
  };
  const Place places[] = {{"corridor", inside_of_a_box(0.5, 0.3, {40.0, 1.5, 1.2})},
                          {"long corridor", inside_of_a_box(1.0, 0.2, {200.0, 2.0, 1.5})},
                          {"pipe", inside_of_a_box(0.3, 0.3, {60.0, 0.5, 0.5})},
                          {"far wall through a long lens", inside_of_a_box(0.02, 0.02, {50.0, 5.0, 5.0})},
                          {"end of a shaft", inside_of_a_box(0.02, 0.02, {25.0, 0.6, 0.6})},
                          {"room", inside_of_a_box(0.6, 0.3, {4.0, 3.0, 1.2})},
                          {"board", inside_of_a_box(0.3, 0.3, {1.0, 2.0, 2.0})}};
  for (const Place& place : places) {
    EXPECT_FALSE(are_radians_with_ranges(in_turn(place.points), place.points)) << place.name;
  }
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
