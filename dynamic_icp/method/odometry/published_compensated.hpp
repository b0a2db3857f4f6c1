// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/registration/alignment.hpp"
#include "dynamic_icp/method/registration/target.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::odometry {

/// Preset `paper` with compensated Doppler as its authors ran it for their table on AevaScenes. Each pair begins with
/// the static points alone: two coarse alignments, of points thinned to 1 m with normals over 3 m, Tukey's scale 1.5 m,
/// gates of 3 m and 1 m, no Doppler term; then one with the paper's objective. The whole source follows from there,
/// with its Doppler term. The start is the motion that the static points showed last, not scaled by the time.
class PublishedCompensated {
 public:
  /// `source`: static and predicted points; `source_static`, `target_static`: those that do not move.
  registration::Alignment align(const Scan& source, const Scan& source_static, const registration::Target& target,
                                const Scan& target_static, const PaperConfig& config, const Workers& workers);

  void state(StateArchive& archive);

 private:
  Eigen::Isometry3d T_target_source_ = Eigen::Isometry3d::Identity();  ///< of the static points, last
};

}  // namespace dynamic_icp::odometry
