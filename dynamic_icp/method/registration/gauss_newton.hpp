// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/registration/alignment.hpp"
#include "dynamic_icp/method/registration/correspondences.hpp"
#include "dynamic_icp/method/registration/linearisation.hpp"

namespace dynamic_icp::registration {

/// What an ICP minimises, as the loop over it sees it.
class Problem {
 public:
  virtual ~Problem() = default;

  /// The correspondences at a pose.
  virtual Correspondences find(const Eigen::Isometry3d& T_target_source) = 0;

  /// The objective around a pose for fixed correspondences. `iteration` counts the steps made before, from 0.
  [[nodiscard]] virtual Linearisation linearise(const Correspondences& correspondences,
                                                const Eigen::Isometry3d& T_target_source, int iteration) const = 0;

  // What the loop asks for, in this order, at each pose. A problem may have faster ways than the two above.

  /// Finds the correspondences at a pose and tells how well they fit.
  virtual Fit associate(const Eigen::Isometry3d& T_target_source) {
    current_ = find(T_target_source);
    return {current_.pairs.size(), current_.fitness, current_.inlier_rmse};
  }
  /// The equations of the step from that pose.
  virtual estimation::NormalEquations equations(const Eigen::Isometry3d& T_target_source, int iteration) {
    return linearise(current_, T_target_source, iteration).equations;
  }
  /// The correspondences themselves.
  virtual Correspondences correspondences() { return current_; }

 private:
  Correspondences current_;
};

/// When the loop ends. A rule of 0 is not used; with both, either ends it.
struct StopRule {
  int max_iterations = 100;
  double tolerance = 0.0;  ///< converged when fitness and inlier RMSE (m) both change by less
  double min_step = 0.0;   ///< converged when the step [rad; m] is shorter
  int min_correspondences = 6;
  double rank_tolerance = 1e-12;
};

/// Root mean square distance of the points from the sensor: the lever through which a rotation moves them.
double typical_distance(const Scan& scan);

/// The ICP loop: correspondences, linearisation, one Gauss-Newton step, until a stopping rule holds. `length_m` is the
/// distance through which a rotation typically moves the points; it makes rotations and translations comparable.
Alignment minimise(Problem& problem, const Eigen::Isometry3d& T_initial, double length_m, const StopRule& stop);

}  // namespace dynamic_icp::registration
