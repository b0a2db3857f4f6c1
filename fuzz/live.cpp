// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/live/access.hpp"
#include "dynamic_icp/recording/live/protocol.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

/// What users name as address and as permitted origin.
void check_named(std::string_view text) {
  live::Access page;
  page.origins = {std::string(text)};
  try {
    live::check(page);
    fuzz::must(live::is_permitted_origin(text, "127.0.0.1", page));
  } catch (const UsageError&) {
  }
  live::Access machine;
  machine.address = text;
  try {
    live::check(machine);
    fuzz::must(live::is_own_host(live::authority(text, machine.port), machine));
  } catch (const UsageError&) {
  }
}

/// Little-endian.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t k = size; k-- > 0;) {
    number = number << 8U | static_cast<unsigned char>(bytes[at + k]);
  }
  return number;
}

/// A client that subscribes is sent messages that bear its own number of the subscription.
void answer(const live::Request& request) {
  for (const live::Subscription& subscription : request.subscriptions) {
    const Stamp stamp{static_cast<std::int64_t>(subscription.channel) << 31U};
    const live::MessageHead head = live::message_head(subscription.id, stamp);
    const std::string_view bytes(head.data(), head.size());
    fuzz::must(bytes[0] == 1 && number_at(bytes, 1, 4) == subscription.id);
    fuzz::must(number_at(bytes, 5, 8) == static_cast<std::uint64_t>(stamp.ns));
    const std::string time = live::time_message(stamp);
    fuzz::must(time.size() == 9 && time[0] == 2 && number_at(time, 1, 8) == static_cast<std::uint64_t>(stamp.ns));
  }
}

/// Texts of ours, with names that others chose in them, are JSON of what they are to say.
void must_say(const std::string& text, const char* operation) {
  const live::Request understood = live::parse_request(text);
  fuzz::must(understood.operation == operation);
}

}  // namespace

// What clients of the live view send: requests, and headers that say who they are. Any bytes are understood or refused;
// no header that a page elsewhere could send opens the stream to it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const live::Request request = live::parse_request(text);
    fuzz::must(request.subscriptions.empty() || request.operation == "subscribe");
    fuzz::must(request.ended.empty() || request.operation == "unsubscribe");
    answer(request);
  } catch (const std::invalid_argument&) {
  }
  const std::string_view chosen = live::chosen_subprotocol(text);
  fuzz::must(chosen.empty() || text.find(chosen) != std::string_view::npos);
  const std::string shown(text);
  must_say(live::status(live::StatusLevel::kError, shown, "id"), "status");
  must_say(live::server_info(shown, "session"), "serverInfo");
  const live::Channel channel{shown, "foxglove.PointCloud", shown};
  must_say(live::advertisement(std::span(&channel, 1)), "advertise");
  check_named(text);
  const live::Access access;
  const std::string lower = formats::lower_case(text);
  if (live::is_own_host(text, access)) {
    const std::string name = lower.substr(lower.starts_with('[') ? 1 : 0);
    fuzz::must(name.starts_with("localhost") || name.starts_with("127.0.0.1") || name.starts_with("::1"));
    fuzz::must(!live::is_permitted_origin("https://evil.example", text, access));
  }
  if (!text.empty() && live::is_permitted_origin(text, "127.0.0.1:8765", access)) {
    fuzz::must(lower == "http://127.0.0.1:8765");
  }
  return 0;
}
