// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/mapping/patch_scatter.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/mapping/plane_sums.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"

namespace dynamic_icp::mapping {

/// How points on planes are believed.
struct PlaneNoise {
  double min_sigma_m = 0.005;    ///< smallest standard deviation of a point from its plane
  double model_sigma_m = 0.003;  ///< of a patch from a plane: common to all points on it
};

/// One scan against one map: what the steps of an alignment share. Scan and map must outlive it.
class PlaneFit {
 public:
  PlaneFit(const Scan& scan, const PlaneMap& map, const Workers& workers);

  /// Deskews every `stride`-th point and looks up its patch; the others take no part until the next call.
  void associate(const Eigen::Isometry3d& T_map_sensor, const motion::SweepMotion& sweep, std::size_t stride);

  /// The point-to-plane terms at the pose of the last `associate`.
  [[nodiscard]] PlaneSums linearise(const PlaneNoise& noise, const PlaneWeights& weights) const;

  /// What the terms say of the position only because normals err (1/m^2): sum of w Sigma_n, the weight of each point
  /// times the covariance of the normal under it. Where the surfaces hold nothing, that is all they seem to say.
  [[nodiscard]] Eigen::Matrix3d position_information_of_noise(const PlaneNoise& noise,
                                                              const PlaneWeights& weights) const;

  /// How far the points on each patch with enough of them lie from its plane on average.
  [[nodiscard]] std::vector<PatchMean> patch_means() const;

  /// Points that take part and have a patch.
  [[nodiscard]] std::size_t on_planes() const { return on_planes_; }

 private:
  void fill(PlaneRows& rows, std::size_t begin, std::size_t end, const PlaneNoise& noise) const;

  const Scan& scan_;
  const PlaneMap& map_;
  const Workers& workers_;
  motion::TimeSpan span_;
  Eigen::Isometry3d T_map_sensor_ = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> at_stamp_;  // m, of each point that takes part, sensor axes at the stamp
  std::vector<std::uint64_t> cells_;       // of each point of the scan: the finest cell it was looked up in
  std::vector<const Patch*> met_;          // of each point of the scan: the patch found there
  std::vector<std::uint32_t> members_;     // points per patch
  std::size_t stride_ = 0;
  std::size_t on_planes_ = 0;
};

}  // namespace dynamic_icp::mapping
