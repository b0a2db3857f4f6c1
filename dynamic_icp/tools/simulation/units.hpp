// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace dynamic_icp::simulation {

inline constexpr double kRadians = std::numbers::pi / 180.0;  ///< in a degree
inline constexpr double kNanoseconds = 1e9;                   ///< in a second
inline constexpr float kPercent = 100.0F;                     ///< in the whole

}  // namespace dynamic_icp::simulation
