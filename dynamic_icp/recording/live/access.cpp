// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/access.hpp"

#include <algorithm>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::live {
namespace {

bool is_address(const std::string& text, int family) {
  unsigned char parsed[sizeof(in6_addr)];
  return text.find('\0') == std::string::npos && ::inet_pton(family, text.c_str(), parsed) == 1;
}

bool is_any_address(const std::string& text) { return is_address(text, AF_INET) || is_address(text, AF_INET6); }

/// "name:port" or "[address]:port". Without a port it is that of HTTP, 80.
struct HostAndPort {
  std::string name;
  std::string port = "80";
};

HostAndPort split(std::string_view host) {
  HostAndPort parts;
  const std::size_t bracket = host.starts_with('[') ? host.find(']') : std::string_view::npos;
  const std::size_t colon = host.find(':', bracket == std::string_view::npos ? 0 : bracket);
  std::string_view name = host.substr(0, colon);
  if (bracket != std::string_view::npos && name.ends_with(']')) {
    name = name.substr(1, name.size() - 2);
  }
  parts.name = formats::lower_case(name);
  if (colon != std::string_view::npos) {
    parts.port = host.substr(colon + 1);
  }
  return parts;
}

}  // namespace

bool is_own_host(std::string_view host, const Access& access) {
  const HostAndPort parts = split(host);
  if (parts.port != std::to_string(access.port)) {
    return false;
  }
  const bool listens_everywhere = access.address == "0.0.0.0" || access.address == "::";
  return parts.name == "localhost" || parts.name == "127.0.0.1" || parts.name == "::1" ||
         parts.name == formats::lower_case(access.address) || (listens_everywhere && is_any_address(parts.name));
}

bool is_permitted_origin(std::string_view origin, std::string_view host, const Access& access) {
  const std::string lower = formats::lower_case(origin);
  return origin.empty() || lower == "http://" + formats::lower_case(host) ||
         std::any_of(access.origins.begin(), access.origins.end(),
                     [&](const std::string& permitted) { return lower == formats::lower_case(permitted); });
}

void check(const Access& access) {
  if (!is_any_address(access.address)) {
    throw UsageError(
        fmt::format("'{}' is no address to listen at: expected one of this machine, such as 127.0.0.1, "
                    "or 0.0.0.0 for all of its interfaces",
                    access.address));
  }
  for (const std::string& origin : access.origins) {
    const std::size_t host = origin.find("://");
    if (host == std::string::npos || host == 0 || host + 3 == origin.size() ||
        origin.find_first_of("/ *?#", host + 3) != std::string::npos) {
      throw UsageError(
          fmt::format("'{}' is no origin of a page: expected scheme and host with nothing behind them, such "
                      "as https://app.foxglove.dev",
                      origin));
    }
  }
}

std::string authority(std::string_view address, std::uint16_t port) {
  return address.find(':') == std::string_view::npos ? fmt::format("{}:{}", address, port)
                                                     : fmt::format("[{}]:{}", address, port);
}

}  // namespace dynamic_icp::live
