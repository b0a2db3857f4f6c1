// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::odometry {
namespace {

// The voxel grid tells 2^20 cells apart in each direction.
constexpr double kMostVoxels = 1 << 20;

[[noreturn]] void throw_unknown(const char* what, std::string_view name, const std::vector<std::string_view>& known) {
  throw UsageError(fmt::format("unknown {} '{}'; known are: {}", what, name, fmt::join(known, ", ")));
}

/// What the alignment of two scans reads whatever it minimises.
constexpr std::string_view kPairKeys[] = {"registration.max_correspondence_distance_m", "registration.max_iterations",
                                          "registration.tolerance", "registration.min_correspondences",
                                          "registration.rank_tolerance"};

/// Keys that a method reads, and beginnings of keys, which end with a dot.
std::vector<std::string_view> keys_read(const Config& config, std::string_view method) {
  if (method == "kiss-icp") {
    return {"kiss_icp.", "odometry.min_points"};
  }
  std::vector<std::string_view> keys = {"preprocess.range.", "preprocess.voxel.", "odometry.max_gap_s",
                                        "odometry.min_points"};
  const auto add = [&](std::initializer_list<std::string_view> more) { keys.insert(keys.end(), more); };
  const bool has_map = method == "dynamic-icp" && !config.scan_to_scan;
  if (!has_map) {
    keys.insert(keys.end(), std::begin(kPairKeys), std::end(kPairKeys));
    if (method != "point-to-point") {
      add({"preprocess.normals."});
    }
  }
  if (method != "dynamic-icp") {
    add({"icp."});
    if (method == "doppler-icp") {
      add({"doppler_icp."});
    }
    return keys;
  }
  add({"odometry.scan_to_scan", "ego_motion.filter.", "dynamics.predict"});
  if (!has_map || !config.ego_motion.use_consensus) {
    add({"ego_motion.regression."});
  }
  if (has_map) {
    add({"odometry.", "ego_motion.consensus.", "ego_motion.drift.", "ego_motion.use_consensus",
         "ego_motion.static_deviations", "sweep.", "mapping.", "registration.map.", "turn.", "tracking."});
  } else {
    add({"dynamics.", "registration.doppler_weight", "registration.tukey_geometry_m",
         "registration.tukey_doppler_mps"});
  }
  return keys;
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
  append_fields(all, "ego_motion.consensus", fields(config.ego_motion.consensus));
  append_fields(all, "ego_motion.drift", fields(config.ego_motion.drift));
  append_fields(all, "ego_motion",
                {{"use_consensus", &config.ego_motion.use_consensus, 0, 0, "",
                  "find the static scene by consensus; off: Huber regression, as from scan to scan"},
                 {"static_deviations", &config.ego_motion.static_deviations, 0.0, 100.0, "",
                  "with a local map a point moves only beyond so many deviations of the static Doppler"}});
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
  append_fields(all, "sweep", fields(config.sweep));
  append_fields(all, "mapping", fields(config.mapping));
  append_fields(all, "registration.map", fields(config.map_align));
  append_fields(all, "turn", fields(config.turn));
  append_fields(all, "tracking", fields(config.tracking));
  append_fields(
      all, "odometry",
      {{"scan_to_scan", &config.scan_to_scan, 0, 0, "",
        "dynamic-icp as in the paper, from scan to scan; off: with Doppler displacement and a local map"},
       {"use_displacement", &config.use_displacement, 0, 0, "",
        "with a local map: the way between scans by the Doppler velocities is a term of the alignment"},
       {"displacement_deviation_mps", &config.displacement_deviation_mps, 0.0, 10.0, "m/s",
        "what the way between scans may be off besides the errors of the velocities, over the time between them"},
       {"search_start", &config.search_start, 0, 0, "", "with a local map: try several turns for the first two scans"},
       {"lost_match", &config.lost_match, 0.0, 1.0, "",
        "with a local map: lost when less than this share of the usual number of points fits the map"},
       {"unknown_deviation_m", &config.unknown_deviation_m, 1e-6, 1e3, "m",
        "with a local map: motions known worse than this are reported as degenerate"}});
  append_fields(all, "odometry",
                {{"max_gap_s", &config.max_gap_s, 1e-3, 3600.0, "s",
                  "scans farther apart in time are not aligned; the last motion is continued"},
                 {"min_points", &config.min_points, 6, 1000000, "",
                  "a scan with fewer points after preprocessing is not aligned; the last motion is continued"}});
  return all;
}

ConfigFields effective_fields(Config& config, std::string_view method) {
  ConfigFields effective = fields(config);
  const std::vector<std::string_view> read = keys_read(config, method);
  std::erase_if(effective, [&](const ConfigField& field) {
    return std::none_of(read.begin(), read.end(), [&](std::string_view key) {
      return key.ends_with('.') ? field.key.starts_with(key) : field.key == key;
    });
  });
  return effective;
}

void check(const Config& config) {
  Config copy = config;
  check_fields(fields(copy));
  check(config.kiss);
  if (config.ego_motion.consensus.min_noise_mps > config.ego_motion.consensus.max_noise_mps) {
    throw UsageError(
        fmt::format("configuration key 'ego_motion.consensus.min_noise_mps' is {}, expected at most "
                    "'ego_motion.consensus.max_noise_mps' ({} m/s)",
                    config.ego_motion.consensus.min_noise_mps, config.ego_motion.consensus.max_noise_mps));
  }
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
  Config config;
  if (name == "paper") {
    config.scan_to_scan = true;
    config.ego_motion.filter = {};  // the initialisers of the stages' structs are the paper's values
  } else if (name != "default") {
    throw_unknown("preset", name, preset_names());
  }
  return config;
}

std::vector<std::string_view> preset_names() { return {"default", "paper"}; }

void apply_ablation(Config& config, std::string_view name) {
  const auto has = [&](const std::vector<std::string_view>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (!has(ablation_names())) {
    throw_unknown("ablation", name, ablation_names());
  }
  if (!has(ablation_names(config))) {
    throw UsageError(
        fmt::format("ablation '{}' is about a part that dynamic-icp from scan to scan (preset paper) does "
                    "not have; it has: {}",
                    name, fmt::join(ablation_names(config), ", ")));
  }
  if (name == "no-vf") {
    config.ego_motion.filter.enabled = false;
  } else if (name == "no-dpp") {
    config.dynamics.predict = false;
  } else if (name == "no-dr") {
    config.registration.doppler_weight = 0.0;
    config.use_displacement = false;
  } else if (name == "no-consensus") {
    config.ego_motion.use_consensus = false;
  } else if (name == "no-bias") {
    config.ego_motion.consensus.estimate_bias = false;
  } else if (name == "no-deskew") {
    config.sweep.undo = false;
  } else if (name == "no-map") {
    config.mapping.memory_scans = 0.0;
  } else if (name == "no-search") {
    config.search_start = false;
  }
}

std::vector<std::string_view> ablation_names() {
  return {"none", "no-vf", "no-dpp", "no-dr", "no-consensus", "no-bias", "no-deskew", "no-map", "no-search"};
}

std::vector<std::string_view> ablation_names(const Config& config) {
  return config.scan_to_scan ? std::vector<std::string_view>{"none", "no-vf", "no-dpp", "no-dr"} : ablation_names();
}

}  // namespace dynamic_icp::odometry
