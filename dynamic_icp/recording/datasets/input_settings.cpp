// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/input_settings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/datasets/field_names.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::array<std::string_view, 4> kColumnNames = {"x", "y", "z", "doppler"};
/// In place of x, y and z.
constexpr std::array<std::string_view, 3> kInDegrees = {"azimuth_deg", "elevation_deg", "range"};
constexpr std::array<std::string_view, 3> kInRadians = {"azimuth_rad", "elevation_rad", "range"};
constexpr std::size_t kMaxColumns = 64;
constexpr double kMinPeriod_s = 1e-6;
constexpr double kMaxPeriod_s = 3600.0;
constexpr double kMaxScale = 1e9;

[[noreturn]] void refuse(const std::string& name, const std::string& text, std::string_view expected) {
  throw UsageError(fmt::format("{} is '{}', expected {}", name, text, expected));
}

double number(const std::string& name, const std::string& text, double least, double most, std::string_view unit) {
  const std::optional<double> value = parse_number<double>(text);
  if (!(value && *value >= least && *value <= most)) {
    refuse(name, text, fmt::format("a number from {} to {}{}", least, most, unit));
  }
  return *value;
}

/// Whether the text is the second of two words; neither is refused.
bool is_second(const std::string& name, const std::string& text, std::string_view first, std::string_view second) {
  if (text != first && text != second) {
    refuse(name, text, fmt::format("{} or {}", first, second));
  }
  return text == second;
}

std::vector<std::string> names_in(const std::string& name, const std::string& text) {
  std::vector<std::string> names;
  for (std::string_view rest = text;;) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    names.push_back(formats::lower_case(rest.substr(0, end)));
    if (names.back().empty() || names.size() > kMaxColumns) {
      refuse(name, text,
             fmt::format("up to {} names with commas: x, y, z, doppler, _ for what is not used, ...", kMaxColumns));
    }
    if (end == rest.size()) {
      return names;
    }
    rest.remove_prefix(end + 1);
  }
}

/// Puts x, y and z in the place of the names of spherical coordinates; says which these were, nothing where there are
/// none.
std::optional<Coordinates> take_spherical(std::vector<std::string>& names) {
  for (const auto& [spherical, coordinates] :
       {std::pair{kInDegrees, Coordinates::kSphericalDegrees}, std::pair{kInRadians, Coordinates::kSphericalRadians}}) {
    const auto is_named = [&](std::string_view name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (!std::all_of(spherical.begin(), spherical.end(), is_named)) {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::replace(names.begin(), names.end(), std::string(spherical.at(k)), std::string(kColumnNames.at(k)));
    }
    return coordinates;
  }
  return std::nullopt;
}

/// The other way round.
std::vector<std::string> with_spherical(std::vector<std::string> names, std::optional<Coordinates> coordinates) {
  const Coordinates stored = coordinates.value_or(Coordinates::kCartesian);
  for (std::size_t k = 0; k < 3 && stored != Coordinates::kCartesian; ++k) {
    const std::string_view name = (stored == Coordinates::kSphericalDegrees ? kInDegrees : kInRadians).at(k);
    std::replace(names.begin(), names.end(), std::string(kColumnNames.at(k)), std::string(name));
  }
  return names;
}

/// Where x, y, z and Doppler stand where the names are these four, each once; nothing else.
std::optional<std::array<int, 4>> permutation_of(const std::vector<std::string>& names) {
  std::array<int, 4> where = {-1, -1, -1, -1};
  for (std::size_t stored = 0; stored < names.size(); ++stored) {
    const auto found = std::find(kColumnNames.begin(), kColumnNames.end(), names[stored]);
    if (found == kColumnNames.end() || names.size() != kColumnNames.size()) {
      return std::nullopt;
    }
    where.at(static_cast<std::size_t>(found - kColumnNames.begin())) = static_cast<int>(stored);
  }
  return std::count(where.begin(), where.end(), -1) == 0 ? std::optional(where) : std::nullopt;
}

/// Four of these names in another order change the columns as read, whatever the layout; more, or others, say what
/// numbers without names are.
void set_columns(InputSettings& settings, const std::string& name, const std::string& text) {
  std::vector<std::string> names = names_in(name, text);
  settings.correction.coordinates = take_spherical(names);
  settings.correction.columns = permutation_of(names);
  settings.open.columns = settings.correction.columns ? std::vector<std::string>() : names;
  if (settings.correction.columns) {
    return;
  }
  std::vector<std::string> used = names;
  std::erase(used, "_");
  std::sort(used.begin(), used.end());
  try {
    if (std::adjacent_find(used.begin(), used.end()) != used.end()) {
      throw DataError("named twice");
    }
    if (map_fields(used, {}, name).spherical) {
      throw DataError("angles without a unit");
    }
  } catch (const DataError&) {
    refuse(
        name, text,
        "x, y, z (or azimuth_deg, elevation_deg, range; or azimuth_rad, elevation_rad, range) and doppler, each once, "
        "and _ for what is not used, with commas: what the stored columns are");
  }
}

std::vector<std::string> stored_columns(const std::array<int, 4>& columns) {
  std::vector<std::string> stored(columns.size());
  for (std::size_t k = 0; k < 4; ++k) {
    stored.at(static_cast<std::size_t>(columns[k])) = kColumnNames[k];
  }
  return stored;
}

/// The names of the numbers of a record when those of x, y, z and Doppler as read change places.
std::vector<std::string> in_other_places(std::vector<std::string> names, const std::array<int, 4>& columns) {
  std::vector<std::string> used = names;
  std::erase(used, "_");
  const FieldMap map = map_fields(used, {}, "columns");
  const std::array<std::string, 4> as_read = {map.point[0].array, map.point[1].array, map.point[2].array,
                                              map.doppler.array};
  std::vector<std::string> changed = names;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto stored = std::find(names.begin(), names.end(), as_read.at(static_cast<std::size_t>(columns.at(k))));
    changed.at(static_cast<std::size_t>(stored - names.begin())) = kColumnNames.at(k);
  }
  return changed;
}

}  // namespace

void set(InputSettings& settings, const std::string& name, const std::string& text) {
  Correction& correction = settings.correction;
  const auto scale = [&] { return number(name, text, 1.0 / kMaxScale, kMaxScale, ""); };
  if (name == "format") {
    settings.open.format = text;
  } else if (name.starts_with("field.")) {
    settings.open.fields[formats::lower_case(name.substr(6))] = text;
  } else if (name.starts_with("lidar.")) {
    settings.open.sensors.push_back(text);
  } else if (name.starts_with("topic.")) {
    settings.open.topics.push_back(text);
  } else if (name == "truth-topic") {
    settings.open.truth_topic = text;
  } else if (name == "period") {
    settings.open.period_s = number(name, text, kMinPeriod_s, kMaxPeriod_s, " s");
  } else if (name == "doppler-sign") {
    correction.doppler_sign = is_second(name, text, "away", "towards") ? DopplerSign::kTowards : DopplerSign::kAway;
  } else if (name == "doppler-kind") {
    correction.doppler_kind =
        is_second(name, text, "relative", "compensated") ? DopplerKind::kCompensated : DopplerKind::kRelative;
  } else if (name == "doppler-scale") {
    correction.doppler_scale = scale();
  } else if (name == "point-scale") {
    correction.point_scale = scale();
  } else if (name == "time-scale") {
    correction.time_scale = scale();
  } else if (name == "columns") {
    set_columns(settings, name, text);
  } else if (name == "dtype") {
    const std::vector<std::string> known = record_types();
    if (std::find(known.begin(), known.end(), text) == known.end()) {
      refuse(name, text, fmt::format("one of: {}", fmt::join(known, ", ")));
    }
    settings.open.dtype = text;
  } else {
    throw UsageError(fmt::format("unknown setting of an input '{}'", name));
  }
}

std::vector<std::pair<std::string, std::string>> texts(const InputSettings& settings) {
  std::vector<std::pair<std::string, std::string>> all;
  const auto add_number = [&](const char* name, std::optional<double> value) {
    if (value) {
      all.emplace_back(name, fmt::format("{}", *value));
    }
  };
  for (const auto& [name, column] : settings.open.fields) {
    all.emplace_back("field." + name, column);
  }
  for (std::size_t k = 0; k < settings.open.sensors.size(); ++k) {
    all.emplace_back(fmt::format("lidar.{}", k + 1), settings.open.sensors[k]);
  }
  for (std::size_t k = 0; k < settings.open.topics.size(); ++k) {
    all.emplace_back(fmt::format("topic.{}", k + 1), settings.open.topics[k]);
  }
  if (!settings.open.truth_topic.empty()) {
    all.emplace_back("truth-topic", settings.open.truth_topic);
  }
  const Correction& correction = settings.correction;
  const auto add_columns = [&](const std::vector<std::string>& names) {
    all.emplace_back("columns", fmt::format("{}", fmt::join(with_spherical(names, correction.coordinates), ",")));
  };
  if (!settings.open.columns.empty()) {
    add_columns(correction.columns ? in_other_places(settings.open.columns, *correction.columns)
                                   : settings.open.columns);
  }
  if (!settings.open.dtype.empty()) {
    all.emplace_back("dtype", settings.open.dtype);
  }
  if (settings.open.period_s != OpenOptions{}.period_s) {
    add_number("period", settings.open.period_s);
  }
  if (correction.doppler_sign) {
    all.emplace_back("doppler-sign", correction.doppler_sign == DopplerSign::kAway ? "away" : "towards");
  }
  if (correction.doppler_kind) {
    all.emplace_back("doppler-kind", correction.doppler_kind == DopplerKind::kRelative ? "relative" : "compensated");
  }
  add_number("doppler-scale", correction.doppler_scale);
  add_number("point-scale", correction.point_scale);
  add_number("time-scale", correction.time_scale);
  if (correction.columns && settings.open.columns.empty()) {
    add_columns(stored_columns(*correction.columns));
  }
  return all;
}

std::vector<std::pair<std::string, std::string>> texts_of_fix(const Correction& fix, const InputSettings& settings) {
  InputSettings fixed = {.open = {}, .correction = fix};
  if (fix.columns) {
    fixed.open.columns = settings.open.columns;
  }
  return texts(fixed);
}

std::vector<std::pair<std::string, std::string>> texts_of_doppler(const std::string& column,
                                                                  const InputSettings& settings) {
  if (!column.empty()) {
    return {{"field.doppler", column}};
  }
  std::vector<std::string> columns = settings.open.columns;
  const auto doppler = std::find(columns.begin(), columns.end(), "doppler");
  const auto left_out = std::find(columns.begin(), columns.end(), "_");
  if (doppler == columns.end() || left_out == columns.end()) {
    return {};
  }
  if (std::count(columns.begin(), columns.end(), "_") > 1) {
    return {{"columns", "LIST"}};
  }
  std::iter_swap(doppler, left_out);
  return {{"columns", fmt::format("{}", fmt::join(columns, ","))}};
}

std::unique_ptr<Dataset> open_input(const std::filesystem::path& input, const InputSettings& settings) {
  check(settings.correction);
  OpenOptions open = settings.open;
  if (settings.correction.columns && open.columns.empty()) {
    open.columns.assign(kColumnNames.begin(), kColumnNames.end());  // four of them, which the correction puts in order
  }
  return corrected(open_dataset(input, open), settings.correction);
}

}  // namespace dynamic_icp::datasets
