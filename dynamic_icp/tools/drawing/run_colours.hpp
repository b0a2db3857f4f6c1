// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dynamic_icp::drawing {

/// Which colour each of several runs or series has, by what they are called: a place in `Theme::series`, beyond its end
/// from the beginning again. A method ("kiss-icp", "dynamic-icp, paper") has the same in all pictures and pages,
/// whatever else is drawn; other names have the rest, in their order.
std::vector<std::size_t> colours_of_runs(const std::vector<std::string>& names);

}  // namespace dynamic_icp::drawing
