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

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/tracking/track_merging.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kNobody = -1;
constexpr double kMax = 2.0;           // new objects are not wider than so many vehicles
constexpr double kMinSignal = 2.0;     // of the radial velocities of a new object over their spread
constexpr std::size_t kMinPoints = 3;  // of a detection: a velocity has three unknowns

double latest_time(const Scan& scan) {
  double latest_s = 0.0;
  for (const double time_s : scan.times()) {
    latest_s = std::max(latest_s, std::abs(time_s));
  }
  return latest_s;
}

/// Whether a point that stands cannot be part of a body that makes it expect a radial velocity.
bool contradicts(const Expectation& expected, const Vector3d& direction, double radial_mps,
                 const TrackerConfig& config) {
  const double expected_mps = expected.W.dot(direction);
  return std::abs(expected_mps) > config.same_velocity_mps &&
         std::abs(radial_mps - expected_mps) > config.same_velocity_mps + expected.radial_sigma(direction);
}

bool are_finite(std::span<const double> values) {
  // Without a way out, so that it becomes vectors.
  bool finite = true;
  for (const double value : values) {
    finite &= std::abs(value) <= std::numeric_limits<double>::max();
  }
  return finite;
}

}  // namespace

/// A track with what is known of it besides its motion.
struct ObjectTracker::Entry {
  std::int64_t id;
  Track track;                             ///< at the mean time of its last detection
  Track predicted;                         ///< at the stamp of the present scan, with what that scan shows
  BoxEstimate now = {};                    ///< of the latter
  std::optional<double> predicted_s = {};  ///< that stamp
  bool confirmed = false;
  bool has_moved = false;  ///< beyond doubt
  double moved_s = 0.0;    ///< when it moved last
  int age = 0;
  int seen = 0;
  int missed = 0;
  std::vector<std::uint32_t> members = {};

  /// The track at the stamp of a scan. It is asked for several times a scan.
  void predict(double stamp_s, const TrackConfig& config) {
    if (predicted_s == stamp_s) {
      return;
    }
    predicted = track;
    predicted.predict(stamp_s, config);
    now = predicted.estimate();
    predicted_s = stamp_s;
  }

  [[nodiscard]] SeenTrack seen_track() const { return {predicted, now, members.size()}; }

  void set_track(Track corrected) {
    track = std::move(corrected);
    predicted_s.reset();
  }
};

ObjectTracker::ObjectTracker(const TrackerConfig& config) : config_(config) { check_fields(fields(config_)); }
ObjectTracker::~ObjectTracker() = default;
ObjectTracker::ObjectTracker(ObjectTracker&&) noexcept = default;
ObjectTracker& ObjectTracker::operator=(ObjectTracker&&) noexcept = default;

std::vector<TrackedObject> ObjectTracker::update(const Scan& scan, std::span<const double> radial,
                                                 std::span<const std::uint8_t> is_moving,
                                                 const Eigen::Isometry3d& T_world_sensor,
                                                 const std::optional<ego_motion::SupportPlane>& support,
                                                 const Workers& workers, const Eigen::Matrix3d& ego_covariance) {
  if (radial.size() != scan.size() || is_moving.size() != scan.size()) {
    throw std::invalid_argument("radial velocities and moving flags must have one value per point of the scan");
  }
  if (!are_finite(radial) || !T_world_sensor.matrix().allFinite()) {
    throw std::invalid_argument("radial velocities and the pose of the sensor must be finite");
  }
  if (last_stamp_ && scan.stamp() <= *last_stamp_) {
    throw std::invalid_argument("scans must come in the order of their stamps");
  }
  first_stamp_ = first_stamp_.value_or(scan.stamp());
  const SensorMotion sensor =
      last_stamp_ ? continued_motion(T_world_last_, T_world_sensor, seconds_between(*last_stamp_, scan.stamp()))
                  : SensorMotion{T_world_sensor};
  last_stamp_ = scan.stamp();
  T_world_last_ = T_world_sensor;

  if (support) {
    const Vector3d normal = T_world_sensor.linear() * support->normal;
    ground_.update(normal, support->offset_m + normal.dot(T_world_sensor.translation()), T_world_sensor.translation());
  }

  const TrackingInput input = prepare(scan, radial, is_moving, sensor, workers);
  const std::vector<Expectation> expected = expectations(input.stamp_s, sensor, [](const Entry&) { return true; });
  owner_.assign(input.moving.cells.size(), kNobody);
  assign(input, expected, owner_);
  associate(input, expected, owner_);
  collect_members(input, expected, owner_, workers);
  initiate_tracks(input, owner_, workers);
  delete_tracks(input);
  std::vector<TrackedObject> objects;
  objects.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    objects.push_back(report(entry, sensor, ego_covariance));
  }
  return objects;
}

TrackingInput ObjectTracker::prepare(const Scan& scan, std::span<const double> radial,
                                     std::span<const std::uint8_t> is_moving, const SensorMotion& sensor,
                                     const Workers& workers) {
  const Vector3d velocity_sensor = sensor.T_world_sensor.linear().transpose() * sensor.velocity_world;
  workers.both([&] { view_.draw(scan, velocity_sensor, workers); },
               [&] {
                 gather_cells(scan, radial, is_moving, config_.grouping, workers, moving_);
                 groups_ = group_cells(moving_.cells, config_.grouping);
                 heights_.emplace(ground_.ground(), scan.points(), is_moving, sensor.T_world_sensor);
               });
  cell_points_.clear();
  cell_directions_.clear();
  for (const MovingCell& cell : moving_.cells) {
    cell_points_.push_back(sensor.T_world_sensor * cell.centroid);
    cell_directions_.push_back(sensor.direction_world(cell.direction, cell.time_s));
  }
  return {scan,
          radial,
          is_moving,
          sensor,
          seconds_between(*first_stamp_, scan.stamp()),
          latest_time(scan),
          moving_,
          groups_,
          cell_points_,
          cell_directions_,
          view_,
          *heights_};
}

/// Of the chosen entries, at the stamp of a scan.
template <typename Choice>
std::vector<Expectation> ObjectTracker::expectations(double stamp_s, const SensorMotion& sensor, const Choice& choice) {
  std::vector<Expectation> expected;
  expected.reserve(entries_.size());
  for (Entry& entry : entries_) {
    if (choice(entry)) {
      entry.predict(stamp_s, config_.track);
      expected.emplace_back(entry.predicted, entry.now, sensor, config_);
    }
  }
  return expected;
}

void ObjectTracker::flag_expected(const Scan& scan, std::span<const double> radial, const SensorMotion& sensor,
                                  const Workers& workers, std::vector<std::uint8_t>& is_moving) {
  if (!entries_.empty()) {
    const double stamp_s = seconds_between(*first_stamp_, scan.stamp());
    flag_rows(scan, radial, sensor, expectations(stamp_s, sensor, [](const Entry& entry) { return entry.confirmed; }),
              workers, is_moving);
  }
}

void ObjectTracker::clear_carrier(const Scan& scan, const Workers& workers,
                                  std::vector<std::uint8_t>& is_moving) const {
  const double squared_m2 = config_.min_range_m * config_.min_range_m;
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t row) {
    const Vector3d origin =
        scan.is_of_rig() ? Vector3d(scan.mountings()[scan.channels().sensor[row]].translation()) : Vector3d::Zero();
    if ((scan.points()[row] - origin).squaredNorm() < squared_m2) {
      is_moving[row] = 0;
    }
  });
}

/// Gives each cell to the track whose box and velocity fit it best.
void ObjectTracker::assign(const TrackingInput& input, std::span<const Expectation> expectations,
                           std::vector<std::int32_t>& owner) const {
  std::vector<double> best(owner.size(), 1.0);
  for (std::size_t k = 0; k < expectations.size(); ++k) {
    const Expectation& expected = expectations[k];
    const double reach =
        std::max(0.5 * expected.box.size.norm() + expected.gate_m,
                 (expected.whole.centre - expected.box.centre).norm() + 0.5 * expected.whole.size.norm());
    for (std::size_t i = 0; i < owner.size(); ++i) {
      const MovingCell& cell = input.moving.cells[i];
      const Vector3d& point = input.cell_points[i];
      if ((point - cell.time_s * expected.velocity - expected.box.centre).squaredNorm() > reach * reach) {
        continue;
      }
      const double score = std::max(expected.distance_ratio(point, cell.time_s),
                                    expected.gate_ratio(input.cell_directions[i], cell.radial_mps));
      if (score < best[i] && expected.width_with(point, cell.time_s) < expected.max_width_m) {
        best[i] = score;
        owner[i] = static_cast<std::int32_t>(k);
      }
    }
  }
}

/// Cells that are linked to those of a track and not far from its box become part of it: sides that come into view.
void ObjectTracker::associate(const TrackingInput& input, std::span<const Expectation> expectations,
                              std::vector<std::int32_t>& owner) const {
  std::vector<std::vector<std::int32_t>> owners_of_group;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    if (input.groups[i] >= owners_of_group.size()) {
      owners_of_group.resize(input.groups[i] + 1);
    }
    std::vector<std::int32_t>& owners = owners_of_group[input.groups[i]];
    if (owner[i] != kNobody && std::find(owners.begin(), owners.end(), owner[i]) == owners.end()) {
      owners.push_back(owner[i]);
    }
  }
  for (std::size_t i = 0; i < owner.size(); ++i) {
    if (owner[i] != kNobody) {
      continue;
    }
    const MovingCell& cell = input.moving.cells[i];
    double nearest = config_.growth_m;
    for (const std::int32_t k : owners_of_group[input.groups[i]]) {
      const Expectation& expected = expectations[static_cast<std::size_t>(k)];
      const double outside = expected.outside(input.cell_points[i], cell.time_s);
      if (outside < nearest && expected.gate_ratio(input.cell_directions[i], cell.radial_mps) < 2.0 &&
          expected.width_with(input.cell_points[i], cell.time_s) < expected.max_width_m) {
        nearest = outside;
        owner[i] = k;
      }
    }
  }
}

/// Adds to slow tracks the points in their boxes that are not among the moving ones but move as they do.
void ObjectTracker::gather_static(const TrackingInput& input, std::span<const Expectation> expectations,
                                  const Workers& workers) {
  std::vector<std::size_t> slow;
  std::vector<Expectation> expected;
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    if (entries_[k].has_moved &&
        expectations[k].may_appear_static(input.sensor.T_world_sensor.translation(), config_.slow_mps)) {
      slow.push_back(k);
      expected.push_back(expectations[k]);
    }
  }
  std::vector<std::vector<std::uint32_t>> static_points(slow.size());
  std::vector<std::size_t> contradictions(slow.size(), 0);
  visit_static_points(input, expected, workers, [&](std::size_t i, std::uint32_t row, const Vector3d& direction) {
    if (contradicts(expected[i], direction, input.radial[row], config_)) {
      ++contradictions[i];
    } else if (expected[i].gate_ratio(direction, input.radial[row]) < 1.0) {
      static_points[i].push_back(row);
    }
  });
  for (std::size_t i = 0; i < slow.size(); ++i) {
    std::vector<std::uint32_t>& members = entries_[slow[i]].members;
    if (contradictions[i] > members.size() + static_points[i].size()) {
      members.clear();
      continue;
    }
    const auto middle = static_cast<std::ptrdiff_t>(members.size());
    members.insert(members.end(), static_points[i].begin(), static_points[i].end());
    std::inplace_merge(members.begin(), members.begin() + middle, members.end());
  }
}

/// Lets each track take in its points.
void ObjectTracker::collect_members(const TrackingInput& input, std::span<const Expectation> expectations,
                                    const std::vector<std::int32_t>& owner, const Workers& workers) {
  for (Entry& entry : entries_) {
    entry.members.clear();
  }
  for (std::size_t i = 0; i < input.moving.rows.size(); ++i) {
    const std::int32_t k = owner[input.moving.order.cell[i]];
    if (k != kNobody) {
      entries_[static_cast<std::size_t>(k)].members.push_back(input.moving.rows[i]);
    }
  }
  gather_static(input, expectations, workers);
  workers.for_each(entries_.size(), 1, [&](std::size_t k) {
    Entry& entry = entries_[k];
    ++entry.age;
    if (entry.members.size() < kMinPoints || input.view.are_mirrored(entry.members)) {
      ++entry.missed;
      entry.members.clear();
      return;
    }
    Track corrected = entry.track;
    corrected.correct(make_detection(input.scan, input.radial, entry.members, input.sensor, input.heights, &input.view),
                      input.stamp_s, config_.track);
    if (corrected.best().spread_mps() > config_.max_spread_mps) {
      ++entry.missed;
      entry.members.clear();
      return;
    }
    entry.set_track(std::move(corrected));
    entry.predict(input.stamp_s, config_.track);
    entry.missed = 0;
    ++entry.seen;
    const bool seen_often =
        entry.seen >= config_.confirm_scans || entry.members.size() >= static_cast<std::size_t>(config_.confirm_points);
    entry.confirmed = entry.confirmed || (seen_often && is_credible(entry));
    note_motion(entry, input.stamp_s);
  });
}

/// Whether the velocity is worth reporting: known well enough, or as well as it will be.
bool ObjectTracker::is_credible(const Entry& entry) const {
  const double variance = entry.now.velocity_covariance.topLeftCorner<2, 2>().trace();
  return variance < config_.confirm_sigma_mps * config_.confirm_sigma_mps || entry.seen >= config_.confirm_anyway_scans;
}

void ObjectTracker::note_motion(Entry& entry, double stamp_s) const {
  const double speed = entry.now.velocity.norm();
  entry.has_moved = entry.has_moved || (entry.confirmed && speed > config_.slow_mps);
  if (speed >= config_.min_speed_mps) {
    entry.moved_s = stamp_s;
  }
}

/// Groups nobody owns become tracks.
void ObjectTracker::initiate_tracks(const TrackingInput& input, const std::vector<std::int32_t>& owner,
                                    const Workers& workers) {
  std::vector<std::uint32_t> unowned;
  for (std::uint32_t cell = 0; cell < owner.size(); ++cell) {
    if (owner[cell] == kNobody) {
      unowned.push_back(cell);
    }
  }
  std::vector<Entry> newborn;
  std::vector<Expectation> expected;
  std::vector<CellGroup> groups =
      vehicle_groups(input.moving, unowned, config_.track.largest_width_m, config_.min_points, config_.grouping);
  std::erase_if(groups, [&](const CellGroup& group) { return input.view.are_mirrored(group.rows); });
  std::vector<std::optional<Track>> tracks(groups.size());
  workers.for_each(groups.size(), 1, [&](std::size_t i) {
    tracks[i].emplace(
        make_detection(input.scan, input.radial, groups[i].rows, input.sensor, input.heights, &input.view),
        input.stamp_s, config_.track);
  });
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Track& track = *tracks[i];
    // Errors around zero have more spread than signal.
    const double spread = track.best().spread_mps();
    const bool plausible = track.best().seen_box().size.y() <= kMax * config_.track.largest_width_m;
    if (plausible && spread <= config_.max_spread_mps && track.best().signal_mps() >= kMinSignal * spread) {
      newborn.push_back({0, track, track});
      newborn.back().predict(input.stamp_s, config_.track);
      newborn.back().members = std::move(groups[i].rows);
      expected.emplace_back(newborn.back().predicted, newborn.back().now, input.sensor, config_);
    }
  }
  // Where many points are static, some that seem to move are errors of measurement.
  std::vector<std::size_t> contradictions(newborn.size(), 0);
  visit_static_points(input, expected, workers, [&](std::size_t i, std::uint32_t row, const Vector3d& direction) {
    contradictions[i] += contradicts(expected[i], direction, input.radial[row], config_) ? 1 : 0;
  });
  for (std::size_t i = 0; i < newborn.size(); ++i) {
    Entry& entry = newborn[i];
    const std::size_t points = entry.members.size();
    if (contradictions[i] > points) {
      continue;
    }
    entry.id = next_id_++;
    entry.age = 1;
    entry.seen = 1;
    const bool seen_often = points >= static_cast<std::size_t>(config_.confirm_points) || config_.confirm_scans <= 1;
    entry.confirmed = seen_often && is_credible(entry);
    note_motion(entry, input.stamp_s);
    entries_.push_back(std::move(entry));
  }
}

/// Whether nothing is to be expected of a track any more.
bool ObjectTracker::is_over(const Entry& entry, double stamp_s) const {
  if (!entry.confirmed) {
    return entry.missed > 0 || entry.now.velocity.norm() < config_.min_speed_mps;
  }
  if (!entry.has_moved && entry.now.velocity.norm() < config_.min_speed_mps) {
    return true;
  }
  const double variance = entry.now.centre_covariance.topLeftCorner<2, 2>().trace();
  const bool is_vague = variance > config_.coast_sigma_m * config_.coast_sigma_m;
  return (entry.missed > 0 && (is_vague || stamp_s - entry.track.time_s() > config_.coast_s)) ||
         stamp_s - entry.moved_s > config_.stand_s;
}

/// Ends tracks of which nothing is to be expected any more, and makes one of those that share a place.
void ObjectTracker::delete_tracks(const TrackingInput& input) {
  std::vector<Entry> living;
  living.reserve(entries_.size());
  for (Entry& entry : entries_) {
    if (is_over(entry, input.stamp_s)) {
      continue;
    }
    const auto same = std::find_if(living.begin(), living.end(), [&](const Entry& older) {
      return are_same_object(older.seen_track(), entry.seen_track(), input.view, input.sensor.T_world_sensor, config_);
    });
    if (same == living.end()) {
      living.push_back(std::move(entry));
    } else if (entry.members.size() > same->members.size()) {
      // The name of the older one continues with the state of what is seen more of.
      entry.id = same->id;
      entry.age = same->age;
      entry.seen = same->seen;
      entry.confirmed = same->confirmed || entry.confirmed;
      entry.has_moved = same->has_moved || entry.has_moved;
      *same = std::move(entry);
    }
  }
  entries_ = std::move(living);
}

TrackedObject ObjectTracker::report(const Entry& entry, const SensorMotion& sensor,
                                    const Eigen::Matrix3d& ego_covariance) const {
  const Eigen::Isometry3d T_sensor_world = sensor.T_world_sensor.inverse();
  const Eigen::Matrix3d R = T_sensor_world.linear();
  const BodyFilter& body = entry.predicted.body();
  TrackedObject object;
  object.id = entry.id;
  object.status = !entry.confirmed   ? TrackStatus::kTentative
                  : entry.missed > 0 ? TrackStatus::kCoasting
                                     : TrackStatus::kConfirmed;
  object.velocity_sensor = R * entry.now.velocity;
  object.covariance = R * entry.now.velocity_covariance * R.transpose() + ego_covariance;
  object.yaw_rate_rps = body.yaw_rate();
  object.yaw_rate_variance = body.covariance()(BodyFilter::kYawRate, BodyFilter::kYawRate);
  object.box = entry.now.box;
  object.box.centre = T_sensor_world * object.box.centre;
  object.box.axes = R * object.box.axes;
  object.centre_covariance = R * entry.now.centre_covariance * R.transpose();
  object.faces = entry.now.faces;
  object.centroid = object.box.centre;
  object.extent = aligned_extent(object.box);
  // Not of unit length: straight above the sensor it is zero, and nothing counts as observed.
  const Vector3d across = (R * ground_.ground().up()).cross(object.centroid);
  const double sigma_mps = config_.tangential_sigma_mps;
  object.tangential_observed = across.dot(object.covariance * across) < sigma_mps * sigma_mps * across.squaredNorm();
  Track later = entry.predicted;
  later.predict(later.time_s() + object.prediction.after_s, config_.track);
  const BoxEstimate then = later.estimate();
  object.prediction.centre = T_sensor_world * then.box.centre;
  const double after_s = object.prediction.after_s;
  object.prediction.centre_covariance = R * then.centre_covariance * R.transpose() + after_s * after_s * ego_covariance;
  object.prediction.velocity_sensor = R * then.velocity;
  object.age_scans = entry.age;
  object.scans_seen = entry.seen;
  object.members = entry.members;
  return object;
}

/// What tracks predict is computed from their states.
void ObjectTracker::state(StateArchive& archive) {
  archive.each(entries_, Entry{0, Track::blank(), Track::blank()}, [&](Entry& entry) {
    archive(entry.id, entry.track, entry.confirmed, entry.has_moved, entry.moved_s, entry.age, entry.seen,
            entry.missed);
  });
  archive(ground_, next_id_, first_stamp_, last_stamp_, T_world_last_);
}

}  // namespace dynamic_icp::tracking
