// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/frame_rows.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/formats/json_row.hpp"

namespace dynamic_icp::runs {
namespace {

using formats::JsonRow;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The ego velocity, NaN where it could not be estimated and zeros stand in the file.
Eigen::Vector3d ego_velocity(const JsonRow& row) {
  const std::string status = row.has("ego_velocity_status") ? row.text("ego_velocity_status") : "converged";
  const bool estimated = status == "converged" || status == "iteration_limit" || status == "from_motion";
  return estimated ? row.vector("ego_velocity") : Eigen::Vector3d::Constant(kNaN);
}

/// What runs of earlier versions do not hold is unknown.
double number_if_any(const JsonRow& row, const char* key) { return row.has(key) ? row.number(key) : kNaN; }

/// A square matrix as a list of its rows.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> square(const JsonRow& row, const char* key) {
  Eigen::Matrix<double, kSize, kSize> matrix;
  const JsonRow::Json& rows = row.list(key);
  for (std::size_t r = 0; r < kSize; ++r) {
    if (rows.size() != kSize || !rows[r].is_array() || rows[r].size() != kSize) {
      row.fail(key, fmt::format("{0} lists of {0} numbers", kSize));
    }
    for (std::size_t c = 0; c < kSize; ++c) {
      matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = row.number(rows[r][c], key);
    }
  }
  return matrix;
}

/// None where the file has null, and in runs of earlier versions.
std::optional<Matrix6d> covariance_of_six(const JsonRow& row, const char* key) {
  return row.has(key) && !row.get(key).is_null() ? std::optional(square<6>(row, key)) : std::nullopt;
}

std::optional<TwistRow> twist(const JsonRow& row) {
  if (!row.has("twist") || row.get("twist").is_null()) {
    return std::nullopt;
  }
  const JsonRow twist = row.object("twist");
  return TwistRow{.angular = twist.vector("angular"),
                  .linear = twist.vector("linear"),
                  .covariance = covariance_of_six(twist, "covariance")};
}

/// NaN in runs of earlier versions.
Eigen::Matrix3d covariance_if_any(const JsonRow& row, const char* key) {
  return row.has(key) ? square<3>(row, key) : Eigen::Matrix3d(Eigen::Matrix3d::Constant(kNaN));
}

std::vector<Vector6d> unobservable_directions(const JsonRow& row) {
  std::vector<Vector6d> directions;
  if (row.has("degenerate")) {
    for (const JsonRow::Json& entry : row.list("degenerate")) {
      directions.push_back(row.part("degenerate", entry).numbers<6>("direction"));
    }
  }
  return directions;
}

FrameRow frame_row(const JsonRow& row) {
  FrameRow frame;
  frame.index = static_cast<std::size_t>(row.integer("index"));
  frame.points = row.number("points");
  frame.points_used = row.number("points_used");
  frame.ego_velocity = ego_velocity(row);
  frame.dynamic_candidates = row.number("dynamic_candidates");
  frame.dynamic_clustered = row.number("dynamic_clustered");
  frame.dynamic_refined = row.number("dynamic_refined");
  frame.iterations = row.number("iterations");
  frame.converged = row.truth("converged");
  frame.status = row.text("status");
  frame.reason = row.text(row.has("reason") ? "reason" : "status");
  frame.fitness = row.number("fitness");
  frame.inlier_rmse = row.number("inlier_rmse");
  frame.information_ratio = number_if_any(row, "information_ratio");
  frame.unobservable_directions = unobservable_directions(row);
  frame.pose_covariance = covariance_of_six(row, "pose_covariance");
  frame.twist = twist(row);
  frame.doppler_bias = row.has("doppler_bias") ? row.number("doppler_bias") : 0.0;
  const JsonRow::Json& stages = row.get("ms");
  if (!stages.is_object()) {
    row.fail("ms", "an object of milliseconds per stage");
  }
  for (const auto& [stage, value] : stages.items()) {
    frame.milliseconds.emplace_back(stage, row.number(value, "ms"));
  }
  return frame;
}

/// The yaw of boxes that stand upright: their quaternion turns about z alone.
std::optional<ObjectRow::Box> box(const JsonRow& row) {
  if (!row.has("box")) {
    return std::nullopt;
  }
  const JsonRow box = row.object("box");
  const Eigen::Vector4d xyzw = box.numbers<4>("orientation_xyzw");
  return ObjectRow::Box{
      .centre = box.vector("center"), .size = box.vector("size"), .yaw_rad = 2.0 * std::atan2(xyzw.z(), xyzw.w())};
}

std::array<std::string, 6> faces(const JsonRow& box) {
  constexpr const char* kFaces[] = {"front", "rear", "left", "right", "top", "bottom"};
  std::array<std::string, 6> views;
  for (std::size_t k = 0; k < views.size(); ++k) {
    views[k] = box.has("faces") ? box.object("faces").text(kFaces[k]) : "unknown";
  }
  return views;
}

/// Of a method that tracks: only such objects have an age.
std::optional<ObjectRow::Track> track(const JsonRow& row) {
  if (!row.has("age_scans") || !row.has("box")) {
    return std::nullopt;
  }
  const JsonRow box = row.object("box");
  return ObjectRow::Track{.age_scans = row.integer("age_scans"),
                          .tangential_observed = row.has("tangential_observed") && row.truth("tangential_observed"),
                          .velocity_covariance = covariance_if_any(row, "velocity_covariance"),
                          .centre_covariance = covariance_if_any(box, "center_covariance"),
                          .faces = faces(box)};
}

ObjectRow object_row(const JsonRow& row) {
  return {.id = row.integer("id"),
          .velocity = row.vector("velocity"),
          .centroid = row.vector("centroid"),
          .extent = row.vector("extent"),
          .points = row.number("points"),
          .box = box(row),
          .track = track(row)};
}

}  // namespace

std::vector<FrameRow> read_frames(const std::filesystem::path& path) {
  std::vector<FrameRow> frames;
  formats::for_each_json_line(path, [&](const JsonRow& row) { frames.push_back(frame_row(row)); });
  return frames;
}

evaluation::StatedMotion stated_motion(const FrameRow& frame) {
  using odometry::FrameStatus;
  const bool skipped =
      frame.reason == to_string(FrameStatus::kTooFewPoints) || frame.reason == to_string(FrameStatus::kTooSoon);
  return {frame.pose_covariance, frame.status == "ok", skipped};
}

std::vector<ObjectsRow> read_objects(const std::filesystem::path& path) {
  std::vector<ObjectsRow> scans;
  formats::for_each_json_line(path, [&](const JsonRow& row) {
    ObjectsRow& scan = scans.emplace_back();
    scan.index = static_cast<std::size_t>(row.integer("index"));
    for (const JsonRow::Json& object : row.list("objects")) {
      scan.objects.push_back(object_row(row.part("objects", object)));
    }
  });
  return scans;
}

}  // namespace dynamic_icp::runs
