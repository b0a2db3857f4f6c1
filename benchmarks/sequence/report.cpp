// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/report.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp::speed {
namespace {

/// The median over the runs of what `value` takes from each.
template <class Value>
double over_runs(const std::vector<Run>& runs, const Value& value) {
  std::vector<double> values;
  for (const Run& run : runs) {
    values.push_back(value(run));
  }
  return median(std::move(values));
}

auto without_recording(const Setup& setup) { return std::tie(setup.method, setup.preset, setup.threads); }

std::string number_or_dash(const std::optional<double>& value) { return value ? fmt::format("{:.2f}", *value) : "-"; }

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::string head(const Row& row) {
  return fmt::format("{:<24} {:<14} {:<8} {:>3}", short_name(row.setup.recording), row.setup.method, row.setup.preset,
                     row.setup.threads);
}

constexpr std::string_view kHead = "recording                method         preset   thr";

}  // namespace

Row summarise(const Setup& setup, const std::vector<Run>& runs) {
  Row row;
  row.setup = setup;
  row.runs = runs.size();
  row.scans = runs.front().ms.size();
  row.points_mean = runs.front().points_mean;
  row.points_used_mean = runs.front().points_used_mean;
  row.lost = runs.front().lost;
  std::vector<double> p50;
  for (const Run& run : runs) {
    p50.push_back(percentiles(run.ms).p50);
  }
  row.p50_ms = repeated(p50);
  row.p95_ms = over_runs(runs, [](const Run& run) { return percentiles(run.ms).p95; });
  row.p99_ms = over_runs(runs, [](const Run& run) { return percentiles(run.ms).p99; });
  row.max_ms = over_runs(runs, [](const Run& run) { return percentiles(run.ms).max; });
  row.cpu_ms = over_runs(runs, [](const Run& run) { return run.cpu_ms_mean; });
  for (std::size_t i = 0; i < runs.front().warm_up_ms.size(); ++i) {
    row.warm_up_ms.push_back(over_runs(runs, [i](const Run& run) { return run.warm_up_ms[i]; }));
  }
  for (const auto& entry : runs.front().stage_p50_ms) {
    row.stage_p50_ms[entry.first] = over_runs(runs, [&](const Run& run) { return run.stage_p50_ms.at(entry.first); });
  }
  row.peak_mib = over_runs(runs, [](const Run& run) { return run.peak_mib; });
  row.work_mib = over_runs(runs, [](const Run& run) { return run.peak_mib - run.loaded_mib; });
  if (std::all_of(runs.begin(), runs.end(), [](const Run& run) { return run.reference_ms.has_value(); })) {
    row.ratio = over_runs(runs, [](const Run& run) { return percentiles(run.ms).p50 / *run.reference_ms; });
  }
  return row;
}

void compare(std::vector<Row>& rows) {
  for (Row& row : rows) {
    const auto single = std::find_if(rows.begin(), rows.end(), [&](const Row& other) {
      return other.setup.threads == 1 && other.setup.recording == row.setup.recording &&
             other.setup.method == row.setup.method && other.setup.preset == row.setup.preset;
    });
    if (single != rows.end()) {
      row.speed_up = single->p50_ms.median / row.p50_ms.median;
    }
  }
}

std::vector<Growth> growth_of(const std::vector<Row>& rows) {
  std::vector<Growth> all;
  std::set<std::tuple<std::string, std::string, int>> done;
  for (const Row& first : rows) {
    if (!done.insert(without_recording(first.setup)).second) {
      continue;
    }
    std::vector<double> points;
    std::vector<double> ms;
    for (const Row& row : rows) {
      if (without_recording(row.setup) == without_recording(first.setup)) {
        points.push_back(row.points_mean);
        ms.push_back(row.p50_ms.median);
      }
    }
    if (const auto exponent = growth_exponent(points, ms)) {
      const auto [low, high] = std::minmax_element(points.begin(), points.end());
      all.push_back({{{}, first.setup.method, first.setup.preset, first.setup.threads}, *low, *high, *exponent});
    }
  }
  return all;
}

std::string short_name(const std::filesystem::path& recording) {
  // A path may end with a slash.
  const std::filesystem::path path = recording.has_filename() ? recording : recording.parent_path();
  const std::string parent = path.parent_path().filename().string();
  return parent.empty() ? path.filename().string() : parent + "/" + path.filename().string();
}

std::string table_text(const std::vector<Row>& rows) {
  std::string text = fmt::format(
      "{} {:>8} {:>6}  {:>8} {:>17} {:>8} {:>8} {:>8}  {:>8} {:>5} {:>6} {:>6} {:>6} {:>4}\n", kHead, "points", "used",
      "p50 ms", "(of runs)", "p95", "p99", "max", "warm-up", "x thr", "ratio", "MiB", "+scans", "lost");
  for (const Row& row : rows) {
    text += fmt::format(
        "{} {:>8.0f} {:>6.0f}  {:>8.2f} {:>17} {:>8.2f} {:>8.2f} {:>8.2f}  {:>8.2f} {:>5} {:>6} {:>6.0f} {:>6.0f} "
        "{:>4}\n",
        head(row), row.points_mean, row.points_used_mean, row.p50_ms.median,
        fmt::format("({:.2f}-{:.2f})", row.p50_ms.min, row.p50_ms.max), row.p95_ms, row.p99_ms, row.max_ms,
        *std::max_element(row.warm_up_ms.begin(), row.warm_up_ms.end()), number_or_dash(row.speed_up),
        number_or_dash(row.ratio), row.work_mib, row.peak_mib, row.lost);
  }
  return text;
}

std::string stage_text(const std::vector<Row>& rows) {
  std::vector<std::string> stages;
  std::string text(kHead);
  for (std::size_t stage = 0; stage < odometry::kStageCount; ++stage) {
    stages.emplace_back(to_string(static_cast<odometry::Stage>(stage)));
    text += fmt::format(" {:>12}", stages.back());
  }
  text += "\n";
  for (const Row& row : rows) {
    text += head(row);
    for (const std::string& stage : stages) {
      text += fmt::format(" {:>12.2f}", row.stage_p50_ms.at(stage));
    }
    text += "\n";
  }
  return text;
}

std::string growth_text(const std::vector<Growth>& growth) {
  std::string text;
  for (const Growth& one : growth) {
    text += fmt::format(
        "{:<14} {:<8} {:>3} threads: p50 grows with the points of a scan to the power of {:.2f}, {:.0f} to {:.0f} "
        "points\n",
        one.setup.method, one.setup.preset, one.setup.threads, one.exponent, one.from_points, one.to_points);
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<Row>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    list.push_back({{"recording", row.setup.recording.string()},
                    {"name", short_name(row.setup.recording)},
                    {"method", row.setup.method},
                    {"preset", row.setup.preset},
                    {"threads", row.setup.threads},
                    {"runs", row.runs},
                    {"scans", row.scans},
                    {"points_mean", row.points_mean},
                    {"points_used_mean", row.points_used_mean},
                    {"lost", row.lost},
                    {"p50_ms", row.p50_ms.median},
                    {"p50_ms_least_of_runs", row.p50_ms.min},
                    {"p50_ms_largest_of_runs", row.p50_ms.max},
                    {"p95_ms", row.p95_ms},
                    {"p99_ms", row.p99_ms},
                    {"max_ms", row.max_ms},
                    {"cpu_ms", row.cpu_ms},
                    {"warm_up_ms", row.warm_up_ms},
                    {"stage_p50_ms", row.stage_p50_ms},
                    {"speed_up", number_or_null(row.speed_up)},
                    {"ratio", number_or_null(row.ratio)},
                    {"work_mib", row.work_mib},
                    {"peak_mib", row.peak_mib}});
  }
  return list;
}

nlohmann::ordered_json json_of(const std::vector<Growth>& growth) {
  auto list = nlohmann::ordered_json::array();
  for (const Growth& one : growth) {
    list.push_back({{"method", one.setup.method},
                    {"preset", one.setup.preset},
                    {"threads", one.setup.threads},
                    {"exponent", one.exponent},
                    {"from_points", one.from_points},
                    {"to_points", one.to_points}});
  }
  return list;
}

}  // namespace dynamic_icp::speed
