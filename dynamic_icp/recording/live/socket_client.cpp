// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/socket_client.hpp"

#include <array>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace dynamic_icp::live {
namespace {

unsigned byte_at(const std::string& bytes, std::size_t at) { return static_cast<unsigned char>(bytes.at(at)); }

}  // namespace

int SocketClient::Frame::close_code() const {
  return opcode == kClose && bytes.size() >= 2 ? static_cast<int>(byte_at(bytes, 0) << 8U | byte_at(bytes, 1)) : -1;
}

SocketClient::SocketClient(std::uint16_t port, int receive_bytes) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  if (receive_bytes > 0) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof(receive_bytes));
  }
  const timeval patience{.tv_sec = kPatience_s, .tv_usec = 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    ::close(socket_);
    throw std::runtime_error("cannot connect");
  }
}

bool SocketClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) {
      return false;
    }
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool SocketClient::send_frame(Opcode opcode, std::string_view bytes, bool is_final, bool is_masked) {
  std::string frame(1, static_cast<char>((is_final ? 0x80U : 0U) | opcode));
  const unsigned mask_bit = is_masked ? 0x80U : 0U;
  const std::size_t size = bytes.size();
  const int length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  frame += static_cast<char>(mask_bit | (length_bytes == 0 ? size : length_bytes == 2 ? 126U : 127U));
  for (int k = length_bytes - 1; k >= 0; --k) {
    frame += static_cast<char>(size >> (8U * static_cast<unsigned>(k)) & 0xFFU);
  }
  const std::array<char, 4> mask = {'\x37', '\x5a', '\x01', '\x7f'};
  if (is_masked) {
    frame.append(mask.data(), mask.size());
  }
  for (std::size_t k = 0; k < size; ++k) {
    frame += static_cast<char>(is_masked ? bytes[k] ^ mask[k % 4] : bytes[k]);
  }
  return send(frame);
}

std::string SocketClient::upgrade(std::uint16_t port, const std::string& lines, const std::string& subprotocol) {
  // The key is that of the example in RFC 6455, 1.3.
  return fmt::format(
      "GET / HTTP/1.1\r\nHost: localhost:{}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Protocol: {}\r\n{}\r\n",
      port, subprotocol, lines);
}

std::string SocketClient::open(std::uint16_t port, const std::string& lines) {
  send(upgrade(port, lines));
  return read_head();
}

std::string SocketClient::read_head() {
  std::size_t end = 0;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) {
      return std::exchange(buffer_, {});
    }
  }
  std::string head = buffer_.substr(0, end + 4);
  buffer_.erase(0, end + 4);
  return head;
}

std::optional<std::string> SocketClient::read_all() {
  while (fill()) {
  }
  return errno == EAGAIN || errno == EWOULDBLOCK ? std::nullopt : std::optional(std::exchange(buffer_, {}));
}

std::optional<SocketClient::Frame> SocketClient::read_frame() {
  const auto need = [this](std::size_t bytes) {
    while (buffer_.size() < bytes) {
      if (!fill()) {
        return false;
      }
    }
    return true;
  };
  if (!need(2)) {
    return std::nullopt;
  }
  const unsigned marker = byte_at(buffer_, 1);
  const std::size_t length_bytes = marker < 126 ? 0 : marker == 126 ? 2 : 8;
  if (!need(2 + length_bytes)) {
    return std::nullopt;
  }
  std::size_t size = length_bytes == 0 ? marker : 0;
  for (std::size_t k = 0; k < length_bytes; ++k) {
    size = size << 8U | byte_at(buffer_, 2 + k);
  }
  if (!need(2 + length_bytes + size)) {
    return std::nullopt;
  }
  Frame frame{static_cast<std::uint8_t>(byte_at(buffer_, 0) & 0x0FU), buffer_.substr(2 + length_bytes, size)};
  buffer_.erase(0, 2 + length_bytes + size);
  return frame;
}

std::string SocketClient::read_text() {
  while (const std::optional<Frame> frame = read_frame()) {
    if (frame->opcode == kText) {
      return frame->bytes;
    }
  }
  return "the connection ended";
}

std::string SocketClient::read_message() {
  while (const std::optional<Frame> frame = read_frame()) {
    if (frame->opcode == kBinary && frame->bytes.starts_with('\x01')) {
      return frame->bytes;
    }
  }
  return "the connection ended";
}

bool SocketClient::is_closed_by_server() {
  errno = 0;
  while (const std::optional<Frame> frame = read_frame()) {
    if (frame->opcode == kClose) {
      close_code_ = frame->close_code();
      send_frame(kClose, frame->bytes);
    }
  }
  return errno != EAGAIN && errno != EWOULDBLOCK;
}

void SocketClient::vanish() {
  if (socket_ >= 0) {
    ::close(std::exchange(socket_, -1));
  }
}

bool SocketClient::fill() {
  std::array<char, 65536> bytes;
  errno = 0;
  const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (got <= 0) {
    return false;
  }
  buffer_.append(bytes.data(), static_cast<std::size_t>(got));
  return true;
}

}  // namespace dynamic_icp::live
