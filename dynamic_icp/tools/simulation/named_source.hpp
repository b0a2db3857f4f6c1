// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::simulation {

/// The random numbers of what has this name.
inline RandomSource named_source(RandomSource source, std::string_view name) {
  for (const char letter : name) {
    source = source.fork(static_cast<unsigned char>(letter));
  }
  return source;
}

}  // namespace dynamic_icp::simulation
