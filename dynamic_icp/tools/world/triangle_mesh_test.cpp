// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/world/body_shapes.hpp"

namespace dynamic_icp::world {
namespace {

using std::numbers::pi;

/// Volume within a closed mesh, by the divergence theorem; positive when the normals point outwards.
double volume_within(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  return sum;
}

/// In a closed mesh with consistent turning each edge is run through once in either direction. Vertices at the same
/// place count as one.
bool is_closed(const TriangleMesh& mesh) {
  using Place = std::array<double, 3>;
  std::map<std::pair<Place, Place>, int> runs;
  const auto place = [&](std::uint32_t i) {
    const Eigen::Vector3d rounded = (mesh.vertices[i] * 1e9).array().round() + 0.0;  // no negative zeros
    return Place{rounded.x(), rounded.y(), rounded.z()};
  };
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++runs[{place(triangle[i]), place(triangle[(i + 1) % 3])}];
    }
  }
  for (const auto& [edge, count] : runs) {
    const auto back = runs.find({edge.second, edge.first});
    if (count != 1 || back == runs.end()) {
      return false;
    }
  }
  return true;
}

TEST(TriangleMesh, BoundsOfAnEmptyMeshAreEmpty) { EXPECT_TRUE(bounds(TriangleMesh{}).isEmpty()); }

TEST(TriangleMesh, SolidsAreClosedAndFaceOutwards) {
  const double polygon_area = 0.5 * 12 * 4.0 * std::sin(2.0 * pi / 12);  // regular 12-gon, radius 2
  EXPECT_TRUE(is_closed(make_box({1.0, 2.0, 3.0})));
  EXPECT_NEAR(volume_within(make_box({1.0, 2.0, 3.0})), 6.0, 1e-12);
  EXPECT_TRUE(is_closed(make_cylinder(2.0, 5.0, 12)));
  EXPECT_NEAR(volume_within(make_cylinder(2.0, 5.0, 12)), 5.0 * polygon_area, 1e-12);
  EXPECT_TRUE(is_closed(make_ellipsoid({1.0, 2.0, 3.0}, 8, 12)));
  const double round = 4.0 / 3.0 * pi * 6.0;
  EXPECT_NEAR(volume_within(make_ellipsoid({1.0, 2.0, 3.0}, 200, 400)), round, 1e-3 * round);
}

TEST(TriangleMesh, SolidsHaveTheSizeAskedFor) {
  const Eigen::AlignedBox3d box = bounds(make_box({1.0, 2.0, 3.0}));
  EXPECT_TRUE(box.isApprox(Eigen::AlignedBox3d(Eigen::Vector3d(-0.5, -1.0, -1.5), Eigen::Vector3d(0.5, 1.0, 1.5))));
  const TriangleMesh ellipsoid = make_ellipsoid({1.0, 2.0, 3.0}, 8, 12);
  for (const Eigen::Vector3d& p : ellipsoid.vertices) {
    EXPECT_NEAR(p.cwiseQuotient(Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1.0, 1e-12);
  }
}

TEST(TriangleMesh, SheetFacesAsDocumentedAndDropsDegenerateTriangles) {
  const std::array<Eigen::Vector3d, 6> points = {
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}, {2.0, 0.0, 0.0}}};
  const TriangleMesh sheet = make_sheet(points, 3);
  EXPECT_EQ(sheet.triangles.size(), 3U);
  for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
    EXPECT_TRUE(triangle_normal(sheet, i).isApprox(Eigen::Vector3d::UnitZ()));
  }
}

TEST(TriangleMesh, AppendMovesThePartAndKeepsItsShape) {
  TriangleMesh mesh = make_box({1.0, 1.0, 1.0});
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  T.pretranslate(Eigen::Vector3d(5.0, -3.0, 2.0));
  append(mesh, make_box({2.0, 1.0, 1.0}), T);
  EXPECT_NEAR(volume_within(mesh), 3.0, 1e-12);
}

TEST(BodyShapes, HaveTheirSizeAndStandOnTheRoad) {
  const auto check = [](const TriangleMesh& mesh, const Eigen::Vector3d& size) {
    const Eigen::AlignedBox3d box = bounds(mesh);
    EXPECT_TRUE(box.sizes().isApprox(size, 0.03)) << box.sizes().transpose();
    EXPECT_NEAR(box.min().z(), 0.0, 1e-12);
    EXPECT_NEAR(box.center().x(), 0.0, 0.05);
    EXPECT_NEAR(box.center().y(), 0.0, 1e-12);
    EXPECT_GT(volume_within(mesh), 0.0);
  };
  check(make_car(), {4.4, 1.8, 1.5});
  check(make_van(), {5.6, 2.0, 2.4});
  check(make_truck(), {10.0, 2.5, 3.6});
  check(make_pedestrian(), {0.5, 0.5, 1.75});
}

}  // namespace
}  // namespace dynamic_icp::world
