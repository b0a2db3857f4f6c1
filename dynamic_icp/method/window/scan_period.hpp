// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "dynamic_icp/method/window/learned_variance.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// The regular period of a sensor's scans, by least squares over its last stamps. A lost scan leaves a gap of whole
/// periods.
class ScanPeriod {
 public:
  /// Takes in the stamp of the next scan, s; that of the scan before again changes nothing. The time since the scan
  /// before as the stamps until then have it, a whole number of periods, and its variance, had it no variance of its
  /// own; nothing where too few stamps were seen or they follow no period.
  std::optional<KnownValue> add(double stamp_s);

  void state(StateArchive& archive);

 private:
  [[nodiscard]] std::optional<KnownValue> expected(double interval_s) const;

  std::vector<double> stamps_s_;  ///< ascending
};

}  // namespace dynamic_icp::window
