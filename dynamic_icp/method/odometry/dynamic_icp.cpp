// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/dynamic_icp.hpp"

#include "dynamic_icp/method/dynamics/prediction.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"
#include "dynamic_icp/method/registration/translation_search.hpp"

namespace dynamic_icp::odometry {
namespace {

// m, for a first motion of which nothing is known.
constexpr double kWideGates_m[] = {1.0, 0.5};

void count_dynamics(Frame& frame, const std::vector<std::uint8_t>& is_dynamic,
                    const std::vector<std::int32_t>& labels) {
  for (std::size_t row = 0; row < is_dynamic.size(); ++row) {
    frame.dynamic_candidates += is_dynamic[row];
    frame.dynamic_clustered += labels[row] >= 0 ? 1 : 0;
  }
  for (const dynamics::ObjectEstimate& object : frame.clusters) {
    frame.dynamic_refined += object.members.size();
  }
}

void label_points(Frame& frame, const Scan& scan, const std::vector<std::uint8_t>& is_dynamic) {
  frame.labels.assign(frame.points, -1);
  for (std::size_t row = 0; row < scan.size(); ++row) {
    frame.labels[scan.records()[row]] = is_dynamic[row] != 0 ? -1 : 0;
    if (is_dynamic[row] == 0) {
      frame.static_points.push_back(scan.points()[row]);
    }
  }
  std::int32_t id = 0;
  for (const dynamics::ObjectEstimate& object : frame.clusters) {
    id += object.verdict == dynamics::ClusterVerdict::kAccepted ? 1 : 0;
    for (const std::uint32_t row : object.members) {
      frame.labels[scan.records()[row]] = id;
    }
  }
}

}  // namespace

/// What is kept of the last usable scan: the source of the next alignment.
struct DynamicIcp::Reference {
  Scan scan;
  std::vector<std::uint8_t> is_dynamic;
  std::vector<dynamics::ObjectEstimate> clusters;
  Eigen::Vector3d velocity_sensor;  // m/s
  Eigen::Isometry3d T_world_sensor;
  std::optional<Vector6d> twist;  // log(T_target_source) / dt of the motion that ended here, where one was found
};

DynamicIcp::DynamicIcp(const PaperConfig& config, int threads, DopplerKind expected)
    : config_(checked(config)), workers_(threads), expected_(expected) {}

DynamicIcp::~DynamicIcp() = default;
DynamicIcp::DynamicIcp(DynamicIcp&&) noexcept = default;
DynamicIcp& DynamicIcp::operator=(DynamicIcp&&) noexcept = default;

std::vector<std::string> DynamicIcp::assumptions() const {
  return expected_ == DopplerKind::kCompensated ? std::vector{compensated_sentence()} : std::vector<std::string>{};
}

// The system overview of the paper for one scan. Its four modules for the pair (last scan, this scan) are spread over
// two calls: (i) ego motion and (ii) clustering of a scan run as soon as it is aligned, because the alignment gives the
// prior of its velocity; (iii) prediction and (iv) matching run when the next scan is there and the time is known.
Frame DynamicIcp::process(const RawScan& raw) {
  check_order(raw, last_stamp_);
  Frame frame;
  StageClock clock(frame.times);
  Scan scan = preprocess(raw, config_.preprocess, workers_, frame);
  clock.finish(Stage::kPreprocess);
  last_stamp_ = raw.stamp;
  const FrameStatus found = obstacle(scan.size(), interval_s(raw.stamp), config_.stream);
  if (found == FrameStatus::kNotRun) {
    align_to_last(scan, frame, clock);  // Eq. (9)-(14)
  } else {
    continue_motion(frame, found);
  }
  if (is_skipped(found)) {
    return frame;
  }

  const bool is_relative = scan.doppler_kind() == DopplerKind::kRelative;
  frame.ego = is_relative ? ego_motion::estimate_velocity(scan, velocity_prior(frame), config_.ego_motion.regression,
                                                          workers_)  // Eq. (3)
                          : velocity_of_motion(frame);
  const std::vector<double> compensated =
      is_relative ? ego_motion::compensated_doppler(scan, frame.ego.velocity_sensor) : scan.doppler();
  std::vector<std::uint8_t> is_dynamic =
      ego_motion::dynamic_mask(scan, compensated, config_.ego_motion.filter);  // Eq. (4)
  clock.finish(Stage::kEgoMotion);

  const std::vector<std::int32_t> labels = cluster(scan, is_dynamic);
  frame.clusters =
      dynamics::reconstruct_velocities(scan, compensated, labels, config_.dynamics.velocity);  // Eq. (5)-(8)
  count_dynamics(frame, is_dynamic, labels);
  label_points(frame, scan, is_dynamic);
  clock.finish(Stage::kDynamics);

  const std::optional<Stamp> before = has_motion(frame) ? std::optional(last_->scan.stamp()) : std::nullopt;
  last_ = std::make_unique<Reference>(Reference{
      std::move(scan), std::move(is_dynamic), frame.clusters, frame.ego.velocity_sensor, frame.T_world_sensor, {}});
  if (before) {
    last_->twist = log_se3(frame.T_target_source) / seconds_between(*before, raw.stamp);
  }
  return frame;
}

void DynamicIcp::align_to_last(const Scan& scan, Frame& frame, StageClock& clock) const {
  const registration::PreparedTarget prepared(scan, config_.normals, workers_);
  clock.finish(Stage::kNormals);

  const double dt_s = seconds_between(last_->scan.stamp(), frame.stamp);
  const Scan source = dynamics::predict(last_->scan, last_->is_dynamic, last_->clusters, dt_s);  // Eq. (9), (11)
  const registration::Target target = prepared.target();
  frame.alignment = scan.doppler_kind() == DopplerKind::kRelative
                        ? registration::align(source, target, predicted_motion(frame.stamp), config_.registration,
                                              workers_)  // Eq. (12)-(14)
                        : align_without_doppler(source, target, frame.stamp);
  const FrameStatus status = frame_status(frame.alignment, dt_s);
  set_motion(frame, status, last_->T_world_sensor,
             is_aligned(status) ? frame.alignment.T_target_source : predicted_motion(frame.stamp));
  clock.finish(Stage::kRegistration);
}

/// Compensated Doppler says nothing of the motion. The first one is searched for, the others begin with the last.
registration::Alignment DynamicIcp::align_without_doppler(const Scan& source, const registration::Target& target,
                                                          Stamp stamp) const {
  registration::AlignConfig config = config_.registration;
  config.doppler_weight = 0.0;
  Eigen::Isometry3d T_start = predicted_motion(stamp);
  if (!last_->twist) {
    T_start =
        registration::search_translation(source, target, seconds_between(last_->scan.stamp(), stamp), {}, workers_)
            .T_target_source;
    for (const double gate_m : kWideGates_m) {
      config.max_correspondence_distance_m = gate_m;
      T_start = registration::align(source, target, T_start, config, workers_).T_target_source;
    }
    config.max_correspondence_distance_m = config_.registration.max_correspondence_distance_m;
  }
  return registration::align(source, target, T_start, config, workers_);
}

std::optional<double> DynamicIcp::interval_s(Stamp stamp) const {
  return last_ ? std::optional(seconds_between(last_->scan.stamp(), stamp)) : std::nullopt;
}

void DynamicIcp::continue_motion(Frame& frame, FrameStatus status) const {
  frame.status = status;
  if (last_) {
    set_motion(frame, status, last_->T_world_sensor, predicted_motion(frame.stamp));
  }
}

/// The start of the alignment: no rotation, and the displacement of the sensor by its Doppler velocity, t = -v dt; with
/// compensated Doppler the last motion.
Eigen::Isometry3d DynamicIcp::predicted_motion(Stamp stamp) const {
  if (last_->scan.doppler_kind() == DopplerKind::kCompensated && last_->twist) {
    return exp_se3(prediction_time_s(last_->scan.stamp(), stamp) * *last_->twist);
  }
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  T_target_source.translation() = -last_->velocity_sensor * prediction_time_s(last_->scan.stamp(), stamp);
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
  return -T.linear().transpose() * T.translation() / seconds_between(last_->scan.stamp(), frame.stamp);
}

/// What compensated Doppler leaves: the velocity of the alignment that ended at this scan.
ego_motion::EgoVelocity DynamicIcp::velocity_of_motion(const Frame& frame) const {
  ego_motion::EgoVelocity ego = at_rest(Scan());
  if (has_motion(frame)) {
    ego.status = ego_motion::EgoVelocityStatus::kFromMotion;
    ego.velocity_sensor = velocity_prior(frame);
  }
  return ego;
}

/// Whether the frame has a motion from the last one that was found, or that goes on from one that was.
bool DynamicIcp::has_motion(const Frame& frame) const { return last_ && (is_aligned(frame.status) || last_->twist); }

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

}  // namespace dynamic_icp::odometry
