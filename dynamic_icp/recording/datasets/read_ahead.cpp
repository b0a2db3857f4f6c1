// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/read_ahead.hpp"

#include <utility>

namespace dynamic_icp::datasets {

ReadAhead::ReadAhead(const Dataset& dataset, std::size_t begin, std::size_t end)
    : dataset_(dataset), next_(begin), end_(end) {
  start_reading();
}

ReadAhead::ReadAhead(FollowedDataset& dataset, std::size_t begin, std::size_t end)
    : dataset_(dataset), followed_(&dataset), next_(begin), end_(end) {
  start_reading();
}

bool ReadAhead::done() const {
  if (next_ == end_ || followed_ == nullptr) {
    return next_ == end_;
  }
  reading_.wait();
  return is_at_end_;
}

bool ReadAhead::wait(std::chrono::milliseconds longest) const {
  return next_ == end_ || reading_.wait_for(longest) == std::future_status::ready;
}

RawScan ReadAhead::next() {
  Read read = reading_.get();
  arrival_ = read.arrival;
  notes_ = std::move(read.notes);
  ++next_;
  start_reading();
  return std::move(read.scan);
}

void ReadAhead::start_reading() {
  if (next_ < end_) {
    reading_ = std::async(std::launch::async, [this, index = next_] { return read(index); });
  }
}

ReadAhead::Read ReadAhead::read(std::size_t index) {
  if (followed_ == nullptr) {
    return {dataset_.scan(index), std::nullopt, {}};
  }
  followed_->release_before(index);
  if (!followed_->wait_for(index, [this] { return is_stopped_.load(); })) {
    is_at_end_ = true;
    return {};
  }
  return {dataset_.scan(index), followed_->arrival(index), followed_->take_notes()};
}

}  // namespace dynamic_icp::datasets
