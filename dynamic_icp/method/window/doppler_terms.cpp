// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/doppler_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::window {
namespace {

constexpr std::size_t kTermBlock = 512;

constexpr int kNodes = 3;

constexpr double kQuarterToSigma = 3.138;  // a quarter of normal errors are smaller than sigma / 3.138

// Nodes at the ends of an interval belong to it, not to its neighbours, however their times are rounded.
constexpr std::array<double, kNodes> kNodeAt = {1e-9, 0.5, 1.0 - 1e-9};

/// Lagrange's polynomials of the nodes at x in [0, 1].
std::array<double, kNodes> node_weights(double x) {
  return {2.0 * (x - 0.5) * (x - 1.0), -4.0 * x * (x - 1.0), 2.0 * x * (x - 0.5)};
}

/// Rows of the cell in what a node holds: velocity, and angular velocity where sensors have lever arms.
Vector6d motion_row(const DopplerCell& cell) {
  Vector6d row;
  row << -cell.u, -cell.lxu;
  return row;
}

}  // namespace

DopplerTerms::DopplerTerms(const std::vector<DopplerCell>& cells, const std::vector<FieldColumns>& columns,
                           const DopplerState& state, double stamp_s, double cell_variance, bool has_lever_arms,
                           const Workers& workers)
    : stamp_s_(stamp_s),
      per_node_(has_lever_arms ? 6 : 3),
      N_theta_(Eigen::MatrixXd::Zero(state.theta.size(), state.theta.size())),
      b_theta_(Eigen::VectorXd::Zero(state.theta.size())),
      N_theta_scan_(Eigen::VectorXd::Zero(state.theta.size())) {
  const SplineTrajectory& trajectory = state.trajectory;
  intervals_.resize(trajectory.coefficients().size() - 3);
  const std::vector<double> w = weights(cells, columns, state, cell_variance, workers);
  std::vector<std::vector<std::uint32_t>> members(intervals_.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (w[k] > 0.0) {
      members[trajectory.interval(stamp_s_ + cells[k].time_s)].push_back(static_cast<std::uint32_t>(k));
    }
  }
  const double h = trajectory.knot_spacing();
  const auto sum_intervals = [&](std::size_t number) {
    const double begin_s = trajectory.interval_begin(number);
    if (has_lever_arms) {
      sum_interval<6 * kNodes>(cells, columns, w, members[number], begin_s, h, intervals_[number]);
    } else {
      sum_interval<3 * kNodes>(cells, columns, w, members[number], begin_s, h, intervals_[number]);
    }
  };
  workers.both([&] { sum_field(cells, columns, w); }, [&] { workers.for_each(intervals_.size(), 1, sum_intervals); });
  std::erase_if(intervals_, [](const Interval& interval) { return interval.b.size() == 0; });
}

/// The kernel's weight of each cell by how far it is from what is expected of it, against how far most of them are;
/// over its variance.
std::vector<double> DopplerTerms::weights(const std::vector<DopplerCell>& cells,
                                          const std::vector<FieldColumns>& columns, const DopplerState& state,
                                          double cell_variance, const Workers& workers) {
  if (cells.empty()) {
    return {};
  }
  std::vector<double> scaled = residuals(cells, columns, state, workers);
  std::vector<double> size(cells.size());
  std::vector<double> w(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double variance = 1.0 / cells[k].weight + cell_variance;
    scaled[k] /= std::sqrt(variance);
    size[k] = std::abs(scaled[k]);
    w[k] = 1.0 / variance;
  }
  const double reach = kDopplerKernel * std::max(1.0, kQuarterToSigma * quantile(size, 0.25));
  robust_.resize(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double inside = std::max(0.0, 1.0 - scaled[k] * scaled[k] / (reach * reach));
    robust_[k] = inside * inside;
    w[k] *= robust_[k];
  }
  return w;
}

/// The sums of all cells with the weights w in which the motion does not occur.
void DopplerTerms::sum_field(const std::vector<DopplerCell>& cells, const std::vector<FieldColumns>& columns,
                             const std::vector<double>& w) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (w[k] <= 0.0) {
      continue;
    }
    N_scan_ += w[k];
    b_scan_ += w[k] * cells[k].s;
    const FieldColumns& of = columns[k];
    for (std::size_t i = 0; i < of.size; ++i) {
      const double wi = w[k] * of.value[i];
      const Eigen::Index at = of.index[i];
      b_theta_[at] += wi * cells[k].s;
      N_theta_scan_[at] += wi;
      for (std::size_t j = i; j < of.size; ++j) {  // in the order of theta: the lower triangle
        N_theta_(of.index[j], at) += wi * of.value[j];
      }
    }
  }
}

/// The others of one knot interval.
template <int nodes>
void DopplerTerms::sum_interval(const std::vector<DopplerCell>& cells, const std::vector<FieldColumns>& columns,
                                const std::vector<double>& w, const std::vector<std::uint32_t>& members, double begin_s,
                                double h, Interval& interval) const {
  if (members.empty()) {
    return;
  }
  constexpr int kPerNode = nodes / kNodes;
  using Nodes = Eigen::Matrix<double, nodes, 1>;
  Eigen::Matrix<double, nodes, nodes> N = Eigen::Matrix<double, nodes, nodes>::Zero();
  Eigen::Matrix<double, nodes, Eigen::Dynamic> N_theta;
  N_theta.setZero(nodes, N_theta_.cols());
  Nodes b = Nodes::Zero();
  Nodes N_scan = Nodes::Zero();
  for (const std::uint32_t k : members) {
    const std::array<double, kNodes> L = node_weights((stamp_s_ + cells[k].time_s - begin_s) / h);
    const Vector6d row = motion_row(cells[k]);
    Nodes a;
    for (int n = 0; n < kNodes; ++n) {
      a.template segment<kPerNode>(n * kPerNode) = L[static_cast<std::size_t>(n)] * row.head<kPerNode>();
    }
    const Nodes wa = w[k] * a;
    N.noalias() += wa * a.transpose();
    b += cells[k].s * wa;
    N_scan += wa;
    for (std::size_t i = 0; i < columns[k].size; ++i) {
      N_theta.col(columns[k].index[i]) += columns[k].value[i] * wa;
    }
  }
  interval.middle_s = begin_s + 0.5 * h;
  interval.N = N;
  interval.N_theta = N_theta;
  interval.b = b;
  interval.N_scan = N_scan;
}

void DopplerTerms::linearise(const SplineTrajectory& trajectory) {
  for (Interval& interval : intervals_) {
    Eigen::MatrixXd& T = interval.by_coefficients;
    T = Eigen::MatrixXd::Zero(interval.b.size(), 24);
    for (int n = 0; n < kNodes; ++n) {
      const TrajectoryPoint at = trajectory.at(node_time(interval, static_cast<std::size_t>(n), trajectory));
      interval.first = at.first;
      const Eigen::Index row = n * per_node_;
      const Eigen::Matrix3d by_rotation = skew(at.velocity) * at.J;
      const Eigen::Matrix3d R_transposed = at.R.transpose();
      for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Index column = 6 * static_cast<Eigen::Index>(k);
        T.block<3, 3>(row, column) = at.weight[k] * by_rotation;
        T.block<3, 3>(row, column + 3) = at.slope[k] * R_transposed;
        if (per_node_ == 6) {
          T.block<3, 3>(row + 3, column) = at.slope[k] * at.J + 0.5 * at.weight[k] * skew(at.omega);
        }
      }
    }
  }
}

double DopplerTerms::node_time(const Interval& interval, std::size_t node, const SplineTrajectory& trajectory) {
  return interval.middle_s + (kNodeAt[node] - 0.5) * trajectory.knot_spacing();
}

Eigen::VectorXd DopplerTerms::motion_at_nodes(const Interval& interval, const SplineTrajectory& trajectory) const {
  Eigen::VectorXd y(interval.b.size());
  for (int n = 0; n < kNodes; ++n) {
    const TrajectoryPoint at = trajectory.at(node_time(interval, static_cast<std::size_t>(n), trajectory));
    const Eigen::Index row = n * per_node_;
    y.segment<3>(row) = at.velocity;
    if (per_node_ == 6) {
      y.segment<3>(row + 3) = at.omega;
    }
  }
  return y;
}

/// How what is seen depends on the error that all of a scan have in common.
Eigen::VectorXd DopplerTerms::scan_column(const Layout& layout) const {
  Eigen::VectorXd U = Eigen::VectorXd::Zero(layout.size());
  U.head(layout.field) = N_theta_scan_;
  for (const Interval& interval : intervals_) {
    U.segment(layout.coefficient(interval.first), 24) += interval.by_coefficients.transpose() * interval.N_scan;
  }
  return U;
}

void DopplerTerms::add_information(const Layout& layout, double scan_variance, Eigen::MatrixXd& H) const {
  const Eigen::Index fields = layout.field;
  H.topLeftCorner(fields, fields) += N_theta_;
  for (const Interval& interval : intervals_) {
    const Eigen::Index first = layout.coefficient(interval.first);
    const Eigen::MatrixXd& T = interval.by_coefficients;
    const Eigen::MatrixXd TN = T.transpose() * interval.N;
    H.block(first, first, 24, 24).noalias() += TN * T;
    H.block(first, 0, 24, fields).noalias() += T.transpose() * interval.N_theta;
  }
  const Eigen::Index head = layout.head();
  const Eigen::VectorXd U = scan_column(layout).head(head) / std::sqrt(N_scan_ + 1.0 / scan_variance);
  H.topLeftCorner(head, head).selfadjointView<Eigen::Lower>().rankUpdate(U, -1.0);
}

DopplerTerms::ScanError DopplerTerms::add_gradient(const SplineTrajectory& trajectory, const Eigen::VectorXd& theta,
                                                   const Layout& layout, double scan_variance,
                                                   Eigen::VectorXd& g) const {
  g.head(layout.field) += N_theta_.selfadjointView<Eigen::Lower>() * theta - b_theta_;
  double gradient = N_theta_scan_.dot(theta) - b_scan_;
  for (const Interval& interval : intervals_) {
    const Eigen::VectorXd y = motion_at_nodes(interval, trajectory);
    const Eigen::VectorXd residual = interval.N * y + interval.N_theta * theta - interval.b;
    g.segment(layout.coefficient(interval.first), 24) += interval.by_coefficients.transpose() * residual;
    g.head(layout.field) += interval.N_theta.transpose() * y;
    gradient += interval.N_scan.dot(y);
  }
  const double variance = 1.0 / (N_scan_ + 1.0 / scan_variance);
  const Eigen::VectorXd U = scan_column(layout);
  g -= (variance * gradient) * U;
  return {-variance * gradient, variance, variance * U};
}

/// What is not explained of each cell.
std::vector<double> DopplerTerms::residuals(const std::vector<DopplerCell>& cells,
                                            const std::vector<FieldColumns>& columns, const DopplerState& state,
                                            const Workers& workers) const {
  const auto [first, last] = std::minmax_element(
      cells.begin(), cells.end(), [](const DopplerCell& a, const DopplerCell& b) { return a.time_s < b.time_s; });
  const SampledMotion motion(state.trajectory, stamp_s_ + first->time_s, stamp_s_ + last->time_s);
  std::vector<double> result(cells.size());
  workers.for_each(cells.size(), kTermBlock, [&](std::size_t k) {
    const DopplerCell& cell = cells[k];
    const double time_s = stamp_s_ + cell.time_s;
    result[k] = cell.s + cell.u.dot(motion.velocity(time_s)) - columns[k].dot(state.theta) - state.scan_error_mps;
    if (per_node_ == 6) {
      result[k] += cell.lxu.dot(motion.omega(time_s));
    }
  });
  return result;
}

double DopplerTerms::unexplained_variance(const std::vector<DopplerCell>& cells,
                                          const std::vector<FieldColumns>& columns, const DopplerState& state,
                                          const Workers& workers) const {
  if (cells.empty()) {
    return 0.0;
  }
  const std::vector<double> unexplained = residuals(cells, columns, state, workers);
  double sum = 0.0;
  double counts = 0.0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double e = unexplained[k];
    sum += robust_[k] * (e * e - 1.0 / cells[k].weight);
    counts += robust_[k];
  }
  return counts > 0.0 ? std::max(0.0, sum / counts) : 0.0;
}

}  // namespace dynamic_icp::window
