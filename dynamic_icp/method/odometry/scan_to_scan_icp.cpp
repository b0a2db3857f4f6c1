// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/scan_to_scan_icp.hpp"

#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"

namespace dynamic_icp::odometry {
namespace {

/// Moves a twist [omega; rho] to another frame.
Matrix6d adjoint(const Eigen::Isometry3d& T) {
  Matrix6d result = Matrix6d::Zero();
  result.topLeftCorner<3, 3>() = T.linear();
  result.bottomRightCorner<3, 3>() = T.linear();
  result.bottomLeftCorner<3, 3>() = skew(T.translation()) * T.linear();
  return result;
}

/// An alignment of scans in the frame of the vehicle, told in the frame of the sensor.
void express_in_sensor_frame(registration::Alignment& alignment, const Eigen::Isometry3d& T_vehicle_sensor) {
  const Eigen::Isometry3d T_sensor_vehicle = T_vehicle_sensor.inverse();
  alignment.T_target_source = T_sensor_vehicle * alignment.T_target_source * T_vehicle_sensor;
  if (alignment.covariance) {
    const Matrix6d A = adjoint(T_sensor_vehicle);
    alignment.covariance = A * *alignment.covariance * A.transpose();
  }
  for (estimation::DegenerateDirection& direction : alignment.degenerate) {
    Vector6d xi = direction.direction;
    xi.head<3>() /= alignment.length_m;
    xi = adjoint(T_sensor_vehicle) * xi;
    xi.head<3>() *= alignment.length_m;
    direction.direction = xi.normalized();
  }
}

}  // namespace

/// What is kept of a scan: the target of this alignment and the source of the next.
struct ScanToScanIcp::Reference {
  registration::PreparedTarget prepared;  // in the frame of the vehicle for Doppler-ICP, else of the sensor
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  std::optional<Vector6d> twist = std::nullopt;  // of the last alignment, log(T_target_source) / dt, sensor frame
  double middle_s = 0.0;                         // what its points were deskewed to, after the stamp

  /// The motion from the stamp of `last` to this one, from that between what their points were deskewed to.
  [[nodiscard]] Eigen::Isometry3d between_stamps(const Reference& last,
                                                 const Eigen::Isometry3d& T_target_source) const {
    return exp_se3(-middle_s * *twist) * T_target_source * exp_se3(last.middle_s * last.twist.value_or(*twist));
  }
};

ScanToScanIcp::ScanToScanIcp(const ScanToScanIcpConfig& config, int threads)
    : config_(checked(config)), workers_(threads), expected_(DopplerKind::kRelative), stream_(config.stream) {}

ScanToScanIcp::ScanToScanIcp(const DopplerIcpConfig& config, const SensorContext& context, int threads)
    : config_(checked(config).icp),
      doppler_icp_(config),
      T_vehicle_sensor_(context.T_vehicle_sensor),
      workers_(threads),
      expected_(context.doppler_kind),
      stream_(config.icp.stream) {}

ScanToScanIcp::~ScanToScanIcp() = default;

std::vector<std::string> ScanToScanIcp::assumptions() const {
  std::vector<std::string> sentences;
  if (doppler_icp_ && !T_vehicle_sensor_) {
    sentences.emplace_back(
        "doppler-icp needs the mounting of the sensor and was given no calibration: the identity is taken");
  }
  if (doppler_icp_ && expected_ == DopplerKind::kCompensated) {
    sentences.emplace_back(
        "the Doppler is compensated: doppler-icp has no Doppler term then, only its robust point-to-plane term is "
        "left");
  }
  return sentences;
}

Frame ScanToScanIcp::process(const ScanView& raw) {
  stream_.check_order(raw.stamp);
  Frame frame;
  StageClock clock(frame.times);
  Scan scan = preprocess(raw, config_.preprocess, workers_, frame);
  const double middle_s = config_.deskew ? deskew(scan, raw, frame) : 0.0;
  clock.finish(Stage::kPreprocess);

  frame.status = stream_.add(raw.stamp, scan.size());
  const bool can_align = frame.status == FrameStatus::kNotRun;
  if (!can_align && last_) {
    set_motion(frame, frame.status, last_->T_world_sensor, predicted_motion());
  }
  if (is_skipped(frame.status)) {
    return frame;
  }
  for (const std::uint32_t record : scan.records()) {
    frame.labels[record] = 0;
  }

  Scan points = T_vehicle_sensor_ ? scan.transformed(*T_vehicle_sensor_) : scan;
  auto now = std::make_unique<Reference>(Reference{prepared(std::move(points))});
  clock.finish(Stage::kNormals);

  if (can_align) {
    align_to_last(*now, frame);
  }
  clock.finish(Stage::kRegistration);

  now->middle_s = middle_s;
  if (last_) {
    now->twist = log_se3(frame.T_target_source) / stream_.interval_s();
    if (config_.deskew) {
      set_motion(frame, frame.status, last_->T_world_sensor, now->between_stamps(*last_, frame.T_target_source));
    }
    set_velocity_from_motion(frame, stream_.interval_s());
  }
  now->T_world_sensor = frame.T_world_sensor;
  last_ = std::move(now);
  return frame;
}

registration::PreparedTarget ScanToScanIcp::prepared(Scan points) const {
  return config_.geometry == registration::GeometryTerm::kPointToPoint
             ? registration::PreparedTarget(std::move(points), workers_)
             : registration::PreparedTarget(std::move(points), config_.normals, workers_);
}

/// Deskews to the middle of the scan by the last motion; the frame tells it. Returns when the middle is, s after the
/// stamp. About the middle an error of that motion displaces as many points forward as back; about the stamp it would
/// come back as an error of the next motion, undamped.
double ScanToScanIcp::deskew(Scan& scan, const ScanView& raw, Frame& frame) const {
  frame.sweep = motion::sweep_in_data(raw);
  frame.sweep->deskewed = frame.sweep->duration_s.value_or(0.0) > 0.0;
  if (!frame.sweep->deskewed) {
    return 0.0;
  }
  const motion::TimeSpan span = motion::time_span(scan);
  if (last_ && last_->twist) {
    scan = motion::deskew_to_middle(scan, exp_se3((span.first - span.last) * *last_->twist));
  }
  return 0.5 * (span.first + span.last);
}

void ScanToScanIcp::align_to_last(const Reference& now, Frame& frame) const {
  const double dt_s = stream_.interval_s();
  const registration::PreparedTarget& last = last_->prepared;
  const registration::Source source{last.scan, last.normals.vectors, last.normals.valid};
  const registration::Target target = now.prepared.target();
  Eigen::Isometry3d T_initial = predicted_motion();
  if (T_vehicle_sensor_) {
    T_initial = *T_vehicle_sensor_ * T_initial * T_vehicle_sensor_->inverse();
  }
  frame.alignment = registration::align(source, target, T_initial, objective(target.scan.doppler_kind(), dt_s),
                                        stop_rule(config_.registration), workers_);
  if (T_vehicle_sensor_) {
    express_in_sensor_frame(frame.alignment, *T_vehicle_sensor_);
  }
  const FrameStatus status = frame_status(frame.alignment, dt_s);
  set_motion(frame, status, last_->T_world_sensor,
             is_aligned(status) ? frame.alignment.T_target_source : predicted_motion());
}

Eigen::Isometry3d ScanToScanIcp::predicted_motion() const {
  if (!config_.constant_velocity_start || !last_->twist) {
    return Eigen::Isometry3d::Identity();
  }
  return exp_se3(stream_.prediction_time_s() * *last_->twist);
}

registration::Objective ScanToScanIcp::objective(DopplerKind kind, double dt_s) const {
  registration::Objective objective;
  objective.geometry = config_.geometry;
  objective.gate.max_distance_m = config_.registration.max_correspondence_distance_m;
  objective.doppler = registration::DopplerTerm::kNone;
  objective.tukey_geometry_m = std::numeric_limits<double>::infinity();
  if (!doppler_icp_) {
    return objective;
  }
  if (kind == DopplerKind::kRelative) {  // what the sensor's own motion was taken out of cannot tell it
    objective.doppler = registration::DopplerTerm::kSensorVelocity;
  }
  objective.doppler_weight = doppler_icp_->doppler_weight;
  // Published: a row is scaled by the root of its share before the kernel sees it. A residual without that factor meets
  // a kernel that is wider by it.
  objective.tukey_geometry_m = doppler_icp_->tukey_geometry_m / std::sqrt(1.0 - objective.doppler_weight);
  if (objective.doppler_weight > 0.0) {
    objective.tukey_doppler_mps = doppler_icp_->tukey_doppler_mps / std::sqrt(objective.doppler_weight);
  }
  objective.tukey_doppler_from_iteration = doppler_icp_->robust_from_iteration;
  objective.reject_doppler_mps = doppler_icp_->reject_doppler_mps;
  objective.reject_from_iteration = doppler_icp_->robust_from_iteration;
  objective.vehicle.dt_s = dt_s;
  if (T_vehicle_sensor_) {
    objective.vehicle.sensor_vehicle = T_vehicle_sensor_->translation();
  }
  return objective;
}

Config ScanToScanIcp::configuration() const {
  if (!doppler_icp_) {
    return config_;
  }
  return *doppler_icp_;
}

/// Search tree and normals of the last scan are found again from its points.
void ScanToScanIcp::state(StateArchive& archive) {
  const bool is_mounted = T_vehicle_sensor_.has_value();
  archive(stream_, T_vehicle_sensor_);
  archive.require(T_vehicle_sensor_.has_value() == is_mounted, "the mounting");
  bool is_there = last_ != nullptr;
  archive(is_there);
  archive.require(is_there == stream_.has_begun(), "the last scan");
  if (!is_there) {
    last_.reset();
    return;
  }
  Scan points = last_ ? last_->prepared.scan : Scan();
  archive(points);
  if (archive.reads()) {
    last_ = std::make_unique<Reference>(Reference{prepared(std::move(points))});
  }
  archive(last_->T_world_sensor, last_->twist, last_->middle_s);
}

}  // namespace dynamic_icp::odometry
