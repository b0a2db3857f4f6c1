// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <Eigen/Cholesky>

#include "dynamic_icp/method/window/plane_terms.hpp"

// What plane terms add to the normal equations of a scan.
namespace dynamic_icp::window {
namespace {

/// m -> the change of the residual with [phi; p].
Matrix6d by_coefficients(const TrajectoryPoint& at) {
  Matrix6d M = Matrix6d::Identity();
  const Eigen::Matrix3d JR = at.J.transpose() * at.R.transpose();
  M.topLeftCorner<3, 3>() = JR;
  M.topRightCorner<3, 3>() = -JR * skew(at.p);
  return M;
}

/// A later stamp moves the points of the slice as the sensor moves: m . [omega; velocity of the origin].
Vector6d along_motion(const TrajectoryPoint& at) {
  Vector6d along;
  along.head<3>() = at.R * at.omega;
  along.tail<3>() = at.R * at.velocity - Eigen::Vector3d(along.head<3>()).cross(at.p);
  return along;
}

}  // namespace

/// The terms of one slice, had map and pointing no error of their own.
void PlaneTerms::add_slice(const Slice& slice, const Layout& layout, Eigen::MatrixXd& H, Eigen::VectorXd& g) {
  const Matrix6d M = by_coefficients(slice.at);
  const Matrix6d S = slice.sums.S();
  const Vector6d E = slice.sums.E();
  const Matrix6d MSM = M * S * M.transpose();
  const Vector6d ME = M * E;
  const Vector6d along = along_motion(slice.at);
  const Vector6d S_along = S * along;
  const Vector6d M_along = M * S_along;
  const Eigen::Index stamp = layout.stamp();
  H(stamp, stamp) += along.dot(S_along);
  g[stamp] += along.dot(E);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Index row = layout.coefficient(slice.at.first + i);
    const double wi = slice.at.weight[i];
    for (std::size_t j = 0; j <= i; ++j) {
      H.block<6, 6>(row, layout.coefficient(slice.at.first + j)) += (wi * slice.at.weight[j]) * MSM;
    }
    H.block<6, 1>(row, stamp) += wi * M_along;
    g.segment<6>(row) += wi * ME;
  }
  for (std::size_t j = 0; j < PlaneSums::kMapNodes; ++j) {
    const Matrix6d S_node = slice.sums.S(j);
    const Matrix6d MS_node = M * S_node;
    const Eigen::Index d = layout.map_node(j);
    H.block<6, 6>(d, d) += slice.sums.LL(j);
    if (j + 1 < PlaneSums::kMapNodes) {
      H.block<6, 6>(layout.map_node(j + 1), d) += slice.sums.LL_next(j);
    }
    g.segment<6>(d) -= slice.sums.E(j);
    H.block<1, 6>(stamp, d) -= (S_node * along).transpose();
    for (std::size_t i = 0; i < 4; ++i) {
      H.block<6, 6>(layout.coefficient(slice.at.first + i), d) -= slice.at.weight[i] * MS_node;
    }
  }
}

/// What patches have to do with the last sweep.
void PlaneTerms::add_last_sweep(const Layout& layout, Eigen::MatrixXd& H, Eigen::VectorXd& g) const {
  const Eigen::Index first = layout.coefficient(0);
  const Eigen::Index n = last_.rows.cols();
  Eigen::MatrixXd now = Eigen::MatrixXd::Zero(n, 6);
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(Layout::kMapError, 6);
  Vector6d stamp = Vector6d::Zero();
  Matrix6d rr = Matrix6d::Zero();
  Vector6d E = Vector6d::Zero();
  for (const Slice& slice : slices_) {
    const Matrix6d S = slice.sums.S_recent();
    const Matrix6d MS = by_coefficients(slice.at) * S;
    for (std::size_t i = 0; i < 4; ++i) {
      now.middleRows<6>(layout.coefficient(slice.at.first + i) - first) += slice.at.weight[i] * MS;
    }
    for (std::size_t j = 0; j < PlaneSums::kMapNodes; ++j) {
      map.middleRows<6>(layout.map_node(j) - layout.map_error()) += slice.sums.Lr(j);
    }
    stamp += S * along_motion(slice.at);
    rr += slice.sums.rr();
    E += slice.sums.E_recent();
  }
  const Eigen::MatrixXd by_now = now * last_.rows;
  auto of_coefficients = H.block(first, first, n, n);
  of_coefficients += last_.rows.transpose() * rr * last_.rows - by_now - by_now.transpose();
  H.block(first, layout.map_error(), n, Layout::kMapError) += last_.rows.transpose() * map.transpose();
  H.block(first, layout.stamp(), n, 1) -= last_.rows.transpose() * stamp;
  g.segment(first, n) -= last_.rows.transpose() * E;
}

PlaneTerms::Common PlaneTerms::common(const Layout& layout) const {
  using ByCommon = Eigen::Matrix<double, 6, kCommon>;  // sum of w m by what is common
  Common common{Eigen::MatrixXd::Zero(layout.size(), kCommon), CommonVector::Zero()};
  ByCommon recent = ByCommon::Zero();
  for (const Slice& slice : slices_) {
    if (slice.matched <= 0.0) {
      continue;
    }
    const PlaneSums& sums = slice.sums;
    ByCommon all;
    all << sums.S_recent() * motions_, sums.rr() * motions_, sums.P_recent();
    recent += all;
    for (std::size_t j = 0; j < PlaneSums::kMapNodes; ++j) {
      ByCommon of_node;
      of_node << sums.S(j) * motions_, sums.Lr(j) * motions_, sums.P(j);
      common.U.middleRows<6>(layout.map_node(j)) -= of_node;
      all += of_node;
    }
    const ByCommon of_coefficients = by_coefficients(slice.at) * all;
    for (std::size_t i = 0; i < 4; ++i) {
      common.U.middleRows<6>(layout.coefficient(slice.at.first + i)) += slice.at.weight[i] * of_coefficients;
    }
    common.U.row(layout.stamp()) += along_motion(slice.at).transpose() * all;
    common.gradient.head<12>() += along_displacements(sums.E(), sums.E_recent());
    common.gradient.tail<2>() += sums.PE();
  }
  common.U.middleRows(layout.coefficient(0), last_.rows.cols()) -= last_.rows.transpose() * recent;
  return common;
}

void PlaneTerms::add(const Layout& layout, Eigen::MatrixXd& H, Eigen::VectorXd& g) const {
  for (const Slice& slice : slices_) {
    if (slice.matched > 0.0) {
      add_slice(slice, layout, H, g);
    }
  }
  if (last_.map_age > 0.0) {
    add_last_sweep(layout, H, g);
  }
  auto [U, gradient] = common(layout);
  const Eigen::LLT<CommonMatrix> information(common_information_);
  information.matrixU().solveInPlace<Eigen::OnTheRight>(U);
  information.matrixL().solveInPlace(gradient);
  const Eigen::Index first = layout.map_error();
  const Eigen::Index n = layout.head() - first;  // the vibration moves nothing
  H.block(first, first, n, n).selfadjointView<Eigen::Lower>().rankUpdate(U.middleRows(first, n), -1.0);
  g.noalias() -= U * gradient;
}

PlaneTerms::ScanPointing PlaneTerms::scan_pointing(const Layout& layout) const {
  const Common in_common = common(layout);
  const CommonMatrix covariance = common_information_.llt().solve(CommonMatrix::Identity());
  return {(covariance * in_common.gradient).tail<2>(), covariance.diagonal().tail<2>(),
          in_common.U * covariance.rightCols<2>()};
}

}  // namespace dynamic_icp::window
