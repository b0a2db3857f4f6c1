// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/benchmark_tables.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/benchmark/caption.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"
#include "dynamic_icp/tools/benchmark/tables.hpp"

#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw DataError(fmt::format("standard output: cannot write: {}", std::strerror(errno)));
  }
}

/// The forms of a table, by the endings of their files.
const std::pair<const char*, std::string (*)(const benchmark::Table&)> kTableForms[] = {
    {".md", benchmark::markdown}, {".csv", benchmark::csv}, {".tex", benchmark::latex}};

/// A folder without tables of earlier results, which the new ones may not replace. Other files are left alone.
void make_tables_folder(const fs::path& folder) {
  formats::make_folder(folder);
  for (const std::string& name : benchmark::table_names()) {
    for (const auto& [ending, write] : kTableForms) {
      std::error_code fault;
      fs::remove(folder / (name + ending), fault);
    }
  }
}

/// What is printed: aligned, what tables have in common once, at the end.
std::string plain_text(const std::vector<benchmark::Table>& tables, const benchmark::BenchmarkResults& results) {
  const std::size_t width = terminal_width(stdout);
  std::string text;
  for (const benchmark::Table& table : tables) {
    text += benchmark::plain(table) + "\n" + wrapped(benchmark::own_caption(table, results), width, 0) + "\n\n";
  }
  return text + wrapped(benchmark::setup_text(results), width, 0) + "\n";
}

}  // namespace

void write_tables(const fs::path& folder) {
  const fs::path source = folder / benchmark::kResultsName;
  if (!fs::exists(source)) {
    throw DataError(
        fmt::format("{}: holds no {}; expected the folder of a benchmark", folder.string(), benchmark::kResultsName));
  }
  const benchmark::BenchmarkResults results = benchmark::results_from_json(formats::read_text_file(source), source);
  make_tables_folder(folder / "tables");
  std::string all;
  const std::vector<benchmark::Table> tables = benchmark::all_tables(results);
  for (const benchmark::Table& table : tables) {
    for (const auto& [ending, write] : kTableForms) {
      formats::write_whole_file(folder / "tables" / (table.name + ending), write(table));
    }
    all += (all.empty() ? "" : "\n") + benchmark::markdown(table);
  }
  formats::write_whole_file(folder / "tables.md", all);
  print(plain_text(tables, results));
}

}  // namespace dynamic_icp::apps
