// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::live {

/// Where the server listens and whose pages may read from it.
struct Access {
  std::string address = "127.0.0.1";  ///< of an interface of this machine; 0.0.0.0 or :: are all of them
  std::uint16_t port = 8765;          ///< 0: one that is free
  std::vector<std::string> origins;   ///< besides its own: "https://app.foxglove.dev"
};

/// Whether the Host header of a request names this server: localhost, a loopback address or the address that it listens
/// at, with its port. Where it listens at all interfaces any address is right, but no name: a page whose name its owner
/// points at this machine (DNS rebinding) sends that name.
bool is_own_host(std::string_view host, const Access& access);

/// Whether a page may read the stream by the Origin header of its request: pages of the server itself and those that
/// are permitted; programs send none. `host`: the Host header, which is_own_host has passed.
bool is_permitted_origin(std::string_view origin, std::string_view host, const Access& access);

/// Throws UsageError where the address is none, or an origin is not of the form scheme://host[:port].
void check(const Access& access);

/// "127.0.0.1:8765", "[::1]:8765"
std::string authority(std::string_view address, std::uint16_t port);

}  // namespace dynamic_icp::live
