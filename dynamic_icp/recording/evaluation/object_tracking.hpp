// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/recording/evaluation/box_overlap.hpp"
#include "dynamic_icp/recording/evaluation/object_error.hpp"
#include "dynamic_icp/recording/evaluation/tracking_score.hpp"

namespace dynamic_icp::evaluation {

/// A moving body in one scan, as it is or as a run reports it; sensor frame of the scan.
struct Body {
  std::int64_t id = 0;
  Box box;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, over ground
  std::optional<Eigen::Matrix3d> velocity_covariance;  ///< (m/s)^2, of reported ones
  std::size_t points = 0;                              ///< of the scan on it
};

struct ScanBodies {
  std::int64_t index = 0;  ///< of the scan in the recording
  double time_s = 0.0;
  std::vector<Body> bodies;
};

/// How well the moving bodies of a recording were tracked. A true body counts by ObjectMatching (its reach aside).
/// Reported ones pair with true ones that count by the intersection over union of their boxes; those that overlap with
/// or lie in reach of a true one that does not count, and pair with none, are left out.
struct ObjectTracking {
  std::size_t scans = 0;  ///< after the warm-up, for which there is truth
  TrackingScore score;    ///< of the intersection over union
  // Of the pairs of each scan that have most in common: means of absolute errors
  std::size_t pairs = 0;
  std::optional<double> overlap;        ///< intersection over union
  std::optional<double> along_mps;      ///< of the velocity, along the true motion
  std::optional<double> across_mps;     ///< across it
  std::optional<double> heading_deg;    ///< between the directions that the boxes look ahead
  std::optional<double> center_m;       ///< distance of the centres
  std::optional<double> size_m;         ///< of an edge
  std::optional<double> nees_velocity;  ///< e^T C^-1 e; 3 is right
  std::optional<double> latency_s;      ///< median over bodies from when they count first to their first pair
  std::optional<double> longest_latency_s;
};

/// The smallest overlap of a pair for MOTA, IDF1 and the latency.
constexpr double kMinOverlap = 0.25;

ObjectTracking compare_tracks(const std::vector<ScanBodies>& truth, const std::vector<ScanBodies>& reported,
                              const ObjectMatching& matching = {});

/// objects.jsonl of a simulated recording. Throws DataError naming the file and the line.
std::vector<ScanBodies> read_true_bodies(const std::filesystem::path& path);

/// objects.jsonl of a run. Throws DataError naming the file and the line; bodies must have boxes.
std::vector<ScanBodies> read_reported_bodies(const std::filesystem::path& path);

/// The comparison as a table to read, or as one JSON object with every number, null where there is none. Both end with
/// a line break.
std::string tracking_table(const ObjectTracking& tracking);
std::string tracking_json(const ObjectTracking& tracking);

}  // namespace dynamic_icp::evaluation
