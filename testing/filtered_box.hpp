// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/method/tracking/box_filter.hpp"

#include "testing/boxes_in_view.hpp"

namespace dynamic_icp::tracking {

inline const Eigen::Vector3d kLorrySize_m(10.0, 2.4, 3.0);

inline FaceView view_of_face(const BoxEstimate& estimate, Face face) { return estimate.faces[index_of(face)]; }

/// Middle of a face, world.
inline Eigen::Vector3d middle_of(const OrientedBox& box, Face face) {
  const int axis = axis_of(face);
  return box.centre + side_of(face) * 0.5 * box.size[axis] * box.axes.col(axis);
}

/// A body of this size (m) that stands on the ground at (x, y) and drives with `speed` (m/s) in the direction of `yaw`.
inline MovingBox moving_body(double x, double y, double yaw, double speed, const Eigen::Vector3d& size) {
  const Eigen::Matrix3d axes = upright_axes(yaw);
  return {{{x, y, 0.5 * size.z() - kSensorHeight_m}, axes, size}, speed * axes.col(0), 0.0};
}

/// Takes in the next scan; the first one begins the filter.
inline void take_in(std::optional<BoxFilter>& filter, const Detection& detection, std::optional<double> yaw_rad,
                    const TrackConfig& config) {
  if (filter) {
    filter->predict(kScanPeriod_s, config);
    filter->correct(detection, config);
  } else {
    filter.emplace(detection, yaw_rad, BoxHistory{}, config);
  }
}

}  // namespace dynamic_icp::tracking
