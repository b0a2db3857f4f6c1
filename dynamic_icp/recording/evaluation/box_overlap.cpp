// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/box_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace dynamic_icp::evaluation {
namespace {

// m: what is nearer to a plane lies on it.
constexpr double kOnPlane_m = 1e-9;

using Corners = std::vector<Eigen::Vector3d>;

/// n . x <= offset
struct HalfSpace {
  Eigen::Vector3d n;
  double offset = 0.0;
  [[nodiscard]] double beyond(const Eigen::Vector3d& x) const { return n.dot(x) - offset; }
};

/// The faces of a box that is centred and not turned, corner after corner.
std::vector<Corners> faces_of(const Eigen::Vector3d& size) {
  std::vector<Corners> faces;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      Corners face;
      for (const auto& [u, v] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
        Eigen::Vector3d corner;
        corner[axis] = side * size[axis];
        corner[(axis + 1) % 3] = u * size[(axis + 1) % 3];
        corner[(axis + 2) % 3] = v * size[(axis + 2) % 3];
        face.push_back(corner);
      }
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

/// What of a face lies in the half-space; points on the plane of it are added to `cut`.
Corners clipped(const Corners& face, const HalfSpace& half, Corners& cut) {
  Corners inside;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Eigen::Vector3d& a = face[k];
    const Eigen::Vector3d& b = face[(k + 1) % face.size()];
    const double of_a = half.beyond(a);
    const double of_b = half.beyond(b);
    if (of_a <= kOnPlane_m) {
      inside.push_back(a);
      if (of_a >= -kOnPlane_m) {
        cut.push_back(a);
      }
    }
    if ((of_a > kOnPlane_m && of_b < -kOnPlane_m) || (of_a < -kOnPlane_m && of_b > kOnPlane_m)) {
      inside.push_back(a + of_a / (of_a - of_b) * (b - a));
      cut.push_back(inside.back());
    }
  }
  return inside;
}

/// The points of a convex face in their order around it.
Corners around(Corners points, const Eigen::Vector3d& n) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    middle += point / static_cast<double>(points.size());
  }
  const Eigen::Vector3d u = n.unitOrthogonal();
  const Eigen::Vector3d v = n.cross(u);
  const auto angle = [&](const Eigen::Vector3d& x) { return std::atan2(v.dot(x - middle), u.dot(x - middle)); };
  std::ranges::sort(points, {}, angle);
  return points;
}

void clip(std::vector<Corners>& faces, const HalfSpace& half) {
  std::vector<Corners> left;
  Corners cut;
  bool is_cut = false;
  for (const Corners& face : faces) {
    is_cut = is_cut || std::ranges::any_of(face, [&](const auto& x) { return half.beyond(x) > kOnPlane_m; });
    Corners inside = clipped(face, half, cut);
    if (inside.size() >= 3) {
      left.push_back(std::move(inside));
    }
  }
  if (is_cut && cut.size() >= 3) {
    left.push_back(around(std::move(cut), half.n));
  }
  faces = std::move(left);
}

/// Of a convex body by its faces: cones from a point within.
double volume_of(const std::vector<Corners>& faces) {
  if (faces.size() < 4) {
    return 0.0;
  }
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  for (const Corners& face : faces) {
    tip += face.front() / static_cast<double>(faces.size());
  }
  double volume = 0.0;
  for (const Corners& face : faces) {
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      area += 0.5 * (face[k] - face[0]).cross(face[k + 1] - face[0]);
    }
    volume += std::abs(area.dot(face[0] - tip)) / 3.0;
  }
  return volume;
}

}  // namespace

double common_volume(const Box& a, const Box& b) {
  if (!(a.size.minCoeff() > 0.0) || !(b.size.minCoeff() > 0.0)) {
    return 0.0;
  }
  const Eigen::Isometry3d T_a_b = a.T_sensor_box.inverse() * b.T_sensor_box;
  std::vector<Corners> faces = faces_of(a.size);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d n = side * T_a_b.linear().col(axis);
      clip(faces, {n, n.dot(T_a_b.translation()) + 0.5 * b.size[axis]});
    }
  }
  return volume_of(faces);
}

double intersection_over_union(const Box& a, const Box& b) {
  const double common = common_volume(a, b);
  const double both = a.size.prod() + b.size.prod() - common;
  return common > 0.0 && both > 0.0 ? std::min(1.0, common / both) : 0.0;
}

}  // namespace dynamic_icp::evaluation
