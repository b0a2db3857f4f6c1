// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/towing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include "dynamic_icp/tools/world/drive.hpp"

namespace dynamic_icp::world {
namespace {

using Eigen::Vector2d;

constexpr double kBegin_s = -30.0;
constexpr double kStep_s = 0.02;

/// The heading of the trailer at equal steps of time, and its derivative.
struct HeadingKnot {
  double heading_rad = 0.0;
  double rate_rps = 0.0;
};

struct Joint {
  Vector2d position;
  Vector2d velocity;
};

Vector2d left_of(double heading_rad) { return {-std::sin(heading_rad), std::cos(heading_rad)}; }

Joint joint_at(const Trajectory& vehicle, const Hitch& hitch, double time_s) {
  const MotionState state = vehicle(time_s);
  const Eigen::Vector3d joint = state.T_world_body * Eigen::Vector3d(hitch.on_vehicle_m, 0.0, 0.0);
  return {joint.head<2>(), point_velocity(state, joint).head<2>()};
}

/// By the classical method of Runge and Kutta.
std::vector<HeadingKnot> integrate_heading(const Trajectory& vehicle, const Hitch& hitch, double end_s) {
  const double to_axle_m = hitch.on_trailer_m - hitch.axle_m;
  const auto rate = [&](double time_s, double heading_rad) {
    return joint_at(vehicle, hitch, time_s).velocity.dot(left_of(heading_rad)) / to_axle_m;
  };
  const Eigen::Vector3d ahead = vehicle(kBegin_s).T_world_body.linear().col(0);
  double heading = std::atan2(ahead.y(), ahead.x());
  std::vector<HeadingKnot> knots;
  while (kBegin_s + kStep_s * static_cast<double>(knots.size()) < end_s + 2.0 * kStep_s) {
    const double time_s = kBegin_s + kStep_s * static_cast<double>(knots.size());
    const double first = rate(time_s, heading);
    knots.push_back({heading, first});
    const double second = rate(time_s + 0.5 * kStep_s, heading + 0.5 * kStep_s * first);
    const double third = rate(time_s + 0.5 * kStep_s, heading + 0.5 * kStep_s * second);
    const double fourth = rate(time_s + kStep_s, heading + kStep_s * third);
    heading += kStep_s / 6.0 * (first + 2.0 * second + 2.0 * third + fourth);
  }
  return knots;
}

/// Cubic between the knots, so that the rate is the derivative of the heading everywhere.
HeadingKnot heading_at(const std::vector<HeadingKnot>& knots, double time_s) {
  const double place = (time_s - kBegin_s) / kStep_s;
  if (place <= 0.0) {
    return {knots.front().heading_rad, 0.0};
  }
  const auto k = static_cast<std::size_t>(place);
  if (k + 1 >= knots.size()) {
    return {knots.back().heading_rad, 0.0};
  }
  const HeadingKnot& a = knots[k];
  const HeadingKnot& b = knots[k + 1];
  const double u = place - static_cast<double>(k);
  const double turned = b.heading_rad - a.heading_rad;
  const double bend_a = kStep_s * a.rate_rps - turned;
  const double bend_b = turned - kStep_s * b.rate_rps;
  const double w = 1.0 - u;
  return {a.heading_rad + turned * u + u * w * (bend_a * w + bend_b * u),
          (turned + (w - u) * (bend_a * w + bend_b * u) + u * w * (bend_b - bend_a)) / kStep_s};
}

}  // namespace

Trajectory tow(const Trajectory& vehicle, const Hitch& hitch, double end_s) {
  if (!(hitch.axle_m < hitch.on_trailer_m)) {
    throw std::invalid_argument("the axle of a trailer must be behind its joint");
  }
  const auto knots = std::make_shared<const std::vector<HeadingKnot>>(integrate_heading(vehicle, hitch, end_s));
  return [=](double time_s) {
    const Joint joint = joint_at(vehicle, hitch, time_s);
    const HeadingKnot trailer = heading_at(*knots, time_s);
    const Vector2d ahead(std::cos(trailer.heading_rad), std::sin(trailer.heading_rad));
    PlanarState state;
    state.position = joint.position - hitch.on_trailer_m * ahead;
    state.velocity = joint.velocity - hitch.on_trailer_m * trailer.rate_rps * left_of(trailer.heading_rad);
    state.heading_rad = trailer.heading_rad;
    state.yaw_rate_rps = trailer.rate_rps;
    return lift(state, {});
  };
}

}  // namespace dynamic_icp::world
