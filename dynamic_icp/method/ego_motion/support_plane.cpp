// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/support_plane.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::ego_motion {
namespace {

// Roads are flat to so much over so far.
constexpr double kTolerance_m = 0.25;
constexpr double kReach_m = 50.0;

// Planes are tried through three points each; all points count, or so many of them.
constexpr std::uint64_t kPlanes = 500;
constexpr std::size_t kMaxPoints = 800;

// Noise and reflections lie beyond any surface, but not more of them.
constexpr double kMaxBeyond = 0.02;
constexpr double kBeyond_m = -0.5;

// The side of a vehicle is long, but not wide: standard deviation along the shorter direction. And a plane of few
// points is one by chance.
constexpr double kMinWidth_m = 2.0;
constexpr double kMinPlaneShare = 0.1;
constexpr std::size_t kMinPlanePoints = 30;

// The sensor is above what carries it. The upper edge of the field of view bounds the scene, too, and roofs of traffic
// that reach it make a plane, which passes through the sensor.
constexpr double kMinHeight_m = 0.2;

// Both sides of a road and its embankments are up to so much steep against each other: cosine.
constexpr double kSameUp = 0.8;

struct Count {
  std::size_t on = 0;
  std::size_t beyond = 0;
};

bool is_on(const SupportPlane& plane, const Eigen::Vector3d& x) { return std::abs(plane.height(x)) < kTolerance_m; }

Count count(const SupportPlane& plane, const std::vector<Eigen::Vector3d>& points) {
  Count result;
  for (const Eigen::Vector3d& x : points) {
    const double height = plane.height(x);
    result.on += std::abs(height) < kTolerance_m ? 1 : 0;
    result.beyond += height < kBeyond_m ? 1 : 0;
  }
  return result;
}

bool bounds(const Count& count, std::size_t points) {
  return static_cast<double>(count.beyond) <= kMaxBeyond * static_cast<double>(points);
}

/// The plane through the points near a plane; nothing where they are not wide, or the sensor is not above it.
std::optional<SupportPlane> fitted(const SupportPlane& plane, const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (const Eigen::Vector3d& x : points) {
    if (is_on(plane, x)) {
      mean += x;
      squares += x * x.transpose();
      n += 1.0;
    }
  }
  mean /= n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / n - mean * mean.transpose());
  if (!(axes.eigenvalues()[1] > kMinWidth_m * kMinWidth_m)) {
    return std::nullopt;
  }
  SupportPlane result;
  result.normal = axes.eigenvectors().col(0);
  result.normal *= result.normal.dot(plane.normal) < 0.0 ? -1.0 : 1.0;
  result.offset_m = result.normal.dot(mean);
  return result.height(Eigen::Vector3d::Zero()) > kMinHeight_m ? std::optional(result) : std::nullopt;
}

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> result;
  const std::size_t n = std::min(kMaxPoints, points.size());
  for (std::size_t k = 0; k < n; ++k) {
    result.push_back(points[k * points.size() / n]);
  }
  return result;
}

struct Candidate {
  SupportPlane plane;
  std::size_t on = 0;  ///< points
};

/// Planes through three of the points each that have nearly all others on one side.
std::vector<Candidate> bounding_planes(const std::vector<Eigen::Vector3d>& points) {
  const RandomSource random(0);
  std::vector<Candidate> result;
  for (std::uint64_t k = 0; k < kPlanes; ++k) {
    const auto draw = [&](std::uint64_t which) -> const Eigen::Vector3d& {
      return points[(random.bits(3 * k + which) >> 32) * points.size() >> 32];
    };
    const Eigen::Vector3d& x = draw(0);
    const Eigen::Vector3d normal = (draw(1) - x).cross(draw(2) - x);
    if (!(normal.norm() > 1.0)) {
      continue;  // m^2: too near to each other or to a line
    }
    for (const double sign : {1.0, -1.0}) {
      const SupportPlane plane{sign * normal.normalized(), sign * normal.normalized().dot(x)};
      const Count found = count(plane, points);
      if (bounds(found, points.size())) {
        result.push_back({plane, found.on});
      }
    }
  }
  return result;
}

/// The candidate with the largest `value`, at least `least`, that is wide; none: nullptr.
template <typename Value>
const Candidate* with_most(const std::vector<Candidate>& candidates, const std::vector<Eigen::Vector3d>& points,
                           std::size_t least, const Value& value) {
  const Candidate* best = nullptr;
  for (const Candidate& one : candidates) {
    const std::size_t found = value(one);
    if (found >= least && fitted(one.plane, points)) {
      best = &one;
      least = found + 1;
    }
  }
  return best;
}

}  // namespace

std::optional<SupportPlane> find_support_plane(const std::vector<Eigen::Vector3d>& points) {
  const std::vector<Eigen::Vector3d> few = thinned(points);
  if (few.size() < kMinPlanePoints) {
    return std::nullopt;
  }
  const std::size_t least =
      std::max(kMinPlanePoints, static_cast<std::size_t>(kMinPlaneShare * static_cast<double>(few.size())));
  const std::vector<Candidate> candidates = bounding_planes(few);
  const Candidate* const widest = with_most(candidates, few, least, [](const Candidate& one) { return one.on; });
  if (widest == nullptr) {
    return std::nullopt;
  }
  // An embankment may show more points than the road, below which it passes near the carrier.
  const Candidate* const nearer = with_most(candidates, few, least, [&](const Candidate& one) -> std::size_t {
    if (one.plane.offset_m < widest->plane.offset_m - kBeyond_m ||
        one.plane.normal.dot(widest->plane.normal) < kSameUp) {
      return 0;
    }
    return static_cast<std::size_t>(std::count_if(few.begin(), few.end(), [&](const Eigen::Vector3d& x) {
      return is_on(one.plane, x) && !is_on(widest->plane, x);
    }));
  });
  return fitted((nearer == nullptr ? widest : nearer)->plane, few);
}

std::optional<SupportPlane> find_support_plane(const Scan& scan, const spatial::CellOrder& order) {
  std::vector<Eigen::Vector3d> all;
  std::vector<Eigen::Vector3d> of_several;  // points; reflections below the road have cells of their own
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (order.rank[i] == 0 && scan.points()[i].squaredNorm() < kReach_m * kReach_m) {
      all.push_back(scan.points()[i]);
      if (order.first[order.cell[i] + 1] - order.first[order.cell[i]] > 1) {
        of_several.push_back(scan.points()[i]);
      }
    }
  }
  return find_support_plane(2 * of_several.size() > all.size() ? of_several : all);  // all of a sparse scan
}

std::vector<std::uint8_t> cells_on_support(const Scan& scan, spatial::CellOrder& order, const SupportPlane& plane) {
  order.count_items([&](std::size_t i) { return is_on(plane, scan.points()[i]); });
  std::vector<std::uint8_t> result(order.cells());
  for (std::size_t cell = 0; cell < result.size(); ++cell) {
    result[cell] = order.counted_most_of(cell) ? 1 : 0;
  }
  return result;
}

}  // namespace dynamic_icp::ego_motion
