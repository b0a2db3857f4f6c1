// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/object_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"
#include "dynamic_icp/recording/evaluation/object_points.hpp"
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;
using evaluation::ObjectTracking;

constexpr double kLongestPoseGap_s = 0.2;
constexpr std::size_t kPoseColumns = 8;  // of motion.csv, as in a TUM file

/// The folder and the file in it, either of which may be named.
struct ObjectsFile {
  explicit ObjectsFile(const fs::path& path)
      : folder(fs::is_directory(path) ? path : path.parent_path()),
        file(fs::is_directory(path) ? path / "objects.jsonl" : path) {}

  fs::path folder;
  fs::path file;
};

/// Null where the folder holds no scans.
std::unique_ptr<datasets::Dataset> recording_in(const fs::path& folder) {
  try {
    return datasets::open_dataset(folder);
  } catch (const datasets::NotARecording&) {
    return nullptr;
  }
}

evaluation::ScanPoses scan_poses(const datasets::Dataset& dataset) {
  evaluation::ScanPoses poses;
  for (std::size_t k = 0; k < dataset.size(); ++k) {
    if (const auto pose = formats::pose_at(dataset.ground_truth(), dataset.stamp(k), kLongestPoseGap_s)) {
      poses[static_cast<std::int64_t>(k)] = *pose;
    }
  }
  return poses;
}

/// The poses of motion.csv, which holds velocities behind them and a line of names above; empty without the file.
formats::Trajectory true_motion(const fs::path& path) {
  if (!fs::exists(path)) {
    return {};
  }
  const std::string text = formats::read_text_file(path);
  std::string poses = "#";  // the names are a comment, so that messages count lines as they are
  std::size_t column = 1;
  for (const char letter : text) {
    column = letter == '\n' ? 1 : column + (letter == ',' ? 1U : 0U);
    if (column <= kPoseColumns) {
      poses += letter;
    }
  }
  return formats::parse_tum(poses, path.string()).trajectory;
}

/// The motion of the sensor during a scan.
evaluation::SensorMotion motion_from(Stamp stamp, const formats::Trajectory& sensor) {
  const auto T_world_stamp = formats::pose_at(sensor, stamp, kLongestPoseGap_s);
  return [=, &sensor](double time_s) -> std::optional<Eigen::Isometry3d> {
    const Stamp then{stamp.ns + std::llround(1e9 * time_s)};
    const auto T_world_then = formats::pose_at(sensor, then, kLongestPoseGap_s);
    return T_world_stamp && T_world_then ? std::optional(T_world_stamp->inverse() * *T_world_then) : std::nullopt;
  };
}

evaluation::HeldPoints compare_points(const ObjectTracking& tracking, const datasets::Dataset& dataset,
                                      const fs::path& recording) {
  const formats::Trajectory sensor = true_motion(recording / "motion.csv");
  std::vector<double> shares;
  auto pair = tracking.pairs.begin();
  while (pair != tracking.pairs.end()) {
    const auto index = static_cast<std::size_t>(pair->scan);
    const auto others = std::find_if(pair, tracking.pairs.end(),
                                     [&](const evaluation::BodyPair& other) { return other.scan != pair->scan; });
    if (index < dataset.size() && fs::exists(labels_file(recording, index))) {
      const RawScan scan = dataset.scan(index);
      const auto labels = read_labels(recording, index, scan.points.size());
      const evaluation::SensorMotion motion = motion_from(scan.stamp, sensor);
      for (auto one = pair; one != others; ++one) {
        if (const auto share = held_share(*one, {scan.points, scan.times, *labels}, motion)) {
          shares.push_back(*share);
        }
      }
    }
    pair = others;
  }
  return evaluation::held_points(std::move(shares));
}

std::optional<double> compare_labels(const std::vector<evaluation::ScanBodies>& reported, const fs::path& run,
                                     const fs::path& recording) {
  evaluation::StaticPoints points;
  for (const evaluation::ScanBodies& scan : reported) {
    const auto index = static_cast<std::size_t>(scan.index);
    if (const auto truth = read_labels(recording, index)) {
      if (const auto labels = read_labels(run, index, truth->size())) {
        points.add(*labels, *truth);
      }
    }
  }
  return points.share_on_moving();
}

}  // namespace

ObjectTracking compare_run_objects(const fs::path& run, const fs::path& recording) {
  const ObjectsFile of_run(run);
  const ObjectsFile of_recording(recording);
  const std::vector<evaluation::ScanBodies> truth = evaluation::read_true_bodies(of_recording.file);
  const std::vector<evaluation::ScanBodies> reported = evaluation::read_reported_bodies(of_run.file);
  ObjectTracking tracking = evaluation::compare_tracks(truth, reported);
  if (const auto dataset = recording_in(of_recording.folder)) {
    tracking.prediction = evaluation::compare_predictions(tracking.pairs, truth, scan_poses(*dataset));
    tracking.held = compare_points(tracking, *dataset, of_recording.folder);
  }
  tracking.map_ghosts = compare_labels(reported, of_run.folder, of_recording.folder);
  return tracking;
}

}  // namespace dynamic_icp::runs
