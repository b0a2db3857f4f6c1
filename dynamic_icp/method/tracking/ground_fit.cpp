// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory_resource>
#include <vector>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLookedAt = 4096;      // of a scan are looked at: more would not make the plane better
constexpr std::size_t kFewestOnGround = 30;  // on the ground
constexpr double kFlat_m = 40.0;             // roads are flat so far
constexpr double kOnGround_m = 0.1;          // what is so near to the plane is on it

// Half widths of the weights from step to step, m. The last is that of what roads bend.
constexpr std::array kWidths_m = {0.5, 0.3, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15};

// What is known before, relative to one point: slopes against the start have a standard deviation of 0.03 rad beside
// heights of 0.05 m.
constexpr double kSlopeWeight_m2 = 2.8;

}  // namespace

std::optional<GroundFit> fit_ground(const ego_motion::SupportPlane& start, std::span<const Vector3d> points,
                                    std::span<const std::uint8_t> is_moving) {
  StackMemory<kLookedAt * sizeof(Vector3d)> memory;  // no more is asked for
  std::pmr::vector<Vector3d> near(memory.resource());
  near.reserve(kLookedAt);
  const std::size_t step = (points.size() + kLookedAt - 1) / kLookedAt;
  for (std::size_t row = 0; row < points.size(); row += std::max<std::size_t>(1, step)) {
    if (is_moving[row] == 0 && std::abs(start.height(points[row])) < kWidths_m.front() &&
        points[row].squaredNorm() < kFlat_m * kFlat_m) {
      near.push_back(points[row]);
    }
  }
  GroundFit fit{start};
  for (const double width_m : kWidths_m) {
    // Height and slopes of the ground over the plane: h = a . (1, u, v).
    const Vector3d u = fit.plane.normal.unitOrthogonal();
    const Vector3d v = fit.plane.normal.cross(u);
    Eigen::Matrix3d information = Vector3d(0.0, kSlopeWeight_m2, kSlopeWeight_m2).asDiagonal();
    Vector3d gradient = -kSlopeWeight_m2 * Vector3d(0.0, u.dot(start.normal), v.dot(start.normal));
    fit.points = 0;
    for (const Vector3d& point : near) {
      const double height = fit.plane.height(point);
      fit.points += std::abs(height) < kOnGround_m ? 1 : 0;
      const double off = height / width_m;
      if (std::abs(off) < 1.0) {
        const double root = 1.0 - off * off;
        const Vector3d row(1.0, u.dot(point), v.dot(point));
        information += root * root * row * row.transpose();
        gradient += root * root * height * row;
      }
    }
    if (fit.points < kFewestOnGround) {
      return std::nullopt;
    }
    const Vector3d a = information.ldlt().solve(gradient);
    const Vector3d turned = fit.plane.normal - a[1] * u - a[2] * v;
    fit.plane = {turned.normalized(), (fit.plane.offset_m + a[0]) / turned.norm()};
  }
  return fit;
}

const GroundFit& likelier_ground(const GroundFit& a, const GroundFit& b) {
  const GroundFit& nearer = a.plane.offset_m >= b.plane.offset_m ? a : b;
  const GroundFit& other = &nearer == &a ? b : a;
  return 2 * nearer.points >= other.points ? nearer : other;
}

}  // namespace dynamic_icp::tracking
