// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/run_data.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/tools/figures/field_parts_plot.hpp"
#include "dynamic_icp/tools/figures/field_plot.hpp"
#include "dynamic_icp/tools/figures/run_series.hpp"
#include "dynamic_icp/tools/report/run_facts.hpp"
#include "dynamic_icp/tools/report/scan_budget.hpp"

namespace dynamic_icp::report {
namespace {

using runs::FrameRow;
using runs::ObjectRow;
using runs::RunFiles;

// Decimals of numbers in the page: a tenth of what can be measured at best.
constexpr int kMetre = 4;
constexpr int kQuaternion = 7;
constexpr int kSpeed = 3;
constexpr int kSecond = 6;
constexpr int kDegree = 1;
constexpr int kPlotDigits = 5;  // significant ones

Json pairs(const Facts& facts) {
  Json list = Json::array();
  for (const auto& [key, value] : facts) {
    list.push_back({key, value});
  }
  return list;
}

void append(Json& list, const Eigen::Vector3d& vector, int decimals) {
  for (const double value : vector) {
    list.push_back(rounded(value, decimals));
  }
}

void append(Json& list, const Eigen::Isometry3d& pose) {
  append(list, pose.translation(), kMetre);
  const Eigen::Vector4d xyzw = Eigen::Quaterniond(pose.linear()).coeffs();
  for (const double value : xyzw) {
    list.push_back(rounded(value, kQuaternion));
  }
}

Json summary(const RunFiles& run) {
  Json list = Json::array();
  for (const SummaryRow& row : summary_of(run)) {
    Json entry = {{"key", row.key}, {"value", row.value}, {"meaning", row.meaning}};
    entry["number"] = std::isfinite(row.number) ? Json(row.number) : Json(nullptr);
    entry["better"] = *row.better == '\0' ? Json(nullptr) : Json(row.better);
    list.push_back(entry);
  }
  return list;
}

Json object(const ObjectRow& row) {
  const ObjectRow::Box box =
      row.box.value_or(ObjectRow::Box{.centre = row.centroid, .size = row.extent, .yaw_rad = 0.0});
  Json entry = {row.id};
  append(entry, row.velocity, kSpeed);
  append(entry, box.centre, kSpeed);
  append(entry, box.size, kSpeed);
  entry.push_back(rounded(box.yaw_rad * 180.0 / std::numbers::pi, kDegree));
  entry.push_back(rounded(row.points, 0));
  return entry;
}

Json directions(const FrameRow& frame) {
  Json texts = Json::array();
  for (const Vector6d& direction : frame.unobservable_directions) {
    texts.push_back(direction_text(direction));
  }
  return texts;
}

Json frames_data(const RunFiles& run, const std::vector<std::size_t>& kept) {
  Json index = Json::array();
  Json seconds = Json::array();
  Json poses = Json::array();
  Json velocity = Json::array();
  Json status = Json::array();
  Json reason = Json::array();
  Json lost = Json::array();
  Json objects = Json::array();
  for (const std::size_t k : kept) {
    const FrameRow& frame = run.frames[k];
    index.push_back(frame.index);
    seconds.push_back(rounded(run.seconds(k), kSecond));
    append(poses, run.trajectory[k].T_world_sensor);
    append(velocity, runs::velocity_at_stamp(frame), kSpeed);
    status.push_back(frame.reason == "first" ? frame.reason : frame.status);
    reason.push_back(frame.reason == "converged" || frame.reason == "first" ? "" : frame.reason);
    lost.push_back(directions(frame));
    Json list = Json::array();
    for (const ObjectRow& row : run.objects[k]) {
      list.push_back(object(row));
    }
    objects.push_back(list);
  }
  return {{"index", index},   {"seconds", seconds}, {"poses", poses},          {"ego_velocity", velocity},
          {"status", status}, {"reason", reason},   {"lost_directions", lost}, {"objects", objects}};
}

Json truth_data(const std::optional<figures::RunTruth>& truth, const std::vector<std::size_t>& kept) {
  if (!truth) {
    return nullptr;
  }
  Json poses = Json::array();
  for (const std::size_t k : kept) {
    if (truth->poses[k]) {
      append(poses, *truth->poses[k]);
      continue;
    }
    for (int i = 0; i < 7; ++i) {
      poses.push_back(nullptr);
    }
  }
  return {{"poses", poses}};
}

/// Metres to each kept frame: along the ground truth where there is one, else along the run itself, whose scale may
/// be wrong.
Json distances(const RunFiles& run, const std::optional<figures::RunTruth>& truth,
               const std::vector<std::size_t>& kept) {
  std::vector<double> along;
  double distance = 0.0;
  std::optional<Eigen::Vector3d> last;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    const std::optional<Eigen::Isometry3d> pose = truth ? truth->poses[k] : run.trajectory[k].T_world_sensor;
    if (pose) {
      distance += last ? (pose->translation() - *last).norm() : 0.0;
      last = pose->translation();
    }
    along.push_back(distance);
  }
  Json list = Json::array();
  for (const std::size_t k : kept) {
    list.push_back(rounded(along[k], kMetre));
  }
  return list;
}

Json stretches_data(const std::optional<figures::RunTruth>& truth) {
  if (!truth || truth->stretches.empty()) {
    return nullptr;
  }
  Json lengths = Json::array();
  Json counts = Json::array();
  Json translations = Json::array();
  Json rotations = Json::array();
  for (const figures::StretchError& error : truth->stretches) {
    lengths.push_back(error.length_m);
    counts.push_back(error.count);
    translations.push_back(significant(100.0 * error.translation_m / error.length_m, kPlotDigits));
    rotations.push_back(significant(100.0 * error.rotation_deg / error.length_m, kPlotDigits));
  }
  return {{"length", lengths}, {"count", counts}, {"translation", translations}, {"rotation", rotations}};
}

Json levels_data(const std::vector<figures::Level>& levels) {
  Json list = Json::array();
  for (const figures::Level& level : levels) {
    list.push_back({level.value, level.name});
  }
  return list;
}

Json plots_data(const RunFiles& run, const std::optional<figures::RunTruth>& truth,
                const std::vector<std::size_t>& kept) {
  Json plots = Json::array();
  for (const figures::RunSeries& plot : figures::run_series(run, truth)) {
    Json series = Json::array();
    for (const figures::Series& line : plot.panel.series) {
      Json values = Json::array();
      for (const std::size_t k : kept) {
        values.push_back(significant(line.values[k], kPlotDigits));
      }
      series.push_back({{"name", line.name}, {"values", values}, {"broad", line.broad}});
    }
    plots.push_back({{"id", plot.id},
                     {"title", plot.panel.title},
                     {"unit", plot.unit},
                     {"log", plot.panel.logarithmic},
                     {"from_zero", plot.panel.from_zero},
                     {"whole_numbers", plot.panel.whole_numbers},
                     {"levels", levels_data(plot.panel.levels)},
                     {"series", series}});
  }
  return plots;
}

Json pictures(const RunFiles& run) {
  Json list = Json::array();
  if (const auto calibration = runs::read_calibration_of(run.folder)) {
    const auto add = [&](const char* title, const char* caption, const auto& draw) {
      list.push_back({{"title", title},
                      {"caption", caption},
                      {"svg", draw(*calibration, drawing::theme(drawing::Ground::kLight)).element()},
                      {"svg_dark", draw(*calibration, drawing::theme(drawing::Ground::kDark)).element()}});
    };
    add("What was learned of the sensor: the error of its Doppler by direction",
        "At 30 m and medium intensity, mean of the faces. What looks like a velocity of the sensor is known by the "
        "planes only.",
        [](const auto&... what) { return figures::field_plot(what...); });
    add("By line, face and range",
        "Bars and band: one standard deviation. What all lines and faces have in common is among the directions.",
        [](const auto&... what) { return figures::field_parts_plot(what...); });
  }
  return list;
}

Facts origin(const RunFiles& run) {
  runs::Settings rest = run.run;
  std::erase_if(rest, [](const auto& entry) { return entry.first == "command"; });
  return texts_of(rest);
}

}  // namespace

Json run_data(const RunFiles& run, const std::optional<figures::RunTruth>& truth, const std::string& name,
              std::size_t max_frames) {
  const std::vector<std::size_t> kept = spread_frames(run.frames.size(), max_frames);
  Json frames = frames_data(run, kept);
  frames["distance"] = distances(run, truth, kept);
  return {{"name", name},
          {"facts", pairs(facts_of(run))},
          {"command", runs::text_of(run.run, "command")},
          {"warnings", warnings_of(run)},
          {"summary", summary(run)},
          {"origin", pairs(origin(run))},
          {"configuration", pairs(texts_of(run.configuration))},
          {"frames", std::move(frames)},
          {"truth", truth_data(truth, kept)},
          {"plots", plots_data(run, truth, kept)},
          {"stretches", stretches_data(truth)},
          {"pictures", pictures(run)},
          {"scans", nullptr},
          {"map", nullptr},
          {"traces", nullptr}};
}

}  // namespace dynamic_icp::report
