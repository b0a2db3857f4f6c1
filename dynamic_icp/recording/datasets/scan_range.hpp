// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// The scans [begin, end) of a recording.
struct ScanRange {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// The scans from `start` on, at most `max_scans` of them. Throws UsageError when the recording is shorter, DataError
/// naming the scan where stamps do not increase.
ScanRange select_scans(const Dataset& dataset, std::size_t start, std::optional<std::size_t> max_scans);

}  // namespace dynamic_icp::datasets
