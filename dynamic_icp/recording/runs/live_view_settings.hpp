// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/recording/live/access.hpp"

namespace dynamic_icp::runs {

/// Where a run may be watched (live_view.hpp).
struct LiveViewSettings {
  live::Access access;
  std::string page;  ///< HTML that browsers are given; empty: none
};

}  // namespace dynamic_icp::runs
