// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/room.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::tracking {
namespace {

constexpr double kParallel = 0.95;  // cosine
constexpr double kSameLane = 0.5;   // of the narrower one is before the other

}  // namespace

Room room_beside(const OrientedBox& seen, const OrientedBox& likely, const OrientedBox& other) {
  const Eigen::Matrix3d turn = seen.axes.transpose() * other.axes;
  if (std::abs(turn(0, 0)) < kParallel) {
    return {};
  }
  const Eigen::Vector3d half = 0.5 * turn.cwiseAbs() * other.size;
  const Eigen::Vector3d to_other = seen.axes.transpose() * (other.centre - seen.centre);
  const double across = to_other.y() - seen.axes.col(1).dot(likely.centre - seen.centre);
  const double half_width = 0.5 * likely.size.y();
  const double shared = std::min(half_width, across + half.y()) - std::max(-half_width, across - half.y());
  if (shared < kSameLane * 2.0 * std::min(half_width, half.y())) {
    return {};
  }
  const double between = std::max(0.0, std::abs(to_other.x()) - half.x() - 0.5 * seen.size.x());
  return to_other.x() > 0.0 ? Room{.ahead = between} : Room{.behind = between};
}

}  // namespace dynamic_icp::tracking
