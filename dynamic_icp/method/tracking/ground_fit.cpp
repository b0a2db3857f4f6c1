// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory_resource>
#include <vector>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLookedAt = 2048;      // of a scan are looked at: more would not make the plane better
constexpr std::size_t kFewestOnGround = 30;  // on the ground
constexpr double kFlat_m = 40.0;             // roads are flat so far
constexpr double kOnGround_m = 0.05;         // what is so near to the plane is on it

constexpr double kGroundSearch_m = 0.5;      // about the start
constexpr double kSameGroundUp = 0.98;       // cosine between the start and the ground
constexpr std::uint64_t kGroundPlanes = 32;  // planes through three of the points each ...
constexpr std::size_t kGroundJury = 256;     // ... are compared by so many of them

// Half widths of the weights from step to step, m. The last is that of what roads bend.
constexpr std::array kWidths_m = {0.15, 0.1, 0.07, 0.05, 0.05};

// What is known before, relative to one point: slopes against the start have a standard deviation of 0.03 rad beside
// heights of 0.05 m.
constexpr double kSlopeWeight_m2 = 2.8;

bool is_on_ground(const ego_motion::SupportPlane& plane, const Vector3d& point) {
  return std::abs(plane.height(point)) < kOnGround_m;
}

/// The plane with most points on it: the start, or one through three points. Least squares from the start alone may
/// end on one that leans on the road and on what is beside it.
ego_motion::SupportPlane with_most_points(const ego_motion::SupportPlane& start, std::span<const Vector3d> points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kGroundJury);
  const auto votes = [&](const ego_motion::SupportPlane& plane) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); i += step) {
      count += is_on_ground(plane, points[i]) ? 1 : 0;
    }
    return count;
  };
  const RandomSource random(0);
  ego_motion::SupportPlane best = start;
  std::size_t most = votes(start);
  for (std::uint64_t k = 0; k < kGroundPlanes; ++k) {
    const auto draw = [&](std::uint64_t which) -> const Vector3d& {
      return points[(random.bits(3 * k + which) >> 32) * points.size() >> 32];
    };
    const Vector3d& x = draw(0);
    Vector3d normal = (draw(1) - x).cross(draw(2) - x);
    normal *= normal.dot(start.normal) < 0.0 ? -1.0 : 1.0;
    if (!(normal.dot(start.normal) > kSameGroundUp * normal.norm() && normal.norm() > 1.0)) {
      continue;  // m^2: points near to a line say little
    }
    normal.normalize();
    const ego_motion::SupportPlane plane{normal, normal.dot(x)};
    if (const std::size_t count = votes(plane); count > most) {
      best = plane;
      most = count;
    }
  }
  return best;
}

}  // namespace

std::optional<GroundFit> fit_ground(const ego_motion::SupportPlane& start, std::span<const Vector3d> points,
                                    std::span<const std::uint8_t> is_moving) {
  StackMemory<kLookedAt * sizeof(Vector3d)> memory;  // no more is asked for
  std::pmr::vector<Vector3d> near(memory.resource());
  near.reserve(kLookedAt);
  const std::size_t step = (points.size() + kLookedAt - 1) / kLookedAt;
  for (std::size_t row = 0; row < points.size(); row += std::max<std::size_t>(1, step)) {
    if (is_moving[row] == 0 && std::abs(start.height(points[row])) < kGroundSearch_m &&
        points[row].squaredNorm() < kFlat_m * kFlat_m) {
      near.push_back(points[row]);
    }
  }
  if (near.size() < kFewestOnGround) {
    return std::nullopt;
  }
  GroundFit fit{with_most_points(start, near)};
  for (const double width_m : kWidths_m) {
    // Height and slopes of the ground over the plane: h = a . (1, u, v).
    const Vector3d u = fit.plane.normal.unitOrthogonal();
    const Vector3d v = fit.plane.normal.cross(u);
    Eigen::Matrix3d information = Vector3d(0.0, kSlopeWeight_m2, kSlopeWeight_m2).asDiagonal();
    Vector3d gradient = -kSlopeWeight_m2 * Vector3d(0.0, u.dot(start.normal), v.dot(start.normal));
    fit.points = 0;
    for (const Vector3d& point : near) {
      const double height = fit.plane.height(point);
      fit.points += is_on_ground(fit.plane, point) ? 1 : 0;
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
  if (a.plane.normal.dot(b.plane.normal) > kSameGroundUp &&
      std::abs(a.plane.offset_m - b.plane.offset_m) < kGroundSearch_m) {
    return a.points >= b.points ? a : b;  // about the same
  }
  const GroundFit& nearer = a.plane.offset_m >= b.plane.offset_m ? a : b;
  const GroundFit& other = &nearer == &a ? b : a;
  return 2 * nearer.points >= other.points ? nearer : other;
}

}  // namespace dynamic_icp::tracking
