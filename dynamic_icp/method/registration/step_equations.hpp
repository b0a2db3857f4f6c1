// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/estimation/normal_equations.hpp"
#include "dynamic_icp/method/registration/objective.hpp"
#include "dynamic_icp/method/registration/source_rows.hpp"

namespace dynamic_icp::registration {

// The step of Eq. (12)-(14): the same residuals and Jacobians as in point_to_plane.hpp and doppler_rotation.hpp,
// written for four pairs at a time, because the inner loop spends its time here. `linearise` (objective.hpp) is the
// general form.

/// What an iteration needs of some pairs: the equations of its step and how well they fit.
struct StepEquations {
  estimation::NormalEquations equations;
  std::size_t pairs = 0;
  double squared_distances = 0.0;  ///< m^2, sum over the pairs

  StepEquations& operator+=(const StepEquations& other);
};

/// Whether `step_equations` knows the terms of an objective: point to plane, with the rotation-only Doppler term or
/// none, the same in all iterations.
bool has_step_equations(const Objective& objective);

/// The normal equations that `linearise` forms (but for rounding) from groups that lie where the pose of rotation `R`
/// has moved them.
StepEquations step_equations(std::span<const SourceRows> groups, const Eigen::Matrix3d& R, const Objective& objective);

}  // namespace dynamic_icp::registration
