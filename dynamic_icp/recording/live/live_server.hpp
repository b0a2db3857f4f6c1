// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/live/access.hpp"
#include "dynamic_icp/recording/live/protocol.hpp"

namespace dynamic_icp::live {

struct ServerSettings {
  Access access;
  std::string name;                                ///< what clients show: "dynamic-icp 0.2.0: drive"
  std::string page;                                ///< HTML that browsers are given; empty: none
  std::chrono::milliseconds request_time{5'000};   ///< until a connection must have said what it wants
  std::chrono::milliseconds silence_time{10'000};  ///< until a client that answers nothing is disconnected
};

/// Sends messages to any number of clients up to kMaxClients, by the Foxglove WebSocket protocol, and a page to
/// browsers at the same port. It runs on a thread of its own, of low priority where the system has such, which alone
/// touches the network: no call of this class waits for a client.
///
/// A client that subscribes to a channel that is kept is sent its last message at once. One that reads too slowly
/// misses messages (send_queue.hpp) and is told so; one that does not answer for a while, that sends anything but
/// requests, too much of it or too fast, is disconnected.
class LiveServer {
 public:
  static constexpr std::size_t kMaxClients = 64;      ///< more are refused with status 503
  static constexpr std::size_t kMaxConnections = 96;  ///< with those that have said nothing yet: closed unheard
  static constexpr std::size_t kMaxRequestBytes = 65536;
  static constexpr std::size_t kMaxRequestsPerSecond = 100;
  static constexpr std::size_t kMaxFaults = 10;  ///< requests that mean nothing

  /// Listens from now on. Throws DataError where the address cannot be listened at, UsageError as `check(Access)`.
  LiveServer(ServerSettings settings, std::vector<Channel> channels);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Whether anybody has subscribed to a channel. Any thread.
  [[nodiscard]] bool is_wanted(std::size_t channel) const;

  /// Sends a message to all who want it. One thread at a time.
  void publish(std::size_t channel, Stamp stamp, std::string bytes);

  /// Tells all clients which time it is in the recording, and those that come later before they are sent a message:
  /// players count from the first time that they are told.
  void tell_time(Stamp stamp);

  /// Sends what still waits, for at most a second or two, tells all clients that nothing more comes, and disconnects
  /// them. Nothing may be published after it.
  void end(const std::string& text);

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace dynamic_icp::live
