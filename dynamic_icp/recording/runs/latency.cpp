// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/latency.hpp"

#include <chrono>
#include <limits>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::runs {

double Latencies::add(const std::optional<datasets::Arrival>& arrival) {
  if (!arrival) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const std::chrono::duration<double, std::milli> latency = std::chrono::steady_clock::now() - *arrival;
  latencies_ms_.push_back(latency.count());
  return latency.count();
}

Latency Latencies::summary() const {
  if (latencies_ms_.empty()) {
    return {};
  }
  return {latencies_ms_.size(), quantile(latencies_ms_, 0.5), quantile(latencies_ms_, 0.99)};
}

}  // namespace dynamic_icp::runs
