// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/odometry/config.hpp"

#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::odometry {
namespace {

// The voxel grid tells 2^20 cells apart in each direction.
constexpr double kMostVoxels = 1 << 20;

[[noreturn]] void throw_unknown(const char* what, std::string_view name, const std::vector<std::string_view>& known) {
  throw UsageError(fmt::format("unknown {} '{}'; known are: {}", what, name, fmt::join(known, ", ")));
}

}  // namespace

ConfigFields fields(DopplerIcpConfig& config) {
  return {
      {"doppler_weight", &config.doppler_weight, 0.0, 0.999, "", "doppler-icp: share of the Doppler term (lambda)"},
      {"tukey_geometry_m", &config.tukey_geometry_m, 1e-6, 1e3, "m",
       "doppler-icp: point-to-plane residuals times the root of their share have no weight beyond this"},
      {"tukey_doppler_mps", &config.tukey_doppler_mps, 1e-6, 1e3, "m/s",
       "doppler-icp: Doppler residuals times the root of their share have no weight beyond this"},
      {"reject_doppler_mps", &config.reject_doppler_mps, 1e-6, 1e3, "m/s",
       "doppler-icp: pairs with a larger Doppler residual are left out"},
      {"robust_from_iteration", &config.robust_from_iteration, 0, 10000, "",
       "doppler-icp: before this iteration (from 0) the Doppler term is least squares and no pair is left out"},
  };
}

ConfigFields fields(Config& config) {
  ConfigFields all;
  append_fields(all, "preprocess.range", fields(config.preprocess.range));
  append_fields(all, "preprocess.voxel", fields(config.preprocess.voxel));
  append_fields(all, "preprocess.normals", fields(config.preprocess.normals));
  append_fields(all, "ego_motion.regression", fields(config.ego_motion.regression));
  append_fields(all, "ego_motion.filter", fields(config.ego_motion.filter));
  append_fields(all, "dynamics.clustering", fields(config.dynamics.clustering));
  append_fields(all, "dynamics.velocity", fields(config.dynamics.velocity));
  append_fields(all, "dynamics",
                {{"predict", &config.dynamics.predict, 0, 0, "",
                  "cluster moving points and predict them to the next scan; off: they are left out"}});
  append_fields(all, "registration", fields(config.registration));
  append_fields(all, "icp",
                {{"constant_velocity_start", &config.icp.constant_velocity_start, 0, 0, "",
                  "point-to-point, point-to-plane, gicp, doppler-icp: start from the last motion, not the identity"}});
  append_fields(all, "doppler_icp", fields(config.doppler_icp));
  append_fields(all, "kiss_icp", fields(config.kiss));
  append_fields(all, "odometry",
                {{"max_gap_s", &config.max_gap_s, 1e-3, 3600.0, "s",
                  "scans farther apart in time are not aligned; the last motion is continued"},
                 {"min_points", &config.min_points, 6, 1000000, "",
                  "a scan with fewer points after preprocessing is not aligned; the last motion is continued"}});
  return all;
}

void check(const Config& config) {
  Config copy = config;
  check_fields(fields(copy));
  check(config.kiss);
  const double voxel = config.preprocess.voxel.voxel_size_m;
  const double max_range = config.preprocess.range.max_range_m;
  if (config.preprocess.range.min_range_m >= max_range) {
    throw UsageError(
        fmt::format("configuration key 'preprocess.range.min_range_m' is {}, expected less than "
                    "'preprocess.range.max_range_m' ({} m)",
                    config.preprocess.range.min_range_m, max_range));
  }
  if (voxel > 0.0 && max_range / voxel >= kMostVoxels - 1) {
    throw UsageError(
        fmt::format("configuration key 'preprocess.voxel.voxel_size_m' is {}, expected 0 or at least "
                    "{:.4g} m with points up to {} m",
                    voxel, max_range / (kMostVoxels - 2), max_range));
  }
}

Config preset(std::string_view name) {
  Config config;  // the initialisers of the configuration structs are the paper's values
  if (name == "default") {
    // One gross Doppler error in a cluster is enough to make least squares report tens of m/s across the line of sight.
    config.dynamics.velocity.huber_delta_mps = 0.15;
    config.dynamics.velocity.max_deviation_mps = 1.0;
  } else if (name != "paper") {
    throw_unknown("preset", name, preset_names());
  }
  return config;
}

std::vector<std::string_view> preset_names() { return {"paper", "default"}; }

void apply_ablation(Config& config, std::string_view name) {
  if (name == "no-vf") {
    config.ego_motion.filter.enabled = false;
  } else if (name == "no-dpp") {
    config.dynamics.predict = false;
  } else if (name == "no-dr") {
    config.registration.doppler_weight = 0.0;
  } else if (name != "none") {
    throw_unknown("ablation", name, ablation_names());
  }
}

std::vector<std::string_view> ablation_names() { return {"none", "no-vf", "no-dpp", "no-dr"}; }

}  // namespace dynamic_icp::odometry
