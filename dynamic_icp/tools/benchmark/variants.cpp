// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/variants.hpp"

#include <algorithm>
#include <iterator>

namespace dynamic_icp::benchmark {
namespace {

const std::vector<Variant> kMethods = {{"point-to-point", "none", "ICP (point-to-point)"},
                                       {"point-to-plane", "none", "ICP (point-to-plane)"},
                                       {"gicp", "none", "GICP"},
                                       {"kiss-icp", "none", "KISS-ICP"},
                                       {"doppler-icp", "none", "Doppler-ICP"},
                                       {kOurMethod, "none", "Dynamic-ICP"}};

const std::vector<Variant> kAblations = {{kOurMethod, "no-vf", "w/o VF"},
                                         {kOurMethod, "no-dpp", "w/o DPP"},
                                         {kOurMethod, "no-dr", "w/o DR"},
                                         {kOurMethod, "none", "Full"}};

bool is_of(const CellResult& cell, const Variant& variant) {
  return cell.key.method == variant.method && cell.key.ablation == variant.ablation;
}

std::vector<Variant> known_variants_run(const BenchmarkResults& results, const std::vector<Variant>& known) {
  std::vector<Variant> run;
  std::copy_if(known.begin(), known.end(), std::back_inserter(run), [&](const Variant& variant) {
    return std::any_of(results.cells.begin(), results.cells.end(),
                       [&](const CellResult& cell) { return is_of(cell, variant); });
  });
  return run;
}

}  // namespace

std::vector<Variant> methods_run(const BenchmarkResults& results) {
  std::vector<Variant> run = known_variants_run(results, kMethods);
  for (const CellResult& cell : results.cells) {
    if (cell.key.ablation == "none" &&
        std::none_of(run.begin(), run.end(), [&](const Variant& variant) { return is_of(cell, variant); })) {
      run.push_back({cell.key.method, "none", cell.key.method});
    }
  }
  return run;
}

std::vector<Variant> ablations_run(const BenchmarkResults& results) { return known_variants_run(results, kAblations); }

const CellResult* find_cell(const BenchmarkResults& results, const CellKey& key) {
  const auto found =
      std::find_if(results.cells.begin(), results.cells.end(), [&](const CellResult& cell) { return cell.key == key; });
  return found == results.cells.end() ? nullptr : &*found;
}

Number number_of(const CellResult* cell, const Pick& pick) {
  if (cell == nullptr) {
    return {};
  }
  return cell->finished ? Number{pick(*cell), false} : Number{std::nullopt, true};
}

}  // namespace dynamic_icp::benchmark
