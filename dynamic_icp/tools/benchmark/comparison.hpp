// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/tools/benchmark/results.hpp"
#include "dynamic_icp/tools/benchmark/table.hpp"
#include "dynamic_icp/tools/benchmark/variants.hpp"

namespace dynamic_icp::benchmark {

/// A number by which variants are compared.
struct Measure {
  std::string title;  ///< with unit
  Style style;
  Pick pick;
};

/// The measures, at least one, of the variants on all sequences and their mean. Variants are the rows as in the paper;
/// with more than six sequences these are the rows. `what` begins the caption. Without variants there are no rows.
Table comparison(const BenchmarkResults& results, const std::vector<Variant>& variants,
                 const std::vector<Measure>& measures, const std::string& what);

}  // namespace dynamic_icp::benchmark
