// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Instead of live_server.cpp where Boost.Beast was missing.
#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/live/live_server.hpp"

namespace dynamic_icp::live {

class LiveServer::Server {};

LiveServer::LiveServer(ServerSettings settings, std::vector<Channel> /*channels*/) {
  check(settings.access);
  throw DataError("no live view: this program was built without Boost.Beast (libboost-dev)");
}

LiveServer::~LiveServer() = default;
std::uint16_t LiveServer::port() const { return 0; }
bool LiveServer::is_wanted(std::size_t /*channel*/) const { return false; }
void LiveServer::publish(std::size_t /*channel*/, Stamp /*stamp*/, std::string /*bytes*/) {}
void LiveServer::tell_time(Stamp /*stamp*/) {}
void LiveServer::end(const std::string& /*text*/) {}

}  // namespace dynamic_icp::live
