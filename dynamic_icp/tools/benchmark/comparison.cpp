// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/comparison.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/tools/benchmark/caption.hpp"

namespace dynamic_icp::benchmark {
namespace {

constexpr std::size_t kMaxSequencesAsColumns = 6;

/// A sequence in a comparison: the cells of all variants.
struct Block {
  std::string label;
  std::vector<TableCell> rte;
  std::vector<TableCell> rre;
};

constexpr Style kErrorStyle{.decimals = 4, .best = Best::kLowest};

std::optional<double> rte_of(const CellResult& cell) { return cell.rte_rmse_m; }
std::optional<double> rre_of(const CellResult& cell) { return cell.rre_rmse_deg; }

std::vector<Number> numbers_of(const BenchmarkResults& results, const std::string& sequence,
                               const std::vector<Variant>& variants, const Pick& pick) {
  std::vector<Number> numbers;
  for (const Variant& variant : variants) {
    numbers.push_back(number_of(find_cell(results, {sequence, variant.method, variant.ablation}), pick));
  }
  return numbers;
}

/// The sequences on which any variant has a number: those that means are over.
std::vector<std::string> sequences_with_numbers(const BenchmarkResults& results, const std::vector<Variant>& variants,
                                                const Pick& pick) {
  std::vector<std::string> sequences;
  for (const auto& [label, path] : results.info.sequences) {
    const std::vector<Number> numbers = numbers_of(results, label, variants, pick);
    if (std::any_of(numbers.begin(), numbers.end(), [](const Number& number) { return number.value.has_value(); })) {
      sequences.push_back(label);
    }
  }
  return sequences;
}

/// Per variant the mean over these sequences; nothing for one that lacks some of them.
std::vector<Number> mean_numbers(const BenchmarkResults& results, const std::vector<Variant>& variants,
                                 const Pick& pick) {
  std::vector<double> sums(variants.size(), 0.0);
  std::vector<bool> complete(variants.size(), true);
  const std::vector<std::string> sequences = sequences_with_numbers(results, variants, pick);
  for (const std::string& label : sequences) {
    const std::vector<Number> numbers = numbers_of(results, label, variants, pick);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      sums[i] += numbers[i].value.value_or(0.0);
      complete[i] = complete[i] && numbers[i].value;
    }
  }
  std::vector<Number> means(variants.size());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (complete[i] && !sequences.empty()) {
      means[i].value = sums[i] / static_cast<double>(sequences.size());
    }
  }
  return means;
}

std::vector<Block> blocks_of(const BenchmarkResults& results, const std::vector<Variant>& variants) {
  std::vector<Block> blocks;
  for (const auto& [label, path] : results.info.sequences) {
    blocks.push_back({label, cells_of(numbers_of(results, label, variants, rte_of), kErrorStyle),
                      cells_of(numbers_of(results, label, variants, rre_of), kErrorStyle)});
  }
  if (blocks.size() > 1) {
    blocks.push_back({"Mean", cells_of(mean_numbers(results, variants, rte_of), kErrorStyle),
                      cells_of(mean_numbers(results, variants, rre_of), kErrorStyle)});
  }
  return blocks;
}

/// Over which sequences the means are: some have no truth, or every run on them failed.
std::string mean_text(const BenchmarkResults& results, const std::vector<Variant>& variants) {
  const std::vector<std::string> sequences = sequences_with_numbers(results, variants, rte_of);
  if (sequences.size() == results.info.sequences.size() || sequences.empty()) {
    return "over all sequences";
  }
  return fmt::format("over {} of the {} sequences ({}; the others have no number)", sequences.size(),
                     results.info.sequences.size(), fmt::join(sequences, ", "));
}

void lay_out_by_variant(Table& table, const std::vector<Variant>& variants, const std::vector<Block>& blocks) {
  table.header = {{"", "Method"}};
  for (const Block& block : blocks) {
    table.header.push_back({block.label, "RTE [m]"});
    table.header.push_back({block.label, "RRE [deg]"});
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    table.rows.push_back({{variants[i].label, Emphasis::kNone}});
    for (const Block& block : blocks) {
      table.rows.back().push_back(block.rte[i]);
      table.rows.back().push_back(block.rre[i]);
    }
  }
}

void lay_out_by_sequence(Table& table, const std::vector<Variant>& variants, const std::vector<Block>& blocks) {
  table.header = {{"", "Sequence"}};
  for (const Variant& variant : variants) {
    table.header.push_back({variant.label, "RTE [m]"});
    table.header.push_back({variant.label, "RRE [deg]"});
  }
  for (const Block& block : blocks) {
    table.rows.push_back({{block.label, Emphasis::kNone}});
    for (std::size_t i = 0; i < variants.size(); ++i) {
      table.rows.back().push_back(block.rte[i]);
      table.rows.back().push_back(block.rre[i]);
    }
  }
}

}  // namespace

Table comparison(const BenchmarkResults& results, const std::vector<Variant>& variants, const std::string& what) {
  Table table;
  table.caption = fmt::format(
      "{} RTE, RRE: root mean square of the translation and rotation error of the motion from each scan to the next "
      "against the ground truth. Mean: {}, for methods that have a number on all of them. Best bold, second "
      "underlined, "
      "per sequence. {}",
      what, mean_text(results, variants), setup_text(results));
  if (variants.empty()) {
    return table;
  }
  const std::vector<Block> blocks = blocks_of(results, variants);
  if (results.info.sequences.size() <= kMaxSequencesAsColumns) {
    lay_out_by_variant(table, variants, blocks);
  } else {
    lay_out_by_sequence(table, variants, blocks);
  }
  return table;
}

}  // namespace dynamic_icp::benchmark
