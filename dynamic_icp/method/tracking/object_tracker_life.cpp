// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dynamic_icp/method/tracking/expected_rows.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"
#include "dynamic_icp/method/tracking/object_tracker.hpp"
#include "dynamic_icp/method/tracking/track_merging.hpp"

// How tracks begin, part and end.
namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kMaxWidths = 2.0;  // new objects are not wider than so many vehicles
constexpr double kMinSignal = 2.0;  // of the radial velocities of a new object over their spread

}  // namespace

/// Groups nobody owns become tracks.
void ObjectTracker::initiate_tracks(const TrackingInput& input, const Workers& workers) {
  // Groups among the unowned cells are parts of those among all: where these have too few points, so have the parts.
  refill(unowned_points_, owners_.owner.size(), std::size_t{0});
  for (std::size_t cell = 0; cell < owners_.owner.size(); ++cell) {
    unowned_points_[groups_[cell]] += owners_.owner[cell] == kNobody ? moving_.cells[cell].count : 0;
  }
  unowned_.clear();
  for (std::uint32_t cell = 0; cell < owners_.owner.size(); ++cell) {
    if (owners_.owner[cell] == kNobody && std::cmp_greater_equal(unowned_points_[groups_[cell]], config_.min_points)) {
      unowned_.push_back(cell);
    }
  }
  vehicle_groups(input.moving, unowned_, config_.track.largest_width_m, config_.min_points, config_.grouping, grouping_,
                 unowned_groups_);
  const std::size_t groups = unowned_groups_.size();
  entries_.resize(std::max(entries_.size(), living_ + groups));
  const std::size_t first = living_;
  workers.for_each(groups, 1, [&](std::size_t i) { begin(input, unowned_groups_.rows_of(i), entries_[first + i]); });
  for (std::size_t i = first; i < first + groups; ++i) {
    if (entries_[i].seen > 0) {
      entries_[i].id = next_id_++;
      keep(entries_[i]);
    }
  }
}

/// Makes a new track of these rows of the scan. It was never seen if they are no object.
void ObjectTracker::begin(const TrackingInput& input, std::span<const std::uint32_t> rows, TrackRecord& entry) const {
  entry.seen = 0;
  refill(entry.members, rows);
  input.view.remove_mirrored(entry.members, entry.merged);
  if (entry.members.size() < kMinDetectionPoints || !detect(input, entry.members, entry.detection)) {
    return;
  }
  entry.track.begin(entry.detection, input.stamp_s, config_.track);
  // Errors around zero have more spread than signal.
  const BoxFilter& best = entry.track.best();
  const bool is_plausible = best.seen_box().size.y() <= kMaxWidths * config_.track.largest_width_m &&
                            best.spread_mps() <= config_.max_spread_mps &&
                            best.signal_mps() >= kMinSignal * best.spread_mps();
  if (!is_plausible) {
    return;
  }
  entry.predicted_s.reset();
  entry.predict(input.stamp_s, sizes_, config_.track);
  // Where many points are static, some that seem to move are errors of measurement.
  const Expectation expected(entry.predicted, entry.now, input.sensor, config_);
  find_static_rows(input, expected, entry.static_rows);
  const auto contradictions = std::count_if(entry.static_rows.begin(), entry.static_rows.end(), [&](std::uint32_t row) {
    return expected.excludes(input.direction_world(row), input.radial[row], config_.same_velocity_mps);
  });
  if (std::cmp_greater(contradictions, entry.members.size())) {
    return;
  }
  entry.age = 1;
  entry.seen = 1;
  entry.missed = 0;
  entry.has_moved = false;
  entry.divided_from = 0;
  entry.moved_s = 0.0;
  const bool seen_often =
      entry.members.size() >= static_cast<std::size_t>(config_.confirm_points) || config_.confirm_scans <= 1;
  entry.confirmed = seen_often && entry.is_credible(ego_error_, config_);
  entry.note_motion(input.stamp_s, config_);
}

/// What turned out to be two bodies becomes two tracks; the one with more points keeps the name.
void ObjectTracker::divide_tracks(const TrackingInput& input) {
  const std::size_t whole = living_;
  for (std::size_t k = 0; k < whole; ++k) {
    if (entries_[k].joint) {
      entries_.resize(std::max(entries_.size(), living_ + 2));
      const Joint joint = *entries_[k].joint;
      divide(input, joint, entries_[k], entries_[living_], entries_[living_ + 1]);
    }
  }
}

/// Of a body that is two. The others are memory behind the living.
void ObjectTracker::divide(const TrackingInput& input, const Joint& joint, TrackRecord& body, TrackRecord& larger,
                           TrackRecord& smaller) {
  std::vector<std::uint32_t>& behind = body.static_rows;
  std::vector<std::uint32_t>& ahead = body.merged;
  behind.clear();
  ahead.clear();
  for (const std::uint32_t row : body.members) {
    const Vector3d point = input.sensor.T_world_sensor * input.scan.points()[row];
    (joint.direction.dot(point) > joint.place_m ? ahead : behind).push_back(row);
  }
  const bool more_are_ahead = ahead.size() > behind.size();
  begin(input, more_are_ahead ? ahead : behind, larger);
  begin(input, more_are_ahead ? behind : ahead, smaller);
  if (larger.seen == 0 || smaller.seen == 0) {
    return;
  }
  for (TrackRecord* part : {&larger, &smaller}) {
    if (joint.is_gap) {
      part->track.point_along(body.track.best().body().yaw());
    }
    if (!joint.is_across) {
      const double outward = (part == &larger) == more_are_ahead ? -1.0 : 1.0;
      part->track.end_at(outward * joint.direction, outward * joint.place_m);
      part->predicted_s.reset();
      part->predict(input.stamp_s, sizes_, config_.track);
    }
    part->take_name_of(body);
  }
  std::swap(body, larger);
  const std::span<TrackRecord> all = living();
  const bool is_known = std::any_of(all.begin(), all.end(), [&](const TrackRecord& other) {
    return other.was_divided_from(body) && distance_outside(other.now.box, smaller.now.box.centre) <= config_.growth_m;
  });
  if (is_known) {
    return;  // it was divided before and had taken what belongs to the other part
  }
  if (joint.is_of_another) {
    if (const TrackRecord* const same = same_object(smaller, input); same == nullptr || same == &body) {
      std::swap(body, larger);
    }
    return;
  }
  smaller.id = next_id_++;
  smaller.divided_from = body.id;
  smaller.age = 1;
  keep(smaller);
}

/// The living track of the object that another one shows; of several the one beside which that is.
TrackRecord* ObjectTracker::same_object(const TrackRecord& entry, const TrackingInput& input) {
  TrackRecord* same = nullptr;
  for (TrackRecord& older : living()) {
    if (older.was_divided_from(entry) ||
        !are_same_object(older.seen_track(), entry.seen_track(), input.view, input.sensor.T_world_sensor, config_)) {
      continue;
    }
    if (gap_between(older.predicted.best().seen_box(), entry.predicted.best().seen_box()).width <= 0.0) {
      return &older;
    }
    same = same == nullptr ? &older : same;
  }
  return same;
}

/// Ends tracks of which nothing is to be expected any more, and makes one of those that share a place.
void ObjectTracker::delete_tracks(const TrackingInput& input) {
  const std::span<TrackRecord> all = living();
  living_ = 0;
  for (TrackRecord& entry : all) {
    if (entry.is_over(input.stamp_s, config_)) {
      continue;
    }
    TrackRecord* const same = same_object(entry, input);
    if (same == nullptr) {
      keep(entry);
      continue;
    }
    if (entry.members.size() > same->members.size()) {
      entry.take_name_of(*same);
      std::swap(*same, entry);
    }
    if (!entry.members.empty()) {
      entry.track.predict(same->track.time_s(), config_.track);
      same->track.include(entry.track.best().seen_box(), is_splinter(entry.members.size(), same->members.size()));
      same->predicted_s.reset();
      same->predict(input.stamp_s, sizes_, config_.track);
    }
  }
}

/// Lets no track reach beyond what was seen of it into one of which more is seen now.
void ObjectTracker::make_way() {
  for (TrackRecord& entry : living()) {
    if (!entry.predicted.is_sure_of_heading()) {
      continue;
    }
    Room room;
    const OrientedBox seen = entry.predicted.best().seen_box();
    for (const TrackRecord& other : living()) {
      if (other.confirmed && other.members.size() > entry.members.size()) {
        const Room beside = room_beside(seen, entry.now.box, other.predicted.best().seen_box());
        room = {std::min(room.ahead, beside.ahead), std::min(room.behind, beside.behind)};
      }
    }
    entry.track.set_room(room);
    entry.predicted.set_room(room);
    entry.now = entry.predicted.estimate(sizes_);
  }
}

}  // namespace dynamic_icp::tracking
