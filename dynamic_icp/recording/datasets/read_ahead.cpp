// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/read_ahead.hpp"

#include <utility>

namespace dynamic_icp::datasets {

ReadAhead::ReadAhead(const Dataset& dataset, std::size_t begin, std::size_t end)
    : dataset_(dataset), next_(begin), end_(end) {
  start_reading();
}

RawScan ReadAhead::next() {
  RawScan scan = reading_.get();
  ++next_;
  start_reading();
  return scan;
}

void ReadAhead::start_reading() {
  if (next_ < end_) {
    reading_ = std::async(std::launch::async, [this, index = next_] { return dataset_.scan(index); });
  }
}

}  // namespace dynamic_icp::datasets
