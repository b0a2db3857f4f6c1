// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/published_compensated.hpp"

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr double kCoarseVoxel_m = 1.0;
constexpr double kCoarseNormals_m = 3.0;
constexpr double kCoarseTukey_m = 1.5;
constexpr double kCoarseGates_m[] = {3.0, 1.0};

Eigen::Isometry3d align_coarsely(const Scan& source_static, const Scan& target_static, const Eigen::Isometry3d& T_start,
                                 const PaperConfig& config, const Workers& workers) {
  const Scan source = preprocess::voxel_grid(source_static, {kCoarseVoxel_m}, workers);
  const registration::PreparedTarget target(preprocess::voxel_grid(target_static, {kCoarseVoxel_m}, workers),
                                            {kCoarseNormals_m, config.normals.max_neighbours}, workers);
  registration::AlignConfig coarse = config.registration;
  coarse.doppler_weight = 0.0;
  coarse.tukey_geometry_m = kCoarseTukey_m;
  Eigen::Isometry3d T = T_start;
  for (const double gate_m : kCoarseGates_m) {
    coarse.max_correspondence_distance_m = gate_m;
    T = registration::align(source, target.target(), T, coarse, workers).T_target_source;
  }
  return T;
}

}  // namespace

registration::Alignment PublishedCompensated::align(const Scan& source, const Scan& source_static,
                                                    const registration::Target& target, const Scan& target_static,
                                                    const PaperConfig& config, const Workers& workers) {
  const Eigen::Isometry3d T_coarse = align_coarsely(source_static, target_static, T_target_source_, config, workers);
  const registration::PreparedTarget fine(target_static, config.normals, workers);
  const registration::Alignment of_static =
      registration::align(source_static, fine.target(), T_coarse, config.registration, workers);
  if (is_aligned(frame_status(of_static.status))) {
    T_target_source_ = of_static.T_target_source;
  }
  return registration::align(source, target, of_static.T_target_source, config.registration, workers);
}

void PublishedCompensated::state(StateArchive& archive) { archive(T_target_source_); }

}  // namespace dynamic_icp::odometry
