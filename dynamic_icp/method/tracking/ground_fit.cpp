// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kLookedAt = 2048;       // of a scan are looked at: more would not make the plane better
constexpr std::size_t kLookedAhead = 16;      // of them are asked for in time, as they lie far apart in memory
constexpr std::size_t kMinGroundPoints = 30;  // on the ground
constexpr double kFlat_m = 40.0;              // roads are flat so far
constexpr double kOnGround_m = 0.05;          // what is so near to the plane is on it

constexpr double kGroundSearch_m = 0.5;      // about the start
constexpr double kSameGroundUp = 0.98;       // cosine between the start and the ground
constexpr std::uint64_t kGroundPlanes = 32;  // planes through three of the points each ...
constexpr std::size_t kGroundJury = 256;     // ... are compared by so many of them

// Half widths of the weights from step to step, m. The last is that of what roads bend.
constexpr std::array kWidths_m = {0.15, 0.1, 0.07, 0.05, 0.05};

// What is known before, relative to one point: slopes against the start have a standard deviation of 0.03 rad beside
// heights of 0.05 m.
constexpr double kSlopeWeight_m2 = 2.8;

/// Some points as columns of numbers, on the stack.
template <std::size_t kMax>
struct Columns {
  std::array<double, kMax> x;
  std::array<double, kMax> y;
  std::array<double, kMax> z;
  std::size_t size = 0;

  void set(std::size_t i, const Vector3d& point) {
    x[i] = point.x();
    y[i] = point.y();
    z[i] = point.z();
  }
  [[nodiscard]] Vector3d operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

using NearPoints = Columns<kLookedAt>;
using Jury = Columns<2 * kGroundJury>;

/// How many are on a plane.
std::size_t votes(const ego_motion::SupportPlane& plane, const Jury& jury) {
  std::size_t count = 0;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = jury.size;
    const Vector3d normal = plane.normal;
    const double offset = plane.offset_m;
    std::size_t on_plane = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double height = normal.x() * jury.x[i] + normal.y() * jury.y[i] + normal.z() * jury.z[i] - offset;
      on_plane += std::abs(height) < kOnGround_m ? 1 : 0;
    }
    count = on_plane;
  });
  return count;
}

/// The plane with most points on it: the start, or one through three points. Least squares from the start alone may
/// end on one that leans on the road and on what is beside it.
ego_motion::SupportPlane with_most_points(const ego_motion::SupportPlane& start, const NearPoints& points) {
  Jury jury;
  for (std::size_t i = 0; i < points.size; i += std::max<std::size_t>(1, points.size / kGroundJury)) {
    jury.set(jury.size++, points[i]);
  }
  const RandomSource random(0);
  ego_motion::SupportPlane best = start;
  std::size_t most = votes(start, jury);
  for (std::uint64_t k = 0; k < kGroundPlanes; ++k) {
    const auto draw = [&](std::uint64_t which) {
      return points[(random.bits(3 * k + which) >> 32) * points.size >> 32];
    };
    const Vector3d x = draw(0);
    Vector3d normal = (draw(1) - x).cross(draw(2) - x);
    normal *= normal.dot(start.normal) < 0.0 ? -1.0 : 1.0;
    if (!(normal.dot(start.normal) > kSameGroundUp * normal.norm() && normal.norm() > 1.0)) {
      continue;  // m^2: points near to a line say little
    }
    normal.normalize();
    const ego_motion::SupportPlane plane{normal, normal.dot(x)};
    if (const std::size_t count = votes(plane, jury); count > most) {
      best = plane;
      most = count;
    }
  }
  return best;
}

/// The points that may be on the ground, and behind them such as are on no plane, up to a multiple of the lanes.
void gather_near(const ego_motion::SupportPlane& start, std::span<const Vector3d> points,
                 std::span<const std::uint8_t> is_moving, NearPoints& near) {
  static_assert(kLookedAt % simd::kLanes == 0);
  const std::size_t step = std::max<std::size_t>(1, (points.size() + kLookedAt - 1) / kLookedAt);
  for (std::size_t row = 0; row < points.size(); row += step) {
    if (row + kLookedAhead * step < points.size()) {
      __builtin_prefetch(&points[row + kLookedAhead * step]);
    }
    const Vector3d& point = points[row];
    const double off = std::abs(start.height(point));
    const double squared_range = point.squaredNorm();
    const bool counts = (is_moving[row] == 0) & (off < kGroundSearch_m) & (squared_range < kFlat_m * kFlat_m);
    near.set(near.size, point);  // the next takes its place if it does not count: a jump would be hard to foresee
    near.size += counts ? 1 : 0;
  }
  for (std::size_t i = near.size; i % simd::kLanes != 0; ++i) {
    near.set(i, 2.0 * kFlat_m * start.normal);
  }
}

/// Sums over the points near to a plane: of the least squares of their heights h = a . (1, u, v).
struct HeightSums {
  Matrix3d information;
  Vector3d gradient;
  std::size_t on_plane = 0;  // points
};

/// `axes`: the normal of the plane, and those of u and v.
HeightSums sum_heights(const Matrix3d& axes, double offset_m, double width_m, const NearPoints& points) {
  HeightSums sums;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    using simd::Lanes;
    using simd::sum;
    const std::size_t n = points.size;
    const Matrix3d R = axes;
    const double offset = offset_m;
    const double per_width2 = 1.0 / (width_m * width_m);
    Lanes w{}, wu{}, wv{}, wuu{}, wuv{}, wvv{}, wh{}, whu{}, whv{};
    simd::LaneMask on_plane{};
    for (std::size_t i = 0; i < n; i += simd::kLanes) {
      Lanes x, y, z;
      simd::load(x, &points.x[i]);
      simd::load(y, &points.y[i]);
      simd::load(z, &points.z[i]);
      const Lanes h = x * R(0, 0) + y * R(1, 0) + z * R(2, 0) - offset;
      const Lanes u = x * R(0, 1) + y * R(1, 1) + z * R(2, 1);
      const Lanes v = x * R(0, 2) + y * R(1, 2) + z * R(2, 2);
      on_plane -= (h < kOnGround_m) & (h > -kOnGround_m);
      Lanes root = 1.0 - h * h * per_width2;
      simd::keep_larger(root, Lanes{});
      const Lanes weight = root * root;
      const Lanes weight_u = weight * u;
      const Lanes weight_v = weight * v;
      w += weight;
      wu += weight_u;
      wv += weight_v;
      wuu += weight_u * u;
      wuv += weight_u * v;
      wvv += weight_v * v;
      wh += weight * h;
      whu += weight_u * h;
      whv += weight_v * h;
    }
    sums.information << sum(w), sum(wu), sum(wv), sum(wu), sum(wuu), sum(wuv), sum(wv), sum(wuv), sum(wvv);
    sums.gradient << sum(wh), sum(whu), sum(whv);
    sums.on_plane = static_cast<std::size_t>(on_plane[0] + on_plane[1] + on_plane[2] + on_plane[3]);
  });
  return sums;
}

}  // namespace

std::optional<GroundFit> fit_ground(const ego_motion::SupportPlane& start, std::span<const Vector3d> points,
                                    std::span<const std::uint8_t> is_moving) {
  NearPoints near;
  gather_near(start, points, is_moving, near);
  if (near.size < kMinGroundPoints) {
    return std::nullopt;
  }
  GroundFit fit{with_most_points(start, near)};
  for (const double width_m : kWidths_m) {
    Matrix3d axes;
    axes.col(0) = fit.plane.normal;
    axes.col(1) = fit.plane.normal.unitOrthogonal();
    axes.col(2) = fit.plane.normal.cross(axes.col(1));
    HeightSums sums = sum_heights(axes, fit.plane.offset_m, width_m, near);
    fit.points = sums.on_plane;
    if (fit.points < kMinGroundPoints) {
      return std::nullopt;
    }
    sums.information.diagonal().tail<2>().array() += kSlopeWeight_m2;
    sums.gradient.tail<2>() -= kSlopeWeight_m2 * axes.rightCols<2>().transpose() * start.normal;
    const Vector3d a = sums.information.ldlt().solve(sums.gradient);
    const Vector3d turned = axes * Vector3d(1.0, -a[1], -a[2]);
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
