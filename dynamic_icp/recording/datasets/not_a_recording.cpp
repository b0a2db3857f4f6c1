// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/truth_search.hpp"
#include "dynamic_icp/recording/formats/csv.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEndingsNamed = 4;

/// Of an array that is not one of points with their Doppler.
std::string why_no_points(const fs::path& npy) {
  try {
    const formats::NpyArray array = formats::read_npy(npy);
    return fmt::format(
        "{}: has the shape ({}), expected (N, 4) or wider: x, y, z, Doppler of each point{}", npy.string(),
        fmt::join(array.shape, ", "),
        array.shape.size() == 3
            ? fmt::format("; write a file for each scan with Python: import numpy; [numpy.save(f'{{i:05d}}"
                          ".npy', scan) for i, scan in enumerate(numpy.load('{}'))]",
                          npy.string())
            : "");
  } catch (const DataError& error) {
    return fmt::format("{}; write a file for each scan with Python: numpy.savez('00000.npz', points=..., doppler=...)",
                       error.what());
  }
}

/// Of a text that is no table of points; empty where it may be one.
std::string why_no_table(const fs::path& csv) {
  try {
    const std::size_t columns = formats::read_csv(csv).columns.size();
    return columns >= 4 ? ""
                        : fmt::format("{}: has {} columns, expected x, y, z and the Doppler", csv.string(), columns);
  } catch (const DataError& error) {
    return error.what();
  }
}

std::string obstacle_of(const fs::path& file) {
  if (is_truth_name(file)) {
    return "";
  }
  const std::string ending = file.extension().string();
  if (ending == ".csv" || ending == ".xyz" || ending == ".asc") {
    return why_no_table(file);
  }
  const formats::FileKind kind = formats::kind_of_file(file);
  if (kind == formats::FileKind::kNpy) {
    return why_no_points(file);
  }
  const std::string_view what = formats::sentence(kind);
  const bool is_bag =
      kind == formats::FileKind::kRosBag || kind == formats::FileKind::kMcap || kind == formats::FileKind::kSqlite;
  return what.empty() ? "" : fmt::format("{}: {}{}", file.string(), what, is_bag ? ": name the file itself" : "");
}

std::string sentence_of(const fs::path& file) {
  try {
    return obstacle_of(file);
  } catch (const DataError&) {
    return "";  // a file that cannot be read tells nothing
  }
}

/// "20 *.dat, 1 *.txt": of files that are not hidden, the most first.
std::string counted_endings(const fs::path& folder) {
  std::map<std::string, std::size_t> counts;
  std::error_code fault;
  const auto is_file = [&](const fs::directory_entry& entry) {
    return entry.is_regular_file(fault) && entry.path().filename().string().front() != '.';
  };
  for (const fs::path& file : entries_of(folder, is_file)) {
    ++counts[file.extension().string()];
  }
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> texts;
  for (const auto& [ending, count] : sorted) {
    texts.push_back(fmt::format("{} {}", count, ending.empty() ? "without an ending" : "*" + ending));
  }
  return fmt::format("{}", fmt::join(std::span(texts).first(std::min(kEndingsNamed, texts.size())), ", "));
}

}  // namespace

std::string what_is_there(const fs::path& input) {
  std::error_code fault;
  if (fs::is_regular_file(input, fault)) {
    return is_truth_name(input) ? ": it is named as files of poses are" : "";
  }
  if (fs::is_regular_file(input / "run.json", fault)) {
    return ": it holds the results of a run; name the recording that was run";
  }
  const std::string endings = counted_endings(input);
  return endings.empty() ? ": it holds no files"
                         : fmt::format(
                               ": it holds {}; records of numbers are read where their names end in .bin, and "
                               "tables of text in .csv",
                               endings);
}

std::string known_obstacle(const fs::path& input) {
  std::error_code fault;
  if (fs::is_regular_file(input, fault)) {
    return sentence_of(input);
  }
  const auto is_file = [&](const fs::directory_entry& entry) { return entry.is_regular_file(fault); };
  for (const fs::path& file : entries_of(input, is_file)) {
    if (std::string sentence = sentence_of(file); !sentence.empty()) {
      return sentence;
    }
  }
  return "";
}

}  // namespace dynamic_icp::datasets
