// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace dynamic_icp::world {

TriangleMesh painted(TriangleMesh mesh, double reflectivity) {
  mesh.reflectivity.assign(mesh.triangles.size(), static_cast<float>(reflectivity));
  return mesh;
}

TriangleMesh leafy(TriangleMesh mesh) {
  mesh.foliage.assign(mesh.triangles.size(), true);
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const Eigen::Isometry3d& T_mesh_part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : part.vertices) {
    mesh.vertices.push_back(T_mesh_part * vertex);
  }
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
  mesh.reflectivity.insert(mesh.reflectivity.end(), part.reflectivity.begin(), part.reflectivity.end());
  if (!mesh.foliage.empty() || !part.foliage.empty()) {
    mesh.foliage.resize(mesh.triangles.size() - part.triangles.size(), false);
    mesh.foliage.insert(mesh.foliage.end(), part.foliage.begin(), part.foliage.end());
    mesh.foliage.resize(mesh.triangles.size(), false);
  }
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  return box;
}

Eigen::Vector3d triangle_normal(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d& corner = mesh.vertices[a];
  const Eigen::Vector3d normal = (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner);
  return normal / normal.norm();
}

TriangleMesh make_box(const Eigen::Vector3d& size) {
  const double x = 0.5 * size.x();
  const double y = 0.5 * size.y();
  const std::array<Eigen::Vector2d, 4> rectangle = {
      {{-x, -y}, {x, -y}, {x, y}, {-x, y}}  // counter-clockwise
  };
  TriangleMesh box = make_prism(rectangle, size.z());
  for (Eigen::Vector3d& vertex : box.vertices) {
    vertex.z() -= 0.5 * size.z();
  }
  return box;
}

TriangleMesh make_cylinder(double radius, double height, int sides) {
  std::vector<Eigen::Vector2d> circle;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    circle.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return make_prism(circle, height);
}

TriangleMesh make_ellipsoid(const Eigen::Vector3d& radii, int rings, int sides) {
  std::vector<Eigen::Vector3d> points;
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * (ring - 0.5 * rings) / rings;  // from the south pole to the north pole
    const bool at_pole = ring == 0 || ring == rings;
    for (int side = 0; side <= sides; ++side) {
      const double azimuth = 2.0 * std::numbers::pi * (side % sides) / sides;
      const double across = at_pole ? 0.0 : std::cos(polar);
      points.emplace_back(radii.x() * across * std::cos(azimuth), radii.y() * across * std::sin(azimuth),
                          radii.z() * std::sin(polar));
    }
  }
  return make_sheet(points, static_cast<std::size_t>(sides) + 1);
}

TriangleMesh make_prism(std::span<const Eigen::Vector2d> polygon, double height) {
  const auto n = static_cast<std::uint32_t>(polygon.size());
  TriangleMesh prism;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : polygon) {
    mean += corner / static_cast<double>(n);
    prism.vertices.emplace_back(corner.x(), corner.y(), 0.0);
    prism.vertices.emplace_back(corner.x(), corner.y(), height);
  }
  prism.vertices.emplace_back(mean.x(), mean.y(), 0.0);
  prism.vertices.emplace_back(mean.x(), mean.y(), height);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t here = 2 * i;
    const std::uint32_t next = 2 * ((i + 1) % n);
    prism.triangles.push_back({here, next, next + 1});
    prism.triangles.push_back({here, next + 1, here + 1});
    prism.triangles.push_back({next, here, 2 * n});              // bottom
    prism.triangles.push_back({here + 1, next + 1, 2 * n + 1});  // top
  }
  return painted(std::move(prism), reflectivity::kUsual);
}

TriangleMesh make_sheet(std::span<const Eigen::Vector3d> points, std::size_t columns) {
  TriangleMesh sheet;
  sheet.vertices.assign(points.begin(), points.end());
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (points[a] != points[b] && points[b] != points[c] && points[c] != points[a]) {
      sheet.triangles.push_back(
          {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
    }
  };
  for (std::size_t row = 0; row + columns < points.size(); row += columns) {
    for (std::size_t i = row; i + 1 < row + columns; ++i) {
      add(i, i + 1, i + columns + 1);
      add(i, i + columns + 1, i + columns);
    }
  }
  return painted(std::move(sheet), reflectivity::kUsual);
}

}  // namespace dynamic_icp::world
