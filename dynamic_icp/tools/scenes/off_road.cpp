// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <memory>

#include "dynamic_icp/tools/scenes/builders.hpp"
#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/traffic.hpp"
#include "dynamic_icp/tools/world/terrain.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector2d;

enum Part : std::uint64_t { kEgoSpeed, kWaves, kGrain, kTrees, kRocks };

constexpr double kSight = 90.0;  // m: ground around the drive

std::shared_ptr<const world::Route> make_route(double path_m) {
  std::vector<world::RoutePiece> pieces = {{8.0, 0.0, 0.0}};
  double side = 1.0;
  for (double length = 0.0; length < path_m + 20.0; length += 60.0) {
    for (const world::RoutePiece& piece : world::turn(side * 0.9, 22.0, 10.0)) {
      pieces.push_back(piece);
    }
    pieces.push_back({20.0, 0.0, 0.0});
    side = -side;
  }
  return std::make_shared<const world::Route>(pieces);
}

Eigen::AlignedBox2d bounds_of(const world::Route& route, double path_m) {
  Eigen::AlignedBox2d box;
  for (double s = 0.0; s <= path_m; s += 1.0) {
    box.extend(route.at(s).position);
  }
  return box;
}

/// Trees and rocks, at random wherever the drive leaves room.
void add_growth(world::TriangleMesh& mesh, const world::Terrain& terrain, const world::Route& route, double path_m,
                const Eigen::AlignedBox2d& area, const RandomSource& random) {
  constexpr double kCell = 8.0;
  std::uint64_t i = 0;
  for (double y = area.min().y() + 5.0; y < area.max().y() - 5.0; y += kCell) {
    for (double x = area.min().x() + 5.0; x < area.max().x() - 5.0; x += kCell) {
      const RandomSource own = random.fork(kTrees).fork(i++);
      const Vector2d position(x + own.uniform(1, 0.0, kCell), y + own.uniform(2, 0.0, kCell));
      if (own.uniform(0) < 0.35 || !is_clear_of(route, -10.0, path_m + 20.0, position, 4.0)) {
        continue;
      }
      const Eigen::Isometry3d T(Eigen::Translation3d(position.x(), position.y(), terrain.height_m(position) - 0.2));
      if (own.uniform(3) < 0.7) {
        add_tree(mesh, T, own);
      } else {
        append(
            mesh,
            world::make_ellipsoid({own.uniform(4, 0.5, 1.6), own.uniform(5, 0.5, 1.6), own.uniform(6, 0.5, 1.2)}, 6, 9),
            T);
      }
    }
  }
}

}  // namespace

Scene build_off_road(const SceneRequest& request) {
  const double path_m = request.speed_mps * request.duration_s;
  const auto route = make_route(path_m);
  const auto terrain = std::make_shared<const world::Terrain>(1.3, request.random.fork(kWaves));
  Eigen::AlignedBox2d area = bounds_of(*route, path_m);
  area.min().array() -= kSight;
  area.max().array() += kSight;
  Scene scene;
  scene.world.statics = painted(terrain->mesh(area.min(), area.max(), 0.8, 0.025, request.random.fork(kGrain)),
                                world::reflectivity::kGrass);
  add_growth(scene.world.statics, *terrain, *route, path_m, area, request.random);
  const world::SpeedProfile speed =
      world::wandering_speed(request.speed_mps, 0.1, request.duration_s, request.random.fork(kEgoSpeed));
  scene.vehicle = world::drive(route, speed, {},
                               [terrain](double, const world::PlanarState& planar) { return terrain->sway(planar); });
  return scene;
}

}  // namespace dynamic_icp::scenes
