// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene_file_statics.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/scene_file_solids.hpp"
#include "dynamic_icp/tools/world/terrain.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using formats::Limits;
using formats::YamlMap;
using world::TriangleMesh;

constexpr double kMaxThings = 2e4;    // of one row
constexpr double kMaxVertices = 4e6;  // of one part

/// Where the copies of a solid stand: one at `position_m`, or `count` of them along a route.
std::vector<Isometry3d> read_places(const YamlMap& map, const Routes& routes) {
  if (!map.has("route")) {
    return {read_turned(map, Isometry3d(Eigen::Translation3d(read_vector3(map, "position_m", kPosition))))};
  }
  if (map.has("position_m")) {
    map.fail("position_m", "stands beside 'route', expected one of them");
  }
  const NamedRoute& route = read_route(map, routes);
  const double s_m = map.number("s_m", kPosition);
  const double lateral_m = map.number("lateral_m", kPosition, 0.0);
  const Eigen::Translation3d up(0.0, 0.0, map.number("z_m", kPosition, 0.0));
  const int count = map.whole_number("count", {1, kMaxThings}, 1);
  const double spacing_m = count > 1 ? map.number("spacing_m", kLength) : map.number("spacing_m", kLength, 1.0);
  std::vector<Isometry3d> places;
  for (int i = 0; i < count; ++i) {
    places.push_back(read_turned(map, pose_on(*route.route, s_m + i * spacing_m, lateral_m) * up));
  }
  return places;
}

StaticPart copies(TriangleMesh solid, std::vector<Isometry3d> places) {
  return [solid = std::move(solid), places = std::move(places)](TriangleMesh& mesh, const RandomSource&) {
    for (const Isometry3d& T_world_solid : places) {
      world::append(mesh, solid, T_world_solid);
    }
  };
}

/// The keys `low_m` and `high_m`.
Eigen::AlignedBox2d read_area(const YamlMap& map) {
  const Vector2d low = read_vector2(map, "low_m", kPosition);
  const Vector2d high = read_vector2(map, "high_m", kPosition);
  if ((low.array() >= high.array()).any()) {
    map.fail("high_m", fmt::format("is [{:g}, {:g}], expected more than low_m, [{:g}, {:g}]", high.x(), high.y(),
                                   low.x(), low.y()));
  }
  return {low, high};
}

StaticPart read_ground(const YamlMap& map, const Routes&) {
  const Eigen::AlignedBox2d area = read_area(map);
  const double z_m = map.number("z_m", kPosition, 0.0);
  return [=](TriangleMesh& mesh, const RandomSource&) { add_ground(mesh, area.min(), area.max(), z_m); };
}

StaticPart read_pavement(const YamlMap& map, const Routes&) {
  const Eigen::AlignedBox2d area = read_area(map);
  return [=](TriangleMesh& mesh, const RandomSource&) { add_pavement(mesh, area.min(), area.max()); };
}

/// The keys `begin_m` and `end_m`, with at most `most` steps of `step_m` between them.
std::pair<double, double> read_stretch(const YamlMap& map, std::string_view step_key, double step_m, double most) {
  const double begin_m = map.number("begin_m", kPosition);
  const double end_m = map.number("end_m", kPosition);
  if (end_m <= begin_m) {
    map.fail("end_m", fmt::format("is {:g}, expected more than begin_m, {:g}", end_m, begin_m));
  }
  if ((end_m - begin_m) / step_m > most) {
    map.fail(step_key,
             fmt::format("is {:g}, expected at least {:g} for this stretch", step_m, (end_m - begin_m) / most));
  }
  return {begin_m, end_m};
}

StaticPart read_ribbon(const YamlMap& map, const Routes& routes) {
  const NamedRoute& route = read_route(map, routes);
  std::vector<Vector2d> profile;
  const double lateral_m = read_lateral(map, "lateral_m", route, 0.0);
  for (const std::vector<double>& row : map.rows("profile_m", 2, kPosition)) {
    profile.emplace_back(lateral_m + row[0], row[1]);
  }
  if (profile.size() < 2) {
    map.fail("profile_m", "has one point, expected at least two points [lateral, height]");
  }
  const double step_m = map.number("step_m", {0.05, 1e4}, 2.0);
  const auto [begin_m, end_m] = read_stretch(map, "step_m", step_m, kMaxVertices / static_cast<double>(profile.size()));
  return [=, route = route.route, begin = begin_m, end = end_m](TriangleMesh& mesh, const RandomSource&) {
    add_ribbon(mesh, *route, begin, end, step_m, profile);
  };
}

/// Where a row of things stands. `closest_m` is the smallest spacing.
Row read_row(const YamlMap& map, double closest_m) {
  Row row;
  row.lateral_m = map.number("lateral_m", kPosition);
  row.spacing_m = map.number("spacing_m", {closest_m, kFarthest});
  std::tie(row.begin_m, row.end_m) = read_stretch(map, "spacing_m", row.spacing_m, kMaxThings);
  return row;
}

using AddRow = void (*)(TriangleMesh& mesh, const world::Route& route, const Row& row, const RandomSource& random);

StaticPart read_things(const YamlMap& map, const Routes& routes, AddRow add) {
  const NamedRoute& route = read_route(map, routes);
  Row row = read_row(map, 0.5);
  row.jitter_m = map.number("jitter_m", {0.0, 1e3}, 0.0);
  return [=, route = route.route](TriangleMesh& mesh, const RandomSource& random) { add(mesh, *route, row, random); };
}

StaticPart read_trees(const YamlMap& map, const Routes& routes) { return read_things(map, routes, add_trees); }

StaticPart read_lamp_posts(const YamlMap& map, const Routes& routes) {
  return read_things(map, routes, add_lamp_posts);
}

StaticPart read_houses(const YamlMap& map, const Routes& routes) {
  const NamedRoute& route = read_route(map, routes);
  const Row row = read_row(map, 3.0);
  return [row, route = route.route](TriangleMesh& mesh, const RandomSource& random) {
    add_houses(mesh, *route, row, random);
  };
}

StaticPart read_parked_cars(const YamlMap& map, const Routes& routes) {
  const NamedRoute& route = read_route(map, routes);
  Row row = read_row(map, 0.5);
  row.jitter_m = map.number("jitter_m", {0.0, 1e3}, 0.0);
  const double yaw_rad = radians(map.number("yaw_deg", kAngle, 0.0));
  return [=, route = route.route](TriangleMesh& mesh, const RandomSource& random) {
    add_parked_cars(mesh, *route, row, random, yaw_rad);
  };
}

StaticPart read_terrain(const YamlMap& map, const Routes&) {
  const Eigen::AlignedBox2d area = read_area(map);
  const double cell_m = map.number("cell_m", {0.05, 100.0}, 1.0);
  const double cells = (area.sizes() / cell_m).prod();
  if (cells > kMaxVertices) {
    map.fail("cell_m", fmt::format("is {:g}, expected at least {:g} for this area", cell_m,
                                   std::sqrt(area.sizes().prod() / kMaxVertices)));
  }
  const double roughness = map.number("roughness", {0.0, 10.0}, 1.0);
  const double grain_m = map.number("grain_m", {0.0, 10.0}, 0.0);
  const Isometry3d up(Eigen::Translation3d(0.0, 0.0, map.number("z_m", kPosition, 0.0)));
  return [=](TriangleMesh& mesh, const RandomSource& random) {
    enum Stream : std::uint64_t { kWaves, kGrain };
    const world::Terrain terrain(roughness, random.fork(kWaves));
    world::append(mesh, terrain.mesh(area.min(), area.max(), cell_m, grain_m, random.fork(kGrain)), up);
  };
}

StaticPart read_height_field(const YamlMap& map, const Routes&) {
  const Vector2d corner = read_vector2(map, "corner_m", kPosition);
  const double cell_m = map.number("cell_m", kLength);
  const std::vector<std::vector<double>> heights = map.rows("heights_m", 0, kPosition);
  if (heights.size() < 2 || heights.front().size() < 2) {
    map.fail("heights_m", fmt::format("has {} rows of {} numbers, expected at least 2 of 2", heights.size(),
                                      heights.front().size()));
  }
  std::vector<Vector3d> points;
  for (std::size_t row = 0; row < heights.size(); ++row) {
    for (std::size_t column = 0; column < heights[row].size(); ++column) {
      points.emplace_back(corner.x() + cell_m * static_cast<double>(column),
                          corner.y() + cell_m * static_cast<double>(row), heights[row][column]);
    }
  }
  return copies(world::make_sheet(points, heights.front().size()), {Isometry3d::Identity()});
}

struct StaticKind {
  const char* name;
  StaticPart (*read)(const YamlMap& map, const Routes& routes);
};

constexpr std::array<StaticKind, 9> kStatics = {{{"ground", read_ground},
                                                 {"pavement", read_pavement},
                                                 {"ribbon", read_ribbon},
                                                 {"houses", read_houses},
                                                 {"trees", read_trees},
                                                 {"lamp_posts", read_lamp_posts},
                                                 {"parked_cars", read_parked_cars},
                                                 {"terrain", read_terrain},
                                                 {"height_field", read_height_field}}};

StaticPart read_static(const std::string& kind, const YamlMap& map, const Routes& routes) {
  if (std::optional<TriangleMesh> solid = read_solid(kind, map)) {
    return copies(std::move(*solid), read_places(map, routes));
  }
  std::string names = solid_names();
  for (const StaticKind& known : kStatics) {
    if (kind == known.name) {
      return known.read(map, routes);
    }
    names += fmt::format(", {}", known.name);
  }
  map.fail(fmt::format("'{}' is no part of statics, expected one of: {}", kind, names));
}

}  // namespace

std::vector<StaticPart> read_statics(const YamlMap& file, const Routes& routes) {
  std::vector<StaticPart> parts;
  for (const auto& [kind, map] : file.kinds("statics")) {
    StaticPart part = read_static(kind, map, routes);
    if (const std::optional<double> reflectivity = read_reflectivity(map)) {
      part = [part, paint = *reflectivity](TriangleMesh& mesh, const RandomSource& random) {
        TriangleMesh bare;
        part(bare, random);
        world::append(mesh, world::painted(std::move(bare), paint));
      };
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace dynamic_icp::scenes
