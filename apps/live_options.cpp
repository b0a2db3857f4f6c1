// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/live_options.hpp"

#include <charconv>
#include <cstdint>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/report/live_page.hpp"

#include "apps/messages.hpp"
#include "apps/options.hpp"

namespace dynamic_icp::apps {
namespace {

std::uint16_t port_of(const std::string& text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [read_to, fault] = std::from_chars(text.data(), end, port);
  if (fault != std::errc() || read_to != end) {
    throw UsageError(
        fmt::format("'{}' is no port: expected 0 (one that is free) to 65535. Behind --live a word counts as the port: "
                    "put INPUT before it, or write --live={}",
                    text, live::Access{}.port));
  }
  return port;
}

}  // namespace

void add_live_options(CLI::App& command, LiveOptions& options) {
  options.live =
      add_option(command, "--live", options.port, "PORT",
                 fmt::format("Let the run be watched while it goes on: in a browser, and in Foxglove and Lichtblick by "
                             "their WebSocket protocol, at this machine alone (default port {}; 0: one that is free)",
                             live::Access{}.port))
          ->expected(0, 1);
  add_option(command, "--live-address", options.address, "ADDRESS",
             "Address of this machine at which it can be watched from others, unencrypted; 0.0.0.0: all of them "
             "(default 127.0.0.1)")
      ->needs(options.live);
  add_option(command, "--live-origin", options.origins, "ORIGIN",
             "A web page that may watch beside our own, such as https://app.foxglove.dev; several: once each")
      ->needs(options.live)
      ->expected(1);
}

std::optional<runs::LiveViewSettings> live_view_settings(const LiveOptions& options) {
  if (options.live->count() == 0) {
    return std::nullopt;
  }
  runs::LiveViewSettings settings;
  if (!options.port.empty()) {
    settings.access.port = port_of(options.port);
  }
  settings.access.address = options.address;
  settings.access.origins = options.origins;
  live::check(settings.access);
  settings.page = report::live_page();
  return settings;
}

void tell_where_to_watch(const std::string& authority) {
  tell("live view at http://{0}/ (Foxglove, Lichtblick: ws://{0})\n", authority);
}

}  // namespace dynamic_icp::apps
