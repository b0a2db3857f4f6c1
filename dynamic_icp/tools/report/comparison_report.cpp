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
#include "dynamic_icp/tools/figures/same_recording.hpp"
#include "dynamic_icp/tools/report/run_data.hpp"
#include "dynamic_icp/tools/report/run_facts.hpp"
#include "dynamic_icp/tools/report/worst_frames.hpp"

namespace dynamic_icp::report {
namespace {

namespace fs = std::filesystem;
using runs::RunFiles;
using runs::text_of;

constexpr const char* kResults = "results.json";
constexpr std::size_t kWorstFrames = 5;

/// Two runs of one method over the same recording from two containers.
struct Difference {
  std::size_t a = 0;
  std::size_t b = 0;
  figures::RunDifference apart;
};

/// Runs that share a picture.
struct Group {
  std::string name;
  std::vector<std::size_t> runs;
  std::vector<Difference> differences = {};
};

Json groups_data(const std::vector<Group>& groups) {
  Json list = Json::array();
  for (const Group& group : groups) {
    list.push_back({{"name", group.name}, {"runs", group.runs}});
    for (const Difference& difference : group.differences) {
      list.back()["differences"].push_back({{"runs", {difference.a, difference.b}},
                                            {"scans", difference.apart.scans},
                                            {"translation_mm", significant(1e3 * difference.apart.translation_m, 4)},
                                            {"rotation_deg", significant(difference.apart.rotation_deg, 4)}});
    }
  }
  return list;
}

/// The group called so, a new one if there is none.
Group& group_called(std::vector<Group>& groups, const std::string& name) {
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.name == name; });
  return found != groups.end() ? *found : groups.emplace_back(Group{name, {}});
}

/// How far a run is from those of its method over another container of the recording.
void add_differences(const std::vector<RunFiles>& runs, std::size_t added, Group& group) {
  const auto is_equal = [&](const RunFiles& other, const char* key) {
    return text_of(other.run, key) == text_of(runs[added].run, key);
  };
  for (const std::size_t place : group.runs) {
    const RunFiles& other = runs[place];
    if (is_equal(other, "method") && is_equal(other, "preset") && is_equal(other, "ablation") &&
        !is_equal(other, "input.path")) {
      if (const auto apart = figures::difference(other, runs[added])) {
        group.differences.push_back({place, added, *apart});
      }
    }
  }
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

/// The path of a run's own page as seen from another page; null where there is none.
Json page_of(const fs::path& run_folder, const fs::path& html) {
  const fs::path page = run_folder / "report.html";
  std::error_code fault;
  if (!fs::exists(page, fault)) {
    return nullptr;
  }
  const fs::path from = fs::absolute(html).lexically_normal().parent_path();
  const fs::path relative = fs::relative(page, from, fault);
  return fault || relative.empty() ? Json(nullptr) : Json(relative.generic_string());
}

/// The frames of a run that its reader looks at first, by their place in the run's own page.
Json worst_data(const RunFiles& run, const std::optional<figures::RunTruth>& truth) {
  constexpr int kDigits = 4;
  Json list = Json::array();
  for (const std::size_t k : worst_frames(run, truth, kWorstFrames)) {
    list.push_back({{"frame", k},
                    {"scan", run.frames[k].index},
                    {"status", run.frames[k].status},
                    {"translation_mm", truth ? significant(1e3 * truth->translation_error[k], kDigits) : Json(nullptr)},
                    {"rotation_deg", truth ? significant(truth->rotation_error[k], kDigits) : Json(nullptr)}});
  }
  return list;
}

/// Collects runs, and says when not all of their frames are shown.
class RunList {
 public:
  RunList(std::size_t runs, fs::path html)
      : html_(std::move(html)),
        max_frames_(std::max<std::size_t>(2, kMaxFramesCompared / std::max<std::size_t>(1, runs))) {}

  /// Returns the place of the run. `coloured` begins with the method: runs of equal words have one colour.
  std::size_t add(const RunFiles& run, const std::string& name, const std::string& coloured,
                  std::vector<std::string>& notes) {
    thinned_ += run.frames.size() > max_frames_ ? 1 : 0;
    const std::optional<figures::RunTruth> truth = truth_of(run, notes);
    runs_.push_back(run_data(run, truth, name, max_frames_));
    runs_.back()["page"] = page_of(run.folder, html_);
    runs_.back()["worst"] = worst_data(run, truth);
    coloured_.push_back(coloured);
    return runs_.size() - 1;
  }

  /// Also gives the runs their colours.
  [[nodiscard]] Json take(std::vector<std::string>& notes) {
    std::vector<std::string> names;
    for (const std::string& name : coloured_) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
    const std::vector<std::size_t> colours = drawing::colours_of_runs(names);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const auto place = std::find(names.begin(), names.end(), coloured_[k]) - names.begin();
      runs_[k]["colour"] = colours[static_cast<std::size_t>(place)];
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
  fs::path html_;
  std::vector<std::string> coloured_;
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

PageContent comparison_report(const std::vector<fs::path>& folders, const fs::path& html) {
  std::vector<RunFiles> runs;
  for (const fs::path& folder : folders) {
    runs.push_back(runs::read_run(folder));
  }
  const std::vector<std::string> names = distinguishing_names(runs);
  std::vector<std::string> notes = {
      "Scans are not shown where runs are compared: the report of a single run has them."};
  RunList list(runs.size(), html);
  std::vector<Group> groups;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string method = text_of(runs[k].run, "method");
    const std::string coloured = names[k].starts_with(method) ? names[k] : method + ", " + names[k];
    const std::size_t place = list.add(runs[k], names[k], coloured, notes);
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& other) {
      return figures::is_same_recording(runs[other.runs.front()], runs[k]);
    });
    if (group == groups.end()) {
      groups.push_back({name_of(runs[k]), {place}});
      continue;
    }
    add_differences(runs, place, *group);
    group->runs.push_back(place);
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

PageContent benchmark_report(const fs::path& folder, const fs::path& html) {
  const fs::path file = folder / kResults;
  const benchmark::BenchmarkResults results = benchmark::results_from_json(formats::read_text_file(file), file);
  std::vector<std::string> notes = {
      "Scans are not shown where runs are compared: the report of a single run has them."};
  RunList list(results.cells.size(), html);
  std::vector<Group> groups;
  for (const benchmark::CellResult& cell : results.cells) {
    const std::string label = label_of(results, cell.key);
    const std::string coloured = cell.key.method + (cell.key.ablation == "none" ? "" : ", " + cell.key.ablation);
    if (!cell.finished) {
      notes.push_back(fmt::format("{}, {}: failed. {}", cell.key.sequence, label, cell.failure));
      continue;
    }
    try {
      const RunFiles run = runs::read_run(folder / cell.folder / "run");
      group_called(groups, cell.key.sequence).runs.push_back(list.add(run, label, coloured, notes));
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
