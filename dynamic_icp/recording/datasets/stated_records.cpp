// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/stated_records.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/field_names.hpp"
#include "dynamic_icp/recording/datasets/point_times.hpp"
#include "dynamic_icp/recording/datasets/record_shape.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::NpyType;
using formats::RecordField;
using formats::RecordLayout;

struct RecordType {
  std::string_view name;
  NpyType type;
};

constexpr std::string_view kHalf = "float16";  // read as float32, which it becomes
constexpr RecordType kTypes[] = {{"float32", NpyType::kFloat32}, {"float64", NpyType::kFloat64},
                                 {"int8", NpyType::kInt8},       {"int16", NpyType::kInt16},
                                 {"int32", NpyType::kInt32},     {"uint8", NpyType::kUint8},
                                 {"uint16", NpyType::kUint16},   {"uint32", NpyType::kUint32}};

constexpr std::string_view kUnused = "_";

NpyType type_of(const std::string& name) {
  if (name == kHalf) {
    return NpyType::kFloat32;
  }
  const auto* const found =
      std::find_if(std::begin(kTypes), std::end(kTypes), [&](const RecordType& type) { return type.name == name; });
  if (found == std::end(kTypes)) {
    throw UsageError(
        fmt::format("the type of the numbers is '{}', expected one of: {}", name, fmt::join(record_types(), ", ")));
  }
  return found->type;
}

/// A layout with what it refers to.
struct StatedLayout {
  std::vector<std::string> names;
  std::vector<RecordField> fields;
  RecordLayout layout;
  std::vector<std::string> assumptions;
  std::string time;  ///< the name of the times; empty: none
};

/// Where the names stand; those that are not used are left out.
std::map<std::string, std::size_t> offsets_of(const std::vector<std::string>& names, std::size_t bytes) {
  std::map<std::string, std::size_t> offsets;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != kUnused && !offsets.emplace(names[k], k * bytes).second) {
      throw UsageError(fmt::format("columns are '{}': '{}' is named twice", fmt::join(names, ","), names[k]));
    }
  }
  return offsets;
}

FieldMap fields_of(const std::vector<std::string>& names) {
  std::vector<std::string> used = names;
  std::erase(used, kUnused);
  try {
    return map_fields(used, {}, fmt::format("columns '{}'", fmt::join(names, ",")));
  } catch (const DataError& error) {
    throw UsageError(error.what());
  }
}

/// Shared: the functions of a recording are copied, and the layout refers to the names.
std::shared_ptr<const StatedLayout> stated_layout(const OpenOptions& options) {
  const auto result = std::make_shared<StatedLayout>();
  StatedLayout& stated = *result;
  stated.names = options.columns.empty() ? std::vector<std::string>{"x", "y", "z", "doppler"} : options.columns;
  const NpyType type = type_of(options.dtype.empty() ? "float32" : options.dtype);
  const std::size_t bytes = formats::size_of(type);
  const std::map<std::string, std::size_t> offsets = offsets_of(stated.names, bytes);
  const FieldMap map = fields_of(stated.names);
  RecordLayout& layout = stated.layout;
  layout.name = "as stated";
  layout.bytes = bytes * stated.names.size();
  layout.type = type;
  layout.is_half = options.dtype == kHalf;
  layout.doppler = offsets.at(map.doppler.array);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!map.point.at(k).whole || map.spherical) {
      throw UsageError(fmt::format("columns are '{}', expected x, y and z among them", fmt::join(stated.names, ",")));
    }
    layout.point.at(k) = offsets.at(map.point.at(k).array);
  }
  if (map.time) {
    layout.time_type = formats::RecordTime::kAsStored;
    layout.time = offsets.at(map.time->array);
    stated.time = map.time->array;
  }
  for (const std::string& name : stated.names) {
    if (name == kUnused || map.uses(name)) {
      continue;
    }
    const auto channel = std::find_if(map.channels.begin(), map.channels.end(),
                                      [&](const ChannelColumn& column) { return column.array == name; });
    stated.fields.push_back({.name = name,
                             .offset = offsets.at(name),
                             .type = type,
                             .is_integer = !formats::is_float(type),
                             .channel = channel == map.channels.end() ? formats::Channel::kNone : channel->channel});
  }
  layout.fields = stated.fields;
  stated.assumptions = map.assumptions;
  return result;
}

/// The times of a scan as they are stored, as the array that says their unit.
formats::NpyArray times_as_stored(const std::vector<double>& times, NpyType type) {
  return formats::array_of(formats::is_float(type) ? NpyType::kFloat64 : NpyType::kInt64, {times.size()}, times);
}

/// Whether the user said all that speaks against it, and the sizes of the files allow it.
bool is_believed(const OpenOptions& options, const std::vector<fs::path>& files, std::size_t bytes,
                 const UnclearInput& other) {
  const UnclearInput::Settings& proposal = other.proposal();
  const bool is_of_type =
      std::any_of(proposal.begin(), proposal.end(), [](const auto& setting) { return setting.first == "dtype"; });
  return !options.columns.empty() && (!options.dtype.empty() || !is_of_type) && sizes_fit(files, bytes);
}

TimeUnit unit_of_times(const RecordRecording& recording, const StatedLayout& stated, double period_s) {
  TimeUnit unit;
  for (const fs::path& file : recording.scans.files) {
    std::error_code fault;
    if (fs::file_size(file, fault) >= stated.layout.stored_bytes() && !fault) {
      const std::vector<double> times = formats::read_points(file, stated.layout).times;
      return time_unit(stated.time, times_as_stored(times, stated.layout.type), period_s);
    }
  }
  return unit;
}

}  // namespace

std::vector<std::string> record_types() {
  std::vector<std::string> names;
  for (const RecordType& type : kTypes) {
    names.emplace_back(type.name);
  }
  names.emplace_back(kHalf);
  return names;
}

bool states_records(const OpenOptions& options) { return !options.columns.empty() || !options.dtype.empty(); }

void read_as_stated(const OpenOptions& options, RecordRecording& recording) {
  const std::shared_ptr<const StatedLayout> stated = stated_layout(options);
  const std::vector<fs::path>& files = recording.scans.files;
  const RecordLayout& layout = stated->layout;
  const std::optional<NpyType> type = layout.is_half ? std::nullopt : std::optional(layout.type);
  if (const auto other = other_shape(files, stated->names.size(), type);
      other && !is_believed(options, files, layout.stored_bytes(), *other)) {
    throw *other;
  }
  recording.layout_of = [stated](const fs::path&, Stamp) -> const RecordLayout& { return stated->layout; };
  std::vector<std::string>& said = recording.scans.assumptions;
  said.insert(said.end(), stated->assumptions.begin(), stated->assumptions.end());
  if (!stated->time.empty()) {
    recording.times.clear();  // those of the records count
    const TimeUnit unit = unit_of_times(recording, *stated, options.period_s);
    if (!unit.assumption.empty()) {
      said.push_back(unit.assumption);
    }
    recording.correct = [stated, unit](RawScan& scan, const fs::path&) {
      scan.times = times_after(scan.stamp, times_as_stored(scan.times, stated->layout.type), unit);
    };
  }
}

}  // namespace dynamic_icp::datasets
