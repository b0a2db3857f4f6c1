// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/window/body_motion.hpp"
#include "dynamic_icp/method/window/doppler_error_field.hpp"

namespace dynamic_icp::window {

/// What bodies say of the change d of the error field: the quadratic 1/2 d^T H d + g^T d.
struct FieldInformation {
  Eigen::MatrixXd H;  ///< the lower triangle
  Eigen::VectorXd g;
};

/// Where traffic hides the static scene, the Doppler does not distinguish its error from a motion of the sensor. A body
/// that moves is a scene of its own: how it moved is seen by its surfaces and by its Doppler, however the sensor moved,
/// and what these differ by is the error of the Doppler,
///   s = u . (V + v + (Omega + w) x l) + Phi (theta + d),   [w; v] as its surfaces have it (BodyMotion).
class BodyTerms {
 public:
  /// Compares the bodies of a scan with the same ones in earlier scans and remembers them; d is the change of `theta`.
  /// Nothing where none was seen before. `point_sigma_mps`: of the Doppler of a point.
  [[nodiscard]] std::optional<FieldInformation> compare(std::vector<SeenBody> bodies, const Eigen::VectorXd& theta,
                                                        double point_sigma_mps, double max_noise_share,
                                                        const Workers& workers);

  /// Remembers them alone.
  void remember(std::vector<SeenBody> bodies);

  void forget() { scans_.clear(); }

  /// What is known between two scans, of a field of that size.
  void state(StateArchive& archive, std::size_t field_size);

 private:
  [[nodiscard]] BodyPath path_of(const SeenBody& now) const;

  std::vector<std::vector<SeenBody>> scans_;  ///< the newest first
};

}  // namespace dynamic_icp::window
