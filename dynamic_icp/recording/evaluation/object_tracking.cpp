// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/evaluation/assignment.hpp"
#include "dynamic_icp/recording/evaluation/consistency.hpp"
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

/// Adds the NEES of an error to others where a covariance is stated.
void append_nees(std::vector<double>& nees, const Eigen::Vector3d& error,
                 const std::optional<Eigen::Matrix3d>& covariance) {
  if (const auto value = covariance ? squared_mahalanobis(error, *covariance) : std::nullopt) {
    nees.push_back(*value);
  }
}

/// Errors of pairs.
struct PairErrors {
  std::vector<double> overlap, along, across, heading, center, size, nees_velocity, nees_center;

  void add(const BodyPair& pair) {
    const Body& truth = pair.truth;
    const Body& reported = pair.reported;
    overlap.push_back(pair.overlap);
    const Eigen::Vector3d ahead = truth.velocity.normalized();
    const Eigen::Vector3d error = reported.velocity - truth.velocity;
    along.push_back(std::abs(error.dot(ahead)));
    across.push_back((error - error.dot(ahead) * ahead).norm());
    append_nees(nees_velocity, error, reported.velocity_covariance);
    const Eigen::Vector3d of_truth = truth.box.T_sensor_box.linear().col(0);
    const Eigen::Vector3d of_reported = reported.box.T_sensor_box.linear().col(0);
    heading.push_back(std::atan2(of_truth.cross(of_reported).norm(), of_truth.dot(of_reported)) * 180.0 /
                      std::numbers::pi);
    const Eigen::Vector3d center_error = reported.box.T_sensor_box.translation() - truth.box.T_sensor_box.translation();
    center.push_back(center_error.norm());
    append_nees(nees_center, center_error, reported.center_covariance);
    size.push_back((reported.box.size - truth.box.size).cwiseAbs().mean());
  }
};

/// When a true body counted first, and when it was first reported from then on.
struct FirstReport {
  double counted_s = 0.0;
  std::optional<double> reported_s;
};

/// By the id of the true body.
using FirstReports = std::map<std::int64_t, FirstReport>;

/// A body that counted once need not count in the scan that reports it: its points may be fewer again.
void add_first_reports(const ComparedScan& scan, const ScanBodies& truth, const ScanBodies& reported,
                       FirstReports& first) {
  for (const Body* body : scan.truth) {
    first.try_emplace(body->id, FirstReport{truth.time_s, {}});
  }
  std::vector<const Body*> expected;
  for (const Body& body : truth.bodies) {
    if (first.contains(body.id)) {
      expected.push_back(&body);
    }
  }
  const Eigen::MatrixXd overlap = overlaps(expected, reported.bodies);
  const std::vector<std::optional<std::size_t>> partner = best_assignment(overlap);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    FirstReport& report = first.at(expected[i]->id);
    if (!report.reported_s && partner[i] &&
        overlap(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*partner[i])) >= kMinOverlap) {
      report.reported_s = truth.time_s;
    }
  }
}

void set_means(ObjectTracking& result) {
  PairErrors errors;
  for (const BodyPair& pair : result.pairs) {
    errors.add(pair);
  }
  result.overlap = mean_of(errors.overlap);
  result.along_mps = mean_of(errors.along);
  result.across_mps = mean_of(errors.across);
  result.heading_deg = mean_of(errors.heading);
  result.center_m = mean_of(errors.center);
  result.size_m = mean_of(errors.size);
  result.nees_velocity = mean_of(errors.nees_velocity);
  result.nees_center = mean_of(errors.nees_center);
}

/// `span_s`: from the first scan that was compared to the last.
void set_rates(double span_s, ObjectTracking& result) {
  if (result.scans > 0) {
    result.false_per_1000_scans =
        1000.0 * static_cast<double>(result.score.false_bodies) / static_cast<double>(result.scans);
  }
  if (result.scans > 1 && span_s > 0.0 && result.score.true_bodies > 0) {
    const double period_s = span_s / static_cast<double>(result.scans - 1);
    result.switches_per_100_s = 100.0 * static_cast<double>(result.score.id_switches) /
                                (period_s * static_cast<double>(result.score.true_bodies));
  }
}

void set_latency(const FirstReports& first_reports, ObjectTracking& result) {
  std::vector<double> latencies;
  for (const auto& [id, report] : first_reports) {
    if (report.reported_s) {
      latencies.push_back(*report.reported_s - report.counted_s);
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
  FirstReports first_reports;
  double first_s = 0.0;
  double last_s = 0.0;
  for (std::size_t k = matching.warm_up_scans; k < reported.size(); ++k) {
    const auto found = truth_of.find(reported[k].index);
    if (found == truth_of.end()) {
      continue;
    }
    const double time_s = found->second->time_s;
    const ComparedScan scan = compared(*found->second, reported[k], matching);
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      if (scan.partner[i]) {
        const double common = scan.overlap(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*scan.partner[i]));
        result.pairs.push_back({found->first, time_s, *scan.truth[i], *scan.reported[*scan.partner[i]], common});
      }
    }
    add_first_reports(scan, *found->second, reported[k], first_reports);
    scans.push_back(scored(scan));
    first_s = result.scans == 0 ? time_s : first_s;
    last_s = time_s;
    ++result.scans;
  }
  result.score = score_tracking(scans, kMinOverlap);
  set_means(result);
  set_rates(last_s - first_s, result);
  set_latency(first_reports, result);
  return result;
}

std::vector<BodyPair> worst_pairs(std::vector<BodyPair> pairs, std::size_t count) {
  std::ranges::stable_sort(pairs, {}, &BodyPair::overlap);
  std::vector<BodyPair> worst;
  for (BodyPair& pair : pairs) {
    const bool is_known =
        std::ranges::any_of(worst, [&](const BodyPair& other) { return other.truth.id == pair.truth.id; });
    if (worst.size() < count && !is_known) {
      worst.push_back(std::move(pair));
    }
  }
  return worst;
}

namespace {

constexpr double kNearestScan_s = 0.075;

/// The scan of these, in the order of time, that is nearest; null where none is near.
const ScanBodies* scan_near(const std::vector<ScanBodies>& scans, double time_s) {
  const auto later = std::lower_bound(scans.begin(), scans.end(), time_s,
                                      [](const ScanBodies& scan, double time) { return scan.time_s < time; });
  const ScanBodies* nearest = nullptr;
  const auto consider = [&](const ScanBodies& scan) {
    const double apart_s = std::abs(scan.time_s - time_s);
    if (apart_s <= (nearest == nullptr ? kNearestScan_s : std::abs(nearest->time_s - time_s))) {
      nearest = &scan;
    }
  };
  if (later != scans.end()) {
    consider(*later);
  }
  if (later != scans.begin()) {
    consider(*(later - 1));
  }
  return nearest;
}

/// Where the centre of a true body is at a time, seen from where the sensor is in scan `from`.
std::optional<Eigen::Vector3d> true_center(std::int64_t id, double time_s, std::int64_t from,
                                           const std::vector<ScanBodies>& truth, const ScanPoses& T_world_sensor) {
  const ScanBodies* scan = scan_near(truth, time_s);
  if (scan == nullptr) {
    return std::nullopt;
  }
  const auto body = std::ranges::find(scan->bodies, id, &Body::id);
  const auto here = T_world_sensor.find(from);
  const auto there = T_world_sensor.find(scan->index);
  if (body == scan->bodies.end() || here == T_world_sensor.end() || there == T_world_sensor.end()) {
    return std::nullopt;
  }
  const Eigen::Vector3d center = body->box.T_sensor_box.translation() + (time_s - scan->time_s) * body->velocity;
  return here->second.inverse() * (there->second * center);
}

}  // namespace

PredictionError compare_predictions(const std::vector<BodyPair>& pairs, const std::vector<ScanBodies>& truth,
                                    const ScanPoses& T_world_sensor) {
  std::vector<double> distance;
  std::vector<double> nees;
  for (const BodyPair& pair : pairs) {
    if (const std::optional<PredictedCenter>& predicted = pair.reported.prediction) {
      const auto center =
          true_center(pair.truth.id, pair.time_s + predicted->after_s, pair.scan, truth, T_world_sensor);
      if (center) {
        const Eigen::Vector3d error = predicted->center - *center;
        distance.push_back(error.norm());
        append_nees(nees, error, predicted->covariance);
      }
    }
  }
  return {distance.size(), mean_of(distance), mean_of(nees)};
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

double finite_number(const formats::JsonRow& row, const char* key) {
  const double number = row.number(key);
  if (!std::isfinite(number)) {
    row.fail(key, "a finite number");
  }
  return number;
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

/// Empty where it is missing or null.
std::optional<Eigen::Matrix3d> matrix_if_any(const formats::JsonRow& row, const char* key) {
  return row.has(key) && !row.get(key).is_null() ? std::optional(matrix_of(row, key)) : std::nullopt;
}

Body true_body(const formats::JsonRow& row) {
  Body body;
  body.id = row.integer("id");
  body.box = box_of(row, "center_sensor", "orientation_sensor_xyzw");
  body.velocity = row.finite_vector("velocity_sensor");
  body.points = static_cast<std::size_t>(row.integer("points"));
  body.yaw_rate_rps = row.has("yaw_rate") ? finite_number(row, "yaw_rate") : 0.0;
  return body;
}

Body reported_body(const formats::JsonRow& row) {
  const formats::JsonRow box = row.object("box");
  Body body;
  body.id = row.integer("id");
  body.box = box_of(box, "center", "orientation_xyzw");
  body.velocity = row.finite_vector("velocity");
  body.velocity_covariance = matrix_if_any(row, "velocity_covariance");
  body.points = static_cast<std::size_t>(row.integer("points"));
  body.center_covariance = matrix_if_any(box, "center_covariance");
  if (row.has("prediction") && !row.get("prediction").is_null()) {
    const formats::JsonRow prediction = row.object("prediction");
    body.prediction = {finite_number(prediction, "after_s"), prediction.finite_vector("center"),
                       matrix_if_any(prediction, "center_covariance")};
  }
  return body;
}

}  // namespace

std::vector<ScanBodies> read_true_bodies(const std::filesystem::path& path) { return read_bodies(path, true_body); }

std::vector<ScanBodies> read_reported_bodies(const std::filesystem::path& path) {
  return read_bodies(path, [&](const formats::JsonRow& row) {
    if (!row.has("box")) {
      throw DataError(
          fmt::format("{}: objects without boxes; expected those of a run with preset 'default'", path.string()));
    }
    return reported_body(row);
  });
}

}  // namespace dynamic_icp::evaluation
