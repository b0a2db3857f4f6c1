// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene_file_solids.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/tools/scenes/parts.hpp"
#include "dynamic_icp/tools/scenes/scene_file_routes.hpp"
#include "dynamic_icp/tools/world/mesh_file.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using formats::YamlMap;
using world::TriangleMesh;

TriangleMesh read_box(const YamlMap& map) {
  TriangleMesh mesh;
  add_box(mesh, Isometry3d::Identity(), read_vector3(map, "size_m", kLength));
  return mesh;
}

TriangleMesh read_cylinder(const YamlMap& map) {
  return world::make_cylinder(map.number("radius_m", kLength), map.number("height_m", kLength),
                              map.whole_number("sides", {3, 256}, 16));
}

TriangleMesh read_ellipsoid_of(const YamlMap& map, const Vector3d& radii) {
  const int sides = map.whole_number("sides", {4, 256}, 16);
  return world::make_ellipsoid(radii, (sides + 1) / 2, sides);
}

TriangleMesh read_sphere(const YamlMap& map) {
  return read_ellipsoid_of(map, Vector3d::Constant(map.number("radius_m", kLength)));
}

TriangleMesh read_ellipsoid(const YamlMap& map) {
  return read_ellipsoid_of(map, read_vector3(map, "radii_m", kLength));
}

TriangleMesh read_mesh(const YamlMap& map) {
  const double scale = map.number("scale", {1e-6, 1e6}, 1.0);
  TriangleMesh mesh = world::load_mesh(map.origin().parent_path() / map.text("file"));
  for (Vector3d& vertex : mesh.vertices) {
    vertex *= scale;
    if (!(vertex.cwiseAbs().maxCoeff() <= kFarthest)) {
      map.fail("scale", fmt::format("makes the mesh reach beyond {:g} m", kFarthest));
    }
  }
  return mesh;
}

struct SolidKind {
  const char* name;
  TriangleMesh (*read)(const YamlMap& map);
};

constexpr std::array<SolidKind, 5> kSolids = {{{"box", read_box},
                                               {"cylinder", read_cylinder},
                                               {"sphere", read_sphere},
                                               {"ellipsoid", read_ellipsoid},
                                               {"mesh", read_mesh}}};

}  // namespace

std::optional<double> read_reflectivity(const YamlMap& map) {
  return map.has("reflectivity") ? std::optional(map.number("reflectivity", {0.0, 100.0})) : std::nullopt;
}

std::optional<TriangleMesh> read_solid(const std::string& kind, const YamlMap& map) {
  for (const SolidKind& solid : kSolids) {
    if (kind == solid.name) {
      return solid.read(map);
    }
  }
  return std::nullopt;
}

std::string solid_names() {
  std::string names;
  for (const SolidKind& solid : kSolids) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", solid.name);
  }
  return names;
}

TriangleMesh read_body_shape(const YamlMap& body) {
  TriangleMesh shape;
  for (const auto& [kind, map] : body.kinds("parts")) {
    std::optional<TriangleMesh> solid = read_solid(kind, map);
    if (!solid) {
      map.fail(fmt::format("'{}' is no part of a body, expected one of: {}", kind, solid_names()));
    }
    const Vector3d position = map.has("position_m") ? read_vector3(map, "position_m", kPosition) : Vector3d::Zero();
    if (const std::optional<double> reflectivity = read_reflectivity(map)) {
      solid = world::painted(std::move(*solid), *reflectivity);
    }
    world::append(shape, *solid, read_turned(map, Isometry3d(Eigen::Translation3d(position))));
  }
  if (shape.triangles.empty()) {
    body.fail("parts", fmt::format("is empty, expected a list of: {}", solid_names()));
  }
  return shape;
}

}  // namespace dynamic_icp::scenes
