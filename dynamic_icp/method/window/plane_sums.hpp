// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/window/doppler_terms.hpp"

namespace dynamic_icp::window {

/// A point beside its plane: e = m . (motion - error of the map) + J . pointing + noise.
struct PlaneRow {
  Vector6d m = Vector6d::Zero();                ///< [X x n; n], reference frame
  Eigen::Vector2d J = Eigen::Vector2d::Zero();  ///< of the residual by azimuth and elevation, m/rad
  double e = 0.0;                               ///< m
  double w = 0.0;                               ///< 1/m^2
  std::size_t node = 0;                         ///< of the map's error, at the phase of the patch or before
  double beyond = 0.0;                          ///< its distance from there, as a share of that between nodes
  double recent = 0.0;                          ///< share of the last sweep, not of the map, in the error of the patch
};

/// Sums over the points of a slice of time. They stand for the points in all steps of the solution. Each node of the
/// map's error (Layout::kMapNodes) has the share L, a hat over the phase times 1 - r, in the error of a patch, and the
/// last sweep the share r.
class PlaneSums {
 public:
  static constexpr auto kMapNodes = static_cast<std::size_t>(Layout::kMapNodes);
  using Pointing = Eigen::Matrix<double, 6, 2>;

  void clear() { *this = PlaneSums(); }
  void add(const PlaneRow& row);

  [[nodiscard]] const Matrix6d& LL(std::size_t node) const { return LL_[node]; }            ///< sum of w L^2 m m^T
  [[nodiscard]] const Matrix6d& LL_next(std::size_t node) const { return LL_next_[node]; }  ///< with L of the next node
  [[nodiscard]] Matrix6d S(std::size_t node) const;                                         ///< sum of w L m m^T
  [[nodiscard]] const Matrix6d& Lr(std::size_t node) const { return Lr_[node]; }            ///< sum of w L r m m^T
  [[nodiscard]] const Matrix6d& rr() const { return rr_; }                                  ///< sum of w r^2 m m^T
  [[nodiscard]] Matrix6d S_recent() const;                                                  ///< sum of w r m m^T
  [[nodiscard]] const Vector6d& E_recent() const { return E_recent_; }                      ///< sum of w r e m
  [[nodiscard]] const Pointing& P_recent() const { return P_recent_; }                      ///< sum of w r m J^T
  [[nodiscard]] const Vector6d& E(std::size_t node) const { return E_[node]; }              ///< sum of w L e m
  [[nodiscard]] const Pointing& P(std::size_t node) const { return P_[node]; }              ///< sum of w L m J^T
  [[nodiscard]] Matrix6d S() const;                                                         ///< sum of w m m^T
  [[nodiscard]] Vector6d E() const;                                                         ///< sum of w e m
  [[nodiscard]] Pointing P() const;                                                         ///< sum of w m J^T
  [[nodiscard]] const Eigen::Matrix2d& PP() const { return PP_; }                           ///< sum of w J J^T
  [[nodiscard]] const Eigen::Vector2d& PE() const { return PE_; }                           ///< sum of w e J

 private:
  std::array<Matrix6d, kMapNodes> LL_{filled<Matrix6d, kMapNodes>()};
  std::array<Matrix6d, kMapNodes - 1> LL_next_{filled<Matrix6d, kMapNodes - 1>()};
  std::array<Matrix6d, kMapNodes> Lr_{filled<Matrix6d, kMapNodes>()};
  Matrix6d rr_ = Matrix6d::Zero();
  Vector6d E_recent_ = Vector6d::Zero();
  Pointing P_recent_ = Pointing::Zero();
  std::array<Vector6d, kMapNodes> E_{filled<Vector6d, kMapNodes>()};
  std::array<Pointing, kMapNodes> P_{filled<Pointing, kMapNodes>()};
  Eigen::Matrix2d PP_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d PE_ = Eigen::Vector2d::Zero();

  template <typename Matrix, std::size_t size>
  static std::array<Matrix, size> filled() {
    std::array<Matrix, size> zeros;
    zeros.fill(Matrix::Zero());
    return zeros;
  }
};

}  // namespace dynamic_icp::window
