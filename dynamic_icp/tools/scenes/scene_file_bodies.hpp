// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "dynamic_icp/tools/scenes/scene.hpp"
#include "dynamic_icp/tools/scenes/scene_file_routes.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"

// What moves in a scene file.
namespace dynamic_icp::scenes {

/// Adds bodies that were read and checked to a world.
using BodyPart =
    std::function<void(world::World& world, const RoadUserShapes& shapes, double traffic, const RandomSource& random)>;

/// The lists `bodies` and `lanes` of a scene file.
std::vector<BodyPart> read_bodies(const formats::YamlMap& file, const Routes& routes);

/// The map `vehicle` of a scene file. `speed_mps` is the default speed: at another speed knob the speeds of the file
/// are scaled.
std::function<world::Trajectory(const SceneRequest& request)> read_vehicle(const formats::YamlMap& file,
                                                                           const Routes& routes, double speed_mps);

/// A body that moves with constant velocity (m/s) and constant angular velocity (rad/s) in the world.
world::Trajectory free_motion(const Eigen::Isometry3d& T_world_start, const Eigen::Vector3d& velocity_world,
                              const Eigen::Vector3d& angular_velocity_world);

}  // namespace dynamic_icp::scenes
