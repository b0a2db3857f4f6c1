// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dynamic_icp/recording/evaluation/statistics.hpp"
#include "dynamic_icp/recording/formats/json_row.hpp"

namespace dynamic_icp::evaluation {
namespace {

struct Errors {
  std::vector<double> along;
  std::vector<double> lateral;
  std::vector<double> relative;

  void add(const Eigen::Vector3d& v_true, const Eigen::Vector3d& v_reported) {
    const double speed = v_true.norm();
    const Eigen::Vector3d error = v_reported - v_true;
    const double along_motion = error.dot(v_true) / speed;
    along.push_back(std::abs(along_motion));
    lateral.push_back((error - along_motion / speed * v_true).norm());
    relative.push_back(along.back() / speed);
  }
};

/// Marks the reported objects in reach of the true one; the index of the nearest of them.
std::optional<std::size_t> nearest_in_reach(const TrueObject& object, const std::vector<ReportedObject>& reported,
                                            double max_distance_m, std::vector<bool>& in_reach) {
  const double reach_m = max_distance_m + object.size.maxCoeff() / 2.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < reported.size(); ++i) {
    const double distance_m = (reported[i].centroid - object.center).norm();
    if (distance_m < reach_m) {
      in_reach[i] = true;
      if (distance_m < nearest_m) {
        nearest_m = distance_m;
        nearest = i;
      }
    }
  }
  return nearest;
}

std::optional<double> ratio(std::size_t part, std::size_t whole) {
  return whole > 0 ? std::optional(static_cast<double>(part) / static_cast<double>(whole)) : std::nullopt;
}

}  // namespace

ObjectError compare_objects(const std::vector<TrueObjects>& truth, const std::vector<ReportedObjects>& reported,
                            const ObjectMatching& matching) {
  std::map<std::int64_t, const TrueObjects*> truth_of;
  for (const TrueObjects& scan : truth) {
    truth_of[scan.index] = &scan;
  }
  ObjectError result;
  Errors errors;
  for (std::size_t k = 0; k < reported.size(); ++k) {
    const auto found = truth_of.find(reported[k].index);
    if (found == truth_of.end()) {
      continue;
    }
    const std::vector<ReportedObject>& candidates = reported[k].objects;
    std::vector<bool> in_reach(candidates.size(), false);
    for (const TrueObject& object : found->second->objects) {
      const auto nearest = nearest_in_reach(object, candidates, matching.max_distance_m, in_reach);
      const bool counts = k >= matching.warm_up_scans && object.points >= matching.min_points &&
                          object.velocity.norm() >= matching.min_speed_mps && object.velocity.norm() > 0.0;
      result.true_objects += counts ? 1 : 0;
      if (counts && nearest) {
        ++result.estimated;
        errors.add(object.velocity, candidates[*nearest].velocity);
      }
    }
    ++result.scans;
    result.false_objects += static_cast<std::size_t>(std::count(in_reach.begin(), in_reach.end(), false));
  }
  result.along_mae_mps = mean_of(errors.along);
  result.lateral_mae_mps = mean_of(errors.lateral);
  if (const auto relative = summarize(errors.relative)) {
    result.median_relative_error = relative->median;
  }
  result.estimated_share = ratio(result.estimated, result.true_objects);
  result.false_per_scan = ratio(result.false_objects, result.scans);
  return result;
}

std::vector<TrueObjects> read_true_objects(const std::filesystem::path& path) {
  std::vector<TrueObjects> scans;
  formats::for_each_json_line(path, [&](const formats::JsonRow& row) {
    TrueObjects& scan = scans.emplace_back();
    scan.index = row.integer("index");
    for (const formats::JsonRow::Json& value : row.list("objects")) {
      const formats::JsonRow object = row.part("objects", value);
      scan.objects.push_back({object.finite_vector("velocity_sensor"), object.finite_vector("center_sensor"),
                              object.finite_vector("size"), static_cast<std::size_t>(object.integer("points"))});
    }
  });
  return scans;
}

}  // namespace dynamic_icp::evaluation
