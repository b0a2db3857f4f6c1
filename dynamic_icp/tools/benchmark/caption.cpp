// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/caption.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dynamic_icp::benchmark {
namespace {

/// "a, b in /data/day; c in /data/night".
std::string inputs_text(const BenchmarkInfo& info) {
  std::vector<std::pair<std::string, std::vector<std::string>>> folders;  // with the inputs in them
  for (const auto& [label, path] : info.sequences) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (folders.empty() || folders.back().first != folder) {
      folders.push_back({folder, {}});
    }
    folders.back().second.push_back(std::filesystem::path(path).filename().string());
  }
  std::string inputs;
  for (const auto& [folder, names] : folders) {
    inputs += fmt::format("{}{} in {}", inputs.empty() ? "" : "; ", fmt::join(names, ", "), folder);
  }
  return inputs;
}

/// What runs had to assume: " Assumed (gicp, kiss-icp): a scan period of 0.1 s."
std::string assumptions_text(const BenchmarkResults& results) {
  std::vector<std::pair<std::string, std::vector<std::string>>> assumptions;  // and by which methods, as they come
  for (const CellResult& cell : results.cells) {
    for (const std::string& note : cell.notes) {
      auto known =
          std::find_if(assumptions.begin(), assumptions.end(), [&](const auto& row) { return row.first == note; });
      if (known == assumptions.end()) {
        known = assumptions.insert(known, {note, {}});
      }
      if (std::find(known->second.begin(), known->second.end(), cell.key.method) == known->second.end()) {
        known->second.push_back(cell.key.method);
      }
    }
  }
  std::string text;
  for (const auto& [note, methods] : assumptions) {
    text += fmt::format(" Assumed ({}): {}.", fmt::join(methods, ", "), note);
  }
  return text;
}

/// That of the benchmark, and others that ran some of its cells, whose times are not to be compared.
std::string machines_text(const BenchmarkResults& results) {
  std::set<std::string> others;
  for (const CellResult& cell : results.cells) {
    if (!cell.processor.empty()) {
      others.insert(cell.processor);
    }
  }
  return others.empty() ? results.info.machine
                        : fmt::format("{}, some runs on {}", results.info.machine, fmt::join(others, " and "));
}

}  // namespace

std::string setup_text(const BenchmarkResults& results) {
  const BenchmarkInfo& info = results.info;
  int jobs = 1;
  for (const CellResult& cell : results.cells) {
    jobs = std::max(jobs, cell.jobs);
  }
  return fmt::format(
      "Measured with dynamic-icp {}, preset {}{}{}; {}; threads of a run: {}; runs at the same time: {}. Inputs: {}.{}",
      info.version, info.preset, info.settings.empty() ? "" : " with ", fmt::join(info.settings, " "),
      machines_text(results), info.threads == 0 ? "all" : std::to_string(info.threads), jobs, inputs_text(info),
      assumptions_text(results));
}

std::string own_caption(const Table& table, const BenchmarkResults& results) {
  std::string caption = table.caption;
  const std::string setup = setup_text(results);
  if (caption.ends_with(setup)) {
    caption.resize(caption.size() - setup.size());
  }
  constexpr std::string_view kMarks = "Best bold, second underlined";
  if (const std::size_t marks = caption.find(kMarks); marks != std::string::npos) {
    caption.replace(marks, kMarks.size(), "Best *, second +");
  }
  return caption.substr(0, caption.find_last_not_of(' ') + 1);
}

}  // namespace dynamic_icp::benchmark
