// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/dynamics/hdbscan.hpp"
#include "dynamic_icp/method/dynamics/object_velocity.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/mapping/mapping_config.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/preprocess/normals.hpp"
#include "dynamic_icp/method/preprocess/range_crop.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/align_config.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

// One struct for each pipeline, with all that it reads and nothing else. An empty one has the values published for its
// method, or the best ones. `fields` lists its keys, e.g. "preprocess.voxel.voxel_size_m"; `check` throws UsageError
// naming the first value out of range, or values that do not go together.
namespace dynamic_icp::odometry {

struct PreprocessConfig {
  preprocess::RangeCropConfig range;
  preprocess::VoxelGridConfig voxel;
};

/// Which scans of a stream can be aligned.
struct StreamConfig {
  double max_gap_s = 1.0;  ///< a longer time between two scans is bridged by the last motion, not by alignment
  int min_points = 6;      ///< a scan with fewer points after preprocessing cannot be aligned
};

struct PaperEgoMotionConfig {
  ego_motion::DopplerRegressionConfig regression;
  ego_motion::VelocityFilterConfig filter;
};

struct DynamicsConfig {
  bool predict = true;  ///< off: moving points are left out instead of predicted (ablation "w/o DPP")
  dynamics::HdbscanConfig clustering;
  dynamics::ObjectVelocityConfig velocity;
};

/// Dynamic-ICP as published, from scan to scan: preset `paper`.
struct PaperConfig {
  PreprocessConfig preprocess;
  preprocess::NormalsConfig normals;
  PaperEgoMotionConfig ego_motion;
  DynamicsConfig dynamics;
  registration::AlignConfig registration;
  /// Compensated Doppler as in the table on AevaScenes, see published_compensated.hpp; off: aligned without a Doppler
  /// term, because there is no rotation of the sensor in such Doppler.
  bool published_compensated = false;
  StreamConfig stream;
};

ConfigFields fields(PaperConfig& config);
void check(const PaperConfig& config);

struct EgoMotionConfig {
  /// Static Doppler scatters by the noise alone once the regression is not biased: a narrower threshold than the
  /// paper's.
  ego_motion::VelocityFilterConfig filter{.tau_0_mps = 0.2, .kappa_per_s = 0.0};
  ego_motion::ConsensusRegressionConfig consensus;
  double static_sigmas = 4.0;  ///< a point moves only beyond so many standard deviations of the static Doppler
};

/// Dynamic-ICP with one estimator of motion and Doppler errors: preset `default`.
struct WindowOdometryConfig {
  PreprocessConfig preprocess;
  EgoMotionConfig ego_motion;
  motion::SweepConfig sweep;
  mapping::PlaneMapConfig mapping;
  window::WindowConfig window;
  bool track_objects = true;
  tracking::TrackerConfig tracking;
  bool find_support = true;  ///< the surface that carries the scene votes for what stands
  bool search_start = true;
  double lost_match = 0.5;
  double unobservable_sigma_m = 0.1;
  StreamConfig stream;
};

ConfigFields fields(WindowOdometryConfig& config);
void check(const WindowOdometryConfig& config);

/// Point-to-point, point-to-plane and plane-to-plane (gicp) from scan to scan. Preprocessing, gate and stopping rule
/// are those of the paper.
struct ScanToScanIcpConfig {
  registration::GeometryTerm geometry = registration::GeometryTerm::kPointToPlane;  ///< what the method is; no key
  PreprocessConfig preprocess;
  preprocess::NormalsConfig normals;  ///< read, and among the fields, unless point-to-point
  registration::MatchingConfig registration;
  bool constant_velocity_start = false;  ///< start from the last motion instead of the identity
  bool deskew = false;                   ///< deskew by the last motion, where the points have times
  StreamConfig stream;
};

ConfigFields fields(ScanToScanIcpConfig& config);
void check(const ScanToScanIcpConfig& config);

/// Doppler-ICP as published. The scales of the kernels are meant for residuals that are multiplied by the root of their
/// share of the objective.
struct DopplerIcpConfig {
  ScanToScanIcpConfig icp;  ///< point-to-plane
  double doppler_weight = 0.01;
  double tukey_geometry_m = 0.5;
  double tukey_doppler_mps = 0.2;
  double reject_doppler_mps = 2.0;
  int robust_from_iteration = 2;
};

ConfigFields fields(DopplerIcpConfig& config);
void check(const DopplerIcpConfig& config);

/// KISS-ICP with the defaults of its authors' releases 0.2.10 to 1.2.0.
struct KissIcpConfig {
  bool deskew = false;
  double min_range_m = 5.0;
  double max_range_m = 100.0;
  double voxel_size_m = 1.0;  ///< published: a hundredth of max_range_m
  int max_points_per_voxel = 20;
  double initial_threshold_m = 2.0;
  double min_motion_m = 0.1;
  int max_iterations = 500;
  double min_step = 1e-4;  ///< of the norm of [omega (rad); rho (m)]
  int min_points = 6;      ///< a scan with fewer points to be registered cannot be aligned
};

ConfigFields fields(KissIcpConfig& config);
void check(const KissIcpConfig& config);

/// The configuration of any pipeline; `Config{}` is preset `default`.
using Config = std::variant<WindowOdometryConfig, PaperConfig, ScanToScanIcpConfig, DopplerIcpConfig, KissIcpConfig>;

ConfigFields fields(Config& config);
void check(const Config& config);

/// A pipeline as a user calls it.
struct Pipeline {
  std::string_view method;
  std::string_view preset;  ///< "default" or "paper" for dynamic-icp; empty for methods that have no presets
  Config config;
};

/// All that there are; preset `default` first.
const std::vector<Pipeline>& pipelines();

/// dynamic-icp, doppler-icp, point-to-point, point-to-plane, gicp, kiss-icp.
std::vector<std::string_view> method_names();

/// Names that keys had up to version 0.1, and those they have now. Programs may read the former for one release more.
std::span<const std::pair<std::string_view, std::string_view>> renamed_keys();

std::vector<std::string_view> preset_names();

/// The configuration of a method by name. The preset is that of dynamic-icp: "default" is the best this program can do;
/// "paper" is the paper's method with its published values and nothing added. Throws UsageError with the known names
/// for any other.
Config configuration(std::string_view method, std::string_view preset = "default");

/// Switches a part off: "none"; as in the paper's ablation study "no-vf" (no velocity filter: all points count as
/// static), "no-dpp" (no prediction: moving points are left out; with the local map: no tracking), "no-dr" (no Doppler
/// term in the alignment); with preset "default" also "no-bias" (no error of the Doppler is looked for), "no-deskew",
/// "no-map" (only the last scan), "no-search" (first pair from one start), "no-planes", "no-support" and
/// "no-vibration". Throws UsageError for other names, and for parts the pipeline does not have.
void apply_ablation(Config& config, std::string_view name);
void apply_ablation(PaperConfig& config, std::string_view name);
void apply_ablation(WindowOdometryConfig& config, std::string_view name);

/// The parts that a pipeline has, "none" first.
std::vector<std::string_view> ablation_names(const Config& config = {});

}  // namespace dynamic_icp::odometry
