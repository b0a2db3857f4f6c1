// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace dynamic_icp::mapping {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Point-to-plane residuals of some points at a pose, in columns.
///
/// A point p of the scan lies at arm = R p in map axes from the sensor, on a plane with the normal n. With r = arm x n
/// a step of [rotation; position; omega; alpha] changes its residual e by [r; n; tau R^T r; tau^2/2 R^T r]: a turn of
/// the sensor by d(tau) in its own axes moves the point by d x p.
struct PlaneRows {
  static constexpr std::size_t kMost = 512;
  using Column = std::array<double, kMost>;

  std::size_t size = 0;
  std::array<Column, 3> r;  ///< m
  std::array<Column, 3> n;  ///< unit
  Column tau;               ///< s after the stamp
  Column e;                 ///< m
  Column own;               ///< m^2, variance of the point alone
  Column common;            ///< m^2, variance of the patch under it, which all points on the patch share
  Column members;           ///< how many points the patch has
};

/// Normal equations of [rotation; position; omega; alpha] and how well the points fit.
struct PlaneSums {
  Matrix12d H = Matrix12d::Zero();
  Vector12d b = Vector12d::Zero();
  double weights = 0.0;      ///< sum of the kernel's weights
  double squares = 0.0;      ///< m^2, sum of e^2 with those
  double chi_squares = 0.0;  ///< the same over the predicted variances

  PlaneSums& operator+=(const PlaneSums& other);
};

/// How the rows are weighted: with Tukey's kernel, `kernel` standard deviations wide and at least `gate_m`.
struct PlaneWeights {
  double kernel = 3.0;
  double gate_m = 0.0;
};

/// The weights of some rows.
struct RowWeights {
  PlaneRows::Column robust;  ///< kernel(e)
  PlaneRows::Column w;       ///< kernel(e) / (own + members common), 1/m^2
};

void weigh(const PlaneRows& rows, const PlaneWeights& weights, RowWeights& result);

/// Sums over rows, each with its weight. `R_map_sensor` is R above; without times tau does not count and the sums of
/// omega and alpha stay zero. The same bits for every instruction set.
PlaneSums sum_planes(const PlaneRows& rows, const Eigen::Matrix3d& R_map_sensor, bool has_times,
                     const PlaneWeights& weights);

}  // namespace dynamic_icp::mapping
