// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dynamic_icp::formats {

/// Of a float16.
constexpr std::size_t kHalfBytes = 2;

/// The bytes of the same numbers as float32, which holds every float16. Both little-endian; an odd byte at the end is
/// left out.
std::string widened_halves(std::string_view halves);

}  // namespace dynamic_icp::formats
