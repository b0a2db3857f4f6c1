// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "dynamic_icp/tools/benchmark/table.hpp"

namespace dynamic_icp::benchmark {

/// A number of a table before it is written.
struct Number {
  std::optional<double> value;
  bool failed = false;
};

enum class Best { kNone, kLowest, kHighest };

/// How a column of numbers is written and compared.
struct Style {
  int decimals = 2;
  bool percent = false;
  Best best = Best::kNone;
};

/// The numbers of a column as cells: "failed", "-" where there is no number, else the number. The best and the second
/// best stand out if there are at least two numbers, by what can be seen of them: equal texts share.
std::vector<TableCell> cells_of(const std::vector<Number>& numbers, const Style& style);

}  // namespace dynamic_icp::benchmark
