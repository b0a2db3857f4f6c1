// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/window/doppler_error_field.hpp"
#include "dynamic_icp/method/window/spline_trajectory.hpp"

namespace dynamic_icp::window {

/// How the unknowns stand in the vectors and matrices of the window: [theta; map error; stamp errors; coefficients;
/// vibration].
struct Layout {
  /// The map errs by a rigid displacement [rotation; position] that changes with the phase of the sweep in which its
  /// patches were measured: linearly between so many phases, the first and the last among them. Wheels hop once within
  /// a sweep, and the map takes that in.
  static constexpr Eigen::Index kMapNodes = 5;
  static constexpr Eigen::Index kMapError = 6 * kMapNodes;

  static constexpr Eigen::Index kStamps = 2;  ///< s, error of the stamp of the scan before and of the one at hand
  static constexpr Eigen::Index kBefore = kMapError + kStamps;  ///< what stands between theta and the coefficients

  /// The prior joins the motion of so many coefficients with the next one: only their vibration depends on anything but
  /// the motion prior, because what was known of dropped coefficients passes to it.
  static constexpr Eigen::Index kJoined = 3;

  Eigen::Index field = 0;         ///< size of theta
  Eigen::Index coefficients = 0;  ///< number of coefficients, six unknowns each
  bool vibrates = false;          ///< each coefficient has six more: how far the vibration moved it

  [[nodiscard]] Eigen::Index map_error() const { return field; }
  [[nodiscard]] Eigen::Index map_node(std::size_t j) const { return field + 6 * static_cast<Eigen::Index>(j); }
  [[nodiscard]] Eigen::Index last_stamp() const { return field + kMapError; }
  [[nodiscard]] Eigen::Index stamp() const { return field + kMapError + 1; }
  [[nodiscard]] Eigen::Index coefficient(std::size_t k) const {
    return field + kBefore + 6 * static_cast<Eigen::Index>(k);
  }
  [[nodiscard]] Eigen::Index vibration(std::size_t k) const { return coefficient(k) + 6 * coefficients; }
  [[nodiscard]] Eigen::Index size() const { return field + kBefore + (vibrates ? 12 : 6) * coefficients; }
  /// Without the tail: the vibration that the motion prior alone knows of.
  [[nodiscard]] Eigen::Index head() const {
    return field + kBefore + 6 * coefficients + (vibrates ? 6 * std::min(kJoined, coefficients) : 0);
  }
};

/// What the Doppler depends on.
struct DopplerState {
  const SplineTrajectory& trajectory;
  const Eigen::VectorXd& theta;
  double scan_error_mps = 0.0;  ///< what all values of the scan have in common
};

/// The Doppler of one scan as normal equations in the motion at three nodes of each knot interval and in theta:
///   s = -u . v(t) - (l x u) . omega(t) + Phi theta + e,
/// v and omega quadratic in t between the nodes. The points are read once: relinearising the trajectory costs nothing
/// but the chain rule from the nodes to its coefficients.
class DopplerTerms {
 public:
  /// `columns` of the error field for each cell. `cell_variance` (m/s)^2 is what the points of a cell have in common.
  /// Cells have times after `stamp_s`. Those far from what the state says, against how far most are, move by
  /// themselves and have no weight.
  DopplerTerms(const std::vector<DopplerCell>& cells, const std::vector<FieldColumns>& columns,
               const DopplerState& state, double stamp_s, double cell_variance, bool has_lever_arms,
               const Workers& workers);

  /// The error that all Doppler values of the scan have in common, N(0, `scan_variance`) (m/s)^2: it is eliminated.
  struct ScanError {
    double value = 0.0;           ///< m/s
    double variance = 0.0;        ///< given the rest, (m/s)^2
    Eigen::VectorXd by_unknowns;  ///< d value / d unknowns of the window, negative
  };

  /// How the terms depend on the trajectory, from now on: that of `trajectory`. In theta they are linear.
  void linearise(const SplineTrajectory& trajectory);

  /// Adds their information to the lower triangle of H.
  void add_information(const Layout& layout, double scan_variance, Eigen::MatrixXd& H) const;

  /// Adds their gradient: of the residuals at this state, by the rows as linearised. A gradient by other rows would ask
  /// for large steps where the information says that nothing is known.
  ScanError add_gradient(const SplineTrajectory& trajectory, const Eigen::VectorXd& theta, const Layout& layout,
                         double scan_variance, Eigen::VectorXd& g) const;

  /// Variance that cells show beyond the noise of their points, (m/s)^2, robust; at the given state.
  [[nodiscard]] double unexplained_variance(const std::vector<DopplerCell>& cells,
                                            const std::vector<FieldColumns>& columns, const DopplerState& state,
                                            const Workers& workers) const;

 private:
  /// What one knot interval sees.
  struct Interval {
    double middle_s = 0.0;
    Eigen::MatrixXd N;        ///< nodes x nodes
    Eigen::MatrixXd N_theta;  ///< nodes x theta
    Eigen::VectorXd b;
    Eigen::VectorXd N_scan;           ///< nodes x error of the scan
    Eigen::MatrixXd by_coefficients;  ///< d nodes / d the four coefficients there
    std::size_t first = 0;            ///< of these coefficients
  };

  [[nodiscard]] std::vector<double> weights(const std::vector<DopplerCell>& cells,
                                            const std::vector<FieldColumns>& columns, const DopplerState& state,
                                            double cell_variance, const Workers& workers);
  void sum_field(const std::vector<DopplerCell>& cells, const std::vector<FieldColumns>& columns,
                 const std::vector<double>& w);
  template <int nodes>
  void sum_interval(const std::vector<DopplerCell>& cells, const std::vector<FieldColumns>& columns,
                    const std::vector<double>& w, const std::vector<std::uint32_t>& members, double begin_s, double h,
                    Interval& interval) const;
  [[nodiscard]] static double node_time(const Interval& interval, std::size_t node, const SplineTrajectory& trajectory);
  [[nodiscard]] Eigen::VectorXd motion_at_nodes(const Interval& interval, const SplineTrajectory& trajectory) const;
  [[nodiscard]] Eigen::VectorXd scan_column(const Layout& layout) const;
  [[nodiscard]] std::vector<double> residuals(const std::vector<DopplerCell>& cells,
                                              const std::vector<FieldColumns>& columns, const DopplerState& state,
                                              const Workers& workers) const;

  double stamp_s_ = 0.0;
  std::vector<double> robust_;  ///< weight of each cell by the kernel
  Eigen::Index per_node_ = 3;
  std::vector<Interval> intervals_;
  Eigen::MatrixXd N_theta_;  ///< the lower triangle
  Eigen::VectorXd b_theta_;
  Eigen::VectorXd N_theta_scan_;  ///< theta x error of the scan
  double N_scan_ = 0.0;
  double b_scan_ = 0.0;
};

}  // namespace dynamic_icp::window
