// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/method_needs.hpp"

#include <variant>

#include "dynamic_icp/method/odometry/odometry.hpp"

namespace dynamic_icp::runs {

motion::SweepConfig* sweep_config(odometry::Config& config) {
  auto* with_window = std::get_if<odometry::WindowOdometryConfig>(&config);
  return with_window != nullptr ? &with_window->sweep : nullptr;
}

Needs needs_of(const RunSettings& settings) {
  odometry::Config config = settings.config;
  const motion::SweepConfig* sweep = sweep_config(config);
  return {.doppler = odometry::needs_doppler(settings.method),
          .sweep = sweep != nullptr && sweep->deskew && sweep->search && sweep->declared_duration_s == 0.0};
}

RunMessagesSettings messages_settings(const RunSettings& settings, double period_s) {
  odometry::Config config = settings.config;
  const motion::SweepConfig* sweep = sweep_config(config);
  RunMessagesSettings messages;
  messages.sweep = sweep != nullptr ? *sweep : motion::SweepConfig{};
  messages.tells_moving = settings.method == "dynamic-icp";
  messages.period_s = period_s;
  messages.threads = settings.threads;
  return messages;
}

}  // namespace dynamic_icp::runs
