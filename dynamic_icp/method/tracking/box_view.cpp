// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <vector>

#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/size_prior.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kGrazing = 0.03;         // faces seen at a smaller angle show nothing
constexpr double kEndOn = 0.25;           // part of an axis across the line of sight, below which it is end-on
constexpr double kEndOnRear = 0.02;       // ... and to the rear of what has flat sides
constexpr double kBehindEnd_m = 1.0;      // from so far behind such an end, and points are nearer before it ...
constexpr double kNothingBeyond_m = 6.0;  // ... to so far nothing is seen of the side
constexpr double kOverGround_m = 1.0;     // what is lower may be the ground
constexpr double kDimSpeed_mps = 0.5;
constexpr double kFadingSpeed_mps = 1.0;  // below it, too, where the radial velocity falls ...
constexpr double kFading = 0.9;           // ... to this share of it
constexpr double kDimReach_m = 1.5;       // beyond an end
constexpr double kEndDepth_m = 0.3;       // points so near to the end of a span make the end
constexpr double kLookBeyond_m = 0.4;
constexpr double kClearance_m = 1.0;
constexpr double kSamePlace_m = 0.03;  // points nearer to an end are at the end, but for noise
constexpr double kMaxGap_m = 0.5;
constexpr double kFaceWidth_m = 0.8;    // what is seen so wide at an end that looks at the sensor is a face
constexpr double kLooksAtSensor = 0.5;  // cosine of the line of sight to such a face
constexpr double kFlatDepth_m = 0.1;    // so is what is narrower, but not deeper than this ...
constexpr double kFlatWidth = 2.5;      // ... and so many times wider, as the sensor sees it, than deep ...
constexpr double kMinFlat_m = 0.2;      // ... and so wide: a few points side by side are as flat ...
constexpr double kFlatFacing = 0.1;     // ... if it looks at the sensor but a little
constexpr double kMinEndPoints = 3.0;   // points of an end
constexpr std::size_t kMinPast = 5;     // points past an end ...
constexpr double kSideAway_m = 1.0;     // ... and how far they lie apart away from it: a side, not a corner
constexpr double kUpperPart = 0.7;      // of the way up to the top: under a nearer body the lower part alone is seen
constexpr double kCarHeight_m = 1.8;    // what is higher has no boot ...
constexpr double kVanHeight_m = 2.8;    // ... and what is higher is a lorry, with a cabin that may be lower
constexpr double kVanHood_m = 0.6;      // hoods and boots are so long in the mean ...
constexpr double kSlope_m = 0.1;        // ... sides lean so much ...
constexpr double kCabin_m = 1.2;        // ... and what there may be of such cabins
constexpr double kHood_m = 0.6;         // below this height bodies reach as far as anywhere: hoods, bumpers ...
constexpr double kBeltLine_m = 0.9;     // of cars: above it are windows, which lean ...
constexpr double kBoot_m = 0.4;         // ... and beyond them so much of boots in the mean
constexpr double kCabinHeight_m = 2.0;  // ... and lorries below this one

/// The body whose ends are asked for.
struct Body {
  const Matrix3d& axes;
  const Vector3d& reference;
  const Vector3d& W;
  const Detection& detection;
  Vector3d sensor;                     ///< m, along the axes from the reference
  std::span<const double> along = {};  ///< m, ahead of the reference: of its points
  double length_m = 0.0;               ///< of what is seen
  double ground_m = 0.0;               ///< of the ground, up from the reference ...
  double top_m = 0.0;                  ///< ... of what is seen ...
  double height_m = 0.0;               ///< ... and how high the body is above the ground in all likelihood
};

/// How far above and below an end, m, it is asked what comes next.
struct LookBeside {
  double lower = 0.0;
  double higher = 0.0;
};

/// Whether a direction is that to the rear of a lorry or a trailer: boxes but for their fronts.
bool is_rear_of_lorry(const Vector3d& outward, const Body& body) {
  return is_lorry_sized(body.length_m, body.height_m) && outward.dot(body.axes.col(0)) < -0.5;
}

/// Whether there may be more of a side behind its end: points are too far apart there, or more of them are seen, of
/// which few need not be a part of what moves yet.
bool may_go_on_behind(const EndView& end, const Vector3d& outward, const Body& body) {
  const double end_m = body.axes.col(0).dot(end.middle - body.reference) - end.inside;
  const auto before = std::ranges::count_if(
      body.along, [&](double at) { return at > end_m + kEndDepth_m && at < end_m + kBehindEnd_m; });
  if (static_cast<double>(before) < kMinEndPoints) {
    return true;
  }
  const Detection& detection = body.detection;
  const Vector3d up = body.axes.col(2);
  const double lowest = body.ground_m + kOverGround_m;
  const Vector3d at_end = end.middle + (lowest - up.dot(end.middle - body.reference)) * up;
  return detection.view->sees_along(detection.T_sensor_world * (at_end + (end.reach + kBehindEnd_m) * outward),
                                    detection.T_sensor_world * (at_end + kNothingBeyond_m * outward),
                                    body.top_m - lowest);
}

/// Whether a body ends at `end`, as seen from the sensor: nothing hides what would come next, there, below and above.
/// `shows_face`: what is seen there is a face rather than the edge of a side.
bool is_true_end(const EndView& end, const Vector3d& outward, const LookBeside& beside, bool shows_face,
                 const Body& body) {
  const Detection& detection = body.detection;
  const Vector3d to_end = end.middle - detection.sensor;
  const double range = to_end.norm();
  const Vector3d sight = to_end / range;
  const Vector3d sideways = outward - outward.dot(sight) * sight;
  const bool is_rear = is_rear_of_lorry(outward, body);
  const double end_on = is_rear ? kEndOnRear : kEndOn;
  if (sideways.norm() < end_on && (shows_face || outward.dot(sight) > 0.0)) {
    return outward.dot(sight) < 0.0;  // the near end of what is seen end-on; the body hides the far one
  }
  // Points of the body that hardly move along the line of sight are missing among the moving ones.
  const double here = sight.dot(body.W);
  const double next = (to_end + kDimReach_m * outward).normalized().dot(body.W);
  const bool fades = std::abs(next) < std::min(kFadingSpeed_mps, kFading * std::abs(here));
  const bool is_dim = std::min(std::abs(here), std::abs(next)) < kDimSpeed_mps || here * next < 0.0 || fades;
  if (detection.view == nullptr) {
    return !is_dim;
  }
  if (is_rear && sideways.norm() < kEndOn && may_go_on_behind(end, outward, body)) {
    return false;
  }
  const double cell = range * RangeImage::cell_width();
  for (const double step : {cell, std::max(kLookBeyond_m, 3.0 * cell)}) {
    const Vector3d beyond = detection.T_sensor_world * (end.middle + (end.reach + step) * sideways.normalized());
    if (detection.view->is_above_all(beyond)) {
      return false;
    }
    // Behind a dim end the body itself may go on; within a cell it is the end that is seen.
    if (detection.view->hides(beyond, is_dim && step > cell ? -kClearance_m : kClearance_m)) {
      return false;
    }
    const Vector3d up = detection.T_sensor_world.linear() * detection.ground.up();
    if ((beside.lower > 0.0 && detection.view->hides(beyond - beside.lower * up, kClearance_m)) ||
        (beside.higher > 0.0 && detection.view->hides(beyond + beside.higher * up, kClearance_m))) {
      return false;
    }
  }
  return true;
}

/// Whether the upper edge of the field of view is right above the top.
bool is_cut_above(const Vector3d& top, const Vector3d& up, const Detection& detection) {
  const double step = 3.0 * RangeImage::cell_width() * (top - detection.sensor).norm();
  return detection.view != nullptr && detection.view->is_above_all(detection.T_sensor_world * (top + step * up));
}

/// Where points (m, from the reference) are along each axis.
using PlacesAlong = std::array<std::span<double>, 3>;

void find_places_along(const Matrix3d& axes, const Vector3d& reference, std::span<const Vector3d> points,
                       const PlacesAlong& along) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const double* const p = points.data()->data();
    const std::size_t n = points.size();
    const Matrix3d a = axes;
    const Vector3d origin = reference;
    double* const first = along[0].data();
    double* const second = along[1].data();
    double* const third = along[2].data();
    for (std::size_t i = 0; i < n; ++i) {
      const double x = p[3 * i] - origin.x();
      const double y = p[3 * i + 1] - origin.y();
      const double z = p[3 * i + 2] - origin.z();
      first[i] = x * a(0, 0) + y * a(1, 0) + z * a(2, 0);
      second[i] = x * a(0, 1) + y * a(1, 1) + z * a(2, 1);
      third[i] = x * a(0, 2) + y * a(1, 2) + z * a(2, 2);
    }
  });
}

/// Where values end: without kViewTrim of them at either end, and without one that lies far from all others.
Interval seen_span(std::span<const double> along) {
  const Interval span = span_of(along, kViewTrim);
  Interval inner{span.high, span.low};
  std::size_t at_low = 0;
  std::size_t at_high = 0;
  for (const double q : along) {
    const bool is_low = q < span.low + kMaxGap_m;
    const bool is_high = q > span.high - kMaxGap_m;
    at_low += is_low ? 1 : 0;
    at_high += is_high ? 1 : 0;
    inner.low = is_low ? inner.low : std::min(inner.low, q);
    inner.high = is_high ? inner.high : std::max(inner.high, q);
  }
  const Interval without{at_low == 1 ? inner.low : span.low, at_high == 1 ? inner.high : span.high};
  return without.length() < 0.0 ? span : without;  // of two points neither is far from all others
}

/// `along`, `across` and `up`: places of the points along the axis, one at right angles to it, and upwards;
/// `sensor_across`: that of the sensor.
AxisView view_along(std::span<const double> along, std::span<const double> across, std::span<const double> up,
                    double sensor_across, std::span<const Vector3d> points) {
  AxisView view;
  view.seen = seen_span(along);
  const auto look_at = [&](auto&& inwards) {  // how far inwards of the end a point lies
    EndView end;
    double sum = 0.0;
    double squares = 0.0;
    double depths = 0.0;
    double farthest = 0.0;  // beyond the end
    end.gap = kMaxGap_m;
    end.lowest = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double depth = inwards(along[i]);
      if (depth > kMaxGap_m) {
        continue;  // as are most: neither at the end nor beside it
      }
      if (depth <= kEndDepth_m) {
        end.count += 1.0;
        sum += across[i];
        squares += across[i] * across[i];
        depths += depth * depth;
        end.lowest = std::min(end.lowest, up[i]);
      }
      if (depth > kSamePlace_m) {
        end.gap = std::min(end.gap, depth);
      }
      if (-depth > end.reach) {
        end.reach = std::min(farthest, -depth);
        farthest = std::max(farthest, -depth);
      }
    }
    end.has_points_beyond = end.reach > kMaxGap_m;
    end.is_of_few = end.count < kMinEndPoints;
    end.depth = std::sqrt(depths / end.count);
    const double mean = sum / end.count;
    end.width = std::sqrt(12.0 * std::max(0.0, squares / end.count - mean * mean));  // if evenly spread
    // What is seen through gaps, of wheels and axles, lies behind the face that ends here.
    const double towards_sensor = sensor_across < mean ? -1.0 : 1.0;
    double nearer = 0.0;
    double deviations = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (inwards(along[i]) <= kEndDepth_m) {
        const double off = across[i] - mean;
        deviations += std::abs(off);
        if (towards_sensor * off > -kSamePlace_m) {
          end.middle += points[i];
          end.inside += inwards(along[i]);
          nearer += 1.0;
        }
      }
    }
    end.middle /= nearer;
    end.inside /= nearer;
    if (end.width > kFaceWidth_m) {  // a side with a few points behind it is not wide
      end.width = std::min(end.width, 4.0 * deviations / end.count);
    }
    return end;
  };
  view.low = look_at([low = view.seen.low](double q) { return q - low; });
  view.high = look_at([high = view.seen.high](double q) { return high - q; });
  return view;
}

/// Whether points are seen past an end of the view along an axis, whose lines of sight would meet what is seen of the
/// near face beyond that end, were there more of it. `outward`: 1 at the high end, -1 at the low one; `near`: where
/// that face is along the other axis.
bool is_seen_past(const AxisView& view, double outward, std::span<const double> along, double sensor_along, double near,
                  std::span<const double> away, double sensor_away) {
  const EndView& face_end = outward > 0.0 ? view.high : view.low;
  const double end = outward > 0.0 ? view.seen.high : -view.seen.low;
  if (face_end.has_points_beyond || face_end.is_of_few || outward * sensor_along <= end) {
    return false;
  }
  std::size_t count = 0;
  Interval side{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double at = outward * along[i];
    const double at_face = at + (away[i] - near) / (away[i] - sensor_away) * (outward * sensor_along - at);
    if (std::abs(at - end) < kFlatDepth_m && at_face > end + kFlatDepth_m) {
      ++count;
      side.low = std::min(side.low, away[i]);
      side.high = std::max(side.high, away[i]);
    }
  }
  return count >= kMinPast && side.length() > kSideAway_m;
}

/// Whether a body ends at `end`, which is how far it is seen along one of its axes; where its upper part does alone,
/// `end.hidden` says how much farther it may go on below.
bool is_end(EndView& end, const Vector3d& outward, const Body& body) {
  if (end.has_points_beyond || end.is_of_few) {
    return false;
  }
  const double facing = outward.dot((body.detection.sensor - end.middle).normalized());
  const bool is_flat =
      end.depth < kFlatDepth_m && end.width > kMinFlat_m && facing * end.width > kFlatWidth * end.depth;
  const bool is_along = std::abs(outward.dot(body.axes.col(0))) > 0.5;
  const bool is_car = body.height_m < kCarHeight_m;
  if ((is_flat && facing > kFlatFacing) || (end.width > kFaceWidth_m && facing > kLooksAtSensor)) {
    const bool is_window = !is_flat && is_car && is_along && end.lowest > body.ground_m + kBeltLine_m;
    end.hidden = is_window ? kBoot_m : 0.0;  // over something nearer
    return !is_window;
  }
  const double at = body.axes.col(2).dot(end.middle - body.reference);
  const auto is_end_down_to = [&](double height_m) {
    return is_true_end(end, outward, {at - height_m, kUpperPart * (body.top_m - at)}, end.width > kEndDepth_m, body);
  };
  if (!is_end_down_to(body.top_m)) {
    return false;
  }
  const bool is_lorry = body.height_m > kVanHeight_m;
  // Vans and lorries are boxes but for their fronts.
  const bool is_box = !is_car && outward.dot(body.axes.col(0)) < 0.5;
  // Over something nearer often the cabin of a car is seen, and neither its hood nor its boot.
  if (is_box || is_end_down_to(body.ground_m + (is_lorry ? kCabinHeight_m : kHood_m))) {
    return true;
  }
  end.hidden = is_lorry ? kCabin_m : is_along ? kVanHood_m : kSlope_m;
  return false;
}

}  // namespace

std::array<AxisView, 3> views_along(const Matrix3d& axes, const Vector3d& reference, std::span<const Vector3d> points,
                                    const Vector3d& W, const Detection& detection, std::optional<double> top_m) {
  DetectionMemory memory;
  std::pmr::vector<double> places(3 * points.size(), memory.resource());
  const auto part = [&](std::size_t axis) { return std::span(places).subspan(axis * points.size(), points.size()); };
  const PlacesAlong along{part(0), part(1), part(2)};
  find_places_along(axes, reference, points, along);
  std::array<AxisView, 3> views;
  Body body{axes, reference, W, detection, axes.transpose() * (detection.sensor - reference)};
  body.along = along[0];
  const Vector3d& sensor = body.sensor;
  views[2] = view_along(along[2], along[1], along[2], sensor.y(), points);
  const Vector3d up = axes.col(2);
  EndView& top = views[2].high;
  top.is_cut = is_cut_above(top.middle + top.inside * up, up, detection);
  body.ground_m = detection.ground.offset_m ? *detection.ground.offset_m - up.dot(reference) : views[2].seen.low;
  body.top_m = views[2].seen.high;
  const double seen_m = body.top_m - body.ground_m;
  body.height_m = top_m ? *top_m - body.ground_m : top.is_cut ? height_beyond(seen_m).mean : seen_m;
  // What is below bodies is hidden by them.
  top.is_true = !top.is_cut && is_true_end(top, up, {}, true, body);

  std::array<bool, 2> faces_sensor{};
  for (const int axis : {0, 1}) {
    const auto k = static_cast<std::size_t>(axis);
    AxisView& view = views[k] = view_along(along[k], along[1 - k], along[2], sensor[1 - axis], points);
    body.length_m = views[0].seen.length();
    const double grazing = kGrazing * sensor.norm();
    view.high.is_true = sensor[axis] > view.seen.high && is_end(view.high, axes.col(axis), body);
    view.low.is_true = sensor[axis] < view.seen.low && is_end(view.low, -axes.col(axis), body);
    faces_sensor[k] = (view.high.is_true && sensor[axis] > view.seen.high + grazing) ||
                      (view.low.is_true && sensor[axis] < view.seen.low - grazing);
  }
  for (const int axis : {0, 1}) {
    AxisView& view = views[static_cast<std::size_t>(axis)];
    if (faces_sensor[static_cast<std::size_t>(1 - axis)]) {
      view.high.is_true = view.high.is_true || is_end(view.high, axes.col(axis), body);
      view.low.is_true = view.low.is_true || is_end(view.low, -axes.col(axis), body);
    }
  }
  if (const Interval& seen = views[0].seen; sensor.x() < seen.low || sensor.x() > seen.high) {
    const double near = sensor.x() < seen.low ? seen.low : seen.high;
    AxisView& across = views[1];
    const auto is_passed = [&](double outward) {
      return is_seen_past(across, outward, along[1], sensor.y(), near, along[0], sensor.x());
    };
    across.high.is_true = across.high.is_true || is_passed(1.0);
    across.low.is_true = across.low.is_true || is_passed(-1.0);
  }
  return views;
}

}  // namespace dynamic_icp::tracking
