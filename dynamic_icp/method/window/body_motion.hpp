// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/window/doppler_error_field.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// The Doppler of a point on a moving body.
struct BodyDoppler {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();      ///< line of sight
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< m, from the centre of the body
  double s = 0.0;                                   ///< m/s, as measured, less that of a point that stands
  FieldColumns columns;                             ///< of its error

  void state(StateArchive& archive);
};

/// Where a moving body was in a scan and how it is believed to have moved, over ground, in axes that do not move.
struct SeenBody {
  std::int64_t id = 0;
  double time_s = 0.0;                                 ///< of what follows
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of the centre
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();     ///< rad/s
  std::vector<Eigen::Vector3d> points = {};            ///< m
  std::vector<BodyDoppler> doppler = {};

  void state(StateArchive& archive);
};

/// A body in one scan after the other, the newest first.
using BodyPath = std::vector<const SeenBody*>;

/// What surfaces say of d = [omega (rad/s); velocity (m/s)] by which a body moved otherwise than believed: the
/// quadratic 1/2 d^T A d - b^T d.
struct BodyMotion {
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  std::size_t points = 0;  ///< on surfaces
};

/// Between the ends of a path. A motion that only the noise of the normals of its surfaces shows is not held
/// (PlaneTerms): the side of a lorry does not show how fast it passes.
BodyMotion motion_by_surfaces(const BodyPath& path, double max_noise_share, const Workers& workers);

}  // namespace dynamic_icp::window
