// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/recording/evaluation/association.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"
#include "dynamic_icp/recording/messages/foxglove_encode.hpp"

namespace dynamic_icp::runs {
namespace {

constexpr const char* kRecordedWorld = "world";
constexpr const char* kRecordedSensor = "sensor";

constexpr std::size_t kMaxPathPoses = 500;    // of the run, in every message
constexpr std::size_t kMaxTruthPoses = 5000;  // of the ground truth, once
constexpr double kMoving_mps = 0.5;           // faster by its Doppler, a point of no object moves
constexpr double kLifetime_periods = 1.5;     // of objects, so that none outlives its scan for long

constexpr RunTopicRow kRunTopics[] = {{RunTopic::kPoints, "/points", messages::kPointCloudType},
                                      {RunTopic::kTransforms, "/tf", messages::kFrameTransformsType},
                                      {RunTopic::kPath, "/path", messages::kPosesInFrameType},
                                      {RunTopic::kObjects, "/objects", messages::kSceneUpdateType},
                                      {RunTopic::kState, "/odometry/state", messages::kOdometryStateType},
                                      {RunTopic::kTruthPath, "/ground_truth/path", messages::kPosesInFrameType}};

constexpr double kDegreesPerRadian = 57.295779513082323;
constexpr double kNotStated = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d not_stated() { return Eigen::Vector3d::Constant(kNotStated); }

/// How the sensor moves during the scan, where the method takes that out of it.
std::optional<motion::SweepMotion> sweep_of(const odometry::Frame& frame) {
  if (!frame.sweep || !frame.sweep->deskewed || !frame.twist || !frame.twist->angular.allFinite() ||
      !frame.twist->linear.allFinite()) {
    return std::nullopt;
  }
  motion::SweepMotion sweep;
  sweep.omega = frame.twist->angular;
  sweep.velocity = frame.twist->linear;
  if (frame.ego.acceleration_sensor.allFinite()) {
    sweep.acceleration = frame.ego.acceleration_sensor;
  }
  return sweep;
}

std::vector<double> compensated_of(const Scan& scan, const odometry::Frame& frame, const Workers& workers) {
  ego_motion::EgoVelocity ego = frame.ego;
  if (scan.doppler_kind() == DopplerKind::kCompensated) {
    ego.velocity_sensor.setZero();
    ego.acceleration_sensor.setZero();
  }
  std::vector<double> compensated;
  ego_motion::compensated_doppler(scan, ego, workers, compensated);
  return compensated;
}

template <class Number>
formats::NamedArray column(const char* name, const std::vector<Number>& values) {
  return {name, formats::npy_array<Number>({values.size()}, std::span<const Number>(values))};
}

std::vector<float> floats(const std::vector<double>& values) {
  std::vector<float> narrow(values.size());
  std::transform(values.begin(), values.end(), narrow.begin(), [](double value) { return static_cast<float>(value); });
  return narrow;
}

std::vector<float> axis_of(const std::vector<Eigen::Vector3d>& points, Eigen::Index axis) {
  std::vector<float> values(points.size());
  std::transform(points.begin(), points.end(), values.begin(),
                 [axis](const Eigen::Vector3d& point) { return static_cast<float>(point[axis]); });
  return values;
}

std::vector<std::int32_t> labels_of(const Scan& scan, const odometry::Frame& frame,
                                    const std::vector<double>& compensated, bool tells_moving) {
  std::vector<std::int32_t> labels(scan.size(), kLabelNotUsed);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::uint32_t record = scan.records()[i];
    labels[i] = record < frame.labels.size() ? frame.labels[record] : kLabelNotUsed;
    if (labels[i] == kLabelNotUsed && tells_moving && std::abs(compensated[i]) > kMoving_mps) {
      labels[i] = kLabelMoving;
    }
  }
  return labels;
}

/// Undoes what the objects themselves moved between the stamp and the time of each of their points: their boxes are
/// those of the stamp.
void put_objects_at_stamp(const odometry::Frame& frame, const std::vector<std::int32_t>& labels,
                          const std::vector<double>& times, std::vector<Eigen::Vector3d>& points) {
  std::unordered_map<std::int64_t, Eigen::Vector3d> velocities;
  for (const tracking::TrackedObject& object : frame.tracked) {
    if (object.velocity_sensor.allFinite()) {
      velocities.emplace(object.id, object.velocity_sensor);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const auto velocity = velocities.find(labels[i]); labels[i] > 0 && velocity != velocities.end()) {
      points[i] -= times[i] * velocity->second;
    }
  }
}

messages::SceneObject scene_object(std::int64_t id, const Eigen::Vector3d& velocity) {
  messages::SceneObject object;
  object.id = std::to_string(id);
  object.velocity = velocity;
  object.text = fmt::format("{} · {:.1f} m/s", id, velocity.norm());
  return object;
}

std::vector<messages::SceneObject> scene_of(const odometry::Frame& frame) {
  std::vector<messages::SceneObject> objects;
  for (const tracking::TrackedObject& tracked : frame.tracked) {
    messages::SceneObject object = scene_object(tracked.id, tracked.velocity_sensor);
    object.T_frame_box.linear() = tracked.box.axes;
    object.T_frame_box.translation() = tracked.box.centre;
    object.size = tracked.box.size;
    object.is_velocity_known = tracked.tangential_observed;
    objects.push_back(object);
  }
  // Methods that do not track: the numbers are those of objects.jsonl, anew in every scan.
  for (const dynamics::ObjectEstimate& cluster : frame.clusters) {
    if (cluster.verdict == dynamics::ClusterVerdict::kAccepted) {
      messages::SceneObject object =
          scene_object(static_cast<std::int64_t>(objects.size()) + 1, cluster.velocity_sensor);
      object.T_frame_box.translation() = cluster.centroid;
      object.size = cluster.extent;
      objects.push_back(object);
    }
  }
  return objects;
}

template <int kSize>
std::vector<double> row_by_row(const Eigen::Matrix<double, kSize, kSize>& matrix) {
  const Eigen::Matrix<double, kSize, kSize, Eigen::RowMajor> rows = matrix;
  return {rows.data(), rows.data() + rows.size()};
}

std::uint32_t count(std::size_t number) { return static_cast<std::uint32_t>(number); }

}  // namespace

std::span<const RunTopicRow> run_topics() { return kRunTopics; }

RunMessages::RunMessages(MessageSink sink, const formats::Trajectory& truth, RunMessagesSettings settings)
    : sink_(std::move(sink)), truth_(truth), settings_(std::move(settings)), workers_(settings_.threads) {}

void RunMessages::add(const RawScan& raw, const odometry::Frame& frame, double latency_ms) {
  const messages::StampedTransform transform{{frame.stamp, kRecordedWorld}, kRecordedSensor, frame.T_world_sensor};
  sink_.write(RunTopic::kTransforms, frame.stamp, messages::encode_transforms({&transform, 1}));
  write_points(raw, frame);
  write_path(frame);
  write_truth({frame.stamp, frame.T_world_sensor});
  write_objects(frame);
  write_state(frame, latency_ms);
  ++scans_;
}

void RunMessages::pass(const formats::StampedPose& pose) {
  write_truth(pose);
  remember_pose(pose.T_world_sensor);
  thin_poses();
  ++scans_;
}

void RunMessages::write_points(const RawScan& raw, const odometry::Frame& frame) {
  if (sink_.wants_points && !sink_.wants_points()) {
    return;
  }
  std::vector<double> declared;
  const Scan scan = Scan::from_raw(motion::retimed(raw, settings_.sweep, declared));
  const std::vector<double> compensated = compensated_of(scan, frame, workers_);
  const std::vector<std::int32_t> labels = labels_of(scan, frame, compensated, settings_.tells_moving);
  std::vector<Eigen::Vector3d> points = scan.points();
  if (const std::optional<motion::SweepMotion> sweep = sweep_of(frame); sweep && scan.has_times()) {
    points = motion::deskewed_points(scan, *sweep, workers_);
    put_objects_at_stamp(frame, labels, scan.times(), points);
  }
  const formats::NamedArray columns[] = {column("x", axis_of(points, 0)),
                                         column("y", axis_of(points, 1)),
                                         column("z", axis_of(points, 2)),
                                         column("doppler", floats(scan.doppler())),
                                         column("doppler_compensated", floats(compensated)),
                                         column("label", labels)};
  const messages::PointCloud cloud = messages::cloud_of_columns({frame.stamp, kRecordedSensor}, columns);
  sink_.write(RunTopic::kPoints, frame.stamp, messages::encode_cloud(cloud));
}

/// A message holds the whole path until then. So that messages stay small, the longer it is the fewer of its poses are
/// in them.
void RunMessages::write_path(const odometry::Frame& frame) {
  remember_pose(frame.T_world_sensor);
  std::vector<Eigen::Isometry3d> path = poses_;
  if (scans_ % pose_stride_ != 0) {
    path.push_back(frame.T_world_sensor);
  }
  sink_.write(RunTopic::kPath, frame.stamp, messages::encode_poses({frame.stamp, kRecordedWorld}, path));
  thin_poses();
}

void RunMessages::remember_pose(const Eigen::Isometry3d& T_world_sensor) {
  if (scans_ % pose_stride_ == 0) {
    poses_.push_back(T_world_sensor);
  }
}

void RunMessages::thin_poses() {
  if (poses_.size() < kMaxPathPoses) {
    return;
  }
  for (std::size_t k = 0; 2 * k < poses_.size(); ++k) {
    poses_[k] = poses_[2 * k];
  }
  poses_.resize((poses_.size() + 1) / 2);
  pose_stride_ *= 2;
}

/// Once, as soon as a scan has a pose of the ground truth.
void RunMessages::write_truth(const formats::StampedPose& pose) {
  if (truth_.empty() || T_world_truth_) {
    return;
  }
  const std::optional<Eigen::Isometry3d> T_truth_sensor =
      formats::pose_at(truth_, pose.stamp, evaluation::AssociationConfig{}.max_gap_s);
  if (!T_truth_sensor) {
    return;
  }
  T_world_truth_ = pose.T_world_sensor * T_truth_sensor->inverse();
  const std::size_t stride = 1 + (truth_.size() - 1) / kMaxTruthPoses;
  std::vector<Eigen::Isometry3d> path;
  for (std::size_t k = 0; k < truth_.size(); k += stride) {
    path.push_back(*T_world_truth_ * truth_[k].T_world_sensor);
  }
  sink_.write(RunTopic::kTruthPath, pose.stamp, messages::encode_poses({pose.stamp, kRecordedWorld}, path));
}

void RunMessages::write_objects(const odometry::Frame& frame) {
  const double lifetime_s = kLifetime_periods * (settings_.period_s > 0.0 ? settings_.period_s : 0.1);
  sink_.write(RunTopic::kObjects, frame.stamp,
              messages::encode_scene({frame.stamp, kRecordedSensor}, scene_of(frame), lifetime_s));
}

void RunMessages::write_state(const odometry::Frame& frame, double latency_ms) {
  messages::OdometryState state;
  state.stamp = frame.stamp;
  state.status = odometry::verdict(frame.status);
  state.reason = odometry::to_string(frame.status);
  state.converged = odometry::converged(frame.status);
  state.ego_velocity_mps = frame.ego.velocity_sensor;
  const bool velocity_stated = !frame.ego.covariance.isZero(0.0);
  state.ego_velocity_sigma_mps =
      velocity_stated ? Eigen::Vector3d(frame.ego.covariance.diagonal().cwiseSqrt()) : not_stated();
  if (velocity_stated) {
    state.ego_velocity_covariance = row_by_row<3>(frame.ego.covariance);
  }
  state.position_sigma_m = not_stated();
  state.rotation_sigma_deg = not_stated();
  if (frame.alignment.covariance) {
    state.position_sigma_m = frame.alignment.covariance->diagonal().tail<3>().cwiseSqrt();
    state.rotation_sigma_deg = kDegreesPerRadian * frame.alignment.covariance->diagonal().head<3>().cwiseSqrt();
    state.pose_covariance = row_by_row<6>(*frame.alignment.covariance);
  }
  state.angular_velocity_dps = frame.twist ? Eigen::Vector3d(kDegreesPerRadian * frame.twist->angular) : not_stated();
  state.position_error_m = kNotStated;
  if (T_world_truth_) {
    if (const auto truth = formats::pose_at(truth_, frame.stamp, evaluation::AssociationConfig{}.max_gap_s)) {
      state.position_error_m = (*T_world_truth_ * truth->translation() - frame.T_world_sensor.translation()).norm();
    }
  }
  state.doppler_bias_mps = frame.ego.bias_mps;
  state.points = count(frame.points);
  state.points_used = count(frame.points_used);
  state.moving_points = count(frame.dynamic_candidates);
  state.objects = count(scene_of(frame).size());
  state.iterations = frame.alignment.iterations;
  state.inlier_rmse_m = frame.alignment.inlier_rmse;
  state.time_ms = frame.times.total_ms;
  state.latency_ms = latency_ms;
  sink_.write(RunTopic::kState, frame.stamp, messages::encode_state(state));
}

}  // namespace dynamic_icp::runs
