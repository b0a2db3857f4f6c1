// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track_record.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kBeyondEgo = 3.0;        // standard deviations of the velocity of the sensor
constexpr double kDecided = 0.75;         // probability: else it is as likely to point, move and lie elsewhere
constexpr int kSureScans = 5;             // sizes are known after so many
constexpr std::size_t kUsualRows = 4096;  // of a track; more cost an allocation now and then
constexpr double kNegligible = 0.02;      // a model of motion less likely than that
constexpr int kMaxScans = 1 << 30;        // no drive has so many

}  // namespace

// Records change their places: without room from the beginning each would grow on its own.
TrackRecord::TrackRecord() {
  for (std::vector<std::uint32_t>* rows : {&members, &static_rows, &merged}) {
    rows->reserve(kUsualRows);
  }
}

void TrackRecord::predict(double stamp_s, const VehicleSizes& sizes, const TrackConfig& config) {
  if (predicted_s == stamp_s) {
    return;
  }
  predicted = track;
  predicted.predict(stamp_s, config);
  now = predicted.estimate(sizes);
  predicted_s = stamp_s;
}

bool TrackRecord::is_credible(const EgoError& ego, const TrackerConfig& config) const {
  // What stands seems to move with the error of the velocity of the sensor.
  const Vector3d sight = (now.box.centre - ego.sensor_world).normalized();
  const double ego_sigma = std::sqrt(sight.dot(ego.covariance * sight));
  if (track.best().signal_mps() < kBeyondEgo * ego_sigma) {
    return false;
  }
  const double variance = now.velocity_covariance.topLeftCorner<2, 2>().trace();
  const bool is_known = variance < config.confirm_sigma_mps * config.confirm_sigma_mps;
  return (is_known && predicted.probability() > kDecided) || seen >= config.confirm_anyway_scans;
}

void TrackRecord::note_motion(double stamp_s, const TrackerConfig& config) {
  const double speed = now.velocity.norm();
  has_moved = has_moved || (confirmed && speed > config.slow_mps);
  if (speed >= config.min_speed_mps) {
    moved_s = stamp_s;
  }
}

bool TrackRecord::is_over(double stamp_s, const TrackerConfig& config) const {
  if (!confirmed) {
    return missed > 0 || now.velocity.norm() < config.min_speed_mps;
  }
  if (!has_moved && now.velocity.norm() < config.min_speed_mps) {
    return true;
  }
  const double variance = predicted.body().covariance().diagonal().head<2>().sum();  // not of what is hidden of it
  const bool is_vague = variance > config.coast_sigma_m * config.coast_sigma_m;
  return (missed > 0 && (is_vague || stamp_s - track.time_s() > config.coast_s)) || stamp_s - moved_s > config.stand_s;
}

void TrackRecord::note_size(VehicleSizes& sizes) const {
  const bool is_seen = confirmed && missed == 0 && seen >= kSureScans;
  if (is_seen && predicted.is_sure_of_heading() && predicted.best().is_whole_vehicle()) {
    sizes.note(id, now.box.size);
  }
}

void TrackRecord::take_name_of(const TrackRecord& older) {
  id = older.id;
  divided_from = older.divided_from > 0 ? older.divided_from : divided_from;
  age = older.age;
  seen = older.seen;
  confirmed = older.confirmed || confirmed;
  has_moved = older.has_moved || has_moved;
  moved_s = std::max(older.moved_s, moved_s);
}

/// By each model as likely as that is, weighted mean and covariance.
BoxEstimate TrackRecord::forecast(double after_s, const VehicleSizes& sizes, const TrackConfig& config) {
  const auto& [standing, straight, turning] = predicted.best().motion();
  BoxEstimate result;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3d offset = Vector3d::Zero();  // of the centre from now: small numbers
  double weights = 0.0;
  for (const auto& [model, weight] :
       {std::pair{MotionModel::kStanding, standing}, std::pair{MotionModel::kStraight, straight},
        std::pair{MotionModel::kTurning, turning}}) {
    if (weight < kNegligible) {
      continue;
    }
    TrackConfig supposed = config;
    supposed.motion = noise_under(model, config.motion);
    Track& later = other;
    later = predicted;
    later.suppose(model);
    later.predict(later.time_s() + after_s, supposed);
    const BoxEstimate then = later.estimate(sizes);
    const Vector3d moved = then.box.centre - now.box.centre;
    weights += weight;
    offset += weight * moved;
    squares += weight * (then.centre_covariance + moved * moved.transpose());
    result.velocity += weight * then.velocity;
  }
  offset /= weights;
  result.box.centre = now.box.centre + offset;
  result.centre_covariance = squares / weights - offset * offset.transpose();
  result.velocity /= weights;
  return result;
}

void TrackRecord::report(const Eigen::Isometry3d& T_world_sensor, const Eigen::Matrix3d& ego_covariance,
                         const Vector3d& up, const VehicleSizes& sizes, const TrackerConfig& config,
                         TrackedObject& object) {
  const Eigen::Isometry3d T_sensor_world = T_world_sensor.inverse();
  const Eigen::Matrix3d R = T_sensor_world.linear();
  const BodyFilter& body = predicted.body();
  object.id = id;
  object.divided_from = divided_from;
  object.status = !confirmed ? TrackStatus::kTentative : missed > 0 ? TrackStatus::kCoasting : TrackStatus::kConfirmed;
  object.velocity_sensor = R * now.velocity;
  object.covariance = R * now.velocity_covariance * R.transpose() + ego_covariance;
  object.yaw_rate_rps = body.yaw_rate();
  object.acceleration_mps2 = body.acceleration();
  object.motion = predicted.best().motion();
  object.yaw_rate_variance = body.covariance()(BodyFilter::kYawRate, BodyFilter::kYawRate);
  object.box = now.box;
  object.box.centre = T_sensor_world * object.box.centre;
  object.box.axes = R * object.box.axes;
  object.centre_covariance = R * now.centre_covariance * R.transpose();
  object.faces = now.faces;
  object.centroid = object.box.centre;
  object.extent = aligned_extent(object.box);
  // Not of unit length: straight above the sensor it is zero, and nothing counts as observed.
  const Vector3d across = (R * up).cross(object.centroid);
  const double sigma_mps = config.tangential_sigma_mps;
  object.tangential_observed = across.dot(object.covariance * across) < sigma_mps * sigma_mps * across.squaredNorm();
  const BoxEstimate then = forecast(object.prediction.after_s, sizes, config.track);
  object.prediction.centre = T_sensor_world * then.box.centre;
  const double after_s = object.prediction.after_s;
  object.prediction.centre_covariance = R * then.centre_covariance * R.transpose() + after_s * after_s * ego_covariance;
  object.prediction.velocity_sensor = R * then.velocity;
  object.age_scans = age;
  object.scans_seen = seen;
  make_room(object.members, kUsualRows);  // objects change their places, too
  refill(object.members, std::span<const std::uint32_t>(members));
}

void TrackRecord::state(StateArchive& archive) {
  archive(id, divided_from, track, confirmed, has_moved, moved_s, age, seen, missed);
  const auto is_count = [](int count) { return count >= 0 && count < kMaxScans; };
  archive.require(id > 0 && divided_from >= 0 && is_count(age) && is_count(seen) && is_count(missed), "an object");
}

}  // namespace dynamic_icp::tracking
