// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "dynamic_icp/method/estimation/normal_equations.hpp"
#include "dynamic_icp/method/registration/residual.hpp"

namespace dynamic_icp::registration {

/// How well one term of the objective fits.
struct TermStatistics {
  std::size_t count = 0;    ///< residuals
  std::size_t inliers = 0;  ///< those with a weight above zero
  double rms = 0.0;         ///< of the inliers, in the unit of the term: m or m/s
};

/// The Gauss-Newton step's equations at one pose.
struct Linearisation {
  estimation::NormalEquations equations;
  Matrix6d score = Matrix6d::Zero();  ///< sum (w r)^2 J J^T: the spread of the gradient, for the covariance
  TermStatistics geometry;
  TermStatistics doppler;
};

/// A linearisation while residuals are added. Parts can be summed.
class LinearisationSum {
 public:
  /// Adds a residual of the geometry term (m) or the Doppler term (m/s) with its weight; none when that is zero.
  void add_geometry(const Residual& residual, double weight) { add(geometry_, residual, weight); }
  void add_doppler(const Residual& residual, double weight) { add(doppler_, residual, weight); }

  /// Adds weight * e^T information e with e in m.
  void add_geometry(const VectorResidual& residual, const Eigen::Matrix3d& information, double weight);

  LinearisationSum& operator+=(const LinearisationSum& other);

  [[nodiscard]] Linearisation finish() const;

 private:
  struct Term {
    std::size_t count = 0;
    std::size_t inliers = 0;
    double squares = 0.0;

    [[nodiscard]] TermStatistics statistics() const;
  };

  void add(Term& term, const Residual& residual, double weight);

  estimation::NormalEquations equations_;
  Matrix6d score_ = Matrix6d::Zero();  // lower half only
  Term geometry_;
  Term doppler_;
};

}  // namespace dynamic_icp::registration
