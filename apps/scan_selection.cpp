// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/scan_selection.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp::apps {

namespace {

std::size_t count_of(const char* option, const std::string& text, std::size_t least) {
  const std::optional<std::size_t> count = parse_number<std::size_t>(text);
  if (!count || *count < least) {
    throw UsageError(fmt::format("{} is '{}', expected a whole number, {} or more", option, text, least));
  }
  return *count;
}

}  // namespace

void add_selection_options(CLI::App& command, const char* what, std::size_t& start,
                           std::optional<std::size_t>& max_frames) {
  command
      .add_option_function<std::string>(
          "--start", [&start](const std::string& text) { start = count_of("--start", text, 0); },
          "First scan, counted from 0 (default 0)")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--max-frames,--max-scans,--frames",
          [&max_frames](const std::string& text) { max_frames = count_of("--max-frames", text, 1); },
          fmt::format("Maximum number of scans to {} (default: all)", what))
      ->type_name("N");
}

}  // namespace dynamic_icp::apps
