// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/tracking/articulation.hpp"

// Joints that show before anything turns.
namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxPoints = 2048;  // are looked at
constexpr double kLongest_m = 12.8;       // roads allow lorries 12 m; longer trailers and buses have no gap
constexpr double kAxleHeight_m = 1.3;     // below it wheels and drawbars reach into a gap
constexpr double kMinGap_m = 0.4;         // behind a cab ...
constexpr double kWideGap_m = 1.2;        // ... and between bodies
constexpr double kBeside = 2.0;           // so many times as far to both sides of a gap ...
constexpr double kCloser = 2.0;           // ... points lie so many times as close together ...
constexpr std::size_t kMinBeside = 8;     // ... and so many on either side ...
constexpr double kMinMissing = 12.0;      // ... so that there would be so many in the gap, were it none
constexpr double kBefore_m = 1.0;         // what hides a gap is so much nearer
constexpr double kDim_mps = 1.0;          // where the radial velocity is so small points of the body may be missing

/// A point and where it lies along the body, m.
struct PlacedPoint {
  double along_m;
  Vector3d point;  ///< m, world
};

/// The points of one side of a gap.
struct BesideGap {
  std::size_t count = 0;
  double widest_m = 0.0;  ///< between any two that follow each other, and on to where one looks no farther
};

/// Those from `from` on that are at most `reach_m` away from it.
template <typename Iterator>
BesideGap look_beside(Iterator from, Iterator end, double reach_m) {
  const double begin_m = from->along_m;
  double last_m = 0.0;
  BesideGap beside;
  for (; from != end && std::abs(from->along_m - begin_m) <= reach_m; ++from) {
    const double at_m = std::abs(from->along_m - begin_m);
    beside.widest_m = std::max(beside.widest_m, at_m - last_m);
    ++beside.count;
    last_m = at_m;
  }
  if (from != end) {  // else the body ends
    beside.widest_m = std::max(beside.widest_m, reach_m - last_m);
  }
  return beside;
}

/// The points above the axles, in the order of their places along a direction; no more of them than `placed` holds.
std::span<const PlacedPoint> place_above_axles(const GapView& view, const Vector3d& along, const Vector3d& velocity,
                                               std::span<PlacedPoint> placed) {
  const Vector3d up = view.detection.ground.up();
  const double lowest_m = *view.detection.ground.offset_m + kAxleHeight_m;
  const std::size_t stride = Workers::block_count(view.rows.size(), placed.size());
  std::size_t size = 0;
  for (std::size_t i = 0; i < view.rows.size(); i += stride) {
    const std::uint32_t row = view.rows[i];
    const double time_s = view.scan.has_times() ? view.scan.times()[row] : 0.0;
    const Vector3d point =
        view.sensor.T_world_sensor * view.scan.points()[row] + (view.detection.mean_time_s - time_s) * velocity;
    if (up.dot(point) > lowest_m) {
      placed[size++] = {along.dot(point), point};
    }
  }
  std::ranges::sort(placed.first(size), {}, &PlacedPoint::along_m);
  return placed.first(size);
}

/// Whether points of the body may be missing in a place for other reasons than a gap.
bool may_lack_points(const Vector3d& place, const Vector3d& velocity, const Detection& detection) {
  return std::abs(velocity.dot((place - detection.sensor).normalized())) < kDim_mps ||
         (detection.view != nullptr && detection.view->hides(detection.T_sensor_world * place, kBefore_m));
}

}  // namespace

std::optional<Joint> find_gap(const GapView& view, const OrientedBox& seen, const Vector3d& velocity) {
  if (!view.detection.ground.offset_m) {
    return std::nullopt;
  }
  const bool may_be_one = seen.size.x() < kLongest_m;
  const double narrowest_m = may_be_one ? kWideGap_m : kMinGap_m;
  const Vector3d along = seen.axes.col(0);
  std::array<PlacedPoint, kMaxPoints> memory;
  const std::span<const PlacedPoint> placed = place_above_axles(view, along, velocity, memory);
  std::optional<Joint> joint;
  double least = 1.0 / kCloser;
  for (std::size_t k = 1; k < placed.size(); ++k) {
    const double width_m = placed[k].along_m - placed[k - 1].along_m;
    if (width_m < narrowest_m) {
      continue;
    }
    const auto ahead = placed.begin() + static_cast<std::ptrdiff_t>(k);
    const BesideGap a = look_beside(std::make_reverse_iterator(ahead), placed.rend(), kBeside * width_m);
    const BesideGap b = look_beside(ahead, placed.end(), kBeside * width_m);
    const double share = std::max(a.widest_m, b.widest_m) / width_m;
    const bool is_gap = share <= least && std::min(a.count, b.count) >= kMinBeside &&
                        static_cast<double>(a.count + b.count) >= 2.0 * kBeside * kMinMissing;
    const Vector3d middle = 0.5 * (placed[k - 1].point + placed[k].point);
    if (is_gap && !may_lack_points(middle, velocity, view.detection)) {
      least = share;
      joint = Joint{.direction = along, .place_m = along.dot(middle), .is_gap = true, .is_of_another = may_be_one};
    }
  }
  return joint;
}

}  // namespace dynamic_icp::tracking
