// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/dynamics/hdbscan.hpp"
#include "dynamic_icp/method/dynamics/object_velocity.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/ego_motion/ego_filter.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/mapping/map_align_config.hpp"
#include "dynamic_icp/method/mapping/plane_map_config.hpp"
#include "dynamic_icp/method/motion/rotation_filter_config.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/odometry/kiss_config.hpp"
#include "dynamic_icp/method/preprocess/normals.hpp"
#include "dynamic_icp/method/preprocess/range_crop.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/align_config.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp::odometry {

struct PreprocessConfig {
  preprocess::RangeCropConfig range;
  preprocess::VoxelGridConfig voxel;
  preprocess::NormalsConfig normals;
};

struct EgoMotionConfig {
  ego_motion::DopplerRegressionConfig regression;
  /// Static Doppler scatters by the noise alone once the regression is not biased: a narrower threshold than the
  /// paper's.
  ego_motion::VelocityFilterConfig filter{.tau_0_mps = 0.2, .kappa_per_s = 0.0};

  // Beyond the paper.
  bool use_consensus = true;  ///< off: Huber regression also with the local map (ablation "no-consensus")
  ego_motion::ConsensusRegressionConfig consensus;
  ego_motion::DriftConfig drift;
  double static_deviations = 4.0;  ///< a point moves only beyond so many deviations of the static Doppler
};

struct DynamicsConfig {
  bool predict = true;  ///< off: moving points are left out instead of predicted (ablation "w/o DPP")
  dynamics::HdbscanConfig clustering;
  dynamics::ObjectVelocityConfig velocity;
};

/// Of point-to-point, point-to-plane, gicp and doppler-icp. Gate and stopping rule are those of dynamic-icp.
struct IcpConfig {
  bool constant_velocity_start = false;  ///< start from the last motion instead of the identity
};

/// Of doppler-icp, with its published values. The scales of the kernels are meant for residuals that are multiplied by
/// the root of their share of the objective.
struct DopplerIcpConfig {
  double doppler_weight = 0.01;
  double tukey_geometry_m = 0.5;
  double tukey_doppler_mps = 0.2;
  double reject_doppler_mps = 2.0;
  int robust_from_iteration = 2;
};

ConfigFields fields(DopplerIcpConfig& config);

/// Everything the odometry can be told, stage by stage. `Config{}` is preset `default`. A method reads only a part of
/// it, see `effective_fields`.
struct Config {
  PreprocessConfig preprocess;
  EgoMotionConfig ego_motion;
  DynamicsConfig dynamics;
  registration::AlignConfig registration;
  IcpConfig icp;
  DopplerIcpConfig doppler_icp;
  KissConfig kiss;

  // Of dynamic-icp beyond the paper, with a local map.
  bool scan_to_scan = false;  ///< the paper's pipeline; off: preset `default`
  motion::SweepConfig sweep;
  mapping::PlaneMapConfig mapping;
  mapping::MapAlignConfig map_align;
  motion::RotationFilterConfig turn;
  tracking::TrackerConfig tracking;
  bool use_displacement = true;               ///< the way between scans from the Doppler, as a term of the alignment
  double displacement_deviation_mps = 0.003;  ///< error of the integrated velocity over the time between two scans
  bool search_start = true;                   ///< try several turns for the first pair of scans
  double lost_match = 0.5;                    ///< lost when less than this share of the usual number of points fits
  double unknown_deviation_m = 0.1;           ///< directions known worse than this are degenerate

  double max_gap_s = 1.0;  ///< a longer time between two scans is bridged by the last motion, not by alignment
  int min_points = 6;      ///< a scan with fewer points after preprocessing cannot be aligned
};

/// All fields with their keys, e.g. "preprocess.voxel.voxel_size_m".
ConfigFields fields(Config& config);

/// Those of them that have an effect on the method of that name (see `method_names`) with this configuration.
ConfigFields effective_fields(Config& config, std::string_view method);

/// Throws UsageError naming the first value out of range, or values that do not go together.
void check(const Config& config);

/// A named configuration: "default", `Config{}`, is the best this program can do; "paper" is the paper's method with
/// its published values and nothing added. Throws UsageError for other names.
Config preset(std::string_view name);

std::vector<std::string_view> preset_names();

/// Switches a part off: "none"; as in the paper's ablation study "no-vf" (no velocity filter: all points count as
/// static), "no-dpp" (no prediction: moving points are left out; with the local map: no tracking), "no-dr" (no Doppler
/// term in the alignment); with the local map also "no-consensus" (Huber regression of the ego velocity), "no-bias" (no
/// Doppler bias), "no-deskew", "no-map" (only the last scan), "no-search" (first pair from one start). Throws
/// UsageError for other names, and for parts the configuration does not have.
void apply_ablation(Config& config, std::string_view name);

/// The parts that dynamic-icp has with this configuration, "none" first.
std::vector<std::string_view> ablation_names(const Config& config);

/// All of them.
std::vector<std::string_view> ablation_names();

}  // namespace dynamic_icp::odometry
