// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "dynamic_icp/recording/runs/live_view_settings.hpp"

namespace dynamic_icp::apps {

/// Whether and where a run can be watched, as the options say it.
struct LiveOptions {
  CLI::Option* live = nullptr;
  std::string port;
  std::string address = live::Access{}.address;
  std::vector<std::string> origins;
};

void add_live_options(CLI::App& command, LiveOptions& options);

/// Nothing where it was not asked for. Throws UsageError where the options cannot be meant.
std::optional<runs::LiveViewSettings> live_view_settings(const LiveOptions& options);

/// Tells where to look.
void tell_where_to_watch(const std::string& authority);

}  // namespace dynamic_icp::apps
