// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/dynamic_icp.hpp"

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/dynamics/prediction.hpp"
#include "dynamic_icp/method/ego_motion/rig_doppler.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_labels.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"

namespace dynamic_icp::odometry {
namespace {

/// Of a scan with compensated Doppler.
Scan static_points(const Scan& scan, const ego_motion::VelocityFilterConfig& filter) {
  const std::vector<std::uint8_t> is_moving = ego_motion::dynamic_mask(scan, scan.doppler(), filter);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < scan.size(); ++row) {
    if (is_moving[row] == 0) {
      rows.push_back(row);
    }
  }
  return scan.select(rows);
}

/// The paper has one sensor: the Doppler of a rig becomes that of one at the origin of the points.
std::optional<ego_motion::AngularVelocity> take_out_lever_arms(Scan& scan, const Workers& workers) {
  if (!scan.is_of_rig() || scan.doppler_kind() != DopplerKind::kRelative) {
    return std::nullopt;
  }
  const ego_motion::AngularVelocity rotation = ego_motion::rig_angular_velocity(scan, {}, workers);
  ego_motion::take_out_lever_arms(scan, rotation.omega, workers);
  return rotation;
}

}  // namespace

/// What is kept of the last usable scan: the source of the next alignment.
struct DynamicIcp::Reference {
  Scan scan;
  std::vector<std::uint8_t> is_dynamic;
  std::vector<dynamics::ObjectEstimate> clusters;
  Eigen::Vector3d velocity_sensor;  // m/s
  Eigen::Isometry3d T_world_sensor;
};

DynamicIcp::DynamicIcp(const PaperConfig& config, int threads, DopplerKind expected)
    : config_(checked(config)), workers_(threads), expected_(expected), stream_(config.stream) {}

DynamicIcp::~DynamicIcp() = default;
DynamicIcp::DynamicIcp(DynamicIcp&&) noexcept = default;
DynamicIcp& DynamicIcp::operator=(DynamicIcp&&) noexcept = default;

std::vector<std::string> DynamicIcp::assumptions() const {
  return expected_ == DopplerKind::kCompensated ? std::vector{compensated_doppler_note()} : std::vector<std::string>{};
}

// The system overview of the paper for one scan. Its four modules for the pair (last scan, this scan) are spread over
// two calls: (i) ego motion and (ii) clustering of a scan run as soon as it is aligned, because the alignment gives the
// prior of its velocity; (iii) prediction and (iv) matching run when the next scan is there and the time is known.
Frame DynamicIcp::process(const ScanView& raw) {
  stream_.check_order(raw.stamp);
  Frame frame;
  StageClock clock(frame.times);
  Scan scan = preprocess(raw, config_.preprocess, workers_, frame);  // Eq. (1)
  const std::optional<ego_motion::AngularVelocity> rig_rotation = take_out_lever_arms(scan, workers_);
  clock.finish(Stage::kPreprocess);

  frame.status = stream_.add(raw.stamp, scan.size());
  if (frame.status == FrameStatus::kNotRun) {
    align_to_last(scan, frame, clock);  // Eq. (9)-(14)
  } else if (last_) {
    set_motion(frame, frame.status, last_->T_world_sensor, predicted_motion());
  }
  if (is_skipped(frame.status)) {
    return frame;
  }

  const std::vector<double> compensated = estimate_ego_motion(scan, frame);  // Eq. (3)
  frame.ego.rotation = rig_rotation;
  std::vector<std::uint8_t> is_dynamic =
      ego_motion::dynamic_mask(scan, compensated, config_.ego_motion.filter);  // Eq. (4)
  clock.finish(Stage::kEgoMotion);

  const std::vector<std::int32_t> labels = cluster(scan, is_dynamic);
  frame.clusters =
      dynamics::reconstruct_velocities(scan, compensated, labels, config_.dynamics.velocity);  // Eq. (5)-(8)
  describe_clusters(frame, scan, is_dynamic, labels);
  clock.finish(Stage::kDynamics);

  last_ = std::make_unique<Reference>(Reference{std::move(scan), std::move(is_dynamic), frame.clusters,
                                                frame.ego.velocity_sensor, frame.T_world_sensor});
  return frame;
}

void DynamicIcp::align_to_last(const Scan& scan, Frame& frame, StageClock& clock) {
  const registration::PreparedTarget prepared(scan, config_.normals, workers_);
  clock.finish(Stage::kNormals);

  const double dt_s = stream_.interval_s();
  const Scan source = dynamics::predict(last_->scan, last_->is_dynamic, last_->clusters, dt_s);  // Eq. (9), (11)
  const registration::Target target = prepared.target();
  const Eigen::Isometry3d T_start = predicted_motion();
  if (scan.doppler_kind() == DopplerKind::kRelative) {
    frame.alignment = registration::align(source, target, T_start, config_.registration, workers_);  // Eq. (12)-(14)
  } else if (config_.published_compensated) {
    frame.alignment = published_.align(source, static_points(last_->scan, config_.ego_motion.filter), target,
                                       static_points(scan, config_.ego_motion.filter), config_, workers_);
  } else {
    frame.alignment = by_geometry_.align(source, target, T_start, dt_s, config_.registration, workers_);
  }
  const FrameStatus status = frame_status(frame.alignment, dt_s);
  set_motion(frame, status, last_->T_world_sensor, is_aligned(status) ? frame.alignment.T_target_source : T_start);
  clock.finish(Stage::kRegistration);
}

/// The velocity of the sensor, Eq. (3). Returns the Doppler of each point without it.
std::vector<double> DynamicIcp::estimate_ego_motion(const Scan& scan, Frame& frame) {
  const Eigen::Vector3d prior = velocity_prior(frame);
  if (last_) {
    by_geometry_.update(frame, stream_.interval_s());
  }
  if (scan.doppler_kind() == DopplerKind::kCompensated) {
    frame.ego = by_geometry_.velocity(prior);
    return scan.doppler();
  }
  frame.ego = ego_motion::estimate_velocity(scan, prior, config_.ego_motion.regression, workers_);
  return ego_motion::compensated_doppler(scan, frame.ego.velocity_sensor);
}

/// The start of the alignment: no rotation, and the displacement of the sensor by its Doppler velocity, t = -v dt; with
/// compensated Doppler the last motion.
Eigen::Isometry3d DynamicIcp::predicted_motion() const {
  if (last_->scan.doppler_kind() == DopplerKind::kCompensated && by_geometry_.is_known()) {
    return by_geometry_.predicted(stream_.prediction_time_s());
  }
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  T_target_source.translation() = -last_->velocity_sensor * stream_.prediction_time_s();
  return T_target_source;
}

/// v = -R^T t / dt from the alignment that ended at this scan; else the last velocity; zero at the start.
Eigen::Vector3d DynamicIcp::velocity_prior(const Frame& frame) const {
  if (!last_) {
    return Eigen::Vector3d::Zero();
  }
  if (!is_aligned(frame.status)) {
    return last_->velocity_sensor;
  }
  const Eigen::Isometry3d& T = frame.T_target_source;
  return -T.linear().transpose() * T.translation() / stream_.interval_s();
}

/// HDBSCAN over the positions of the moving points; -1 for static points, noise, and when nothing is to be predicted.
std::vector<std::int32_t> DynamicIcp::cluster(const Scan& scan, const std::vector<std::uint8_t>& is_dynamic) const {
  std::vector<std::int32_t> labels(scan.size(), -1);
  if (!config_.dynamics.predict) {
    return labels;
  }
  std::vector<std::uint32_t> rows;
  std::vector<Eigen::Vector3d> moving;
  for (std::uint32_t row = 0; row < scan.size(); ++row) {
    if (is_dynamic[row] != 0) {
      rows.push_back(row);
      moving.push_back(scan.points()[row]);
    }
  }
  const dynamics::HdbscanResult clusters = dynamics::hdbscan(moving, config_.dynamics.clustering, workers_);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    labels[rows[k]] = clusters.labels[k];
  }
  return labels;
}

void DynamicIcp::state(StateArchive& archive) {
  archive(stream_, by_geometry_, published_);
  bool is_there = last_ != nullptr;
  archive(is_there);
  archive.require(is_there == stream_.has_begun(), "the last scan");
  if (!is_there) {
    last_.reset();
    return;
  }
  if (!last_) {
    last_ = std::make_unique<Reference>();
  }
  archive(last_->scan, last_->is_dynamic, last_->velocity_sensor, last_->T_world_sensor);
  archive.each(last_->clusters, [&](dynamics::ObjectEstimate& cluster) {
    archive(cluster.verdict, cluster.velocity_sensor, cluster.covariance, cluster.inlier_fraction,
            cluster.smallest_singular_value, cluster.condition_number, cluster.members, cluster.centroid,
            cluster.extent);
  });
  archive.require(last_->is_dynamic.size() == last_->scan.size(), "a column");
  const auto is_row = [&](std::uint32_t row) { return row < last_->scan.size(); };
  for (const dynamics::ObjectEstimate& cluster : last_->clusters) {
    archive.require(std::ranges::all_of(cluster.members, is_row), "a point of an object");
  }
}

}  // namespace dynamic_icp::odometry
