// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/body_shapes.hpp"

#include <utility>
#include <vector>

namespace dynamic_icp::world {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kWheelSides = 16;
constexpr double kCabin = 0.12;  // reflectivity: windows and the frames between them

/// A side view (x forward, z up, counter-clockwise), given to it the width of a body.
TriangleMesh across(const std::vector<Vector2d>& side_view, double width) {
  TriangleMesh mesh = make_prism(side_view, width);
  for (Vector3d& vertex : mesh.vertices) {
    vertex = Vector3d(vertex.x(), 0.5 * width - vertex.z(), vertex.y());
  }
  return mesh;
}

void add_wheels(TriangleMesh& mesh, std::initializer_list<double> axles, double track, double radius, double width) {
  TriangleMesh wheel = painted(make_cylinder(radius, width, kWheelSides), reflectivity::kRubber);
  for (Vector3d& vertex : wheel.vertices) {
    vertex = Vector3d(vertex.x(), 0.5 * width - vertex.z(), vertex.y() + radius);
  }
  for (const double x : axles) {
    for (const double y : {-0.5 * track, 0.5 * track}) {
      append(mesh, wheel, Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.0)));
    }
  }
}

void add_box(TriangleMesh& mesh, const Vector3d& center, const Vector3d& size) {
  append(mesh, make_box(size), Eigen::Isometry3d(Eigen::Translation3d(center)));
}

}  // namespace

TriangleMesh make_car() {
  TriangleMesh car =
      across({{2.1, 0.25}, {2.2, 0.45}, {2.15, 0.7}, {1.0, 0.9}, {-2.1, 0.95}, {-2.2, 0.5}, {-2.1, 0.25}}, 1.8);
  append(car, painted(across({{1.1, 0.85}, {0.3, 1.45}, {-1.3, 1.5}, {-2.0, 0.9}}, 1.56), kCabin));
  add_wheels(car, {1.35, -1.35}, 1.6, 0.32, 0.2);
  return car;
}

TriangleMesh make_van() {
  TriangleMesh van =
      across({{2.7, 0.3}, {2.8, 0.6}, {2.75, 1.0}, {2.0, 1.2}, {1.3, 2.25}, {0.9, 2.4}, {-2.8, 2.4}, {-2.8, 0.4}}, 2.0);
  add_wheels(van, {1.8, -1.7}, 1.8, 0.36, 0.22);
  return van;
}

TriangleMesh make_truck() {
  TriangleMesh truck;
  add_box(truck, {3.9, 0.0, 1.75}, {2.2, 2.4, 2.5});
  add_box(truck, {-1.2, 0.0, 2.3}, {7.6, 2.5, 2.6});
  add_box(truck, {-0.6, 0.0, 0.8}, {8.4, 1.2, 0.4});
  add_wheels(truck, {3.7, -2.6, -3.8}, 2.2, 0.5, 0.3);
  return truck;
}

TriangleMesh make_tractor() {
  TriangleMesh tractor;
  add_box(tractor, {1.9, 0.0, 2.05}, {2.2, 2.5, 3.1});
  add_box(tractor, {-1.1, 0.0, 0.8}, {3.8, 1.2, 0.4});
  add_wheels(tractor, {1.6, -1.9}, 2.2, 0.5, 0.3);
  return tractor;
}

TriangleMesh make_semitrailer() {
  TriangleMesh trailer;
  add_box(trailer, {0.0, 0.0, 2.6}, {13.6, 2.5, 2.8});
  add_box(trailer, {-2.5, 0.0, 1.0}, {8.0, 1.2, 0.4});
  add_wheels(trailer, {-2.5, -3.7, -4.9}, 2.2, 0.5, 0.3);
  return trailer;
}

TriangleMesh make_trailer() {
  TriangleMesh trailer;
  add_box(trailer, {0.0, 0.0, 2.3}, {7.4, 2.5, 2.6});
  add_wheels(trailer, {0.65, -0.65}, 2.2, 0.5, 0.3);
  return trailer;
}

TriangleMesh make_pedestrian() {
  TriangleMesh pedestrian;
  append(pedestrian, make_cylinder(0.1, 0.85, 10), Eigen::Isometry3d(Eigen::Translation3d(0.15, 0.11, 0.0)));
  append(pedestrian, make_cylinder(0.1, 0.85, 10), Eigen::Isometry3d(Eigen::Translation3d(-0.15, -0.11, 0.0)));
  append(pedestrian, make_ellipsoid({0.17, 0.25, 0.38}, 8, 12),
         Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.14)));
  append(pedestrian, make_ellipsoid({0.11, 0.1, 0.13}, 6, 10), Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.62)));
  return painted(std::move(pedestrian), reflectivity::kClothes);
}

}  // namespace dynamic_icp::world
