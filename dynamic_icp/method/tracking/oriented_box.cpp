// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/oriented_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/selection.hpp"
#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/coordinates.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kMinPointsOfAYaw = 5;
constexpr std::size_t kMaxPointsOfAYaw = 200;
constexpr double kCoarseStep_rad = 0.052;  // 3 degrees
constexpr double kFineStep_rad = 0.0087;   // half a degree
constexpr double kNearestToEdge_m = 0.05;  // closer than the noise of the range is not better

/// A value for each of some points, and points in a plane, on the stack.
using PlaneValues = std::array<double, kMaxPointsOfAYaw>;
struct PlanePoints {
  PlaneValues x;
  PlaneValues y;
  std::size_t count = 0;
};

constexpr std::size_t kFew = 8;

/// Keeps the lowest values that came, ascending.
struct Lowest {
  std::array<double, kFew> values{};
  std::size_t count = 0;

  void add(double value, std::size_t most) {
    if (count == most && !(value < values[count - 1])) {
      return;
    }
    std::size_t place = count < most ? count++ : count - 1;
    for (; place > 0 && value < values[place - 1]; --place) {
      values[place] = values[place - 1];
    }
    values[place] = value;
  }
};

/// span_of without `rank` values at either end, fewer than kFew and than there are values.
Interval span_without_few(std::span<const double> values, std::size_t rank) {
  Lowest low;
  Lowest high;  // of the negative values
  const auto add = [&](double value) {
    low.add(value, rank + 1);
    high.add(-value, rank + 1);
  };
  // Bodies are seen from one side to the other: after both ends few values are among the lowest or the highest.
  const std::size_t begin = rank + 1;
  const std::size_t end = std::max(begin, values.size() - begin);
  std::ranges::for_each(values.first(begin), add);
  std::ranges::for_each(values.subspan(end), add);
  std::size_t i = begin;
  while ((i += first_outside(values.subspan(i, end - i), low.values[rank], -high.values[rank])) < end) {
    add(values[i++]);
  }
  return {low.values[rank], -high.values[rank]};
}

/// Sum of 1 / d over the points, with the distance d of each to the nearest side of the rectangle around them.
double closeness(const PlanePoints& points, double yaw) {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  PlaneValues along;
  PlaneValues across;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = points.count;
    const double cosine = c;
    const double sine = s;
    for (std::size_t i = 0; i < n; ++i) {
      along[i] = cosine * points.x[i] + sine * points.y[i];
      across[i] = cosine * points.y[i] - sine * points.x[i];
    }
  });
  const Interval length = interval_around(std::span(along).first(points.count));
  const Interval width = interval_around(std::span(across).first(points.count));
  double total = 0.0;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = points.count;
    const simd::Lanes nearest_that_counts = kNearestToEdge_m - simd::Lanes{};
    simd::Lanes sums{};
    std::size_t i = 0;
    for (; i + simd::kLanes <= n; i += simd::kLanes) {
      simd::Lanes u, v;
      simd::load(u, &along[i]);
      simd::load(v, &across[i]);
      simd::Lanes distance = u - length.low;
      simd::keep_smaller(distance, length.high - u);
      simd::keep_smaller(distance, v - width.low);
      simd::keep_smaller(distance, width.high - v);
      simd::keep_larger(distance, nearest_that_counts);
      sums += 1.0 / distance;
    }
    const auto inverse_distance = [&](std::size_t k) DYNAMIC_ICP_KERNEL {
      const double lengthwise = std::min(along[k] - length.low, length.high - along[k]);
      const double widthwise = std::min(across[k] - width.low, width.high - across[k]);
      return 1.0 / std::max(std::min(lengthwise, widthwise), kNearestToEdge_m);
    };
    double even = sums[0] + sums[2];
    double odd = sums[1] + sums[3];
    if (i + 2 <= n) {
      even += inverse_distance(i);
      odd += inverse_distance(i + 1);
      i += 2;
    }
    total = even + odd + (i < n ? inverse_distance(i) : 0.0);
  });
  return total;
}

/// A yaw with its closeness.
struct ScoredYaw {
  double yaw = 0.0;
  double score = 0.0;
};

/// The best of the yaws within `range` of one, a step apart.
ScoredYaw best_yaw(const PlanePoints& points, const ScoredYaw& middle, double range, double step) {
  const int steps = std::max(1, static_cast<int>(std::ceil(range / step)));
  ScoredYaw best = middle;
  for (int i = 1; i <= steps; ++i) {
    for (const double yaw : {middle.yaw - i * range / steps, middle.yaw + i * range / steps}) {
      const double score = closeness(points, yaw);
      if (score > best.score) {
        best = {yaw, score};
      }
    }
  }
  return best;
}

}  // namespace

Eigen::Matrix3d upright_axes(double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  Eigen::Matrix3d axes;
  axes << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return axes;
}

double distance_outside(const OrientedBox& box, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = box.axes.transpose() * (point - box.centre);
  return (q.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm();
}

namespace {

std::array<Eigen::Vector3d, 8> corners(const OrientedBox& box) {
  std::array<Eigen::Vector3d, 8> result;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Eigen::Vector3d signs((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
    result[i] = box.centre + box.axes * signs.cwiseProduct(box.size);
  }
  return result;
}

/// Whether the outlines of two upright boxes have a point in common: no side of either parts them.
bool outlines_overlap(const OrientedBox& a, const OrientedBox& b) {
  const Eigen::Vector3d apart = b.centre - a.centre;
  const auto half_span = [](const OrientedBox& box, const Eigen::Vector3d& axis) {
    return 0.5 * (box.axes.leftCols<2>().transpose() * axis).cwiseAbs().dot(box.size.head<2>());
  };
  for (const Eigen::Vector3d axis : {a.axes.col(0), a.axes.col(1), b.axes.col(0), b.axes.col(1)}) {
    if (std::abs(axis.dot(apart)) > half_span(a, axis) + half_span(b, axis)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Gap gap_between(const OrientedBox& a, const OrientedBox& b) {
  const Eigen::Vector3d up = a.axes.col(2);
  Gap outlines{std::numeric_limits<double>::infinity(), 0.5 * (a.centre + b.centre)};
  if (outlines_overlap(a, b)) {
    outlines.width = 0.0;
  } else {  // then a corner of one is nearest to the other
    for (const auto& [box, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
      for (const Eigen::Vector3d& corner : corners(*other)) {
        const Eigen::Vector3d q = box->axes.transpose() * (corner - box->centre);
        const Eigen::Vector3d half = 0.5 * box->size;
        const Eigen::Vector3d nearest(std::clamp(q.x(), -half.x(), half.x()), std::clamp(q.y(), -half.y(), half.y()),
                                      q.z());
        if (const double width = (q - nearest).norm(); width < outlines.width) {
          outlines = {width, box->centre + 0.5 * box->axes * (q + nearest)};
        }
      }
    }
  }
  // Above each other: the middle of what both heights share, or of what parts them.
  const double low = std::max(up.dot(a.centre) - 0.5 * a.size.z(), up.dot(b.centre) - 0.5 * b.size.z());
  const double high = std::min(up.dot(a.centre) + 0.5 * a.size.z(), up.dot(b.centre) + 0.5 * b.size.z());
  return {std::hypot(outlines.width, std::max(0.0, low - high)),
          outlines.middle + (0.5 * (low + high) - up.dot(outlines.middle)) * up};
}

Eigen::Vector3d size_with(const OrientedBox& a, const OrientedBox& b) {
  Eigen::Vector3d high = 0.5 * a.size;
  Eigen::Vector3d low = -high;
  for (const Eigen::Vector3d& corner : corners(b)) {
    const Eigen::Vector3d q = a.axes.transpose() * (corner - a.centre);
    high = high.cwiseMax(q);
    low = low.cwiseMin(q);
  }
  return high - low;
}

Eigen::Vector3d aligned_extent(const OrientedBox& box) { return box.axes.cwiseAbs() * box.size; }

Interval span_of(std::span<const double> values, double trim) {
  if (values.empty()) {
    return {};
  }
  const auto rank = static_cast<std::size_t>(trim * static_cast<double>(values.size() - 1));
  if (rank < kFew) {
    return span_without_few(values, rank);
  }
  std::vector<double> parted(values.begin(), values.end());
  const std::size_t last = parted.size() - 1;
  select_place(parted, rank);
  select_place(std::span(parted).subspan(rank), last - 2 * rank);
  return {parted[rank], parted[last - rank]};
}

Interval span_along(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                    double trim) {
  StackMemory<4096> memory;
  std::pmr::vector<double> values(memory.resource());
  values.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    values.push_back((point - origin).dot(axis));
  }
  return span_of(values, trim);
}

std::optional<double> fit_yaw(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& level,
                              double near_yaw_rad, double range_rad) {
  if (points.size() < kMinPointsOfAYaw) {
    return std::nullopt;
  }
  const std::size_t stride = (points.size() + kMaxPointsOfAYaw - 1) / kMaxPointsOfAYaw;
  PlanePoints plane;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    // Relative to one of them: coordinates in the world may be large.
    const Eigen::Vector2d place = level.leftCols<2>().transpose() * (points[i] - points.front());
    plane.x[plane.count] = place.x();
    plane.y[plane.count++] = place.y();
  }
  const ScoredYaw near{near_yaw_rad, closeness(plane, near_yaw_rad)};
  const ScoredYaw coarse = best_yaw(plane, near, range_rad, kCoarseStep_rad);
  return best_yaw(plane, coarse, kCoarseStep_rad, kFineStep_rad).yaw;
}

}  // namespace dynamic_icp::tracking
