// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/scan_as_run.hpp"

#include <cmath>

#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"

namespace dynamic_icp::runs {
namespace {

/// What the run was told about sweeps, and whether it took them out.
motion::SweepConfig sweep_config(const RunFiles& run) {
  motion::SweepConfig config;
  ConfigFields known;
  append_fields(known, "sweep", motion::fields(config));
  for (const ConfigField& field : known) {
    if (const std::string text = text_of(run.configuration, field.key); !text.empty()) {
      set_field(known, field.key, text);
    }
  }
  // Runs of version 0.1 say "undone".
  config.deskew = text_of(run.run, "sweep.deskewed") == "true" || text_of(run.run, "sweep.undone") == "true";
  return config;
}

/// The motion during a scan: by the twists at its stamp and at the next one or, at the end, the one before.
std::optional<motion::SweepMotion> sweep_motion(const RunFiles& run, std::size_t frame) {
  const std::optional<TwistRow>& twist = run.frames[frame].twist;
  if (!twist || !twist->angular.allFinite() || !twist->linear.allFinite()) {
    return std::nullopt;
  }
  motion::SweepMotion motion;
  motion.omega = twist->angular;
  motion.velocity = twist->linear;
  const std::size_t other = frame + 1 < run.frames.size() ? frame + 1 : frame - 1;
  constexpr double kMaxGap_s = 0.5;
  if (run.frames.size() > 1 && run.frames[other].twist) {
    const double dt_s = run.seconds(other) - run.seconds(frame);
    const TwistRow& there = *run.frames[other].twist;
    if (std::abs(dt_s) < kMaxGap_s && there.angular.allFinite() && there.linear.allFinite()) {
      motion.alpha = (there.angular - motion.omega) / dt_s;
      motion.acceleration = (there.linear - motion.velocity) / dt_s;
    }
  }
  return motion;
}

Scan at_stamp(const RunFiles& run, std::size_t frame, const Scan& scan,
              const std::optional<motion::SweepMotion>& motion, const Workers& workers) {
  if (motion) {
    return motion::deskew(scan, *motion, workers);
  }
  // Methods without a twist take the motion between scans for the one during them.
  return frame == 0 ? scan
                    : motion::deskew_to_middle(scan, run.trajectory[frame - 1].T_world_sensor.inverse() *
                                                         run.trajectory[frame].T_world_sensor);
}

}  // namespace

ScanAsRun scan_as_run(const RunFiles& run, std::size_t frame, const RawScan& raw, double max_range_m,
                      const Workers& workers) {
  const motion::SweepConfig sweep = sweep_config(run);
  std::vector<double> times;
  Scan measured = Scan::from_raw(motion::retimed(raw, sweep, times), {.max_m = max_range_m}, workers);
  if (!sweep.deskew) {
    return {.scan = std::move(measured), .motion = std::nullopt, .is_deskewed = false};
  }
  const std::optional<motion::SweepMotion> motion = sweep_motion(run, frame);
  return {.scan = at_stamp(run, frame, measured, motion, workers), .motion = motion, .is_deskewed = true};
}

}  // namespace dynamic_icp::runs
