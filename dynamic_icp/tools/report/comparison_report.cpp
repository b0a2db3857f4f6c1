// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/comparison_report.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"
#include "dynamic_icp/tools/benchmark/tables.hpp"
#include "dynamic_icp/tools/benchmark/variants.hpp"
#include "dynamic_icp/tools/drawing/run_colours.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"
#include "dynamic_icp/tools/report/run_data.hpp"
#include "dynamic_icp/tools/report/run_facts.hpp"

namespace dynamic_icp::report {
namespace {

namespace fs = std::filesystem;
using runs::RunFiles;
using runs::text_of;

constexpr const char* kResults = "results.json";

/// Runs that share a picture.
struct Group {
  std::string name;
  std::vector<std::size_t> runs;
};

Json groups_data(const std::vector<Group>& groups) {
  Json list = Json::array();
  for (const Group& group : groups) {
    list.push_back({{"name", group.name}, {"runs", group.runs}});
  }
  return list;
}

/// The group called so, a new one if there is none.
Group& group_called(std::vector<Group>& groups, const std::string& name) {
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.name == name; });
  return found != groups.end() ? *found : groups.emplace_back(Group{name, {}});
}

/// Each text once, in the order of their first use.
void add_notes(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  for (const std::string& note : more) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) {
      notes.push_back(note);
    }
  }
}

std::optional<figures::RunTruth> truth_of(const RunFiles& run, std::vector<std::string>& notes) {
  if (run.frames.empty()) {
    return std::nullopt;
  }
  // Only the truth is wanted: that the recording itself is gone is no loss here.
  std::vector<std::string> not_needed;
  const std::unique_ptr<datasets::Dataset> recording = figures::open_recording(run, not_needed);
  std::vector<std::string> of_truth;
  std::optional<figures::RunTruth> truth = figures::read_truth(run, recording.get(), of_truth);
  for (std::string& note : of_truth) {
    note = name_of(run) + ": " + note;
  }
  add_notes(notes, of_truth);
  return truth;
}

/// Collects runs, and says when not all of their frames are shown.
class RunList {
 public:
  explicit RunList(std::size_t runs)
      : max_frames_(std::max<std::size_t>(2, kMaxFramesCompared / std::max<std::size_t>(1, runs))) {}

  /// Returns the place of the run.
  std::size_t add(const RunFiles& run, const std::string& name, std::vector<std::string>& notes) {
    thinned_ += run.frames.size() > max_frames_ ? 1 : 0;
    runs_.push_back(run_data(run, truth_of(run, notes), name, max_frames_));
    return runs_.size() - 1;
  }

  /// Also gives the runs their colours, by their names.
  [[nodiscard]] Json take(std::vector<std::string>& notes) {
    std::vector<std::string> names;
    for (const Json& run : runs_) {
      if (const std::string name = run["name"]; std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
    const std::vector<std::size_t> colours = drawing::colours_of_runs(names);
    for (Json& run : runs_) {
      const auto place = std::find(names.begin(), names.end(), run["name"].get<std::string>()) - names.begin();
      run["colour"] = colours[static_cast<std::size_t>(place)];
    }

    if (thinned_ > 0) {
      notes.push_back(
          fmt::format("{} of {} runs show {} of their scans, evenly spread, in paths and plots; tables and "
                      "summaries hold all.",
                      thinned_, runs_.size(), max_frames_));
    }
    return std::move(runs_);
  }

 private:
  std::size_t max_frames_;
  std::size_t thinned_ = 0;
  Json runs_ = Json::array();
};

Json table_data(const benchmark::Table& table) {
  Json columns = Json::array();
  for (const benchmark::TableColumn& column : table.header) {
    columns.push_back(column.group.empty() ? column.title : column.group + " " + column.title);
  }
  Json rows = Json::array();
  Json best = Json::array();
  Json second = Json::array();
  for (const std::vector<benchmark::TableCell>& row : table.rows) {
    Json texts = Json::array();
    Json is_best = Json::array();
    Json is_second = Json::array();
    for (const benchmark::TableCell& cell : row) {
      texts.push_back(cell.text);
      is_best.push_back(cell.emphasis == benchmark::Emphasis::kBest);
      is_second.push_back(cell.emphasis == benchmark::Emphasis::kSecond);
    }
    rows.push_back(texts);
    best.push_back(is_best);
    second.push_back(is_second);
  }
  return {{"title", table.title}, {"caption", table.caption}, {"columns", columns}, {"rows", rows},
          {"best", best},         {"second", second}};
}

/// What the tables call the method of a cell.
std::string label_of(const benchmark::BenchmarkResults& results, const benchmark::CellKey& key) {
  const bool is_ablation = key.ablation != "none";
  for (const benchmark::Variant& variant :
       is_ablation ? benchmark::ablations_run(results) : benchmark::methods_run(results)) {
    if (variant.method == key.method && variant.ablation == key.ablation) {
      return variant.label;
    }
  }
  return is_ablation ? key.method + " " + key.ablation : key.method;
}

}  // namespace

PageContent comparison_report(const std::vector<fs::path>& folders) {
  std::vector<RunFiles> runs;
  for (const fs::path& folder : folders) {
    runs.push_back(runs::read_run(folder));
  }
  const std::vector<std::string> names = distinguishing_names(runs);
  std::vector<std::string> notes = {
      "Scans are not shown where runs are compared: the report of a single run has them."};
  RunList list(runs.size());
  std::vector<Group> groups;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    // By its path: two recordings may have one name.
    const std::string input = text_of(runs[k].run, "input.path");
    group_called(groups, input).runs.push_back(list.add(runs[k], names[k], notes));
  }
  for (Group& group : groups) {
    group.name = name_of(runs[group.runs.front()]);
  }
  PageContent content;
  content.report = {{"schema", 1},
                    {"kind", "comparison"},
                    {"title", fmt::format("{} runs compared", runs.size())},
                    {"generator", generator()}};
  content.report["runs"] = list.take(notes);
  content.report["notes"] = notes;
  content.report["groups"] = groups_data(groups);
  return content;
}

bool is_benchmark_folder(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / kResults, ignored);
}

PageContent benchmark_report(const fs::path& folder) {
  const fs::path file = folder / kResults;
  const benchmark::BenchmarkResults results = benchmark::results_from_json(formats::read_text_file(file), file);
  std::vector<std::string> notes = {
      "Scans are not shown where runs are compared: the report of a single run has them."};
  RunList list(results.cells.size());
  std::vector<Group> groups;
  for (const benchmark::CellResult& cell : results.cells) {
    const std::string label = label_of(results, cell.key);
    if (!cell.finished) {
      notes.push_back(fmt::format("{}, {}: failed. {}", cell.key.sequence, label, cell.failure));
      continue;
    }
    try {
      const RunFiles run = runs::read_run(folder / cell.folder / "run");
      group_called(groups, cell.key.sequence).runs.push_back(list.add(run, label, notes));
    } catch (const DataError& error) {
      notes.push_back(fmt::format("{}, {}: the run is not shown. {}", cell.key.sequence, label, error.what()));
    }
  }
  PageContent content;
  content.report = {{"schema", 1}, {"kind", "benchmark"}, {"title", folder_name(folder)}, {"generator", generator()}};
  content.report["runs"] = list.take(notes);
  content.report["notes"] = notes;
  content.report["groups"] = groups_data(groups);
  Json tables = Json::array();
  for (const benchmark::Table& table : benchmark::all_tables(results)) {
    tables.push_back(table_data(table));
  }
  content.report["tables"] = tables;
  return content;
}

}  // namespace dynamic_icp::report
