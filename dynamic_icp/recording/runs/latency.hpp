// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dynamic_icp/recording/datasets/followed_dataset.hpp"

namespace dynamic_icp::runs {

/// How long results took from when their scans were there, of a recording that grew.
struct Latency {
  std::size_t scans = 0;  ///< that came while they were waited for
  double median_ms = 0.0;
  double p99_ms = 0.0;
};

class Latencies {
 public:
  /// In ms, of the result that is there now; NaN where it is not known when the scan came.
  double add(const std::optional<datasets::Arrival>& arrival);

  [[nodiscard]] Latency summary() const;

 private:
  std::vector<double> latencies_ms_;
};

}  // namespace dynamic_icp::runs
