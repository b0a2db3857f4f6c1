// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::evaluation {

/// A moving thing as it truly is; sensor frame of its scan.
struct TrueObject {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, over ground
  Eigen::Vector3d center = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d size = Eigen::Vector3d::Zero();      ///< m, edges of its box
  std::size_t points = 0;                              ///< of the scan on it
};

struct TrueObjects {
  std::int64_t index = 0;  ///< of the scan in the recording
  std::vector<TrueObject> objects;
};

/// A moving thing as a run reports it; sensor frame of its scan.
struct ReportedObject {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, over ground
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< m
};

struct ReportedObjects {
  std::int64_t index = 0;  ///< of the scan in the recording
  std::vector<ReportedObject> objects;
};

/// Which true objects count, and when a reported object lies at a true one.
struct ObjectMatching {
  double max_distance_m = 3.0;    ///< centroid to true centre, beyond half the longest edge of the true box
  std::size_t min_points = 50;    ///< on the true object
  double min_speed_mps = 2.0;     ///< of the true object
  std::size_t warm_up_scans = 5;  ///< first scans of the run in which true objects do not count
};

/// Reported object velocities against the truth. Numbers that do not exist are empty, never NaN.
///
/// A true object counts when it has enough points, is fast enough and the run is warmed up. The nearest reported object
/// in reach is its estimate; one reported object may be the estimate of several true ones. With the true velocity v and
/// the estimate w, the error e = w - v has a part along the motion, |e.v| / |v|, and a part across it,
/// |e - (e.v) v / |v|^2|.
struct ObjectError {
  std::size_t scans = 0;                        ///< of the run, for which there is truth
  std::size_t true_objects = 0;                 ///< that count, over all scans
  std::size_t estimated = 0;                    ///< of these, with an estimate
  std::size_t false_objects = 0;                ///< reported ones in reach of no true object at all, over all scans
  std::optional<double> along_mae_mps;          ///< mean of the part along the motion
  std::optional<double> lateral_mae_mps;        ///< mean of the part across it
  std::optional<double> median_relative_error;  ///< median of the part along the motion over the true speed
  std::optional<double> estimated_share;        ///< estimated / true_objects: the recall
  std::optional<double> false_per_scan;         ///< false_objects / scans
};

/// Scans are paired by their index; reported scans without truth are left out.
ObjectError compare_objects(const std::vector<TrueObjects>& truth, const std::vector<ReportedObjects>& reported,
                            const ObjectMatching& matching = {});

/// objects.jsonl of a simulated recording: a line a scan with `index` and `objects` [{`velocity_sensor`,
/// `center_sensor`, `size`, `points`}]. Throws DataError naming the file and the line.
std::vector<TrueObjects> read_true_objects(const std::filesystem::path& path);

}  // namespace dynamic_icp::evaluation
