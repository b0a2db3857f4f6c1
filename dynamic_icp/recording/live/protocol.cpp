// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/protocol.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/formats/base64.hpp"

namespace dynamic_icp::live {
namespace {

using Json = nlohmann::json;

enum class Binary : std::uint8_t { kMessage = 1, kTime = 2 };

/// Puts a number, little-endian, in place of what is there.
template <class Number>
void put(std::span<char> bytes, Number number) {
  for (std::size_t k = 0; k < sizeof(Number); ++k) {
    bytes[k] = static_cast<char>(number >> (8 * k) & 0xFFU);
  }
}

std::uint32_t number_of(const Json& value, const char* what) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument(fmt::format("expected '{}' to be a number from 0 to 4294967295", what));
  }
  return value.get<std::uint32_t>();
}

const Json& list_of(const Json& request, const char* key) {
  const auto found = request.find(key);
  if (found == request.end() || !found->is_array()) {
    throw std::invalid_argument(fmt::format("expected a list '{}'", key));
  }
  return *found;
}

const Json& member(const Json& entry, const char* key) {
  const auto found = entry.is_object() ? entry.find(key) : entry.end();
  if (found == entry.end()) {
    throw std::invalid_argument(fmt::format("expected an object with '{}'", key));
  }
  return *found;
}

/// Texts of ours may hold names of files, which need not be UTF-8.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string_view chosen_subprotocol(std::string_view offered) {
  while (!offered.empty()) {
    const std::size_t comma = std::min(offered.find(','), offered.size());
    std::string_view name = offered.substr(0, comma);
    offered.remove_prefix(std::min(comma + 1, offered.size()));
    name.remove_prefix(std::min(name.find_first_not_of(" \t"), name.size()));
    name = name.substr(0, name.find_last_not_of(" \t") + 1);
    const auto* const found = std::find(kSubprotocols.begin(), kSubprotocols.end(), name);
    if (found != kSubprotocols.end()) {
      return *found;
    }
  }
  return {};
}

std::string server_info(const std::string& name, const std::string& session) {
  return text_of({{"op", "serverInfo"},
                  {"name", name},
                  {"capabilities", {"time"}},
                  {"metadata", Json::object()},
                  {"sessionId", session}});
}

std::string advertisement(std::span<const Channel> channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", list.size()},
                    {"topic", channel.topic},
                    {"encoding", "protobuf"},
                    {"schemaName", channel.type},
                    {"schemaEncoding", "protobuf"},
                    {"schema", formats::base64(channel.schema)}});
  }
  return text_of({{"op", "advertise"}, {"channels", list}});
}

std::string status(StatusLevel level, const std::string& text, const std::string& id) {
  return text_of({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}, {"id", id}});
}

Request parse_request(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    throw std::invalid_argument("expected a JSON object");
  }
  const Json& operation = member(json, "op");
  if (!operation.is_string()) {
    throw std::invalid_argument("expected 'op' to be a text");
  }
  Request request;
  request.operation = operation.get<std::string>();
  if (request.operation == "subscribe") {
    for (const Json& entry : list_of(json, "subscriptions")) {
      request.subscriptions.push_back(
          {number_of(member(entry, "id"), "id"), number_of(member(entry, "channelId"), "channelId")});
    }
  } else if (request.operation == "unsubscribe") {
    for (const Json& id : list_of(json, "subscriptionIds")) {
      request.ended.push_back(number_of(id, "subscriptionIds"));
    }
  }
  return request;
}

MessageHead message_head(std::uint32_t subscription, Stamp stamp) {
  MessageHead head{static_cast<char>(Binary::kMessage)};
  put(std::span(head).subspan(1), subscription);
  put(std::span(head).subspan(5), static_cast<std::uint64_t>(stamp.ns));
  return head;
}

std::string time_message(Stamp stamp) {
  std::string message(1 + 8, static_cast<char>(Binary::kTime));
  put(std::span(message).subspan(1), static_cast<std::uint64_t>(stamp.ns));
  return message;
}

}  // namespace dynamic_icp::live
