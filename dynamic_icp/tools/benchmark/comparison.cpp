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

/// A sequence in a comparison: per measure the cells of all variants.
struct Block {
  std::string label;
  std::vector<std::vector<TableCell>> cells;
};

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

std::vector<Block> blocks_of(const BenchmarkResults& results, const std::vector<Variant>& variants,
                             const std::vector<Measure>& measures) {
  std::vector<Block> blocks;
  for (const auto& [label, path] : results.info.sequences) {
    blocks.push_back({label, {}});
    for (const Measure& measure : measures) {
      blocks.back().cells.push_back(cells_of(numbers_of(results, label, variants, measure.pick), measure.style));
    }
  }
  if (blocks.size() > 1) {
    blocks.push_back({"Mean", {}});
    for (const Measure& measure : measures) {
      blocks.back().cells.push_back(cells_of(mean_numbers(results, variants, measure.pick), measure.style));
    }
  }
  return blocks;
}

/// Over which sequences the means are: some have no truth, or every run on them failed.
std::string mean_text(const BenchmarkResults& results, const std::vector<Variant>& variants, const Measure& measure) {
  const std::vector<std::string> sequences = sequences_with_numbers(results, variants, measure.pick);
  if (sequences.size() == results.info.sequences.size() || sequences.empty()) {
    return "over all sequences";
  }
  return fmt::format("over {} of the {} sequences ({}; the others have no number)", sequences.size(),
                     results.info.sequences.size(), fmt::join(sequences, ", "));
}

/// The measures as columns of a group.
void append_heads(Table& table, const std::string& group, const std::vector<Measure>& measures) {
  for (const Measure& measure : measures) {
    table.header.push_back({group, measure.title});
  }
}

void append_cells(std::vector<TableCell>& row, const Block& block, std::size_t variant) {
  for (const std::vector<TableCell>& cells : block.cells) {
    row.push_back(cells[variant]);
  }
}

void lay_out_by_variant(Table& table, const std::vector<Variant>& variants, const std::vector<Measure>& measures,
                        const std::vector<Block>& blocks) {
  table.header = {{"", "Method"}};
  for (const Block& block : blocks) {
    append_heads(table, block.label, measures);
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    table.rows.push_back({{variants[i].label, Emphasis::kNone}});
    for (const Block& block : blocks) {
      append_cells(table.rows.back(), block, i);
    }
  }
}

void lay_out_by_sequence(Table& table, const std::vector<Variant>& variants, const std::vector<Measure>& measures,
                         const std::vector<Block>& blocks) {
  table.header = {{"", "Sequence"}};
  for (const Variant& variant : variants) {
    append_heads(table, variant.label, measures);
  }
  for (const Block& block : blocks) {
    table.rows.push_back({{block.label, Emphasis::kNone}});
    for (std::size_t i = 0; i < variants.size(); ++i) {
      append_cells(table.rows.back(), block, i);
    }
  }
}

}  // namespace

Table comparison(const BenchmarkResults& results, const std::vector<Variant>& variants,
                 const std::vector<Measure>& measures, const std::string& what) {
  Table table;
  table.caption = fmt::format("{} Mean: {}, for methods that have a number on all of them. {}", what,
                              mean_text(results, variants, measures.front()), setup_text(results));
  if (variants.empty()) {
    return table;
  }
  const std::vector<Block> blocks = blocks_of(results, variants, measures);
  if (results.info.sequences.size() <= kMaxSequencesAsColumns) {
    lay_out_by_variant(table, variants, measures, blocks);
  } else {
    lay_out_by_sequence(table, variants, measures, blocks);
  }
  return table;
}

}  // namespace dynamic_icp::benchmark
