// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/evaluation/assignment.hpp"
#include "dynamic_icp/recording/evaluation/statistics.hpp"
#include "dynamic_icp/recording/formats/json_row.hpp"

namespace dynamic_icp::evaluation {
namespace {

bool counts(const Body& body, const ObjectMatching& matching) {
  return body.points >= matching.min_points && body.velocity.norm() >= matching.min_speed_mps &&
         body.velocity.norm() > 0.0;
}

bool is_near(const Body& reported, const Body& truth, double max_distance_m) {
  const double distance_m = (reported.box.T_sensor_box.translation() - truth.box.T_sensor_box.translation()).norm();
  return distance_m < max_distance_m + 0.5 * truth.box.size.maxCoeff();
}

Eigen::MatrixXd overlaps(const std::vector<const Body*>& truth, const std::vector<Body>& reported) {
  return Eigen::MatrixXd::NullaryExpr(static_cast<Eigen::Index>(truth.size()),
                                      static_cast<Eigen::Index>(reported.size()), [&](Eigen::Index i, Eigen::Index j) {
                                        return intersection_over_union(truth[static_cast<std::size_t>(i)]->box,
                                                                       reported[static_cast<std::size_t>(j)].box);
                                      });
}

/// The bodies of a scan that count.
struct ComparedScan {
  std::vector<const Body*> truth;
  std::vector<const Body*> reported;
  Eigen::MatrixXd overlap;
  std::vector<std::optional<std::size_t>> partner;  ///< of each true one
};

ComparedScan compared(const ScanBodies& truth, const ScanBodies& reported, const ObjectMatching& matching) {
  ComparedScan result;
  std::vector<const Body*> others;
  for (const Body& body : truth.bodies) {
    (counts(body, matching) ? result.truth : others).push_back(&body);
  }
  result.overlap = overlaps(result.truth, reported.bodies);
  result.partner = best_assignment(result.overlap);
  std::vector<Eigen::Index> kept;
  for (std::size_t j = 0; j < reported.bodies.size(); ++j) {
    const Body& body = reported.bodies[j];
    const auto pair = std::ranges::find(result.partner, std::optional(j));
    if (pair != result.partner.end()) {
      *pair = kept.size();
    } else if (std::ranges::any_of(others,
                                   [&](const Body* other) { return is_near(body, *other, matching.max_distance_m); })) {
      continue;
    }
    kept.push_back(static_cast<Eigen::Index>(j));
    result.reported.push_back(&body);
  }
  result.overlap = result.overlap(Eigen::all, kept).eval();
  return result;
}

/// Errors of pairs.
struct PairErrors {
  std::vector<double> overlap, along, across, heading, center, size, nees;

  void add(const Body& truth, const Body& reported, double common) {
    overlap.push_back(common);
    const Eigen::Vector3d ahead = truth.velocity.normalized();
    const Eigen::Vector3d error = reported.velocity - truth.velocity;
    along.push_back(std::abs(error.dot(ahead)));
    across.push_back((error - error.dot(ahead) * ahead).norm());
    const Eigen::Vector3d of_truth = truth.box.T_sensor_box.linear().col(0);
    const Eigen::Vector3d of_reported = reported.box.T_sensor_box.linear().col(0);
    heading.push_back(std::atan2(of_truth.cross(of_reported).norm(), of_truth.dot(of_reported)) * 180.0 /
                      std::numbers::pi);
    center.push_back((reported.box.T_sensor_box.translation() - truth.box.T_sensor_box.translation()).norm());
    size.push_back((reported.box.size - truth.box.size).cwiseAbs().mean());
    if (reported.velocity_covariance) {
      const Eigen::LLT<Eigen::Matrix3d> covariance(*reported.velocity_covariance);
      if (covariance.info() == Eigen::Success) {
        nees.push_back(error.dot(covariance.solve(error)));
      }
    }
  }
};

/// When a true body counted first, and when it had its first pair.
struct FirstMatch {
  double counted_s = 0.0;
  std::optional<double> matched_s;
};

void set_means(const PairErrors& errors, ObjectTracking& result) {
  result.pairs = errors.overlap.size();
  result.overlap = mean_of(errors.overlap);
  result.along_mps = mean_of(errors.along);
  result.across_mps = mean_of(errors.across);
  result.heading_deg = mean_of(errors.heading);
  result.center_m = mean_of(errors.center);
  result.size_m = mean_of(errors.size);
  result.nees_velocity = mean_of(errors.nees);
}

void set_latency(const std::map<std::int64_t, FirstMatch>& first_matches, ObjectTracking& result) {
  std::vector<double> latencies;
  for (const auto& [id, match] : first_matches) {
    if (match.matched_s) {
      latencies.push_back(*match.matched_s - match.counted_s);
    }
  }
  if (const auto statistics = summarize(latencies)) {
    result.latency_s = statistics->median;
    result.longest_latency_s = statistics->max;
  }
}

ScoredScan scored(const ComparedScan& scan) {
  ScoredScan result;
  for (const Body* body : scan.truth) {
    result.true_ids.push_back(body->id);
  }
  for (const Body* body : scan.reported) {
    result.reported_ids.push_back(body->id);
  }
  result.similarity = scan.overlap;
  return result;
}

}  // namespace

ObjectTracking compare_tracks(const std::vector<ScanBodies>& truth, const std::vector<ScanBodies>& reported,
                              const ObjectMatching& matching) {
  std::map<std::int64_t, const ScanBodies*> truth_of;
  for (const ScanBodies& scan : truth) {
    truth_of[scan.index] = &scan;
  }
  ObjectTracking result;
  std::vector<ScoredScan> scans;
  PairErrors errors;
  std::map<std::int64_t, FirstMatch> first_matches;
  for (std::size_t k = matching.warm_up_scans; k < reported.size(); ++k) {
    const auto found = truth_of.find(reported[k].index);
    if (found == truth_of.end()) {
      continue;
    }
    const double time_s = found->second->time_s;
    const ComparedScan scan = compared(*found->second, reported[k], matching);
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      FirstMatch& match = first_matches.try_emplace(scan.truth[i]->id, FirstMatch{time_s, {}}).first->second;
      if (scan.partner[i]) {
        const double common = scan.overlap(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*scan.partner[i]));
        errors.add(*scan.truth[i], *scan.reported[*scan.partner[i]], common);
        if (common >= kMinOverlap && !match.matched_s) {
          match.matched_s = time_s;
        }
      }
    }
    scans.push_back(scored(scan));
    ++result.scans;
  }
  result.score = score_tracking(scans, kMinOverlap);
  set_means(errors, result);
  set_latency(first_matches, result);
  return result;
}

namespace {

Box box_of(const formats::JsonRow& row, const char* center, const char* orientation) {
  const Eigen::Vector4d xyzw = row.numbers<4>(orientation);
  if (!xyzw.allFinite() || !(std::abs(xyzw.norm() - 1.0) < 1e-3)) {
    row.fail(orientation, "a unit quaternion");
  }
  Box box;
  box.T_sensor_box = Eigen::Translation3d(row.finite_vector(center)) * Eigen::Quaterniond(xyzw.normalized());
  box.size = row.finite_vector("size");
  return box;
}

template <class Read>
std::vector<ScanBodies> read_bodies(const std::filesystem::path& path, const Read& read) {
  std::vector<ScanBodies> scans;
  formats::for_each_json_line(path, [&](const formats::JsonRow& row) {
    ScanBodies& scan = scans.emplace_back();
    scan.index = row.integer("index");
    scan.time_s = row.number("timestamp");
    for (const formats::JsonRow::Json& value : row.list("objects")) {
      scan.bodies.push_back(read(row.part("objects", value)));
    }
  });
  return scans;
}

Eigen::Matrix3d matrix_of(const formats::JsonRow& row, const char* key) {
  Eigen::Matrix3d matrix;
  const formats::JsonRow::Json& rows = row.list(key);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (rows.size() != 3 || !rows[i].is_array() || rows[i].size() != 3 || !rows[i][j].is_number()) {
        row.fail(key, "3 x 3 numbers");
      }
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j].get<double>();
    }
  }
  return matrix;
}

}  // namespace

std::vector<ScanBodies> read_true_bodies(const std::filesystem::path& path) {
  return read_bodies(path, [](const formats::JsonRow& row) {
    return Body{row.integer("id"), box_of(row, "center_sensor", "orientation_sensor_xyzw"),
                row.finite_vector("velocity_sensor"), std::nullopt, static_cast<std::size_t>(row.integer("points"))};
  });
}

std::vector<ScanBodies> read_reported_bodies(const std::filesystem::path& path) {
  return read_bodies(path, [&](const formats::JsonRow& row) {
    if (!row.has("box")) {
      throw DataError(
          fmt::format("{}: objects without boxes; expected those of a run with preset 'default'", path.string()));
    }
    Body body{row.integer("id"), box_of(row.object("box"), "center", "orientation_xyzw"), row.finite_vector("velocity"),
              std::nullopt, static_cast<std::size_t>(row.integer("points"))};
    if (row.has("velocity_covariance") && !row.get("velocity_covariance").is_null()) {
      body.velocity_covariance = matrix_of(row, "velocity_covariance");
    }
    return body;
  });
}

std::string tracking_table(const ObjectTracking& tracking) {
  const TrackingScore& score = tracking.score;
  std::string text = fmt::format("objects    {} in {} scans, {} found, {} false, {} id switches\n\n", score.true_bodies,
                                 tracking.scans, score.found, score.false_bodies, score.id_switches);
  const auto add = [&](std::string_view name, std::optional<double> value, std::string_view unit) {
    text += fmt::format("{:<42}{:>10}{}{}\n", name, value ? fmt::format("{:.3f}", *value) : "-",
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
  add("size, an edge", tracking.size_m, "m");
  add("NEES of the velocity (3 is right)", tracking.nees_velocity, "");
  add("latency, median over bodies", tracking.latency_s, "s");
  add("latency, the longest", tracking.longest_latency_s, "s");
  return text + "\nErrors are means of absolute values over pairs.\n";
}

std::string tracking_json(const ObjectTracking& tracking) {
  using Json = nlohmann::ordered_json;
  const auto number = [](std::optional<double> value) { return value ? Json(*value) : Json(nullptr); };
  const TrackingScore& score = tracking.score;
  const Json json = {{"scans", tracking.scans},
                     {"true_objects", score.true_bodies},
                     {"found", score.found},
                     {"false_objects", score.false_bodies},
                     {"id_switches", score.id_switches},
                     {"hota", number(score.hota)},
                     {"det_a", number(score.detection)},
                     {"ass_a", number(score.association)},
                     {"loc_a", number(score.localisation)},
                     {"min_overlap", kMinOverlap},
                     {"mota", number(score.mota)},
                     {"idf1", number(score.idf1)},
                     {"pairs", tracking.pairs},
                     {"overlap_mean", number(tracking.overlap)},
                     {"along_mae_mps", number(tracking.along_mps)},
                     {"across_mae_mps", number(tracking.across_mps)},
                     {"heading_mae_deg", number(tracking.heading_deg)},
                     {"center_mae_m", number(tracking.center_m)},
                     {"size_mae_m", number(tracking.size_m)},
                     {"nees_velocity", number(tracking.nees_velocity)},
                     {"latency_median_s", number(tracking.latency_s)},
                     {"latency_max_s", number(tracking.longest_latency_s)}};
  return json.dump(2) + "\n";
}

}  // namespace dynamic_icp::evaluation
