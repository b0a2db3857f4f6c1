// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_run.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/evaluation/object_error.hpp"
#include "dynamic_icp/recording/evaluation/object_tracking.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/json_row.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/frame_rows.hpp"
#include "dynamic_icp/recording/runs/lost_scans.hpp"
#include "dynamic_icp/recording/runs/run_values.hpp"
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"
#include "dynamic_icp/tools/benchmark/machine.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kResultName = "cell.json";
constexpr const char* kMessagesName = "messages.txt";
constexpr std::size_t kLongestFailure = 1000;

void read_summary(const fs::path& path, CellResult& result) {
  const runs::Settings summary = runs::read_summary(path);
  const auto frames = runs::number_of(summary, "frames");
  if (!frames) {
    throw DataError(fmt::format("{}: not the summary of a run: the number of frames is missing", path.string()));
  }
  result.frames = static_cast<std::size_t>(*frames);
  for_each_number(result, [&](const char* key, std::optional<double>& value) {
    if (const auto number = runs::number_of(summary, key)) {
      value = number;
    }
  });
}

void read_notes(const fs::path& path, CellResult& result) {
  runs::RunRecord record = runs::read_run_json(path);
  result.notes = std::move(record.assumptions);
  result.warnings = record.warnings.size();
}

std::vector<evaluation::ReportedObjects> reported_objects(const std::vector<runs::ObjectsRow>& rows) {
  std::vector<evaluation::ReportedObjects> scans;
  for (const runs::ObjectsRow& row : rows) {
    evaluation::ReportedObjects& scan = scans.emplace_back();
    scan.index = static_cast<std::int64_t>(row.index);
    for (const runs::ObjectRow& object : row.objects) {
      scan.objects.push_back({object.velocity, object.centroid});
    }
  }
  return scans;
}

ObjectScores score_objects(const fs::path& truth, const std::vector<runs::ObjectsRow>& rows) {
  const evaluation::ObjectError error =
      evaluation::compare_objects(evaluation::read_true_objects(truth), reported_objects(rows));
  return {error.along_mae_mps, error.lateral_mae_mps, error.median_relative_error, error.estimated_share,
          error.false_per_scan};
}

/// Whether there are objects, all of them with boxes.
bool have_boxes(const std::vector<runs::ObjectsRow>& rows) {
  const auto all_have = [](const runs::ObjectsRow& row) {
    return std::ranges::all_of(row.objects, [](const runs::ObjectRow& object) { return object.box.has_value(); });
  };
  return std::ranges::any_of(rows, [](const runs::ObjectsRow& row) { return !row.objects.empty(); }) &&
         std::ranges::all_of(rows, all_have);
}

TrackScores score_tracks(const fs::path& truth, const fs::path& reported) {
  const std::vector<evaluation::ScanBodies> bodies = evaluation::read_true_bodies(truth);
  const evaluation::ObjectTracking tracking =
      evaluation::compare_tracks(bodies, evaluation::read_reported_bodies(reported));
  TrackScores scores;
  scores.hota = tracking.score.hota;
  scores.mota = tracking.score.mota;
  scores.idf1 = tracking.score.idf1;
  scores.switches_per_100_s = tracking.switches_per_100_s;
  scores.false_per_1000_scans = tracking.false_per_1000_scans;
  scores.along_mps = tracking.along_mps;
  scores.across_mps = tracking.across_mps;
  scores.heading_deg = tracking.heading_deg;
  scores.center_m = tracking.center_m;
  scores.size_m = tracking.size_m;
  scores.overlap = tracking.overlap;
  scores.nees_velocity = tracking.nees_velocity;
  scores.nees_center = tracking.nees_center;
  scores.latency_s = tracking.latency_s;
  return scores;
}

void read_objects(const fs::path& truth, const fs::path& reported, CellResult& result) {
  const std::vector<runs::ObjectsRow> rows = runs::read_objects(reported);
  result.objects = score_objects(truth, rows);
  if (have_boxes(rows)) {
    result.tracks = score_tracks(truth, reported);
  }
}

/// The last things the run said, without the program's name.
std::string last_messages(const fs::path& path) {
  std::string text;
  try {
    text = formats::read_whole_file(path);
  } catch (const DataError&) {
    return {};
  }
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) {
    text.pop_back();
  }
  if (text.size() > kLongestFailure) {
    text = "..." + text.substr(text.size() - kLongestFailure);
  }
  const std::string name = "dynamic-icp: ";
  return text.starts_with(name) ? text.substr(name.size()) : text;
}

/// This machine's processor when the plan is of a machine with another one, whose times are not to be compared.
std::string other_processor(const CellPlan& plan) {
  const Json fingerprint = Json::parse(plan.fingerprint);
  const std::string here = describe_processor();
  return fingerprint.value("processor", here) == here ? "" : here;
}

std::string failure_of(const EndedChild& child, const fs::path& messages) {
  const std::string said = last_messages(messages);
  const std::string ending = child.signal != 0
                                 ? fmt::format("killed by signal {} ({})", child.signal, ::strsignal(child.signal))
                                 : fmt::format("exit status {}", child.exit_status);
  return said.empty() ? ending : fmt::format("{}: {}", ending, said);
}

}  // namespace

std::optional<CellResult> ended_result(const fs::path& benchmark_folder, const CellPlan& plan) {
  const fs::path path = benchmark_folder / plan.folder / kResultName;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    return std::nullopt;
  }
  try {
    const Json saved = formats::read_json_object(path);
    const CellResult result = cell_from_json(saved.at("result").dump(), path);
    const bool same = saved.at("fingerprint") == Json::parse(plan.fingerprint) && result.key == plan.key;
    return same ? std::optional(result) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;  // of another version or damaged: as good as none
  }
}

std::optional<CellResult> saved_result(const fs::path& benchmark_folder, const CellPlan& plan) {
  std::error_code ignored;
  const bool is_there = fs::exists(benchmark_folder / plan.folder / "run" / "summary.json", ignored);
  const auto result = is_there ? ended_result(benchmark_folder, plan) : std::nullopt;
  return result && result->finished ? result : std::nullopt;
}

pid_t start_cell(const fs::path& benchmark_folder, const fs::path& program, const CellPlan& plan) {
  const fs::path folder = benchmark_folder / plan.folder;
  formats::make_folder(folder);
  remove_partial_files(folder);
  std::error_code fault;
  fs::remove(folder / kResultName, fault);
  if (fault) {
    throw DataError(fmt::format("{}: cannot remove: {}", (folder / kResultName).string(), fault.message()));
  }
  std::vector<std::string> arguments = plan.arguments;
  for (const std::string& word :
       {std::string("--output"), (folder / "run").string(), std::string("--force"), std::string("--quiet")}) {
    arguments.push_back(word);
  }
  return start_child(program, arguments, folder / kMessagesName);
}

CellResult finish_cell(const fs::path& benchmark_folder, const CellPlan& plan, const EndedChild& child, int jobs) {
  const fs::path folder = benchmark_folder / plan.folder;
  CellResult result;
  result.key = plan.key;
  result.folder = plan.folder;
  result.jobs = jobs;
  result.processor = other_processor(plan);
  result.peak_memory_mib = child.peak_memory_mib;
  // A method that loses most scans has numbers all the same, which a comparison is about.
  if (!child.succeeded() && child.exit_status != runs::kMostScansLost) {
    result.failure = failure_of(child, folder / kMessagesName);
  } else {
    try {
      const fs::path summary = folder / "run" / "summary.json";
      read_summary(summary, result);
      read_notes(folder / "run" / "run.json", result);
      if (!plan.object_truth.empty()) {
        read_objects(plan.object_truth, folder / "run" / "objects.jsonl", result);
      }
      result.finished = true;
      result.failure = child.succeeded() ? "" : runs::text_of(runs::read_summary(summary), "failure");
    } catch (const DataError& error) {
      result.failure = error.what();
    }
  }
  const Json saved = {{"fingerprint", Json::parse(plan.fingerprint)}, {"result", Json::parse(to_json(result))}};
  formats::write_whole_file(folder / kResultName, saved.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return result;
}

}  // namespace dynamic_icp::benchmark
