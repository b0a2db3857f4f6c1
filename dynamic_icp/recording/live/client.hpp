// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/live/network.hpp"
#include "dynamic_icp/recording/live/protocol.hpp"
#include "dynamic_icp/recording/live/send_queue.hpp"

namespace dynamic_icp::live {

/// What clients need of their server; it outlives them.
struct ServerState {
  std::string info;           ///< serverInfo
  std::string advertisement;  ///< of the channels
  std::size_t channels = 0;
  std::chrono::milliseconds request_time{};  ///< see ServerSettings
  std::chrono::milliseconds silence_time{};
  std::vector<Outgoing> latest;                       ///< by channel; without bytes: none yet
  Outgoing time;                                      ///< the last that was told; without bytes: none yet
  std::unique_ptr<std::atomic<int>[]> subscriptions;  ///< by channel, of all clients
};

/// A client that has asked for the stream. All of it happens on the thread of the server.
class Client : public std::enable_shared_from_this<Client> {
 public:
  using WhenGone = std::function<void(const std::shared_ptr<Client>& client)>;

  /// `connection` is given up with the client.
  Client(beast::tcp_stream&& stream, std::shared_ptr<void> connection, ServerState& server, WhenGone when_gone);

  /// Answers the request, and listens from then on.
  void accept(const HttpRequest& request, std::string_view subprotocol);

  /// A message of a channel, if the client wants it.
  void offer(const Outgoing& message);

  /// What every client is sent. Who is still being greeted is told the last one then.
  void offer_time(const Outgoing& message);

  /// Disconnects it once what waits is sent.
  void finish(const std::string& text);

 private:
  void read_next();
  bool count_request();
  void handle();
  void begin(const Subscription& wanted);
  void end(std::uint32_t id);
  void complain(const std::string& text);
  void complain_if_slow();
  void tell(std::string text);
  void write_next();
  void write(const std::array<net::const_buffer, 2>& bytes);
  void close_socket();
  void leave();

  websocket::stream<beast::tcp_stream> stream_;
  std::shared_ptr<void> connection_;
  ServerState& server_;
  WhenGone when_gone_;
  beast::flat_buffer incoming_;
  std::map<std::uint32_t, std::size_t> subscriptions_;  ///< channels by the client's numbers
  SendQueue queue_;
  std::deque<std::string> texts_;  ///< go first
  std::string text_;               ///< being sent
  Outgoing message_;               ///< likewise, behind its head
  MessageHead head_{};
  std::string farewell_;
  bool is_open_ = false;
  bool is_writing_ = false;
  bool is_finishing_ = false;
  bool is_over_ = false;
  std::size_t left_out_ = 0;
  std::size_t faults_ = 0;
  std::size_t requests_ = 0;
  std::chrono::steady_clock::time_point second_began_;
  std::chrono::steady_clock::time_point complained_;
};

}  // namespace dynamic_icp::live
