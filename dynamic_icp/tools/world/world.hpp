// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/world/motion_state.hpp"
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

namespace dynamic_icp::world {

/// What bodies of one kind look like, in the body frame.
struct Shape {
  TriangleMesh mesh;
  Eigen::AlignedBox3d box;  ///< the bounds of `mesh`
};

/// A body with a motion of its own.
struct MovingBody {
  std::int32_t id = 0;        ///< > 0, unique in the world; the label of its points
  std::string name;           ///< what it is, e.g. "car"
  std::size_t shape = 0;      ///< index into World::shapes
  Trajectory trajectory;      ///< of the frame its shape is given in
  std::int32_t towed_by = 0;  ///< id of the body it hangs on; 0: none
};

/// Everything a ray can meet: one surface that never moves, in the world frame, and bodies that do. Bodies of the
/// same kind share a shape.
struct World {
  TriangleMesh statics;
  std::vector<Shape> shapes;
  std::vector<MovingBody> bodies;
};

/// Adds a shape and returns its index.
std::size_t add_shape(World& world, TriangleMesh mesh);

/// Adds a body with the next free id and returns that id.
std::int32_t add_body(World& world, std::string name, std::size_t shape, Trajectory trajectory);

/// A moving body at one time, with a ball that holds it.
struct BodyAt {
  MotionState motion;
  Eigen::Vector3d ball_center_world = Eigen::Vector3d::Zero();
  double ball_radius_m = 0.0;
};

/// All moving bodies at one time, in the order of World::bodies.
std::vector<BodyAt> bodies_at(const World& world, double time_s);

}  // namespace dynamic_icp::world
