// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/runs/frame_json.hpp"

#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/messages.hpp"
#include "apps/method_options.hpp"
#include "apps/options.hpp"

namespace dynamic_icp::apps {
namespace {

struct RegisterOptions {
  std::string source;
  std::string target;
  std::string calibration;
  double dt_s = 0.1;
  datasets::InputSettings settings;  ///< how the scans are read and corrected
  MethodOptions method;
};

/// One scan in a file of any form that a recording may have; files without a known ending are records of float32.
RawScan read_scan_file(const std::string& path, Stamp stamp, const datasets::InputSettings& settings) {
  datasets::InputSettings of_file = settings;
  const std::string ending = std::filesystem::path(path).extension().string();
  const bool is_known = ending == ".bin" || ending == ".pcd" || ending == ".ply" || ending == ".npz" ||
                        ending == ".npy" || ending == ".csv" || ending == ".txt" || ending == ".xyz" ||
                        ending == ".asc";
  const bool is_file = std::filesystem::is_regular_file(path);
  const bool is_empty = is_file && ending == ".bin" && std::filesystem::file_size(path) == 0;  // a scan without points
  if (settings.open.format == "auto" && is_file && (!is_known || is_empty)) {
    of_file.open.format = "dicp";
  }
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_input(path, of_file);
  if (dataset->size() != 1) {
    throw DataError(fmt::format("{}: holds {} scans, expected a file of one scan", path, dataset->size()));
  }
  RawScan raw = dataset->scan(0);
  raw.stamp = stamp;
  if (!raw.warning.empty()) {
    tell("dynamic-icp: warning: {}\n", raw.warning);
  }
  return raw;
}

int register_pair(const RegisterOptions& options) {
  const odometry::Config config = make_config(options.method);
  if (!(options.dt_s >= 1e-9 && options.dt_s <= 3600.0)) {
    throw UsageError(fmt::format("--dt is {}, expected 1e-9 to 3600 s", options.dt_s));
  }
  datasets::check(options.settings.correction);
  const RawScan source = read_scan_file(options.source, Stamp{0}, options.settings);
  const RawScan target = read_scan_file(options.target, Stamp{std::llround(options.dt_s * 1e9)}, options.settings);
  odometry::SensorContext surroundings;
  surroundings.doppler_kind = source.doppler_kind;
  if (!options.calibration.empty()) {
    surroundings.T_vehicle_sensor = datasets::read_calibration(options.calibration).T_vehicle_sensor;
  }
  const std::unique_ptr<odometry::Odometry> odometry =
      odometry::make_odometry(config, surroundings, options.method.threads);
  for (const std::string& assumption : odometry->assumptions()) {
    tell("dynamic-icp: warning: {}\n", assumption);
  }
  const odometry::Frame first = odometry->process(source);
  odometry::Frame second = odometry->process(target);
  if (first.status != odometry::FrameStatus::kFirst) {
    second.status = first.status;  // nothing to align from: the pair is no better than its source
  }
  fmt::print("{}\n", runs::pair_document(first, second, odometry->assumptions()));
  return 0;
}

}  // namespace

void add_register_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<RegisterOptions>();
  CLI::App* command =
      app.add_subcommand("register", "Align one pair of scans; prints transform, covariance and velocities as JSON");
  command
      ->add_option(
          "SOURCE", options->source,
          "Earlier scan: .bin (float32 x, y, z in m, Doppler in m/s, positive away), .pcd, .ply, .npz, .npy or .csv")
      ->required();
  command->add_option("TARGET", options->target, "Later scan; T_target_source maps points of SOURCE into it")
      ->required();
  add_option(*command, "--dt", options->dt_s, "SECONDS", "Time between the two scans in s (default 0.1)");
  add_option(*command, "--calibration", options->calibration, "FILE",
             "calibration.json with the mounting of the sensor, for doppler-icp (default: the identity)");
  add_input_options(*command, options->settings);
  add_method_options(*command, options->method);
  command->callback([options, &selected] { selected = [options] { return register_pair(*options); }; });
}

}  // namespace dynamic_icp::apps
