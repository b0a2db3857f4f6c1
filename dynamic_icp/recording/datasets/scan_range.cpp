// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/scan_range.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {

ScanRange select_scans(const Dataset& dataset, std::size_t start, std::optional<std::size_t> max_scans) {
  if (start >= dataset.size()) {
    throw UsageError(fmt::format("the first scan is to be {}, expected 0 to {}: the recording has {} scans", start,
                                 dataset.size() - 1, dataset.size()));
  }
  const std::size_t rest = dataset.size() - start;
  const ScanRange range{start, start + std::min(rest, max_scans.value_or(rest))};
  for (std::size_t i = range.begin + 1; i < range.end; ++i) {
    if (dataset.stamp(i) <= dataset.stamp(i - 1)) {
      throw DataError(fmt::format("{}: scan {} is at {} s, expected later than scan {} at {} s",
                                  dataset.scan_file(i).string(), i, format_seconds(dataset.stamp(i)), i - 1,
                                  format_seconds(dataset.stamp(i - 1))));
    }
  }
  return range;
}

}  // namespace dynamic_icp::datasets
