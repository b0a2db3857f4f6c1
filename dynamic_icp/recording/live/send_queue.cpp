// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/send_queue.hpp"

#include <algorithm>
#include <utility>

namespace dynamic_icp::live {

void SendQueue::push(Outgoing message) {
  while (!waiting_.empty() && (waiting_.size() >= kMaxMessages || bytes_ + message.bytes->size() > kMaxBytes)) {
    const auto same = std::find_if(waiting_.begin(), waiting_.end(),
                                   [&](const Outgoing& other) { return other.channel == message.channel; });
    remove(same != waiting_.end() ? same : waiting_.begin());
    ++left_out_;
  }
  bytes_ += message.bytes->size();
  waiting_.push_back(std::move(message));
}

std::optional<Outgoing> SendQueue::pop() {
  if (waiting_.empty()) {
    return std::nullopt;
  }
  Outgoing first = std::move(waiting_.front());
  bytes_ -= first.bytes->size();
  waiting_.pop_front();
  return first;
}

void SendQueue::end(std::uint32_t subscription) {
  for (auto message = waiting_.begin(); message != waiting_.end();) {
    if (message->subscription == subscription) {
      bytes_ -= message->bytes->size();
      message = waiting_.erase(message);
    } else {
      ++message;
    }
  }
}

std::size_t SendQueue::take_left_out() { return std::exchange(left_out_, 0); }

void SendQueue::remove(std::deque<Outgoing>::iterator message) {
  bytes_ -= message->bytes->size();
  waiting_.erase(message);
}

}  // namespace dynamic_icp::live
