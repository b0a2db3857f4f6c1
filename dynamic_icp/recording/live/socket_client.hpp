// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::live {

/// A connection for tests, made of plain sockets and RFC 6455 alone: what is sent may be as wrong as a test wants it.
/// Nothing waits longer than kPatience_s.
class SocketClient {
 public:
  static constexpr int kPatience_s = 10;

  enum Opcode : std::uint8_t { kContinuation = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

  struct Frame {
    std::uint8_t opcode = 0;
    std::string bytes;
    [[nodiscard]] int close_code() const;  ///< -1: none
  };

  /// `receive_bytes`: of the buffer of the system; 0: as it likes.
  explicit SocketClient(std::uint16_t port, int receive_bytes = 0);
  ~SocketClient() { vanish(); }
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  /// False when the other side has closed.
  bool send(std::string_view bytes);
  bool send_frame(Opcode opcode, std::string_view bytes, bool is_final = true, bool is_masked = true);

  /// The head of the request for the stream, with further lines.
  static std::string upgrade(std::uint16_t port, const std::string& lines = "",
                             const std::string& subprotocol = "foxglove.websocket.v1");

  /// Sends the request for the stream and reads the answer.
  std::string open(std::uint16_t port, const std::string& lines = "");

  /// Up to the blank line behind the head of an answer; what came until the connection ended where there is none.
  std::string read_head();

  /// All until the other side closes; nothing where it does not.
  std::optional<std::string> read_all();

  /// The next frame; nothing where the connection ended.
  std::optional<Frame> read_frame();

  /// The next text; frames of other kinds are left out.
  std::string read_text();

  /// The next message of a channel, with its head.
  std::string read_message();

  /// Whether the other side closes, whatever it sends before. The code of its closing frame is kept.
  bool is_closed_by_server();
  [[nodiscard]] int close_code() const { return close_code_; }

  /// Ends the connection without a word.
  void vanish();

 private:
  bool fill();

  int socket_ = -1;
  std::string buffer_;
  int close_code_ = -1;
};

}  // namespace dynamic_icp::live
