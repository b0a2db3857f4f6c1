// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace dynamic_icp {

/// Brings finite values into an order in which that in `place` (below their number) is the one that stands there when
/// they ascend; none before it is larger, and none behind it is smaller. As std::nth_element, but without branches that
/// depend on values: of unordered numbers a processor foretells half of them only.
void select_place(std::span<double> values, std::size_t place);

}  // namespace dynamic_icp
