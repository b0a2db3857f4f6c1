// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/evaluation_report.hpp"

#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace dynamic_icp::evaluation {
namespace {

using Json = nlohmann::ordered_json;

// In the order of their types.
constexpr const char* kStatusNames[] = {"not-run", "given", "unique", "line", "point"};
constexpr const char* kUnitNames[] = {"frames", "seconds", "meters"};
constexpr const char* kAlignmentNames[] = {"none", "first", "se3", "sim3"};
constexpr const char* kAlignmentTexts[] = {"not aligned", "first poses made equal", "best rigid alignment",
                                           "best alignment with scale"};

template <class Enum, std::size_t kCount>
const char* name_of(const char* const (&names)[kCount], Enum value) {
  return names[static_cast<std::size_t>(value)];
}

/// "1 frame", "12 frames", "0.5 s", "100 m".
std::string gap_text(const RelativeGap& gap) {
  if (gap.unit == GapUnit::kFrames) {
    return fmt::format("{:g} frame{}", gap.length, gap.length == 1.0 ? "" : "s");
  }
  return fmt::format("{} {}", gap.length, gap.unit == GapUnit::kSeconds ? "s" : "m");
}

std::string number_text(std::optional<double> number) { return number ? fmt::format("{:.4g}", *number) : "-"; }

std::string statistics_row(std::string_view name, const std::optional<Statistics>& statistics) {
  const Statistics s = statistics.value_or(Statistics{});
  const auto text = [&](double number) { return statistics ? fmt::format("{:.4g}", number) : std::string("-"); };
  return fmt::format("{:<42}{:>10}{:>10}{:>10}{:>10}{:>10}{:>7}\n", name, text(s.rmse), text(s.mean), text(s.median),
                     text(s.p95), text(s.max), s.count);
}

/// "1 pose", "2 poses".
std::string poses_text(std::size_t count) { return fmt::format("{} pose{}", count, count == 1 ? "" : "s"); }

std::string matching_text(const Evaluation& evaluation, const EvaluationSource& source) {
  const Association& matched = evaluation.matched;
  return fmt::format(
      "estimate   {} ({})\n"
      "reference  {} ({})\n"
      "matched    {} of {} estimated poses: {} with equal stamps, {} interpolated (reference poses at most {:g} s "
      "apart)\n"
      "span       {:.3f} s; path {} m (reference), {} m (estimate)\n",
      source.estimate, poses_text(matched.estimate_count), source.reference, poses_text(matched.reference_count),
      matched.size(), matched.estimate_count, matched.exact_count, matched.size() - matched.exact_count,
      evaluation.config.association.max_gap_s, evaluation.time_span_s, number_text(evaluation.reference_path_length_m),
      number_text(evaluation.estimate_path_length_m));
}

std::string errors_text(const Evaluation& evaluation) {
  const std::string gap = gap_text(evaluation.relative.gap);
  std::string text = fmt::format("\n{:<42}{:>10}{:>10}{:>10}{:>10}{:>10}{:>7}\n", "error", "RMSE", "mean", "median",
                                 "p95", "max", "n");
  text += statistics_row(fmt::format("RTE  m, translation over {}", gap), evaluation.relative.translation_m);
  text += statistics_row(fmt::format("RRE  deg, rotation over {}", gap), evaluation.relative.rotation_deg);
  text += statistics_row(fmt::format("ATE  m, position, {}", name_of(kAlignmentTexts, evaluation.absolute.alignment)),
                         evaluation.absolute.translation_m);
  return text;
}

std::string segments_text(const SegmentError& segments) {
  if (segments.all.count == 0) {
    return "\ndrift over segments (KITTI): none, the path is not longer than 100 m\n";
  }
  std::string text = fmt::format("\n{:<42}{:>10}{:>16}{:>11}\n", "drift over segments (KITTI)", "transl. %",
                                 "rot. deg/100 m", "segments");
  const auto row = [](const std::string& name, const SegmentMean& mean) {
    return fmt::format("{:<42}{:>10}{:>16}{:>11}\n", name, number_text(mean.translation_percent),
                       number_text(mean.rotation_deg_per_100m), mean.count);
  };
  for (const SegmentLength& length : segments.lengths) {
    text += length.mean.count > 0 ? row(fmt::format("{:g} m", length.length_m), length.mean) : "";
  }
  return text + row("all segments", segments.all);
}

std::string consistency_text(const Consistency& consistency) {
  if (consistency.motions == 0) {
    return "";
  }
  const std::optional<double> beyond = consistency.beyond_4_sigma;
  return fmt::format("\n{:<42}{:>10}{:>14}{:>16}{:>7}\n{:<42}{:>10}{:>14}{:>16}{:>7}\n",
                     "stated covariance of the motion, NEES", "rotation", "translation", "beyond 4 sigma", "n",
                     "over 1 frame (3 is right)", number_text(consistency.nees_rotation),
                     number_text(consistency.nees_translation), beyond ? fmt::format("{:.1f} %", 100.0 * *beyond) : "-",
                     consistency.motions);
}

std::string alignment_warning(const AbsoluteError& absolute) {
  switch (absolute.status) {
    case AlignmentStatus::kLine:
      return "warning: the positions lie on one line; the alignment's rotation about it is taken from the first "
             "poses\n";
    case AlignmentStatus::kPoint:
      return "warning: the positions do not determine the alignment; its rotation is taken from the first poses\n";
    case AlignmentStatus::kNotRun:
      return "warning: the positions are too large for an absolute error\n";
    default:
      return "";
  }
}

std::string warnings_text(const Evaluation& evaluation, const EvaluationSource& source) {
  std::string text = alignment_warning(evaluation.absolute);
  if (evaluation.relative.steps.empty()) {
    text += fmt::format("warning: no two matched poses are {} apart: no relative error\n",
                        gap_text(evaluation.relative.gap));
  }
  if (evaluation.relative.steps_over_unmatched > 0) {
    text += fmt::format("warning: {} of {} relative errors span estimated poses without reference\n",
                        evaluation.relative.steps_over_unmatched, evaluation.relative.steps.size());
  }
  if (evaluation.repeated_reference_poses > 0) {
    text += fmt::format(
        "warning: the reference repeats its position {} times while the estimate moves; errors over "
        "single frames mean little, take a gap of 1 s\n",
        evaluation.repeated_reference_poses);
  }
  const auto repeated_lines = [](const std::string& name, std::size_t count) {
    return count > 0 ? fmt::format("warning: {}: {} repeated lines dropped\n", name, count) : "";
  };
  text += repeated_lines(source.estimate, source.estimate_repeated_lines);
  text += repeated_lines(source.reference, source.reference_repeated_lines);
  return text.empty() ? text : "\n" + text;
}

Json number(std::optional<double> value) { return value ? Json(*value) : Json(nullptr); }

/// Adds rte_rmse_m, rte_mean_m, ... for prefix "rte" and unit "m".
void add_statistics(Json& json, const std::string& prefix, const std::string& unit,
                    const std::optional<Statistics>& statistics) {
  const Statistics s = statistics.value_or(Statistics{});
  const auto add = [&](const char* name, double value) {
    json[fmt::format("{}_{}_{}", prefix, name, unit)] = number(statistics ? std::optional(value) : std::nullopt);
  };
  add("rmse", s.rmse);
  add("mean", s.mean);
  add("median", s.median);
  add("p95", s.p95);
  add("max", s.max);
}

void add_segment_mean(Json& json, const SegmentMean& mean) {
  json["count"] = mean.count;
  json["translation_percent"] = number(mean.translation_percent);
  json["rotation_deg_per_100m"] = number(mean.rotation_deg_per_100m);
}

Json alignment_json(const AbsoluteError& absolute) {
  const Eigen::Vector3d t = absolute.T_reference_estimate.translation();
  const Eigen::Quaterniond q(absolute.T_reference_estimate.linear());
  return {{"kind", alignment_name(absolute.alignment)},
          {"status", name_of(kStatusNames, absolute.status)},
          {"scale", absolute.scale},
          {"translation", {t.x(), t.y(), t.z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

Json segments_json(const SegmentError& segments) {
  Json json;
  add_segment_mean(json, segments.all);
  json["lengths"] = Json::array();
  for (const SegmentLength& length : segments.lengths) {
    Json row;
    row["length_m"] = length.length_m;
    add_segment_mean(row, length.mean);
    json["lengths"].push_back(row);
  }
  return json;
}

}  // namespace

const char* alignment_name(Alignment alignment) { return name_of(kAlignmentNames, alignment); }

std::string evaluation_table(const Evaluation& evaluation, const EvaluationSource& source) {
  return matching_text(evaluation, source) + errors_text(evaluation) + segments_text(evaluation.segments) +
         consistency_text(evaluation.consistency) + warnings_text(evaluation, source);
}

std::string evaluation_json(const Evaluation& evaluation, const EvaluationSource& source) {
  const Association& matched = evaluation.matched;
  Json json;
  json["estimate"] = source.estimate;
  json["reference"] = source.reference;
  json["estimate_poses"] = matched.estimate_count;
  json["reference_poses"] = matched.reference_count;
  json["estimate_repeated_lines"] = source.estimate_repeated_lines;
  json["reference_repeated_lines"] = source.reference_repeated_lines;
  json["matched"] = matched.size();
  json["matched_exact"] = matched.exact_count;
  json["matched_interpolated"] = matched.size() - matched.exact_count;
  json["max_gap_s"] = evaluation.config.association.max_gap_s;
  json["time_span_s"] = evaluation.time_span_s;
  json["path_length_m"] = number(evaluation.reference_path_length_m);
  json["estimate_path_length_m"] = number(evaluation.estimate_path_length_m);
  json["repeated_reference_poses"] = evaluation.repeated_reference_poses;
  json["relative_gap"] = {{"unit", name_of(kUnitNames, evaluation.relative.gap.unit)},
                          {"length", evaluation.relative.gap.length}};
  json["relative_steps"] = evaluation.relative.steps.size();
  json["relative_steps_over_unmatched"] = evaluation.relative.steps_over_unmatched;
  add_statistics(json, "rte", "m", evaluation.relative.translation_m);
  add_statistics(json, "rre", "deg", evaluation.relative.rotation_deg);
  add_statistics(json, "ate", "m", evaluation.absolute.translation_m);
  json["alignment"] = alignment_json(evaluation.absolute);
  json["segments"] = segments_json(evaluation.segments);
  const Consistency& consistency = evaluation.consistency;
  json["consistency"] = {{"motions", consistency.motions},
                         {"nees_rotation", number(consistency.nees_rotation)},
                         {"nees_translation", number(consistency.nees_translation)},
                         {"beyond_4_sigma", number(consistency.beyond_4_sigma)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace dynamic_icp::evaluation
