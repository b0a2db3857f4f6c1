// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <utility>

#include "dynamic_icp/method/window/window_estimator.hpp"

// How the linearised terms are solved for all unknowns: theta is eliminated, the vibration of past scans is factored
// once.
namespace dynamic_icp::window {
namespace {

/// 1/rad^2 and 1/m^2: what no scan shows of the map's error stays within what it may be, 0.1 rad and 1 m.
Eigen::VectorXd map_information() {
  Vector6d information;
  information << Eigen::Vector3d::Constant(100.0), Eigen::Vector3d::Constant(1.0);
  return information.replicate<Layout::kMapNodes, 1>();
}

}  // namespace

/// One step of all unknowns.
double WindowEstimator::solve(const Problem& rest) {
  Eigen::VectorXd gradient = linear_gradient();
  field_->add_prior_gradient(theta_, gradient.head(theta_.size()));
  factor(rest);
  Eigen::VectorXd rest_gradient = gradient.tail(rest.g.size()) + rest.g;
  const Eigen::VectorXd by_field = elimination_.rest_gradient(gradient.head(layout().head()));
  rest_gradient.head(by_field.size()) = by_field + rest.g.head(by_field.size());
  rest_gradient.segment<Layout::kMapError>(rest_layout().map_error()) += map_information().cwiseProduct(map_error_);
  const Eigen::VectorXd y = -rest_factor_.solve(rest_gradient);
  if (!elimination_.is_solvable() || !rest_factor_.is_solvable() || !y.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  theta_ += elimination_.step(gradient.head(layout().head()), y.head(by_field.size()));
  const Layout at = rest_layout();
  map_error_ += y.head(Layout::kMapError);
  stamp_errors_ += y.segment<2>(Layout::kMapError);
  double largest = 0.0;
  for (std::size_t k = 0; k < trajectory_.coefficients().size(); ++k) {
    const auto step = y.segment<6>(at.coefficient(k));
    trajectory_.coefficients()[k] += step;
    largest = std::max(largest, step.cwiseAbs().maxCoeff());
    if (at.vibrates) {
      trajectory_.vibration()[k] += y.segment<6>(at.vibration(k));
    }
  }
  return largest;
}

/// The information of all unknowns but theta. The priors of theta and of the map's error stay apart from the past.
void WindowEstimator::factor(const Problem& rest) {
  const Eigen::Index head = rest_layout().head();
  Eigen::MatrixXd S = elimination_.rest() + rest.H.topLeftCorner(head, head);
  S.diagonal().segment<Layout::kMapError>(rest_layout().map_error()) += map_information();
  S.diagonal().array() += kNothing;
  rest_factor_.compute(S);
}

/// The vibration that nothing but the past and the prior of the motion know of: the same in all steps.
void WindowEstimator::factor_tail(const Problem& rest) {
  const Eigen::Index tail = rest.H.rows() - rest_layout().head();
  Eigen::MatrixXd rows = quadratic_->Q().bottomRightCorner(tail, rest.H.cols()) + rest.H.bottomRows(tail);
  rows.rightCols(tail).diagonal().array() += kNothing;
  rest_factor_.set_tail(rows);
}

/// The scan becomes part of the past. The prior of the field stays apart, so that its scale can still be learned; that
/// of the map's error, too: the map goes along with a velocity that no plane shows, and to be told in each scan that it
/// is hardly displaced is to measure that velocity.
void WindowEstimator::join(const Problem& rest, const Workers& workers) {
  Eigen::VectorXd g = linear_gradient();
  g.tail(rest.g.size()) += rest.g;
  factor_tail(rest);
  Eigen::MatrixXd H = quadratic_->Q();
  H.topLeftCorner(linear_H_.rows(), linear_H_.cols()) = linear_H_;
  H.bottomRightCorner(rest.g.size(), rest.g.size()) += rest.H;
  quadratic_->set(std::move(H), std::move(g));
  linearise_here();
  factor(rest);
  workers.both([&] { learn_field(); }, [&] { learn_cell_variance(workers); });
}

}  // namespace dynamic_icp::window
