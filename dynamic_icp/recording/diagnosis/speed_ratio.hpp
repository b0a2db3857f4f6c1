// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"

namespace dynamic_icp::diagnosis {

/// How a speed can be told wrong.
struct SpeedRatio {
  const Comparison* reference = nullptr;
  double ratio = 1.0;          ///< Doppler speed as stored over the reference's by the stamps as stored
  bool is_one = true;          ///< within what is usual and what the evidence allows
  std::string_view unit = {};  ///< of the Doppler, where the ratio is the factor of a usual one
  double unit_factor = 1.0;    ///< as many of them are 1 m/s
};

/// Nothing where the Doppler gives no velocity along the reference's. The reference is ground truth or
/// matching scans, whichever gives the ratio better; but the metres of the latter are those of the points.
std::optional<SpeedRatio> speed_ratio(const Evidence& evidence);

}  // namespace dynamic_icp::diagnosis
