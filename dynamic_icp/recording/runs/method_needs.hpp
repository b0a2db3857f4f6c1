// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/recording/runs/recording_check.hpp"
#include "dynamic_icp/recording/runs/run_messages.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"

// What the method of a run needs to know of a recording, and tells of it.
namespace dynamic_icp::runs {

/// What the configuration says of sweeps; null where the method does not look at it.
motion::SweepConfig* sweep_config(odometry::Config& config);

Needs needs_of(const RunSettings& settings);

/// `period_s`: from scan to scan.
RunMessagesSettings messages_settings(const RunSettings& settings, double period_s);

}  // namespace dynamic_icp::runs
