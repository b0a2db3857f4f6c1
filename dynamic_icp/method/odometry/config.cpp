// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"

namespace dynamic_icp::odometry {
namespace {

// The voxel grid distinguishes 2^20 cells in each direction.
constexpr double kMaxVoxels = 1 << 20;

[[noreturn]] void throw_unknown(const char* what, std::string_view name, const std::vector<std::string_view>& known) {
  throw UsageError(fmt::format("unknown {} '{}'{}; known are: {}", what, name,
                               did_you_mean(name, std::vector<std::string>(known.begin(), known.end())),
                               fmt::join(known, ", ")));
}

/// `low` must be less than `high`, both in m.
void check_order(std::string_view low_key, double low, std::string_view high_key, double high) {
  if (low >= high) {
    throw UsageError(
        fmt::format("configuration key '{}' is {}, expected less than '{}' ({} m)", low_key, low, high_key, high));
  }
}

template <class PipelineConfig>
void check_ranges(PipelineConfig config) {
  check_fields(fields(config));
}

void check_together(const PreprocessConfig& config) {
  const double voxel = config.voxel.voxel_size_m;
  const double max_range = config.range.max_range_m;
  check_order("preprocess.range.min_range_m", config.range.min_range_m, "preprocess.range.max_range_m", max_range);
  if (voxel > 0.0 && max_range / voxel >= kMaxVoxels - 1) {
    throw UsageError(
        fmt::format("configuration key 'preprocess.voxel.voxel_size_m' is {}, expected 0 or at least "
                    "{:.4g} m with points up to {} m",
                    voxel, max_range / (kMaxVoxels - 2), max_range));
  }
}

constexpr const char* kPredict = "cluster moving points and predict them to the next scan; off: they are left out";
constexpr const char* kMinPoints =
    "a scan with fewer points after preprocessing is not aligned; the last motion is continued";

void append_preprocess(ConfigFields& all, PreprocessConfig& config) {
  append_fields(all, "preprocess.range", fields(config.range));
  append_fields(all, "preprocess.voxel", fields(config.voxel));
}

void append_stream(ConfigFields& all, StreamConfig& config) {
  append_fields(all, "odometry",
                {{"max_gap_s", &config.max_gap_s, 1e-3, 3600.0, "s",
                  "scans farther apart in time are not aligned; the last motion is continued"},
                 {"min_points", &config.min_points, 6, 1000000, "", kMinPoints}});
}

ScanToScanIcpConfig icp(registration::GeometryTerm geometry) {
  ScanToScanIcpConfig config;
  config.geometry = geometry;
  return config;
}

}  // namespace

ConfigFields fields(PaperConfig& config) {
  ConfigFields all;
  append_preprocess(all, config.preprocess);
  append_fields(all, "preprocess.normals", fields(config.normals));
  append_fields(all, "ego_motion.regression", fields(config.ego_motion.regression));
  append_fields(all, "ego_motion.filter", fields(config.ego_motion.filter));
  append_fields(all, "dynamics.clustering", fields(config.dynamics.clustering));
  append_fields(all, "dynamics.velocity", fields(config.dynamics.velocity));
  append_fields(all, "dynamics", {{"predict", &config.dynamics.predict, 0, 0, "", kPredict}});
  append_fields(all, "registration", fields(config.registration));
  append_fields(all, "registration",
                {{"published_compensated", &config.published_compensated, 0, 0, "",
                  "compensated Doppler: align as published for AevaScenes; off: without a Doppler term"}});
  append_stream(all, config.stream);
  return all;
}

ConfigFields fields(WindowOdometryConfig& config) {
  EgoMotionConfig& ego_motion = config.ego_motion;
  ConfigFields all;
  append_preprocess(all, config.preprocess);
  append_fields(all, "ego_motion.filter", fields(ego_motion.filter));
  append_fields(
      all, "ego_motion",
      {{"static_sigmas", &ego_motion.static_sigmas, 0.0, 100.0, "",
        "with a local map a point is moving only beyond this many standard deviations of the static Doppler"}});
  append_fields(all, "ego_motion.consensus", fields(ego_motion.consensus));
  append_fields(all, "sweep", fields(config.sweep));
  append_fields(all, "mapping", fields(config.mapping));
  append_fields(all, "window", fields(config.window));
  append_fields(all, "dynamics", {{"predict", &config.track_objects, 0, 0, "", kPredict}});
  append_fields(all, "tracking", fields(config.tracking));
  append_fields(
      all, "odometry",
      {{"find_support", &config.find_support, 0, 0, "", "the surface that carries the scene votes for what stands"},
       {"search_start", &config.search_start, 0, 0, "",
        "with a local map: try several rotations for the first two scans"},
       {"lost_match", &config.lost_match, 0.0, 1.0, "",
        "with a local map: lost when less than this share of the usual number of points fits the map"},
       {"unobservable_sigma_m", &config.unobservable_sigma_m, 1e-6, 1e3, "m",
        "with a local map: directions with a larger standard deviation are reported as degenerate"}});
  append_stream(all, config.stream);
  return all;
}

ConfigFields fields(ScanToScanIcpConfig& config) {
  ConfigFields all;
  append_preprocess(all, config.preprocess);
  if (config.geometry != registration::GeometryTerm::kPointToPoint) {
    append_fields(all, "preprocess.normals", fields(config.normals));
  }
  append_fields(all, "registration", fields(config.registration));
  append_fields(all, "icp",
                {{"constant_velocity_start", &config.constant_velocity_start, 0, 0, "",
                  "point-to-point, point-to-plane, gicp, doppler-icp: start from the last motion, not the identity"},
                 {"deskew", &config.deskew, 0, 0, "",
                  "point-to-point, point-to-plane, gicp, doppler-icp: deskew by the last motion, where the "
                  "points have times"}});
  append_stream(all, config.stream);
  return all;
}

ConfigFields fields(DopplerIcpConfig& config) {
  ConfigFields all = fields(config.icp);
  append_fields(
      all, "doppler_icp",
      {{"doppler_weight", &config.doppler_weight, 0.0, 0.999, "", "doppler-icp: share of the Doppler term (lambda)"},
       {"tukey_geometry_m", &config.tukey_geometry_m, 1e-6, 1e3, "m",
        "doppler-icp: point-to-plane residuals times the root of their share have no weight beyond this"},
       {"tukey_doppler_mps", &config.tukey_doppler_mps, 1e-6, 1e3, "m/s",
        "doppler-icp: Doppler residuals times the root of their share have no weight beyond this"},
       {"reject_doppler_mps", &config.reject_doppler_mps, 1e-6, 1e3, "m/s",
        "doppler-icp: pairs with a larger Doppler residual are left out"},
       {"robust_from_iteration", &config.robust_from_iteration, 0, 10000, "",
        "doppler-icp: before this iteration (from 0) the Doppler term is least squares and no pair is left out"}});
  return all;
}

ConfigFields fields(KissIcpConfig& config) {
  ConfigFields all;
  append_fields(
      all, "kiss_icp",
      {{"deskew", &config.deskew, 0, 0, "",
        "deskew to the middle of the scan by the last motion, where the points have times"},
       {"min_range_m", &config.min_range_m, 0.0, 1000.0, "m", "points nearer to the sensor are left out"},
       {"max_range_m", &config.max_range_m, 1.0, 10000.0, "m",
        "points farther from the sensor are left out, in the scan and in the map"},
       // With half of this edge the farthest point is still one of the 2^20 cells that the voxel grid tells apart.
       {"voxel_size_m", &config.voxel_size_m, 0.05, 100.0, "m",
        "edge of the voxels of the map; half of it thins the points of the map, 1.5 times those to be registered"},
       {"max_points_per_voxel", &config.max_points_per_voxel, 1, 1000, "",
        "maximum number of points in a voxel of the map"},
       {"initial_threshold_m", &config.initial_threshold_m, 1e-3, 1e3, "m",
        "expected error of the predicted pose before it is known (sigma)"},
       {"min_motion_m", &config.min_motion_m, 0.0, 1e3, "m",
        "smaller errors of the prediction do not count (delta_min)"},
       {"max_iterations", &config.max_iterations, 1, 10000, "", "maximum number of Gauss-Newton steps"},
       {"min_step", &config.min_step, 1e-12, 1.0, "",
        "the registration has converged when the step, rad and m together, is shorter"}});
  append_fields(all, "odometry", {{"min_points", &config.min_points, 6, 1000000, "", kMinPoints}});
  return all;
}

ConfigFields fields(Config& config) {
  return std::visit([](auto& pipeline) { return fields(pipeline); }, config);
}

void check(const PaperConfig& config) {
  check_ranges(config);
  check_together(config.preprocess);
}

namespace {

void check_noise(const ego_motion::ConsensusRegressionConfig& consensus) {
  if (consensus.min_noise_mps > consensus.max_noise_mps) {
    throw UsageError(
        fmt::format("configuration key 'ego_motion.consensus.min_noise_mps' is {}, expected at most "
                    "'ego_motion.consensus.max_noise_mps' ({} m/s)",
                    consensus.min_noise_mps, consensus.max_noise_mps));
  }
}

}  // namespace

void check(const WindowOdometryConfig& config) {
  check_ranges(config);
  check_together(config.preprocess);
  check_noise(config.ego_motion.consensus);
}

void check(const ScanToScanIcpConfig& config) {
  check_ranges(config);
  check_together(config.preprocess);
}

void check(const DopplerIcpConfig& config) {
  check_ranges(config);
  check_together(config.icp.preprocess);
}

void check(const KissIcpConfig& config) {
  check_ranges(config);
  check_order("kiss_icp.min_range_m", config.min_range_m, "kiss_icp.max_range_m", config.max_range_m);
}

void check(const Config& config) {
  std::visit([](const auto& pipeline) { check(pipeline); }, config);
}

const std::vector<Pipeline>& pipelines() {
  using registration::GeometryTerm;
  static const std::vector<Pipeline> all = {{"dynamic-icp", "default", WindowOdometryConfig{}},
                                            {"dynamic-icp", "paper", PaperConfig{}},
                                            {"doppler-icp", "", DopplerIcpConfig{}},
                                            {"point-to-point", "", icp(GeometryTerm::kPointToPoint)},
                                            {"point-to-plane", "", icp(GeometryTerm::kPointToPlane)},
                                            {"gicp", "", icp(GeometryTerm::kPlaneToPlane)},
                                            {"kiss-icp", "", KissIcpConfig{}}};
  return all;
}

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const Pipeline& pipeline : pipelines()) {
    if (names.empty() || names.back() != pipeline.method) {
      names.push_back(pipeline.method);
    }
  }
  return names;
}

std::span<const std::pair<std::string_view, std::string_view>> renamed_keys() {
  static constexpr std::pair<std::string_view, std::string_view> kKeys[] = {
      {"ego_motion.static_deviations", "ego_motion.static_sigmas"},
      {"ego_motion.consensus.vote_width_mps", "ego_motion.consensus.inlier_threshold_mps"},
      {"dynamics.velocity.max_deviation_mps", "dynamics.velocity.max_sigma_mps"},
      {"tracking.confirm_deviation_mps", "tracking.confirm_sigma_mps"},
      {"tracking.least_speed_mps", "tracking.min_speed_mps"},
      {"tracking.tangential_deviation_mps", "tracking.tangential_sigma_mps"},
      {"odometry.unknown_deviation_m", "odometry.unobservable_sigma_m"},
      {"sweep.undo", "sweep.deskew"},
  };
  return kKeys;
}

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const Pipeline& pipeline : pipelines()) {
    if (!pipeline.preset.empty()) {
      names.push_back(pipeline.preset);
    }
  }
  return names;
}

Config configuration(std::string_view method, std::string_view preset) {
  const std::vector<std::string_view> presets = preset_names();
  if (std::ranges::find(presets, preset) == presets.end()) {
    throw_unknown("preset", preset, presets);
  }
  for (const Pipeline& pipeline : pipelines()) {
    if (pipeline.method == method && (pipeline.preset.empty() || pipeline.preset == preset)) {
      return pipeline.config;
    }
  }
  throw_unknown("method", method, method_names());
}

}  // namespace dynamic_icp::odometry
