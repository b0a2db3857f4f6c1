// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <fmt/format.h>

namespace dynamic_icp::apps {

/// What to state of scans whose points have no times, where the Doppler does not show how they were taken.
inline std::string sweep_advice(double period_s) {
  return fmt::format(
      "if the sensor takes the whole period for a scan, state it: --set sweep.declared_duration_s={:.3g} (right to "
      "left), and for left to right --set sweep.declared_left_to_right=true as well",
      period_s > 0.0 ? period_s : 0.1);
}

}  // namespace dynamic_icp::apps
