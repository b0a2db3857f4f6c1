// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dynamic_icp::world {

/// A surface of triangles in metres. Seen from outside, the corners of a triangle run counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
  /// One per triangle: the share of infrared light it sends back diffusely. White paper has 0.9; retroreflectors send
  /// more towards the light than any diffuse surface and may have more than 1.
  std::vector<float> reflectivity;
  std::vector<bool> foliage;  ///< one per triangle: whether wind moves it; empty where it moves none
};

/// Reflectivities of common surfaces in the near infrared. Leaves are bright there, water is a mirror.
namespace reflectivity {
constexpr double kUsual = 0.3;  ///< what a mesh has until it is painted
constexpr double kAsphalt = 0.15;
constexpr double kPavement = 0.25;
constexpr double kGrass = 0.4;
constexpr double kLeaves = 0.5;
constexpr double kBark = 0.3;
constexpr double kPlaster = 0.4;
constexpr double kConcrete = 0.3;
constexpr double kZinc = 0.5;
constexpr double kSign = 5.0;  ///< retroreflecting
constexpr double kWater = 0.02;
constexpr double kRubber = 0.05;
constexpr double kClothes = 0.4;
}  // namespace reflectivity

/// The mesh with this reflectivity on all its triangles.
TriangleMesh painted(TriangleMesh mesh, double reflectivity);

/// The mesh with wind moving all its triangles.
TriangleMesh leafy(TriangleMesh mesh);

/// Adds a copy of `part`, moved by `T_mesh_part`, to `mesh`.
void append(TriangleMesh& mesh, const TriangleMesh& part,
            const Eigen::Isometry3d& T_mesh_part = Eigen::Isometry3d::Identity());

/// The smallest box with edges along the axes that holds all vertices; empty for an empty mesh.
Eigen::AlignedBox3d bounds(const TriangleMesh& mesh);

/// The outward unit normal of one triangle; not finite where the triangle has no area.
Eigen::Vector3d triangle_normal(const TriangleMesh& mesh, std::size_t triangle);

/// A closed box of this size (m) about the origin.
TriangleMesh make_box(const Eigen::Vector3d& size);

/// A closed upright cylinder on the plane z = 0 with its axis on z. It is a prism: the middle of a face lies
/// radius * (1 - cos(pi / sides)) inside the round cylinder, its edges lie on it.
TriangleMesh make_cylinder(double radius, double height, int sides);

/// A closed ellipsoid about the origin with vertices on the round surface.
TriangleMesh make_ellipsoid(const Eigen::Vector3d& radii, int rings, int sides);

/// A closed prism between z = 0 and z = height over a polygon. The polygon runs counter-clockwise and every corner can
/// be seen from the mean of the corners (true of all convex ones).
TriangleMesh make_prism(std::span<const Eigen::Vector2d> polygon, double height);

/// An open sheet through a grid of points, given row by row with `columns` points each. Its normals are those of
/// (along the row) x (to the next row). Triangles without area, where points coincide, are left out.
TriangleMesh make_sheet(std::span<const Eigen::Vector3d> points, std::size_t columns);

}  // namespace dynamic_icp::world
