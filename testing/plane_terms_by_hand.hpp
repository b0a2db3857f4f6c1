// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/window/plane_terms.hpp"

// For tests of plane terms.
namespace dynamic_icp::window::by_hand {

inline constexpr double kStamp_s = 5.003;
inline constexpr double kBendInCommon = 0.4;
inline constexpr double kTiltOfModel = 0.3;

/// The terms written out point by point; weights and patches stay as they are at the first state.
struct Definition {
  const Scan& scan;
  SplineTrajectory trajectory;
  Eigen::VectorXd map_error;
  double model_variance;
  LastSweep last = {};
  std::vector<Vector6d> coefficients = {};  ///< where the last sweep was displaced as `last` says
  double map_scans = 0.0;
  double stamp_s = kStamp_s;
  std::vector<const mapping::Patch*> patches;
  Eigen::VectorXd weights;
  Eigen::VectorXd robust;

  Definition(const Scan& points, const mapping::PlaneMap& map, const SplineTrajectory& at, const Eigen::VectorXd& error,
             const PlaneNoise& noise, bool adapt, const Matrix6d& displacement = Matrix6d::Zero(),
             const LastSweep& last_sweep = {})
      : scan(points),
        trajectory(at),
        map_error(error),
        model_variance(std::pow(noise.model_sigma_m, 2)),
        last(last_sweep),
        coefficients(at.coefficients()),
        map_scans(map.scans()) {
    std::map<const mapping::Patch*, double> members;
    std::map<const mapping::Patch*, double> precision;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      patches.push_back(map.find(in_map(i)));
      if (const mapping::Patch* patch = patches.back(); patch != nullptr) {
        ++members[patch];
        precision[patch] += 1.0 / (patch->plane.height_variance(in_map(i)) + std::pow(noise.model_sigma_m, 2) +
                                   kBendInCommon * patch->plane.bend);
      }
    }
    const Eigen::VectorXd e = residuals();
    const Eigen::MatrixXd m = by_rigid_motion();
    const Eigen::VectorXd displaced = (m * displacement).cwiseProduct(m).rowwise().sum();
    const auto size = static_cast<Eigen::Index>(scan.size());
    Eigen::VectorXd own = Eigen::VectorXd::Ones(size);
    Eigen::VectorXd common = Eigen::VectorXd::Zero(size);
    std::vector<double> scaled;
    for (Eigen::Index i = 0; i < size; ++i) {
      if (const mapping::Patch* patch = patches[static_cast<std::size_t>(i)]; patch != nullptr) {
        own[i] = std::max(patch->plane.variance, std::pow(noise.min_sigma_m, 2));
        common[i] = members[patch] / precision[patch];
        scaled.push_back(std::abs(e[i]) / std::sqrt(own[i] + common[i] + displaced[i]));
      }
    }
    const double kernel = noise.kernel * (adapt ? std::max(1.0, 1.4826 * median(scaled)) : 1.0);
    weights = robust = Eigen::VectorXd::Zero(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const mapping::Patch* patch = patches[static_cast<std::size_t>(i)];
      if (patch != nullptr) {
        const double variance = own[i] + common[i] + displaced[i];
        const double inside = std::max(0.0, 1.0 - e[i] * e[i] / (kernel * kernel * variance));
        robust[i] = inside * inside;
        weights[i] = robust[i] / (own[i] + members[patch] * noise.repeated * common[i]);
      }
    }
  }

  [[nodiscard]] Eigen::Vector3d in_map(std::size_t i) const {
    return trajectory.pose(stamp_s + scan.times()[i]) * scan.points()[i];
  }

  [[nodiscard]] Eigen::Vector3d normal(std::size_t i) const {
    return trajectory.reference().linear().transpose() * patches[i]->plane.normal;
  }

  /// Of the last sweep in the error of the patch under a point.
  [[nodiscard]] double recent_share(std::size_t i) const {
    const double age = patches[i] != nullptr ? map_scans - patches[i]->plane.scan : 0.0;
    return last.map_age > 0.0 ? std::max(0.0, 1.0 - age / last.map_age) : 0.0;
  }

  [[nodiscard]] Eigen::VectorXd recent_shares() const {
    return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(scan.size()),
                                        [&](Eigen::Index i) { return recent_share(static_cast<std::size_t>(i)); });
  }

  /// n . (p(t) + R(t) x - m) - n . (d_p + d_phi x X)
  [[nodiscard]] Eigen::VectorXd residuals() const {
    Eigen::VectorXd e = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scan.size()));
    Vector6d d_last = last.displacement;
    for (Eigen::Index k = 0; k < last.rows.cols() / 6; ++k) {
      const auto at = static_cast<std::size_t>(k);
      d_last += last.rows.middleCols<6>(6 * k) * (trajectory.coefficients()[at] - coefficients[at]);
    }
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (patches[i] == nullptr) {
        continue;
      }
      const Eigen::Vector3d X = trajectory.reference().inverse() * in_map(i);
      Vector6d d = Vector6d::Zero();  // hats around the nodes
      for (Eigen::Index node = 0; node < Layout::kMapNodes; ++node) {
        const double apart = std::abs(patches[i]->plane.phase * (Layout::kMapNodes - 1.0) - static_cast<double>(node));
        d += std::max(0.0, 1.0 - apart) * map_error.segment<6>(6 * node);
      }
      d = (1.0 - recent_share(i)) * d + recent_share(i) * d_last;
      e[static_cast<Eigen::Index>(i)] =
          patches[i]->plane.distance(in_map(i)) -
          normal(i).dot(Eigen::Vector3d(d.tail<3>()) + Eigen::Vector3d(d.head<3>()).cross(X));
    }
    return e;
  }

  [[nodiscard]] Layout layout() const { return {3, static_cast<Eigen::Index>(trajectory.coefficients().size())}; }

  [[nodiscard]] Eigen::MatrixXd jacobian() const {
    constexpr double kStep = 1e-6;
    const Layout at = layout();
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(scan.size()), at.size());
    Definition moved = *this;
    const auto differentiate = [&](double& unknown, Eigen::Index column) {
      const double value = unknown;
      unknown = value + kStep;
      J.col(column) = moved.residuals();
      unknown = value - kStep;
      J.col(column) = (J.col(column) - moved.residuals()) / (2.0 * kStep);
      unknown = value;
    };
    for (Eigen::Index k = 0; k < Layout::kMapError; ++k) {
      differentiate(moved.map_error[k], at.map_error() + k);
    }
    differentiate(moved.stamp_s, at.stamp());
    for (std::size_t k = 0; k < trajectory.coefficients().size(); ++k) {
      for (Eigen::Index axis = 0; axis < 6; ++axis) {
        differentiate(moved.trajectory.coefficients()[k][axis], at.coefficient(k) + axis);
      }
    }
    return J;
  }

  /// [X x n; n] of each point: how its residual changes with a rigid motion of all.
  [[nodiscard]] Eigen::MatrixXd by_rigid_motion() const {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(scan.size()), 6);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (patches[i] != nullptr) {
        const Eigen::Vector3d X = trajectory.reference().inverse() * in_map(i);
        m.row(static_cast<Eigen::Index>(i)) << X.cross(normal(i)).transpose(), normal(i).transpose();
      }
    }
    return m;
  }

  /// Sum of w times the covariance of these rows by the noise of the normals.
  [[nodiscard]] Matrix6d noise_of_normals() const {
    Matrix6d sum = Matrix6d::Zero();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (patches[i] != nullptr) {
        const mapping::Plane& plane = patches[i]->plane;
        Eigen::Matrix<double, 6, 3> A;
        A << skew(trajectory.reference().inverse() * in_map(i)), Eigen::Matrix3d::Identity();
        A = A * trajectory.reference().linear().transpose();
        const double variance = plane.variance / plane.points + kTiltOfModel * model_variance;
        sum += weights[static_cast<Eigen::Index>(i)] * variance * A * plane.tangential * A.transpose();
      }
    }
    return sum;
  }
};

}  // namespace dynamic_icp::window::by_hand
