// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/field_names.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::array<std::string_view, 4> kPoints = {"points", "xyz", "pts", "positions"};
constexpr std::array<std::string_view, 17> kDoppler = {"doppler",      "velocity",     "radial_velocity",
                                                       "radial_vel",   "v_radial",     "doppler_velocity",
                                                       "dopplers",     "velocity_mps", "v_doppler_mps",
                                                       "range_rate",   "vel",          "v_r",
                                                       "vr",           "rv",           "v",
                                                       "radial_speed", "speed"};
constexpr std::array<std::string_view, 12> kTime = {"time_offset_ns",
                                                    "time_offset_s",
                                                    "offset_time",
                                                    "t",
                                                    "time_stamp",
                                                    "timestamp",
                                                    "time",
                                                    "time_offset",
                                                    "time_offsets",
                                                    "nanosecs_since_frame",
                                                    "timestamp_nsecs",
                                                    "point_time"};
constexpr std::array<std::string_view, 4> kTimeEndings = {"_ns", "_us", "_ms", "_s"};
constexpr std::array<std::string_view, 2> kLineOfSight = {"los", "directions"};
constexpr std::array<std::string_view, 3> kAzimuth = {"azimuth", "az", "azi"};
constexpr std::array<std::string_view, 3> kElevation = {"elevation", "elev", "el"};
constexpr std::array<std::string_view, 2> kPolar = {"polar", "zenith"};
constexpr std::array<std::string_view, 1> kTheta = {"theta"};
constexpr std::array<std::string_view, 1> kPhi = {"phi"};
constexpr std::array<std::string_view, 5> kRange = {"range", "range_m", "distance", "dist", "r"};
constexpr std::array<std::string_view, 13> kKeys = {
    "x",        "y",           "z",           "doppler",       "time",          "los",
    "range",    "azimuth_deg", "azimuth_rad", "elevation_deg", "elevation_rad", "polar_deg",
    "polar_rad"};

/// An angle, and its unit where its name or the user says it.
struct AngleColumn {
  FieldColumn column;
  std::optional<AngleUnit> unit;
};

struct ChannelNames {
  formats::Channel channel;
  std::array<std::string_view, 5> names;  ///< empty: no further one
};

constexpr std::array<ChannelNames, 10> kChannels = {
    {{formats::Channel::kSensor, {"sensor", "lidar", "sensor_id"}},
     {formats::Channel::kLine, {"ring", "line", "line_index", "channel", "beam_id"}},
     {formats::Channel::kFace, {"face"}},
     {formats::Channel::kIntensity, {"intensity", "reflectivity", "rcs", "amplitude"}},
     {formats::Channel::kReturnNumber, {"return", "return_index", "echo"}},
     {formats::Channel::kValid, {"valid"}},
     {formats::Channel::kValid, {"is_valid"}},
     {formats::Channel::kInvalid, {"in_ambiguity_region"}},
     {formats::Channel::kInvalid, {"drop_reason"}},
     {formats::Channel::kInvalid, {"scan_offset"}}}};

bool is_flag(formats::Channel channel) {
  return channel == formats::Channel::kValid || channel == formats::Channel::kInvalid;
}

/// In lower case, the words of "Radial Velocity" and "radial-velocity" joined as in radial_velocity.
std::string plain_name(std::string_view name) {
  std::string plain = formats::lower_case(name);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return plain;
}

/// With the units that may stand behind them, each once.
std::vector<std::string> time_names() {
  std::vector<std::string> names(kTime.begin(), kTime.end());
  for (const std::string_view ending : kTimeEndings) {
    for (const std::string_view name : kTime) {
      const std::string with_unit = std::string(name) + std::string(ending);
      if (std::find(names.begin(), names.end(), with_unit) == names.end()) {
        names.push_back(with_unit);
      }
    }
  }
  return names;
}

/// Names that go without saying.
bool is_obvious(std::string_view name) {
  return name == "doppler" || name == "time_offset_ns" || name == "time_offset_s";
}

class FieldFinder {
 public:
  FieldFinder(const std::vector<std::string>& names, const std::map<std::string, std::string>& wanted,
              const std::string& origin, const std::vector<std::string>& unusable)
      : names_(names), wanted_(wanted), origin_(origin), unusable_(unusable) {
    std::transform(names.begin(), names.end(), std::back_inserter(plain_names_), plain_name);
  }

  FieldMap find() {
    for (const auto& [key, column] : wanted_) {
      if (!is_field(key)) {
        throw UsageError(fmt::format("field '{}' = '{}': expected one of: {}", key, column, fmt::join(kKeys, ", ")));
      }
    }
    find_point();
    find_doppler();
    static const std::vector<std::string> kTimes = time_names();
    map_.time = find_column("time", kTimes);
    find_line_of_sight();
    find_channels();
    return std::move(map_);
  }

 private:
  /// The name in the file that is, but for its case and blanks, the one given.
  [[nodiscard]] const std::string* same_as(std::string_view name) const {
    if (const auto exact = std::find(names_.begin(), names_.end(), name); exact != names_.end()) {
      return &*exact;
    }
    const auto found = std::find(plain_names_.begin(), plain_names_.end(), plain_name(name));
    return found == plain_names_.end() ? nullptr : &names_[static_cast<std::size_t>(found - plain_names_.begin())];
  }

  [[nodiscard]] std::string there_are() const {
    std::string text = names_.empty() ? "there are none" : fmt::format("there are: {}", fmt::join(names_, ", "));
    for (const std::string& reason : unusable_) {
      text += "; " + reason;
    }
    return text;
  }

  /// The column that the user names, for instance "range" or "points[3]".
  [[nodiscard]] std::optional<FieldColumn> wanted_column(const std::string& key) const {
    const auto asked = wanted_.find(key);
    if (asked == wanted_.end()) {
      return std::nullopt;
    }
    const std::string& text = asked->second;
    if (const std::string* name = same_as(text)) {
      return FieldColumn{*name, 0, true};
    }
    const std::size_t bracket = text.rfind('[');
    if (bracket != std::string::npos && text.back() == ']') {
      const std::string* name = same_as(text.substr(0, bracket));
      const std::optional<std::size_t> column =
          parse_number<std::size_t>(std::string_view(text).substr(bracket + 1, text.size() - bracket - 2));
      if (name != nullptr && column) {
        return FieldColumn{*name, *column, false};
      }
    }
    throw DataError(fmt::format("{}: no column '{}' for {}; {}", origin_, text, key, there_are()));
  }

  /// The first of the aliases that is there, told where it is not the obvious one.
  template <class Aliases>
  std::optional<FieldColumn> find_column(const std::string& key, const Aliases& aliases) {
    if (std::optional<FieldColumn> asked = wanted_column(key)) {
      return asked;
    }
    std::vector<std::string> found;
    for (const std::string_view alias : aliases) {
      if (const std::string* name = same_as(alias)) {
        found.push_back(*name);
      }
    }
    if (found.empty()) {
      return std::nullopt;
    }
    if (!is_obvious(formats::lower_case(found.front())) || found.size() > 1) {
      std::string sentence = fmt::format("using column '{}' as {}", found.front(), key);
      if (found.size() > 1) {
        sentence += fmt::format("; there is also: {}", fmt::join(std::span(found).subspan(1), ", "));
      }
      map_.assumptions.push_back(sentence);
    }
    return FieldColumn{found.front(), 0, true};
  }

  /// The column of an angle by what it is called, the unit behind it or not.
  template <class Names>
  [[nodiscard]] std::optional<AngleColumn> find_angle(const Names& names) const {
    constexpr std::pair<std::string_view, std::optional<AngleUnit>> kEndings[] = {{"", std::nullopt},
                                                                                  {"_deg", AngleUnit::kDegrees},
                                                                                  {"_degrees", AngleUnit::kDegrees},
                                                                                  {"_rad", AngleUnit::kRadians},
                                                                                  {"_radians", AngleUnit::kRadians}};
    for (const auto& [ending, unit] : kEndings) {
      const std::string key = fmt::format("{}{}", names.front(), ending);
      if (const std::optional<FieldColumn> asked = wanted_column(key)) {
        return AngleColumn{*asked, unit};
      }
    }
    for (const auto& [ending, unit] : kEndings) {
      for (const std::string_view name : names) {
        if (const std::string* const own = same_as(fmt::format("{}{}", name, ending))) {
          return AngleColumn{{*own, 0, true}, unit};
        }
      }
    }
    return std::nullopt;
  }

  /// Azimuth, elevation and range in place of x, y and z, if they are there.
  bool find_spherical_point() {
    const std::string* own_range = nullptr;
    for (std::size_t k = 0; k < kRange.size() && own_range == nullptr; ++k) {
      own_range = same_as(kRange[k]);
    }
    std::optional<FieldColumn> range = wanted_column("range");
    if (!range && own_range != nullptr) {
      range = FieldColumn{*own_range, 0, true};
    }
    SphericalFields spherical;
    std::optional<AngleColumn> first = find_angle(kAzimuth);
    std::optional<AngleColumn> second = find_angle(kElevation);
    if (const std::optional<AngleColumn> polar = find_angle(kPolar); polar && (!second || wants_any(kPolar))) {
      second = polar;
      spherical.from_zenith = true;
    }
    if (!first && !second) {
      first = find_angle(kTheta);
      second = find_angle(kPhi);
      spherical.is_theta_phi = true;
    }
    if (!range || !first || !second) {
      return false;
    }
    if (first->unit && second->unit && *first->unit != *second->unit) {
      throw DataError(fmt::format("{}: '{}' and '{}' are angles in different units, expected one", origin_,
                                  first->column.array, second->column.array));
    }
    spherical.unit = first->unit ? first->unit : second->unit;
    map_.point = {first->column, second->column, *range};
    map_.spherical = spherical;
    return true;
  }

  /// Whether the user names a column of this kind of angle.
  template <class Names>
  [[nodiscard]] bool wants_any(const Names& names) const {
    return std::any_of(wanted_.begin(), wanted_.end(),
                       [&](const auto& wish) { return wish.first.starts_with(names.front()); });
  }

  void find_point() {
    const bool wants_spherical = wants_any(kAzimuth) || wants_any(kElevation) || wants_any(kPolar);
    if (wants_spherical) {
      if (!find_spherical_point()) {
        throw DataError(fmt::format("{}: expected columns of azimuth, elevation and range; {}", origin_, there_are()));
      }
      return;
    }
    constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
    const std::string* array = nullptr;
    for (std::size_t k = 0; k < kPoints.size() && array == nullptr; ++k) {
      array = same_as(kPoints[k]);
    }
    for (std::size_t k = 0; k < kAxes.size(); ++k) {
      const std::string* const axis = same_as(kAxes[k]);
      if (const std::optional<FieldColumn> asked = wanted_column(std::string(kAxes[k]))) {
        map_.point[k] = *asked;
      } else if (axis != nullptr) {
        map_.point[k] = {*axis, 0, true};
      } else if (array != nullptr) {
        map_.point[k] = {*array, k, false};
      } else if (find_spherical_point()) {
        return;
      } else {
        throw DataError(fmt::format("{}: no column for {}, expected x, y and z, or one of {} with all three; {}",
                                    origin_, kAxes[k], fmt::join(kPoints, ", "), there_are()));
      }
    }
  }

  void find_doppler() {
    const std::optional<FieldColumn> found = find_column("doppler", kDoppler);
    if (!found) {
      throw DataError(fmt::format("{}: no column of Doppler velocities, expected one of: {}; {}", origin_,
                                  fmt::join(kDoppler, ", "), there_are()));
    }
    map_.doppler = *found;
  }

  void find_line_of_sight() {
    if (const std::optional<FieldColumn> asked = wanted_column("los")) {
      map_.line_of_sight = {{{asked->array, 0, false}, {asked->array, 1, false}, {asked->array, 2, false}}};
      return;
    }
    for (const std::string_view alias : kLineOfSight) {
      if (const std::string* name = same_as(alias)) {
        map_.line_of_sight = {{{*name, 0, false}, {*name, 1, false}, {*name, 2, false}}};
        return;
      }
    }
    const std::string* const x = same_as("los_x");
    const std::string* const y = same_as("los_y");
    const std::string* const z = same_as("los_z");
    if (x != nullptr && y != nullptr && z != nullptr) {
      map_.line_of_sight = {{{*x, 0, true}, {*y, 0, true}, {*z, 0, true}}};
    }
  }

  void find_channels() {
    for (const ChannelNames& known : kChannels) {
      for (const std::string_view alias : known.names) {
        const std::string* const name = alias.empty() ? nullptr : same_as(alias);
        if (name == nullptr || map_.uses(*name)) {
          continue;
        }
        map_.channels.push_back({known.channel, *name});
        if (is_flag(known.channel)) {
          map_.assumptions.push_back(
              fmt::format("points that column '{}' flags as no measurement are left out", *name));
        }
        break;
      }
    }
  }

  const std::vector<std::string>& names_;
  std::vector<std::string> plain_names_;  ///< of each of them: looked for about 150 times
  const std::map<std::string, std::string>& wanted_;
  const std::string& origin_;
  const std::vector<std::string>& unusable_;
  FieldMap map_;
};

}  // namespace

bool FieldMap::uses(const std::string& array) const {
  bool used = array == doppler.array || (time && array == time->array);
  for (std::size_t k = 0; k < point.size(); ++k) {
    used = used || array == point[k].array || (line_of_sight && array == (*line_of_sight)[k].array);
  }
  return used;
}

bool is_field(std::string_view key) { return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end(); }

bool has_doppler_name(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return std::find(kDoppler.begin(), kDoppler.end(), plain_name(name)) != kDoppler.end();
  });
}

FieldMap map_fields(const std::vector<std::string>& names, const std::map<std::string, std::string>& wanted,
                    const std::string& origin, const std::vector<std::string>& unusable) {
  return FieldFinder(names, wanted, origin, unusable).find();
}

}  // namespace dynamic_icp::datasets
