// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/scan_selection.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::apps {

ScanSelection select_scans(const datasets::Dataset& dataset, std::size_t start, std::optional<std::size_t> max_frames) {
  if (start >= dataset.size()) {
    throw UsageError(fmt::format("--start is {}, expected 0 to {}: the recording has {} scans", start,
                                 dataset.size() - 1, dataset.size()));
  }
  const std::size_t rest = dataset.size() - start;
  const ScanSelection selection{start, start + std::min(rest, max_frames.value_or(rest))};
  for (std::size_t i = selection.begin + 1; i < selection.end; ++i) {
    if (dataset.stamp(i) <= dataset.stamp(i - 1)) {
      throw DataError(fmt::format("{}: scan {} is at {} s, expected later than scan {} at {} s",
                                  dataset.scan_file(i).string(), i, format_seconds(dataset.stamp(i)), i - 1,
                                  format_seconds(dataset.stamp(i - 1))));
    }
  }
  return selection;
}

}  // namespace dynamic_icp::apps
