// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"

// The Foxglove WebSocket protocol, version 1 (github.com/foxglove/ws-protocol), as far as a server uses it that only
// sends. Texts are JSON; numbers in binary messages are little-endian.
namespace dynamic_icp::live {

/// The subprotocol that client and server agree on; the messages of the newer name that are used here are the same.
inline constexpr std::array<std::string_view, 2> kSubprotocols = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

/// The first of the client's list (Sec-WebSocket-Protocol, with commas) that is spoken here; empty: none.
std::string_view chosen_subprotocol(std::string_view offered);

/// What messages of a channel are, all protobuf.
struct Channel {
  std::string topic;
  std::string type;     ///< "foxglove.PointCloud"
  std::string schema;   ///< bytes of a FileDescriptorSet
  bool is_kept = true;  ///< whether who subscribes is sent the last message at once
};

/// `session` differs from run to run, so that clients forget what they know of an earlier one.
std::string server_info(const std::string& name, const std::string& session);

/// All channels, with their places in the list as their numbers.
std::string advertisement(std::span<const Channel> channels);

enum class StatusLevel : std::uint8_t { kInfo = 0, kWarning = 1, kError = 2 };

/// `id`: what it is about; a later status of the same id replaces it.
std::string status(StatusLevel level, const std::string& text, const std::string& id);

struct Subscription {
  std::uint32_t id = 0;  ///< the client's own number
  std::uint32_t channel = 0;
};

/// A text from a client: what it wants to have and no longer wants.
struct Request {
  std::string operation;                    ///< "subscribe", "unsubscribe", or another that means nothing here
  std::vector<Subscription> subscriptions;  ///< to begin
  std::vector<std::uint32_t> ended;         ///< numbers of subscriptions
};

/// Throws std::invalid_argument saying what was expected.
Request parse_request(std::string_view text);

/// What precedes the bytes of a message.
using MessageHead = std::array<char, 1 + 4 + 8>;
MessageHead message_head(std::uint32_t subscription, Stamp stamp);

/// A message that tells the time of what is shown.
std::string time_message(Stamp stamp);

}  // namespace dynamic_icp::live
