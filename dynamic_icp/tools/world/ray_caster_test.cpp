// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/ray_caster.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/tools/world/body_shapes.hpp"
#include "dynamic_icp/tools/world/drive.hpp"

namespace dynamic_icp::world {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(const RandomSource& random, double span) {
  return {random.uniform(0, -span, span), random.uniform(1, -span, span), random.uniform(2, -span, span)};
}

/// Every triangle, by solving origin + range * direction = corner + b * edge1 + c * edge2 in double precision.
std::optional<double> brute_force(const TriangleMesh& mesh, const Ray& ray) {
  std::optional<double> nearest;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d& corner = mesh.vertices[triangle[0]];
    Eigen::Matrix3d A;
    A << -ray.direction_world, mesh.vertices[triangle[1]] - corner, mesh.vertices[triangle[2]] - corner;
    const Vector3d x = A.fullPivLu().solve(ray.origin_world - corner);
    const bool inside = x[1] >= 0.0 && x[2] >= 0.0 && x[1] + x[2] <= 1.0;
    if (inside && x[0] > 0.0 && x[0] <= ray.max_range_m && (!nearest || x[0] < *nearest)) {
      nearest = x[0];
    }
  }
  return nearest;
}

TEST(RayCaster, EmptyWorldReturnsNothing) {
  const World world;
  const RayCaster caster(world);
  EXPECT_FALSE(caster.cast({Vector3d::Zero(), Vector3d::UnitX(), 100.0}, bodies_at(world, 0.0)).has_value());
}

TEST(RayCaster, BoxFromInsideAndOutside) {
  World world;
  world.statics = make_box({4.0, 6.0, 8.0});
  const RayCaster caster(world);
  const auto outside = caster.cast({Vector3d(-10.0, 1.0, 2.0), Vector3d::UnitX(), 100.0}, {});
  ASSERT_TRUE(outside.has_value());
  EXPECT_NEAR(outside->range_m, 8.0, 1e-12);
  EXPECT_TRUE(outside->normal_world.isApprox(-Vector3d::UnitX()));
  EXPECT_FALSE(outside->body.has_value());
  // From inside: the nearest of the six planes in the ray's way.
  for (std::uint64_t i = 0; i < 200; ++i) {
    const RandomSource random = RandomSource(1).fork(i);
    const Vector3d origin = random_vector(random, 1.5);
    const Vector3d direction = random_vector(random.fork(1), 1.0).normalized();
    const Vector3d half(2.0, 3.0, 4.0);
    double expected = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      expected = std::min(expected, (std::copysign(half[axis], direction[axis]) - origin[axis]) / direction[axis]);
    }
    const auto hit = caster.cast({origin, direction, 100.0}, {});
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->range_m, expected, 1e-9);
  }
}

TEST(RayCaster, CylinderIsMetWithinItsFacetsDepth) {
  World world;
  const double radius = 0.5;
  const int sides = 24;
  world.statics = make_cylinder(radius, 4.0, sides);
  const RayCaster caster(world);
  const double sagitta = radius * (1.0 - std::cos(std::numbers::pi / sides));
  for (int i = -40; i <= 40; ++i) {
    const double y = 0.01 * i;
    const auto hit = caster.cast({Vector3d(-10.0, y, 2.0), Vector3d::UnitX(), 100.0}, {});
    ASSERT_TRUE(hit.has_value()) << y;
    const double round = 10.0 - std::sqrt(radius * radius - y * y);
    const double slope = radius / std::sqrt(radius * radius - y * y);
    EXPECT_GE(hit->range_m, round - 1e-12);
    EXPECT_LE(hit->range_m, round + 1.2 * sagitta * slope);
  }
}

TEST(RayCaster, RespectsTheMaximumRange) {
  World world;
  world.statics = make_box({2.0, 2.0, 2.0});
  const RayCaster caster(world);
  EXPECT_FALSE(caster.cast({Vector3d(-10.0, 0.1, 0.2), Vector3d::UnitX(), 8.9}, {}).has_value());
  EXPECT_TRUE(caster.cast({Vector3d(-10.0, 0.1, 0.2), Vector3d::UnitX(), 9.1}, {}).has_value());
}

TEST(RayCaster, AgreesWithBruteForceOnStaticAndTurnedMovingBodies) {
  World world;
  append(world.statics, make_car(), Eigen::Isometry3d(Eigen::Translation3d(3.0, 4.0, -1.0)));
  append(world.statics, make_ellipsoid({1.0, 2.0, 3.0}, 8, 12),
         Eigen::Isometry3d(Eigen::Translation3d(-4.0, 1.0, 0.0)));
  add_shape(world, make_van());
  Eigen::Isometry3d T_world_van = Eigen::Isometry3d::Identity();
  T_world_van.linear() = exp_so3(Vector3d(0.3, -0.4, 2.0));
  T_world_van.translation() << 1.0, -5.0, 1.0;
  add_body(world, "van", 0, stand(T_world_van));
  TriangleMesh everything = world.statics;
  append(everything, world.shapes[0].mesh, T_world_van);

  const RayCaster caster(world);
  const std::vector<BodyAt> bodies = bodies_at(world, 0.0);
  int hits = 0;
  int on_van = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const RandomSource random = RandomSource(5).fork(i);
    const Vector3d origin = 15.0 * random_vector(random, 1.0).normalized();
    const Vector3d direction = (random_vector(random.fork(1), 4.0) - origin).normalized();
    const Ray ray{origin, direction, 40.0};
    const auto expected = brute_force(everything, ray);
    const auto hit = caster.cast(ray, bodies);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (hit) {
      EXPECT_NEAR(hit->range_m, *expected, 1e-5) << i;
      EXPECT_NEAR(hit->normal_world.norm(), 1.0, 1e-12);
      ++hits;
      const bool van = !brute_force(world.statics, {origin, direction, hit->range_m + 1e-6}).has_value();
      EXPECT_EQ(hit->body.has_value(), van) << i;
      on_van += van ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 400);
  EXPECT_GT(on_van, 100);
}

TEST(RayCaster, MeetsAMovingBodyWhereItIsAtTheRaysTime) {
  World world;
  add_shape(world, make_box({2.0, 2.0, 2.0}));
  add_body(world, "box", 0, drive(std::make_shared<const Route>(std::vector<RoutePiece>{}), SpeedProfile(10.0), {}));
  const RayCaster caster(world);
  for (const double t : {0.0, 0.35, 2.0}) {
    const auto hit = caster.cast({Vector3d(-10.0, 0.1, 0.2), Vector3d::UnitX(), 100.0}, bodies_at(world, t));
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->range_m, 9.0 + 10.0 * t, 1e-9);
    EXPECT_EQ(hit->body, std::size_t{0});
  }
}

}  // namespace
}  // namespace dynamic_icp::world
