// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/datasets/spherical_fields.hpp"
#include "dynamic_icp/recording/formats/channel.hpp"

namespace dynamic_icp::datasets {

/// A column of a file whose arrays have names.
struct FieldColumn {
  std::string array;
  std::size_t column = 0;  ///< of an array with several
  bool whole = true;       ///< the array must have this column only

  bool operator==(const FieldColumn&) const = default;
};

/// A column that says more of a point.
struct ChannelColumn {
  formats::Channel channel = formats::Channel::kNone;
  std::string array;

  bool operator==(const ChannelColumn&) const = default;
};

/// Which columns say what.
struct FieldMap {
  std::array<FieldColumn, 3> point;          ///< x, y, z
  std::optional<SphericalFields> spherical;  ///< azimuth, elevation and range in place of these
  FieldColumn doppler;
  std::optional<FieldColumn> time;
  std::optional<std::array<FieldColumn, 3>> line_of_sight;
  std::vector<ChannelColumn> channels;   ///< each at most once, but for flags; never a column that is used above
  std::vector<std::string> assumptions;  ///< what was chosen where the name was not the obvious one, in sentences

  /// Whether point, Doppler, time or line of sight are taken from the array of that name.
  [[nodiscard]] bool uses(const std::string& array) const;
};

/// Finds the columns by the names that are in use, whatever their case. `names` are those of the arrays of one file,
/// `origin` the file that messages name.
///
///   point          x, y, z; or one array of them: points, xyz, pts, positions
///                  else range (distance, dist, r) with azimuth (az, azi) and elevation (elev, el) or polar (zenith),
///                  or with theta and phi, also with _deg or _rad behind the angles (spherical_fields.hpp)
///   doppler        doppler, velocity, radial_velocity, radial_vel, v_radial, doppler_velocity, dopplers, velocity_mps,
///                  v_doppler_mps, range_rate, vel, v_r, vr, rv, v, radial_speed, speed, in this order
///   time           time_offset_ns, time_offset_s, offset_time, t, time_stamp, timestamp, time, time_offset,
///                  time_offsets, nanosecs_since_frame, timestamp_nsecs, in this order
///   line of sight  los or directions, or los_x, los_y, los_z
///   sensor         sensor, lidar, sensor_id; the first of these, and so on
///   line           ring, line, line_index, channel, beam_id
///   face           face
///   intensity      intensity, reflectivity, rcs
///   return number  return, return_index, echo
///   no measurement valid, is_valid where 0; in_ambiguity_region, drop_reason, scan_offset where not 0
///
/// `wanted` goes before that: the column of x, y, z, doppler or time, of range, azimuth_deg, azimuth_rad,
/// elevation_deg, elevation_rad, polar_deg (from z) or polar_rad, "points[3]" being the fourth of an array, and the
/// array of los. Throws UsageError for other keys; DataError naming the columns there are where a wanted one is not
/// among them or none has a known name (time and line of sight may be missing), and saying of `unusable` arrays why
/// they are not among the names.
FieldMap map_fields(const std::vector<std::string>& names, const std::map<std::string, std::string>& wanted,
                    const std::string& origin, const std::vector<std::string>& unusable = {});

/// Whether `wanted` of map_fields may have the key.
bool is_field(std::string_view key);

/// Whether one of the names is one of a Doppler.
bool has_doppler_name(const std::vector<std::string>& names);

}  // namespace dynamic_icp::datasets
