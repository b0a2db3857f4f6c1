// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dynamic_icp/recording/live/live_server.hpp"
#include "dynamic_icp/recording/live/network.hpp"

namespace dynamic_icp::live {

/// A connection until it is known what it wants: the page, which it is given, or the stream. It has
/// `request_time` of the settings for its one request, and again for reading the answer.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  /// Asked for the stream and may have it.
  using WhenUpgrade = std::function<void(Visitor& visitor)>;

  /// `connection` is given up with the visitor.
  Visitor(tcp::socket&& socket, std::shared_ptr<void> connection, const ServerSettings& settings,
          WhenUpgrade when_upgrade);

  void read();
  void answer(http::status code, std::string body, const char* type = "text/plain; charset=utf-8");

  [[nodiscard]] const HttpRequest& request() const { return parser_.get(); }
  beast::tcp_stream take_stream() { return std::move(stream_); }
  std::shared_ptr<void> take_connection() { return std::move(connection_); }

 private:
  void handle();

  beast::tcp_stream stream_;
  std::shared_ptr<void> connection_;
  const ServerSettings& settings_;
  WhenUpgrade when_upgrade_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace dynamic_icp::live
