// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/linearisation.hpp"

#include <cmath>

namespace dynamic_icp::registration {

void LinearisationSum::add(Term& term, const Residual& residual, double weight) {
  ++term.count;
  if (weight <= 0.0) {
    return;
  }
  ++term.inliers;
  term.squares += residual.value * residual.value;
  equations_.add(residual.jacobian, residual.value, weight);
  const Vector6d gradient = weight * residual.value * residual.jacobian;
  score_.selfadjointView<Eigen::Lower>().rankUpdate(gradient);
}

void LinearisationSum::add_geometry(const VectorResidual& residual, const Eigen::Matrix3d& information, double weight) {
  ++geometry_.count;
  if (weight <= 0.0) {
    return;
  }
  ++geometry_.inliers;
  geometry_.squares += residual.value.squaredNorm();
  equations_.add(residual.jacobian, residual.value, weight * information);
  const Vector6d gradient = weight * residual.jacobian.transpose() * (information * residual.value);
  score_.selfadjointView<Eigen::Lower>().rankUpdate(gradient);
}

LinearisationSum& LinearisationSum::operator+=(const LinearisationSum& other) {
  equations_ += other.equations_;
  score_ += other.score_;
  const auto add_term = [](Term& sum, const Term& part) {
    sum.count += part.count;
    sum.inliers += part.inliers;
    sum.squares += part.squares;
  };
  add_term(geometry_, other.geometry_);
  add_term(doppler_, other.doppler_);
  return *this;
}

TermStatistics LinearisationSum::Term::statistics() const {
  return {count, inliers, inliers > 0 ? std::sqrt(squares / static_cast<double>(inliers)) : 0.0};
}

Linearisation LinearisationSum::finish() const {
  return {equations_, Matrix6d(score_.selfadjointView<Eigen::Lower>()), geometry_.statistics(), doppler_.statistics()};
}

}  // namespace dynamic_icp::registration
