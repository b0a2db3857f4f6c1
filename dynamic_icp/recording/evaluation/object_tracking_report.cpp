// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_tracking_report.hpp"

#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace dynamic_icp::evaluation {

std::string tracking_table(const ObjectTracking& tracking) {
  const TrackingScore& score = tracking.score;
  std::string text = fmt::format("objects    {} in {} scans, {} found, {} false, {} id switches\n\n", score.true_bodies,
                                 tracking.scans, score.found, score.false_bodies, score.id_switches);
  const auto percent = [](std::optional<double> share) { return share ? std::optional(100.0 * *share) : std::nullopt; };
  const auto add = [&](std::string_view name, std::optional<double> value, std::string_view unit) {
    text += fmt::format("{:<46}{:>10}{}{}\n", name, value ? fmt::format("{:.3f}", *value) : "-",
                        unit.empty() ? "" : " ", unit);
  };
  add("HOTA", score.hota, "");
  add("  detection, DetA", score.detection, "");
  add("  association, AssA", score.association, "");
  add("  localisation, LocA", score.localisation, "");
  add(fmt::format("MOTA, pairs by an overlap of {}", kMinOverlap), score.mota, "");
  add("IDF1", score.idf1, "");
  add("intersection over union", tracking.overlap, "");
  add("velocity, along the motion", tracking.along_mps, "m/s");
  add("velocity, across it", tracking.across_mps, "m/s");
  add("heading", tracking.heading_deg, "deg");
  add("centre", tracking.center_m, "m");
  add("centre, predicted 1 s ahead", tracking.prediction.center_m, "m");
  add("size, an edge", tracking.size_m, "m");
  add("NEES of the velocity (3 is right)", tracking.nees_velocity, "");
  add("NEES of the centre", tracking.nees_center, "");
  add("NEES of the predicted centre", tracking.prediction.nees, "");
  add("points of a body in its box, median", percent(tracking.held.median), "%");
  add("points of a body in its box, 5th percentile", percent(tracking.held.p5), "%");
  add("static points on moving bodies", percent(tracking.map_ghosts), "%");
  add("latency, median over bodies", tracking.latency_s, "s");
  add("latency, the longest", tracking.longest_latency_s, "s");
  return text + "\nErrors are means of absolute values over pairs.\n";
}

std::string tracking_json(const ObjectTracking& tracking) {
  using OrderedJson = nlohmann::ordered_json;
  const auto number = [](std::optional<double> value) { return value ? OrderedJson(*value) : OrderedJson(nullptr); };
  const TrackingScore& score = tracking.score;
  const OrderedJson json = {{"scans", tracking.scans},
                            {"true_objects", score.true_bodies},
                            {"found", score.found},
                            {"false_objects", score.false_bodies},
                            {"id_switches", score.id_switches},
                            {"id_switches_per_100_s", number(tracking.switches_per_100_s)},
                            {"false_per_1000_scans", number(tracking.false_per_1000_scans)},
                            {"hota", number(score.hota)},
                            {"det_a", number(score.detection)},
                            {"ass_a", number(score.association)},
                            {"loc_a", number(score.localisation)},
                            {"min_overlap", kMinOverlap},
                            {"mota", number(score.mota)},
                            {"idf1", number(score.idf1)},
                            {"pairs", tracking.pairs.size()},
                            {"overlap_mean", number(tracking.overlap)},
                            {"along_mae_mps", number(tracking.along_mps)},
                            {"across_mae_mps", number(tracking.across_mps)},
                            {"heading_mae_deg", number(tracking.heading_deg)},
                            {"center_mae_m", number(tracking.center_m)},
                            {"size_mae_m", number(tracking.size_m)},
                            {"nees_velocity", number(tracking.nees_velocity)},
                            {"nees_center", number(tracking.nees_center)},
                            {"predictions", tracking.prediction.count},
                            {"predicted_center_mae_m", number(tracking.prediction.center_m)},
                            {"nees_predicted_center", number(tracking.prediction.nees)},
                            {"points_in_box_median", number(tracking.held.median)},
                            {"points_in_box_p5", number(tracking.held.p5)},
                            {"map_ghosts", number(tracking.map_ghosts)},
                            {"latency_median_s", number(tracking.latency_s)},
                            {"latency_max_s", number(tracking.longest_latency_s)}};
  return json.dump(2) + "\n";
}

}  // namespace dynamic_icp::evaluation
