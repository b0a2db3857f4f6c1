// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"

#include "python/src/arrays.hpp"

namespace dynamic_icp::python {

/// The arrays of a dynamic_icp.Scan as the library looks at them. Keeps them alive; made and destroyed with the GIL,
/// `view` may be used without.
class ScanArrays {
 public:
  /// Throws UsageError naming the array that is of another shape or type than expected.
  explicit ScanArrays(const py::object& scan);

  [[nodiscard]] const ScanView& view() const { return view_; }

 private:
  template <class Number>
  std::span<const Number> channel(const py::object& scan, const char* name);
  py::array array(const py::object& scan, const char* name);

  std::vector<py::array> kept_;
  std::vector<Eigen::Isometry3d> mountings_;
  ScanView view_;
};

/// The members of a dynamic_icp.Scan.
py::dict scan_members(RawScan scan);

/// "relative" or "compensated". Throws UsageError for other words.
DopplerKind doppler_kind_of(const std::string& word);
const char* word_of(DopplerKind kind);

}  // namespace dynamic_icp::python
