// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/likely_extent.hpp"

#include <cstddef>

#include "dynamic_icp/method/tracking/size_prior.hpp"
#include "dynamic_icp/method/tracking/vehicle_sizes.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kHiddenHeight_m = 0.5;  // standard deviation of a height of which the top was not seen
constexpr double kLowestVehicle_m = 1.5;
constexpr double kNoBox = 0.05;  // bodies end by this share of their size nearer or farther than boxes do

/// The size where there is no room for what is likely: anything that there is room for.
Belief within_room(const Belief& size, const SeenExtent& seen) {
  const double room = (seen.ends_high ? 0.0 : seen.room_high) + (seen.ends_low ? 0.0 : seen.room_low);
  return size.mean <= seen.length() + room ? size : Belief{seen.length() + 0.5 * room, room * room / 12.0};
}

LikelyExtent placed(const SeenExtent& seen, const Belief& size) {
  LikelyExtent extent;
  extent.size = size.mean;
  const double shape = kNoBox * kNoBox * size.mean * size.mean;  // m^2, of an end that is seen
  if (seen.is_whole()) {
    extent.weight_high = extent.weight_low = 0.5;
    extent.middle = 0.5 * (seen.high - seen.low);
    extent.variance = 0.5 * shape;
  } else if (seen.ends_high) {
    extent.weight_high = 1.0;
    extent.middle = seen.high - 0.5 * size.mean;
    extent.variance = 0.25 * size.variance + shape;
  } else if (seen.ends_low) {
    extent.weight_low = 1.0;
    extent.middle = 0.5 * size.mean - seen.low;
    extent.variance = 0.25 * size.variance + shape;
  } else {
    const double hidden = std::max(0.0, size.mean - seen.length());
    const double beyond_high = std::max(hidden - seen.room_low, std::min(seen.room_high, 0.5 * hidden));
    extent.middle = 0.5 * (seen.high - seen.low - hidden) + beyond_high;
    extent.variance = hidden * hidden / 12.0 + 0.25 * size.variance;
  }
  return extent;
}

}  // namespace

std::array<LikelyExtent, 3> likely_extents(const std::array<SeenExtent, 3>& seen, bool has_heading, bool may_be_person,
                                           const VehicleSizes& sizes) {
  const auto& [along, across, as_seen_up] = seen;
  const bool is_as_seen = !has_heading || may_be_person;
  SeenExtent up = as_seen_up;
  Belief height{up.length(), 0.0};
  if (!is_as_seen && !along.is_whole() && !across.is_whole()) {
    up.ends_high = false;  // a hood; something hides the cabin
    height.mean = std::max(kLowestVehicle_m, height.mean);
  }
  if (!is_as_seen && up.is_cut_high) {
    height = height_beyond(height.mean);
  } else if (!up.ends_high) {
    height.variance = kHiddenHeight_m * kHiddenHeight_m;
  }
  // The width first: it varies least.
  Belief width{across.length(), 0.0};
  if (!is_as_seen && !across.is_whole()) {
    width = at_least(along.is_whole() ? typical_width(along.length()) : typical_width_by_height(height.mean),
                     across.length());
  }
  Belief length{along.length(), 0.0};
  if (!is_as_seen && !along.is_whole()) {
    length = at_least(typical_length(width.mean, height.mean), along.length());
    const double slope = length_per_height(width.mean, height.mean);
    length.variance += slope * slope * height.variance;
  }
  if (!has_heading && !may_be_person) {
    // A part of a vehicle, whichever: as much of it again may be anywhere.
    const double more = typical_width_by_height(height.mean).mean;
    width.variance = across.is_whole() ? 0.0 : more * more;
    length.variance = along.is_whole() ? 0.0 : more * more;
  }
  if (is_as_seen) {
    return {placed(along, length), placed(across, width), placed(up, height)};
  }
  const auto seen_size = [](const SeenExtent& extent) { return SeenSize{extent.length(), extent.is_whole()}; };
  const auto [long_as, wide_as, high_as] =
      sizes.complete({seen_size(along), seen_size(across), seen_size(up)}, {length, width, height});
  return {placed(along, within_room(long_as, along)), placed(across, wide_as), placed(up, high_as)};
}

}  // namespace dynamic_icp::tracking
