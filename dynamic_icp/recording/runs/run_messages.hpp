// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::runs {

/// Column `label` of the points, which are those of labels/*.bin but for the last one.
inline constexpr std::int32_t kLabelNotUsed = -1;
inline constexpr std::int32_t kLabelStatic = 0;   ///< and above it the id of an object
inline constexpr std::int32_t kLabelMoving = -2;  ///< by its Doppler, and of no object

/// What the messages of a run are about.
enum class RunTopic : std::uint8_t { kPoints, kTransforms, kPath, kObjects, kState, kTruthPath };

struct RunTopicRow {
  RunTopic topic;
  const char* name;  ///< "/points"
  const char* type;  ///< of its messages: messages::protobuf_schema
};

/// All topics by their numbers; the last one is that of the ground truth.
std::span<const RunTopicRow> run_topics();

/// Where messages go.
struct MessageSink {
  std::function<void(RunTopic topic, Stamp stamp, std::string bytes)> write;
  /// Whether points, which cost the most by far, are wanted at all; empty: always.
  std::function<bool()> wants_points;
};

struct RunMessagesSettings {
  motion::SweepConfig sweep;  ///< of the method: which times of points count
  bool tells_moving = true;   ///< whether the method tells moving points from static ones
  double period_s = 0.1;      ///< from scan to scan
  int threads = 0;            ///< 0: as many as the machine has
};

/// What a run sees and finds as messages with Foxglove's schemas, scan by scan and in bounded memory. The topics are
/// those of docs/formats.md; every message has the stamp of its scan. All in the frame `sensor`, whose pose in `world`
/// is that of the trajectory.
///
/// Points that cannot be measurements are left out (Scan::from_raw); the others are where they would have been
/// measured at the stamp where the method deskews and states a twist, those of objects moved along with their object.
class RunMessages {
 public:
  /// `truth` may be empty and must outlive the object.
  RunMessages(MessageSink sink, const formats::Trajectory& truth, RunMessagesSettings settings);

  /// `latency_ms`: see OdometryState. Throws DataError when the stamp is before 1970.
  void add(const RawScan& raw, const odometry::Frame& frame, double latency_ms);

  /// For a scan that is left out, in place of `add`: only the paths, now and later, are as if it had been added.
  void pass(const formats::StampedPose& pose);

 private:
  void write_points(const RawScan& raw, const odometry::Frame& frame);
  void write_path(const odometry::Frame& frame);
  void remember_pose(const Eigen::Isometry3d& T_world_sensor);
  void thin_poses();
  void write_truth(const formats::StampedPose& pose);
  void write_objects(const odometry::Frame& frame);
  void write_state(const odometry::Frame& frame, double latency_ms);

  MessageSink sink_;
  const formats::Trajectory& truth_;
  RunMessagesSettings settings_;
  Workers workers_;
  std::vector<Eigen::Isometry3d> poses_;  ///< every `pose_stride_`-th of the run, few enough for a message
  std::size_t pose_stride_ = 1;
  std::size_t scans_ = 0;
  std::optional<Eigen::Isometry3d> T_world_truth_;  ///< makes the first pose equal to that of the ground truth
};

}  // namespace dynamic_icp::runs
