// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/tracking/box_filter.hpp"
#include "dynamic_icp/method/tracking/likely_extent.hpp"
#include "dynamic_icp/method/tracking/size_prior.hpp"

// What a hypothesis says of its body: how much of it was seen, and how large it is likely to be.
namespace dynamic_icp::tracking {

OrientedBox BoxFilter::seen_box() const {
  OrientedBox box{body_.position(), body_.axes(), Eigen::Vector3d::Zero()};
  for (const int axis : {0, 1, 2}) {
    const double high = reach(high_face(axis));
    const double low = reach(low_face(axis));
    box.size[axis] = std::max(0.0, high + low);
    box.centre += 0.5 * (high - low) * box.axes.col(axis);
  }
  return box;
}

bool BoxFilter::is_whole_vehicle() const {
  return has_heading_ && was_vehicle_ && is_whole(0) && is_whole(1) && is_whole(2);
}

bool BoxFilter::is_whole(int axis) const { return extent(axis).is_whole(); }

double BoxFilter::likely_width() const { return is_whole(1) ? span(1) : typical_width_by_height(span(2)).mean; }

double BoxFilter::span(int axis) const { return extent(axis).length(); }

SeenExtent BoxFilter::extent(int axis) const {
  const Face high = high_face(axis);
  const Face low = low_face(axis);
  // An end of the upper part tells where the body is, but not how large: of two, neither counts.
  const bool is_one = is_known(high) != is_known(low);
  const auto is_end = [&](Face face) {
    return is_known(face) && (is_one || faces_[index_of(face)] != FaceView::kUnknown);
  };
  const auto likely_reach = [&](Face face) { return reach(face) + (is_end(face) ? hidden_[index_of(face)] : 0.0); };
  SeenExtent seen{likely_reach(high), likely_reach(low), is_end(high), is_end(low),
                  axis == 2 && top_is_cut_ && !is_end(high)};
  if (axis == 0) {
    seen.room_high = std::max(0.0, free_[0] - reach(high));
    seen.room_low = std::max(0.0, free_[1] - reach(low));
  }
  return seen;
}

BoxEstimate BoxFilter::estimate(const VehicleSizes& sizes) const {
  const std::array<LikelyExtent, 3> along =
      likely_extents({extent(0), extent(1), extent(2)}, has_heading_, may_be_person(), sizes);
  const Eigen::Matrix3d axes = body_.axes();
  const Eigen::Vector3d middle(along[0].middle, along[1].middle, along[2].middle);
  BoxEstimate estimate;
  estimate.box = {body_.position() + axes * middle, axes, {along[0].size, along[1].size, along[2].size}};
  estimate.faces = faces_;
  estimate.velocity = body_.velocity_at(middle);
  estimate.velocity_covariance = body_.velocity_covariance_at(middle);
  Eigen::Matrix<double, 3, BodyFilter::kStates> H = Eigen::Matrix<double, 3, BodyFilter::kStates>::Zero();
  H.leftCols<3>().setIdentity();
  H.col(BodyFilter::kYaw) = axes.col(2).cross(axes * middle);
  Eigen::Matrix3d hidden = Eigen::Matrix3d::Zero();
  for (const int axis : {0, 1, 2}) {
    const LikelyExtent& likely = along[static_cast<std::size_t>(axis)];
    H.col(BodyFilter::kFirstFace + 2 * axis) = likely.weight_high * axes.col(axis);
    H.col(BodyFilter::kFirstFace + 2 * axis + 1) = -likely.weight_low * axes.col(axis);
    const double below = std::hypot(likely.weight_high * hidden_[index_of(high_face(axis))],
                                    likely.weight_low * hidden_[index_of(low_face(axis))]);
    hidden(axis, axis) = likely.variance + below * below / 3.0;  // even from none to twice as much
  }
  estimate.centre_covariance = H * body_.covariance() * H.transpose() + axes * hidden * axes.transpose();
  // A body that turns moves otherwise where its centre may be, too: omega x.
  const Eigen::Matrix3d turn = body_.yaw_rate() * skew(axes.col(2)) * axes;
  estimate.velocity_covariance += turn * hidden * turn.transpose();
  if (!has_heading_) {  // the side that the motion is nearest to counts as the front
    const Eigen::Vector3d v = axes.transpose() * body_.velocity();
    const double quarters = std::round(std::atan2(v.y(), v.x()) / (0.5 * std::numbers::pi));
    estimate.box.axes = body_.level() * upright_axes(body_.yaw() + 0.5 * std::numbers::pi * quarters);
    if (std::abs(quarters) == 1.0) {
      std::swap(estimate.box.size.x(), estimate.box.size.y());
    }
  }
  return estimate;
}

}  // namespace dynamic_icp::tracking
