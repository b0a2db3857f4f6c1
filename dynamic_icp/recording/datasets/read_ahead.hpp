// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <future>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// Hands out the scans [begin, end) of a recording in their order and reads the one after in the meantime, on a thread
/// of its own. At most two scans are in memory. The recording must outlive it, and nobody else may read from it.
class ReadAhead {
 public:
  ReadAhead(const Dataset& dataset, std::size_t begin, std::size_t end);

  [[nodiscard]] bool done() const { return next_ == end_; }

  /// The next scan. Waits for it where the computation is faster than the disk; throws what `Dataset::scan` throws.
  RawScan next();

 private:
  void start_reading();

  const Dataset& dataset_;
  std::size_t next_;
  std::size_t end_;
  std::future<RawScan> reading_;
};

}  // namespace dynamic_icp::datasets
