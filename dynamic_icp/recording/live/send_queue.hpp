// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::live {

/// A message on its way to one client; its bytes are shared by all of them.
struct Outgoing {
  std::size_t channel = 0;
  std::uint32_t subscription = 0;
  Stamp stamp;
  std::shared_ptr<const std::string> bytes;
};

/// What waits to be sent to one client, in the order in which it came, and never more than the limits: where a client
/// reads too slowly the oldest messages of the same channel are left out, then the oldest of all. Messages are sent
/// whole or not at all.
class SendQueue {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{8} << 20U;  ///< of more than one message
  static constexpr std::size_t kMaxMessages = 256;

  void push(Outgoing message);

  /// The one that has waited longest; nothing where none waits.
  std::optional<Outgoing> pop();

  /// Leaves out what waits for a subscription that ended.
  void end(std::uint32_t subscription);

  /// How many messages were left out since this was last asked.
  std::size_t take_left_out();

 private:
  void remove(std::deque<Outgoing>::iterator message);

  std::deque<Outgoing> waiting_;
  std::size_t bytes_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace dynamic_icp::live
