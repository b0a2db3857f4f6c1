// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene_file.hpp"

#include <utility>

#include "dynamic_icp/tools/scenes/scene_file_bodies.hpp"
#include "dynamic_icp/tools/scenes/scene_file_routes.hpp"
#include "dynamic_icp/tools/scenes/scene_file_statics.hpp"

namespace dynamic_icp::scenes {
namespace {

/// What a scene file describes, checked.
struct Plan {
  std::function<world::Trajectory(const SceneRequest& request)> vehicle;
  std::vector<StaticPart> statics;
  std::vector<BodyPart> bodies;
};

Scene build(const Plan& plan, const SceneRequest& request) {
  enum Stream : std::uint64_t { kVehicle, kStatics, kBodies };
  const auto source = [&](Stream stream, std::size_t part) {
    return request.random.fork(stream).fork(static_cast<std::uint64_t>(part));
  };
  Scene scene;
  for (std::size_t i = 0; i < plan.statics.size(); ++i) {
    plan.statics[i](scene.world.statics, source(kStatics, i));
  }
  const RoadUserShapes shapes = add_road_user_shapes(scene.world);
  for (std::size_t i = 0; i < plan.bodies.size() && request.traffic > 0.0; ++i) {
    plan.bodies[i](scene.world, shapes, request.traffic, source(kBodies, i));
  }
  SceneRequest vehicle_request = request;
  vehicle_request.random = source(kVehicle, 0);
  scene.vehicle = plan.vehicle(vehicle_request);
  return scene;
}

}  // namespace

SceneKind load_scene_file(const std::filesystem::path& path) {
  const formats::YamlMap file = formats::YamlMap::load(path);
  SceneKind kind;
  kind.name = path.stem().string();
  kind.description = file.text("description");
  kind.speed_mps = file.number("speed_mps", {0.0, 70.0});
  const Routes routes = read_routes(file);
  Plan plan;
  plan.vehicle = read_vehicle(file, routes, kind.speed_mps);
  plan.statics = read_statics(file, routes);
  plan.bodies = read_bodies(file, routes);
  file.finish();
  kind.build = [plan = std::move(plan)](const SceneRequest& request) { return build(plan, request); };
  return kind;
}

}  // namespace dynamic_icp::scenes
