// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/evaluation/statistics.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::evaluation {
namespace {

using Json = nlohmann::json;

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

std::optional<double> mean(const std::vector<double>& values) {
  const auto statistics = summarize(values);
  return statistics ? std::optional(statistics->mean) : std::nullopt;
}

std::optional<double> ratio(std::size_t part, std::size_t whole) {
  return whole > 0 ? std::optional(static_cast<double>(part) / static_cast<double>(whole)) : std::nullopt;
}

Eigen::Vector3d vector_of(const Json& values) {
  if (values.size() != 3) {
    throw DataError(fmt::format("{} numbers, expected 3", values.size()));
  }
  return {values.at(0).get<double>(), values.at(1).get<double>(), values.at(2).get<double>()};
}

TrueObject true_object(const Json& json) {
  return {vector_of(json.at("velocity_sensor")), vector_of(json.at("center_sensor")), vector_of(json.at("size")),
          json.at("points").get<std::size_t>()};
}

ReportedObject reported_object(const Json& json) {
  return {vector_of(json.at("velocity")), vector_of(json.at("centroid"))};
}

template <class Objects, class Read>
std::vector<Objects> read_lines(const std::filesystem::path& path, const Read& read_object) {
  const std::string content = formats::read_text_file(path);
  std::string_view rest = content;
  std::vector<Objects> scans;
  for (std::size_t line = 1; const auto text = formats::take_line(rest); ++line) {
    try {
      const Json json = Json::parse(*text);
      Objects scan;
      scan.index = json.at("index").get<std::int64_t>();
      for (const Json& object : json.at("objects")) {
        scan.objects.push_back(read_object(object));
      }
      scans.push_back(std::move(scan));
    } catch (const Json::exception& error) {
      throw DataError(
          fmt::format("{}, line {}: not the moving objects of a scan: {}", path.string(), line, error.what()));
    } catch (const DataError& error) {
      throw DataError(fmt::format("{}, line {}: {}", path.string(), line, error.what()));
    }
  }
  return scans;
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
  result.along_mae_mps = mean(errors.along);
  result.lateral_mae_mps = mean(errors.lateral);
  if (const auto relative = summarize(errors.relative)) {
    result.median_relative_error = relative->median;
  }
  result.estimated_share = ratio(result.estimated, result.true_objects);
  result.false_per_scan = ratio(result.false_objects, result.scans);
  return result;
}

std::vector<TrueObjects> read_true_objects(const std::filesystem::path& path) {
  return read_lines<TrueObjects>(path, true_object);
}

std::vector<ReportedObjects> read_reported_objects(const std::filesystem::path& path) {
  return read_lines<ReportedObjects>(path, reported_object);
}

}  // namespace dynamic_icp::evaluation
