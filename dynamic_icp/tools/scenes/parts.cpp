// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamic_icp/tools/world/body_shapes.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr int kCrownRings = 8;
constexpr double kKerbHeight = 0.12;  // m

/// Calls place(s, random of this thing) for each thing of a row.
template <class Place>
void for_each_of(const Row& row, const RandomSource& random, const Place& place) {
  std::uint64_t i = 0;
  for (double s = row.begin_m; s <= row.end_m; s += row.spacing_m, ++i) {
    const RandomSource own = random.fork(i);
    place(s + own.uniform(0, -row.jitter_m, row.jitter_m), own);
  }
}

/// Turns a frame of the route so that y points away from it.
double away_from_route(double lateral_m) { return lateral_m < 0.0 ? pi : 0.0; }

/// One house; frame: x along the front, y into the house, origin in the middle of the front.
void add_house(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_front, double width,
               const RandomSource& random) {
  const double depth = random.uniform(1, 8.0, 11.0);
  const double height = random.uniform(2, 8.0, 16.0);
  const double paint = world::reflectivity::kPlaster * random.uniform(6, 0.5, 1.5);
  const auto add = [&](double x, double y, const Vector3d& size, double z = 0.0) {
    add_box(mesh, T_world_front * Eigen::Translation3d(x, y, 0.0), size, z, paint);
  };
  add(0.0, 0.5 * depth, {width, depth, height});
  const int bays = std::max(2, static_cast<int>(std::round(width / random.uniform(3, 2.5, 4.0))));
  const double pilaster_depth = random.uniform(4, 0.25, 0.5);
  for (int bay = 0; bay <= bays; ++bay) {
    const double x = (0.5 - static_cast<double>(bay) / bays) * (width - 0.5);
    add(x, 0.0, {0.5, 2.0 * pilaster_depth, height - 0.6});
  }
  const double porch_x = random.uniform(5, -0.25, 0.25) * width;
  add(porch_x, 0.0, {1.8, 2.4, 0.5}, 2.4);
  add(0.0, 0.0, {width, 2.0 * pilaster_depth + 0.3, 0.35}, 3.4);
}

}  // namespace

Eigen::Isometry3d pose_on(const world::Route& route, double s_m, double lateral_m, double yaw_rad) {
  const world::RoutePoint point = route.at(s_m);
  const Eigen::Vector2d left(-std::sin(point.heading_rad), std::cos(point.heading_rad));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(point.heading_rad + yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << point.position + lateral_m * left, 0.0;
  return T;
}

void add_box(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_ground, const Vector3d& size, double z_m,
             double reflectivity) {
  append(mesh, painted(world::make_box(size), reflectivity),
         T_world_ground * Eigen::Translation3d(0.0, 0.0, z_m + 0.5 * size.z()));
}

void add_ribbon(world::TriangleMesh& mesh, const world::Route& route, double begin_m, double end_m, double step_m,
                std::span<const Eigen::Vector2d> profile, double reflectivity) {
  const int sections = std::max(1, static_cast<int>(std::ceil((end_m - begin_m) / step_m)));
  std::vector<Vector3d> points;
  // Backwards along the route, so that a profile drawn from right to left has its outside up.
  for (int i = sections; i >= 0; --i) {
    const double s = begin_m + (end_m - begin_m) * i / sections;
    for (const Eigen::Vector2d& point : profile) {
      points.push_back(pose_on(route, s, point.x()) * Vector3d(0.0, 0.0, point.y()));
    }
  }
  append(mesh, painted(world::make_sheet(points, profile.size()), reflectivity));
}

void add_ground(world::TriangleMesh& mesh, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double z_m,
                double reflectivity) {
  const std::array<Vector3d, 4> corners = {
      {{low.x(), low.y(), z_m}, {high.x(), low.y(), z_m}, {low.x(), high.y(), z_m}, {high.x(), high.y(), z_m}}};
  append(mesh, painted(world::make_sheet(corners, 2), reflectivity));
}

void add_pavement(world::TriangleMesh& mesh, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const Eigen::Vector2d size = high - low;
  add_box(mesh, Eigen::Isometry3d(Eigen::Translation3d(middle.x(), middle.y(), 0.0)), {size.x(), size.y(), kKerbHeight},
          0.0, world::reflectivity::kPavement);
}

bool is_clear_of(const world::Route& route, double begin_m, double end_m, const Eigen::Vector2d& position,
                 double distance_m) {
  for (double s = begin_m; s < end_m; s += 0.5) {
    if ((route.at(s).position - position).norm() < distance_m) {
      return false;
    }
  }
  return true;
}

void add_houses(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random) {
  double s = row.begin_m;
  for (std::uint64_t i = 0; s < row.end_m; ++i) {
    const RandomSource own = random.fork(i);
    const double width = row.spacing_m * own.uniform(10, 0.7, 1.3);
    const double set_back = own.uniform(11) < 0.3 ? 1.5 : 0.0;
    const double alley = own.uniform(12) < 0.35 ? own.uniform(13, 1.5, 4.0) : 0.0;
    const double lateral = row.lateral_m + std::copysign(set_back, row.lateral_m);
    if (s + width <= row.end_m) {
      add_house(mesh, pose_on(route, s + 0.5 * width, lateral, away_from_route(row.lateral_m)), width, own);
    }
    s += width + alley;
  }
}

void add_tree(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_ground, const RandomSource& random) {
  const double trunk = random.uniform(21, 2.2, 3.2);
  const double radius = random.uniform(22, 1.1, 1.9);
  append(mesh,
         painted(world::make_cylinder(random.uniform(23, 0.12, 0.25), trunk + 0.5, 10), world::reflectivity::kBark),
         T_world_ground);
  append(mesh,
         leafy(painted(world::make_ellipsoid({radius, radius, 1.2 * radius}, kCrownRings, 12),
                       world::reflectivity::kLeaves)),
         T_world_ground * Eigen::Translation3d(0.0, 0.0, trunk + 1.1 * radius));
}

void add_lamp_post(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_ground) {
  append(mesh, painted(world::make_cylinder(0.11, 6.5, 10), world::reflectivity::kZinc), T_world_ground);
  add_box(mesh, T_world_ground, {0.4, 1.2, 0.15}, 6.4, world::reflectivity::kZinc);
}

void add_trees(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random) {
  for_each_of(row, random,
              [&](double s, const RandomSource& own) { add_tree(mesh, pose_on(route, s, row.lateral_m), own); });
}

void add_lamp_posts(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random) {
  for_each_of(row, random,
              [&](double s, const RandomSource&) { add_lamp_post(mesh, pose_on(route, s, row.lateral_m)); });
}

void add_parked_cars(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random,
                     double yaw_rad) {
  const world::TriangleMesh car = world::make_car();
  const world::TriangleMesh van = world::make_van();
  for_each_of(row, random, [&](double s, const RandomSource& own) {
    if (own.uniform(1) < 0.25) {
      return;
    }
    const double turned = yaw_rad + away_from_route(own.uniform(2) - 0.5) + own.uniform(3, -0.03, 0.03);
    append(mesh, own.uniform(4) < 0.8 ? car : van, pose_on(route, s, row.lateral_m, turned));
  });
}

}  // namespace dynamic_icp::scenes
