// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"
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
  datasets::InputSettings settings;  ///< how the scans are corrected
  MethodOptions method;
};

RawScan read_scan(const std::string& path, Stamp stamp, const datasets::Correction& correction) {
  RawScan raw = datasets::corrected(formats::read_xyzd(path), correction);
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
  const RawScan source = read_scan(options.source, Stamp{0}, options.settings.correction);
  const RawScan target =
      read_scan(options.target, Stamp{std::llround(options.dt_s * 1e9)}, options.settings.correction);
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
  command->add_option("SOURCE", options->source, "Earlier scan: float32 x, y, z (m), Doppler (m/s, positive away)")
      ->required();
  command->add_option("TARGET", options->target, "Later scan; T_target_source maps points of SOURCE into it")
      ->required();
  add_option(*command, "--dt", options->dt_s, "SECONDS", "Time between the two scans in s (default 0.1)");
  add_option(*command, "--calibration", options->calibration, "FILE",
             "calibration.json with the mounting of the sensor, for doppler-icp (default: the identity)");
  add_correction_options(*command, options->settings);
  add_method_options(*command, options->method);
  command->callback([options, &selected] { selected = [options] { return register_pair(*options); }; });
}

}  // namespace dynamic_icp::apps
