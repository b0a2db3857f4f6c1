// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/world/route.hpp"
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

namespace dynamic_icp::scenes {

// The parts that scenes are composed of. Everything stands along a route: s is the arc length, lateral the distance
// to the left of it (m).

/// A row of things along a route.
struct Row {
  double begin_m = 0.0;  ///< arc length of the first
  double end_m = 0.0;    ///< no thing beyond this
  double lateral_m = 0.0;
  double spacing_m = 10.0;
  double jitter_m = 0.0;  ///< each is moved along the route by up to this, either way
};

/// Frame on the ground at a point of the route: x along the route turned by `yaw_rad`, z up.
Eigen::Isometry3d pose_on(const world::Route& route, double s_m, double lateral_m, double yaw_rad = 0.0);

/// A closed box of this size standing on the ground of `T_world_ground`, raised by `z_m`.
void add_box(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_ground, const Eigen::Vector3d& size,
             double z_m = 0.0, double reflectivity = world::reflectivity::kUsual);

/// A cross-section of the road, drawn out along the route: roads, kerbs, walls, rails and tunnels. The profile's points
/// are (lateral, height); seen along the route, the visible side is the left one on the way through the points from
/// right to left. `step_m` is the distance between sections.
void add_ribbon(world::TriangleMesh& mesh, const world::Route& route, double begin_m, double end_m, double step_m,
                std::span<const Eigen::Vector2d> profile, double reflectivity = world::reflectivity::kAsphalt);

/// A level rectangle of ground between two corners (m), at a height.
void add_ground(world::TriangleMesh& mesh, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double z_m = 0.0,
                double reflectivity = world::reflectivity::kAsphalt);

/// A raised block of pavement with vertical kerbs between two corners (m).
void add_pavement(world::TriangleMesh& mesh, const Eigen::Vector2d& low, const Eigen::Vector2d& high);

/// Whether no point of the route between two arc lengths comes nearer to `position` than `distance_m` (to 0.5 m).
bool is_clear_of(const world::Route& route, double begin_m, double end_m, const Eigen::Vector2d& position,
                 double distance_m);

/// Houses side by side with their fronts at row.lateral_m, facing the route: fronts with pilasters and a porch, some
/// set back, alleys between them. row.spacing_m is the mean width.
void add_houses(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random);

void add_trees(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random);
void add_lamp_posts(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random);

/// Parked cars and vans in a row along the route, with gaps. `yaw_rad` turns each one (pi / 2: side by side).
void add_parked_cars(world::TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random,
                     double yaw_rad = 0.0);

/// One tree, one lamp post on the ground of `T_world_ground`.
void add_tree(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_ground, const RandomSource& random);
void add_lamp_post(world::TriangleMesh& mesh, const Eigen::Isometry3d& T_world_ground);

}  // namespace dynamic_icp::scenes
