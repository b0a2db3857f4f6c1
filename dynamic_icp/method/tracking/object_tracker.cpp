// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamic_icp/method/base/selection.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/tracking/articulation.hpp"
#include "dynamic_icp/method/tracking/expected_rows.hpp"
#include "dynamic_icp/method/tracking/ground_fit.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"
#include "dynamic_icp/method/tracking/track_merging.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kMinHeight_m = 0.25;  // of what is no ground
constexpr double kShown = 0.95;        // probability with which a heading is one of the traffic
constexpr int kMany = 1 << 30;         // no drive has so many objects

/// Whether all of it lies flat on the ground, which seems to move where the velocity of the sensor is wrong.
bool is_ground(const Detection& detection) {
  if (!detection.ground.offset_m) {
    return false;
  }
  const Vector3d up = detection.ground.up();
  return std::ranges::all_of(detection.points, [&](const Vector3d& point) {
    return up.dot(point) - *detection.ground.offset_m < kMinHeight_m;
  });
}

bool are_finite(std::span<const double> values) {
  using Limits = std::numeric_limits<double>;
  return first_outside(values, Limits::lowest(), Limits::max()) == values.size();
}

}  // namespace

ObjectTracker::ObjectTracker(const TrackerConfig& config) : config_(config) { check_fields(fields(config_)); }

std::span<TrackRecord> ObjectTracker::living() { return std::span(entries_).first(living_); }

/// Makes an entry behind the living ones the last of these.
void ObjectTracker::keep(TrackRecord& entry) {
  if (TrackRecord& last = entries_[living_++]; &last != &entry) {
    std::swap(last, entry);
  }
}

std::span<const TrackedObject> ObjectTracker::update(const Scan& scan, std::span<const double> radial,
                                                     std::span<const std::uint8_t> is_moving,
                                                     const SensorMotion& sensor,
                                                     const std::optional<ego_motion::SupportPlane>& support,
                                                     const Workers& workers, const Eigen::Matrix3d& ego_covariance,
                                                     const ScanPatches* measured) {
  if (radial.size() != scan.size() || is_moving.size() != scan.size()) {
    throw std::invalid_argument("radial velocities and moving flags must have one value per point of the scan");
  }
  if (!are_finite(radial) || !sensor.T_world_sensor.matrix().allFinite() || !sensor.velocity_world.allFinite() ||
      !sensor.angular_velocity_sensor.allFinite()) {
    throw std::invalid_argument("radial velocities and the motion of the sensor must be finite");
  }
  if (last_stamp_ && scan.stamp() <= *last_stamp_) {
    throw std::invalid_argument("scans must come in the order of their stamps");
  }
  first_stamp_ = first_stamp_.value_or(scan.stamp());
  last_stamp_ = scan.stamp();
  const Eigen::Isometry3d& T_world_sensor = sensor.T_world_sensor;
  ego_error_ = {T_world_sensor.translation(),
                T_world_sensor.linear() * ego_covariance * T_world_sensor.linear().transpose()};

  find_ground(scan, is_moving, support, T_world_sensor);
  const TrackingInput input = prepare(scan, measured, radial, is_moving, sensor, workers);
  expect(input.stamp_s, sensor, [](const TrackRecord&) { return true; });
  gather_traffic(sensor);
  associate(input, expected_, config_.growth_m, owners_);
  collect_members(input, workers);
  divide_tracks(input);
  initiate_tracks(input, workers);
  delete_tracks(input);
  make_way();
  for (const TrackRecord& entry : living()) {
    entry.note_size(sizes_);
  }
  objects_.resize(std::max(objects_.size(), living_));
  workers.for_each(living_, 1, [&](std::size_t k) {
    entries_[k].report(T_world_sensor, ego_covariance, ground_.ground().up(), sizes_, config_, objects_[k]);
  });
  return std::span(objects_).first(living_);
}

void ObjectTracker::forget() {
  living_ = 0;
  ground_ = {};
  sizes_ = {};
}

/// Of the points of a deskewed scan.
const ScanPatches& ObjectTracker::patches_of(const Scan& scan, const ScanPatches* measured, const Workers& workers) {
  if (measured != nullptr && !scan.has_times()) {
    return *measured;
  }
  patches_.bound(scan, workers);
  return patches_;
}

/// Where the scan shows it: near the plane that carries the scene, or near where it was.
void ObjectTracker::find_ground(const Scan& scan, std::span<const std::uint8_t> is_moving,
                                const std::optional<ego_motion::SupportPlane>& support,
                                const Eigen::Isometry3d& T_world_sensor) {
  const Eigen::Matrix3d R_world_sensor = T_world_sensor.linear();
  const Vector3d& sensor_world = T_world_sensor.translation();
  std::optional<GroundFit> fit;
  const auto try_from = [&](const ego_motion::SupportPlane& start) {
    if (const std::optional<GroundFit> other = fit_ground(start, scan.points(), is_moving)) {
      fit = fit ? likelier_ground(*fit, *other) : *other;
    }
  };
  if (const Ground& last = ground_.ground(); last.offset_m) {
    try_from({R_world_sensor.transpose() * last.up(), *last.offset_m - last.up().dot(sensor_world)});
  }
  if (support) {
    try_from(*support);
  }
  if (fit || support) {
    const ego_motion::SupportPlane& plane = fit ? fit->plane : *support;
    const Vector3d normal = R_world_sensor * plane.normal;
    ground_.update(normal, plane.offset_m + normal.dot(sensor_world), sensor_world);
  }
}

/// Of what lies in the directions in which the points were measured; after patches_of. The sensors of a rig are not
/// where all lines of sight would begin.
const ScanPatches& ObjectTracker::sights_of(const Scan& scan, const ScanPatches* measured, const Workers& workers) {
  if (!scan.has_times()) {
    return measured != nullptr ? *measured : patches_;
  }
  if (measured != nullptr && !scan.is_of_rig()) {
    return *measured;
  }
  sights_.bound_sights(scan, workers);
  return sights_;
}

TrackingInput ObjectTracker::prepare(const Scan& scan, const ScanPatches* measured, std::span<const double> radial,
                                     std::span<const std::uint8_t> is_moving, const SensorMotion& sensor,
                                     const Workers& workers) {
  const ScanPatches& patches = patches_of(scan, measured, workers);
  view_.show(scan, sights_of(scan, measured, workers),
             sensor.T_world_sensor.linear().transpose() * sensor.velocity_world);
  heights_->begin(ground_.ground(), scan.points(), patches, is_moving, sensor.T_world_sensor);
  gather_cells(scan, radial, is_moving, config_.grouping, workers, moving_);
  group_cells(moving_.cells, config_.grouping, grouping_, groups_);
  cell_points_.clear();
  cell_directions_.clear();
  for (const MovingCell& cell : moving_.cells) {
    cell_points_.push_back(sensor.T_world_sensor * cell.centroid);
    cell_directions_.push_back(sensor.direction_world(cell.direction, cell.time_s));
  }
  return {scan,      radial,  is_moving,    sensor,           seconds_between(*first_stamp_, scan.stamp()),
          moving_,   groups_, cell_points_, cell_directions_, view_,
          *heights_, patches};
}

/// What the chosen tracks expect at the stamp of a scan.
template <typename Choice>
void ObjectTracker::expect(double stamp_s, const SensorMotion& sensor, const Choice& choice) {
  expected_.clear();
  for (TrackRecord& entry : living()) {
    if (choice(entry)) {
      entry.predict(stamp_s, sizes_, config_.track);
      expected_.emplace_back(entry.predicted, entry.now, sensor, config_, entry.missed > 0);
    }
  }
}

/// How what is predicted moves, and the carrier.
void ObjectTracker::gather_traffic(const SensorMotion& sensor) {
  traffic_.clear(ground_.ground().level);
  const auto add = [&](const Vector3d& position, const Vector3d& velocity, const Vector3d& direction) {
    if (velocity.norm() > config_.slow_mps) {
      traffic_.add(position, direction, velocity.norm());
    }
  };
  add(sensor.T_world_sensor.translation(), sensor.velocity_world, sensor.velocity_world);
  for (const TrackRecord& entry : living()) {
    if (entry.confirmed && entry.predicted.shows_heading(kShown)) {
      add(entry.now.box.centre, entry.now.velocity, entry.now.box.axes.col(0));
    }
  }
}

void ObjectTracker::flag_expected(const Scan& scan, const ScanPatches& patches, std::span<const double> radial,
                                  const SensorMotion& sensor, const Workers& workers,
                                  std::vector<std::uint8_t>& is_moving) {
  if (living_ > 0) {
    expect(seconds_between(*first_stamp_, scan.stamp()), sensor,
           [](const TrackRecord& entry) { return entry.confirmed; });
    flag_rows(scan, patches, radial, sensor, expected_, workers, is_moving);
  }
}

void ObjectTracker::clear_carrier(const Scan& scan, const ScanPatches& patches,
                                  std::vector<std::uint8_t>& is_moving) const {
  clear_near_rows(scan, patches, config_.min_range_m, is_moving);
}

/// Adds to a slow track the points in its box that are not among the moving ones but move as it does.
void ObjectTracker::gather_static(const TrackingInput& input, const Expectation& expected, TrackRecord& entry) const {
  if (!entry.has_moved || !expected.may_appear_static(input.sensor.T_world_sensor.translation(), config_.slow_mps)) {
    return;
  }
  find_static_rows(input, expected, entry.static_rows);
  std::size_t contradictions = 0;
  std::erase_if(entry.static_rows, [&](std::uint32_t row) {
    const Vector3d direction = input.direction_world(row);
    const bool is_contrary = expected.excludes(direction, input.radial[row], config_.same_velocity_mps);
    contradictions += is_contrary ? 1 : 0;
    return is_contrary || !(expected.gate_ratio(direction, input.radial[row]) < 1.0);
  });
  if (contradictions > entry.members.size() + entry.static_rows.size()) {
    entry.members.clear();
    return;
  }
  make_room(entry.merged, entry.members.size() + entry.static_rows.size());
  entry.merged.resize(entry.members.size() + entry.static_rows.size());
  std::merge(entry.members.begin(), entry.members.end(), entry.static_rows.begin(), entry.static_rows.end(),
             entry.merged.begin());
  std::swap(entry.members, entry.merged);
}

/// Lets each track take in its points.
void ObjectTracker::collect_members(const TrackingInput& input, const Workers& workers) {
  for (TrackRecord& entry : living()) {
    entry.members.clear();
  }
  for (std::size_t i = 0; i < input.moving.rows.size(); ++i) {
    const std::int32_t k = owners_.owner[input.moving.order.cell[i]];
    if (k != kNobody) {
      entries_[static_cast<std::size_t>(k)].members.push_back(input.moving.rows[i]);
    }
  }
  workers.for_each(living_, 1, [&](std::size_t k) { correct(input, expected_[k], entries_[k]); });
}

/// What these rows of the scan show, in the traffic of the tracks; false where it is the ground.
bool ObjectTracker::detect(const TrackingInput& input, std::span<const std::uint32_t> rows,
                           Detection& detection) const {
  make_detection(input.scan, input.radial, rows, input.sensor, input.heights, &input.view, detection);
  detection.traffic = &traffic_;
  if (is_ground(detection)) {
    return false;
  }
  fit_motion(config_.track.doppler_sigma_mps, detection);
  return true;
}

/// Lets a track take in its points and such as stand but may be its own.
void ObjectTracker::correct(const TrackingInput& input, const Expectation& expected, TrackRecord& entry) const {
  const auto miss = [&] {
    ++entry.missed;
    entry.members.clear();
  };
  entry.joint.reset();
  gather_static(input, expected, entry);
  ++entry.age;
  input.view.remove_mirrored(entry.members, entry.merged);
  if (entry.members.size() < kMinDetectionPoints) {
    return miss();
  }
  Track& corrected = entry.other;
  corrected = entry.track;
  if (!detect(input, entry.members, entry.detection)) {
    return miss();
  }
  corrected.correct(entry.detection, input.stamp_s, config_.track);
  if (corrected.best().spread_mps() > config_.max_spread_mps) {
    return miss();
  }
  std::swap(entry.track, corrected);
  entry.predicted_s.reset();
  entry.predict(input.stamp_s, sizes_, config_.track);
  entry.missed = 0;
  ++entry.seen;
  const bool seen_often =
      entry.seen >= config_.confirm_scans || entry.members.size() >= static_cast<std::size_t>(config_.confirm_points);
  entry.confirmed = entry.confirmed || (seen_often && entry.is_credible(ego_error_, config_));
  entry.note_motion(input.stamp_s, config_);
  if (const BoxFilter& best = entry.track.best(); best.has_heading()) {
    entry.joint =
        find_joint(entry.detection, entry.now.box.axes, best.body().yaw_rate(), config_.track.doppler_sigma_mps);
    if (!entry.joint) {
      entry.joint =
          find_gap({input.scan, entry.members, input.sensor, entry.detection}, best.seen_box(), best.body().velocity());
    }
  }
}

/// What tracks predict is computed from their states; what lies behind the living ones is memory.
void ObjectTracker::state(StateArchive& archive) {
  entries_.resize(living_);
  archive.each(entries_, [&](TrackRecord& entry) { archive(entry); });
  living_ = entries_.size();
  archive(ground_, sizes_, next_id_, first_stamp_, last_stamp_);
  archive.require(next_id_ > 0 && next_id_ < kMany &&
                      std::ranges::all_of(entries_, [&](const TrackRecord& entry) { return entry.id < next_id_; }),
                  "the number of an object");
  archive.require(first_stamp_.has_value() == last_stamp_.has_value() &&
                      (!last_stamp_ || *first_stamp_ <= *last_stamp_) && (last_stamp_ || entries_.empty()),
                  "the time of the objects");
}

}  // namespace dynamic_icp::tracking
