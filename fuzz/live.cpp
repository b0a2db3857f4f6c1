// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
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
  live::Access named;
  try {
    named.origins = {std::string(text)};
    live::check(named);
    named.address = text;
    named.origins.clear();
    live::check(named);
    fuzz::must(live::is_own_host(live::authority(text, named.port), named));
  } catch (const UsageError&) {
  }
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
  } catch (const std::invalid_argument&) {
  }
  const std::string_view chosen = live::chosen_subprotocol(text);
  fuzz::must(chosen.empty() || text.find(chosen) != std::string_view::npos);
  fuzz::must(live::status(live::StatusLevel::kError, std::string(text), "id").starts_with('{'));  // shown to the client
  fuzz::must(live::server_info(std::string(text), "session").starts_with('{'));
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
