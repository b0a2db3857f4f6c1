// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"

namespace dynamic_icp::world {
namespace {

using Eigen::Vector3d;

constexpr double kGreatestCoordinate = 1e12;  // products of three coordinates stay far from overflow

bool is_usable(const Vector3d& vertex) {
  return vertex.cwiseAbs().maxCoeff() <= kGreatestCoordinate && !vertex.hasNaN();
}

void add_triangle(TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Vector3d& corner = mesh.vertices[triangle[0]];
  const Vector3d normal = (mesh.vertices[triangle[1]] - corner).cross(mesh.vertices[triangle[2]] - corner);
  if (normal.norm() > 0.0) {
    mesh.triangles.push_back(triangle);
  }
}

void add_polygon(TriangleMesh& mesh, const std::vector<std::uint32_t>& corners) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    add_triangle(mesh, {corners[0], corners[i], corners[i + 1]});
  }
}

/// The mesh without the vertices that no triangle has, painted; `path` is for the message when nothing is left.
TriangleMesh finished(TriangleMesh mesh, const std::filesystem::path& path) {
  if (mesh.triangles.empty()) {
    throw DataError(fmt::format("{}: holds no face with an area", path.string()));
  }
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> kept(mesh.vertices.size(), kUnused);
  std::vector<Vector3d> vertices;
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      if (kept[corner] == kUnused) {
        kept[corner] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(mesh.vertices[corner]);
      }
      corner = kept[corner];
    }
  }
  mesh.vertices = std::move(vertices);
  return painted(std::move(mesh), reflectivity::kUsual);
}

const formats::PlyElement& find_element(const formats::PlyFile& file, std::string_view name,
                                        const std::filesystem::path& path) {
  const formats::PlyElement* element = file.find(name);
  if (element == nullptr) {
    throw DataError(fmt::format("{}: has no element '{}', expected 'vertex' and 'face'", path.string(), name));
  }
  return *element;
}

std::vector<Vector3d> ply_vertices(const formats::PlyElement& element, const std::filesystem::path& path) {
  std::vector<Vector3d> vertices(element.count);
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const formats::PlyColumn* column = element.find(kNames[axis]);
    if (column == nullptr || column->is_list) {
      throw DataError(
          fmt::format("{}: element 'vertex' has no number '{}', expected x, y and z", path.string(), kNames[axis]));
    }
    for (std::size_t i = 0; i < element.count; ++i) {
      vertices[i][static_cast<Eigen::Index>(axis)] = column->values[i];
    }
  }
  const auto bad = std::find_if_not(vertices.begin(), vertices.end(), is_usable);
  if (bad != vertices.end()) {
    throw DataError(
        fmt::format("{}: record {} of element 'vertex': ({}, {}, {}), expected finite coordinates up to {:g}",
                    path.string(), bad - vertices.begin() + 1, bad->x(), bad->y(), bad->z(), kGreatestCoordinate));
  }
  return vertices;
}

TriangleMesh load_ply(const std::filesystem::path& path) {
  const formats::PlyFile file = formats::read_ply(path);
  TriangleMesh mesh;
  mesh.vertices = ply_vertices(find_element(file, "vertex", path), path);
  const formats::PlyElement& faces = find_element(file, "face", path);
  const formats::PlyColumn* indices = faces.find("vertex_indices");
  indices = indices == nullptr ? faces.find("vertex_index") : indices;
  if (indices == nullptr || !indices->is_list) {
    throw DataError(fmt::format("{}: element 'face' has no list 'vertex_indices'", path.string()));
  }
  const auto count = static_cast<double>(mesh.vertices.size());
  for (std::size_t i = 0; i < faces.count; ++i) {
    std::vector<std::uint32_t> corners;
    for (const double index : indices->list(i)) {
      if (!(index >= 0.0 && index < count && index == static_cast<double>(static_cast<std::uint32_t>(index)))) {
        throw DataError(fmt::format("{}: record {} of element 'face': corner {}, expected 0 to {}", path.string(),
                                    i + 1, index, count - 1.0));
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    if (corners.size() < 3) {
      throw DataError(fmt::format("{}: record {} of element 'face': {} corners, expected at least 3", path.string(),
                                  i + 1, corners.size()));
    }
    add_polygon(mesh, corners);
  }
  return finished(std::move(mesh), path);
}

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending != ".ply") {
    throw DataError(fmt::format("{}: is no mesh that can be read, expected a name that ends with .ply", path.string()));
  }
  return load_ply(path);
}

}  // namespace dynamic_icp::world
