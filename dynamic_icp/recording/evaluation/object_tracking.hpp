// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/evaluation/box_overlap.hpp"
#include "dynamic_icp/recording/evaluation/object_error.hpp"
#include "dynamic_icp/recording/evaluation/tracking_score.hpp"

namespace dynamic_icp::evaluation {

/// Where a run expects the centre of a body to be.
struct PredictedCenter {
  double after_s = 0.0;                              ///< s after the stamp of the scan in which it was predicted
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m, sensor frame of that scan
  std::optional<Eigen::Matrix3d> covariance;         ///< m^2
};

/// A moving body in one scan, as it is or as a run reports it; sensor frame of the scan.
struct Body {
  std::int64_t id = 0;
  Box box;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, over ground
  std::optional<Eigen::Matrix3d> velocity_covariance;  ///< (m/s)^2, of reported ones
  std::size_t points = 0;                              ///< of the scan on it
  double yaw_rate_rps = 0.0;                           ///< about the z axis of its box, of true ones
  std::optional<Eigen::Matrix3d> center_covariance;    ///< m^2, of reported ones
  std::optional<PredictedCenter> prediction;           ///< of reported ones
};

struct ScanBodies {
  std::int64_t index = 0;  ///< of the scan in the recording
  double time_s = 0.0;
  std::vector<Body> bodies;
};

/// A true body that counts and the reported one that it is paired with.
struct BodyPair {
  std::int64_t scan = 0;  ///< index in the recording
  double time_s = 0.0;
  Body truth;
  Body reported;
  double overlap = 0.0;  ///< intersection over union, more than 0
};

/// Where bodies were expected to be, against where they were.
struct PredictionError {
  std::size_t count = 0;           ///< predictions for which there is truth
  std::optional<double> center_m;  ///< mean distance of the centres
  std::optional<double> nees;      ///< mean of e^T C^-1 e; 3 is right
};

/// Shares of the points of true bodies that lie in, or near, the reported boxes (object_points.hpp).
struct HeldPoints {
  std::optional<double> median;  ///< over pairs, 0 to 1
  std::optional<double> p5;      ///< 5th percentile
};

/// How well the moving bodies of a recording were tracked. A true body counts by ObjectMatching (its reach aside).
/// Reported ones pair with true ones that count by the intersection over union of their boxes; those that overlap with
/// or lie in reach of a true one that does not count, and pair with none, are left out. Only the latency takes pairs of
/// true bodies that counted before, too: a body whose points become fewer can still be reported.
struct ObjectTracking {
  std::size_t scans = 0;  ///< after the warm-up, for which there is truth
  TrackingScore score;    ///< of the intersection over union
  /// 100 id switches over the time that bodies which count are there: their scans times the mean period of scans.
  std::optional<double> switches_per_100_s;
  std::optional<double> false_per_1000_scans;
  std::vector<BodyPair> pairs;  ///< of each scan, those that have most in common
  // Over these, means of absolute errors
  std::optional<double> overlap;        ///< intersection over union
  std::optional<double> along_mps;      ///< of the velocity, along the true motion
  std::optional<double> across_mps;     ///< across it
  std::optional<double> heading_deg;    ///< between the directions that the boxes look ahead
  std::optional<double> center_m;       ///< distance of the centres
  std::optional<double> size_m;         ///< of an edge
  std::optional<double> nees_velocity;  ///< e^T C^-1 e; 3 is right
  std::optional<double> nees_center;
  std::optional<double> latency_s;  ///< median over bodies from when they count first to their first report
  std::optional<double> longest_latency_s;
  // What takes more than bodies to compare; `compare_tracks` leaves it empty
  PredictionError prediction;
  HeldPoints held;
  std::optional<double> map_ghosts;  ///< share of the points a run takes for static that lie on moving bodies, 0 to 1
};

/// The smallest overlap of a pair for MOTA, IDF1 and the latency.
constexpr double kMinOverlap = 0.25;

ObjectTracking compare_tracks(const std::vector<ScanBodies>& truth, const std::vector<ScanBodies>& reported,
                              const ObjectMatching& matching = {});

/// The pairs with the smallest overlap, the worst first: at most `count`, and one of each true body.
std::vector<BodyPair> worst_pairs(std::vector<BodyPair> pairs, std::size_t count);

/// T_world_sensor by the index of a scan in its recording.
using ScanPoses = std::map<std::int64_t, Eigen::Isometry3d>;

/// The predictions of the reported bodies of pairs against the same true bodies: those of the scan whose time is
/// nearest, moved by their velocity to the very time of the prediction, and by the true poses of the sensor into the
/// scan in which it was predicted. Left out are predictions with no scan within 75 ms of their time, no pose, or where
/// nothing of the body is seen then. `truth` in the order of time.
PredictionError compare_predictions(const std::vector<BodyPair>& pairs, const std::vector<ScanBodies>& truth,
                                    const ScanPoses& T_world_sensor);

/// objects.jsonl of a simulated recording. Throws DataError naming the file and the line.
std::vector<ScanBodies> read_true_bodies(const std::filesystem::path& path);

/// objects.jsonl of a run. Throws DataError naming the file and the line; bodies must have boxes. Covariances and
/// predictions, which older runs do not have, may be missing.
std::vector<ScanBodies> read_reported_bodies(const std::filesystem::path& path);

}  // namespace dynamic_icp::evaluation
