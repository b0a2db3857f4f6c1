// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/world.hpp"

#include <utility>

namespace dynamic_icp::world {

std::size_t add_shape(World& world, TriangleMesh mesh) {
  const Eigen::AlignedBox3d box = bounds(mesh);
  world.shapes.push_back({std::move(mesh), box});
  return world.shapes.size() - 1;
}

std::int32_t add_body(World& world, std::string name, std::size_t shape, Trajectory trajectory) {
  const auto id = static_cast<std::int32_t>(world.bodies.size()) + 1;
  world.bodies.push_back({id, std::move(name), shape, std::move(trajectory)});
  return id;
}

std::vector<BodyAt> bodies_at(const World& world, double time_s) {
  std::vector<BodyAt> bodies;
  bodies.reserve(world.bodies.size());
  for (const MovingBody& body : world.bodies) {
    const Eigen::AlignedBox3d& box = world.shapes[body.shape].box;
    BodyAt at;
    at.motion = body.trajectory(time_s);
    at.ball_center_world = at.motion.T_world_body * box.center();
    at.ball_radius_m = 0.5 * box.diagonal().norm();
    bodies.push_back(at);
  }
  return bodies;
}

}  // namespace dynamic_icp::world
