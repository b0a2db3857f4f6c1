// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/point_records.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/half_floats.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr double kNanosecond = 1e-9;        // s
constexpr double kLongestScanSeconds = 10;  // what is more counts nanoseconds
constexpr double kUint64End = 18446744073709551616.0;

constexpr RecordField kAevaLine = {
    .name = "line_index", .offset = 24, .type = NumberType::kUint8, .is_integer = true, .channel = Channel::kLine};

constexpr std::array<RecordField, 2> kAeva25Fields = {
    {{.name = "reflectivity", .offset = 12, .channel = Channel::kIntensity}, kAevaLine}};

constexpr std::array<RecordField, 3> kAeva29Fields = {
    {{"reflectivity", 12}, kAevaLine, {.name = "intensity", .offset = 25, .channel = Channel::kIntensity}}};

/// A part of the lower word of flags of Boreas-RT. The two words are stored as the numbers they are, rounded to
/// float32; these parts lie above the bits that are lost by it.
constexpr RecordField flag_field(std::string_view name, unsigned shift, unsigned mask, Channel channel) {
  return {name, 32, NumberType::kFloat32, true, shift, mask, channel};
}

constexpr std::array<RecordField, 8> kBoreas40Fields = {
    {{.name = "intensity", .offset = 16, .channel = Channel::kIntensity},
     {"signal_quality", 20},
     {"reflectivity", 24},
     {"point_flags_lsb", 32, NumberType::kFloat32, true},
     {"point_flags_msb", 36, NumberType::kFloat32, true},
     flag_field("line_index", 8, 0xFF, Channel::kLine),
     flag_field("beam_id", 16, 0xF, Channel::kNone),
     flag_field("face", 22, 0xF, Channel::kFace)}};

constexpr RecordField boreas_field(std::string_view name, std::size_t offset, Channel channel) {
  return {.name = name, .offset = offset, .is_integer = channel != Channel::kIntensity, .channel = channel};
}

constexpr std::array<RecordField, 3> kBoreasFields = {{boreas_field("intensity", 12, Channel::kIntensity),
                                                       boreas_field("beam_id", 24, Channel::kLine),
                                                       boreas_field("sensor_id", 28, Channel::kSensor)}};

constexpr std::array<RecordField, 2> kBoreasBeamFirstFields = {
    {boreas_field("intensity", 12, Channel::kIntensity), boreas_field("beam_id", 20, Channel::kLine)}};

// Folders of several scans put together have points of earlier ones, whose lines of sight are lost: -1 is the last.
constexpr std::array<RecordField, 3> kVodFields = {
    {{.name = "RCS", .offset = 12, .channel = Channel::kIntensity},
     {"v_r_compensated", 20},
     {.name = "scan_offset", .offset = 24, .is_integer = true, .channel = Channel::kInvalid}}};

template <class Number>
void read_times(std::string_view block, const RecordLayout& layout, double unit_s, double* times) {
  for (std::size_t at = layout.time; at < block.size(); at += layout.bytes) {
    *times++ = unit_s * static_cast<double>(value_at<Number>(block, at));
  }
}

void read_times(std::string_view block, const RecordLayout& layout, double* times) {
  if (layout.time_type == RecordTime::kNanoseconds) {
    read_times<std::int32_t>(block, layout, kNanosecond, times);
  } else if (layout.time_type == RecordTime::kAsStored) {
    with_type(layout.type, [&](auto zero) { read_times<decltype(zero)>(block, layout, 1.0, times); });
  } else if (layout.time_type != RecordTime::kNone) {
    read_times<float>(block, layout, 1.0, times);
  }
}

double field_value(double value, const RecordField& field) {
  if (field.mask == 0) {
    return value;
  }
  const bool has_parts = value >= 0.0 && value < kUint64End;  // false for NaN
  return has_parts ? static_cast<double>(static_cast<std::uint64_t>(value) >> field.shift & field.mask) : 0.0;
}

void append_field(std::string_view block, const RecordLayout& layout, const RecordField& field,
                  std::vector<double>& values) {
  with_type(field.type, [&](auto zero) {
    for (std::size_t at = field.offset; at < block.size(); at += layout.bytes) {
      values.push_back(field_value(static_cast<double>(value_at<decltype(zero)>(block, at)), field));
    }
  });
}

/// Points and Doppler of whole records, from a row of the scan on.
template <class Number>
void read_measurements(std::string_view block, const RecordLayout& layout, std::size_t row, RawScan& raw) {
  const auto [x, y, z] = layout.point;
  for (std::size_t at = 0; at < block.size(); at += layout.bytes, ++row) {
    raw.points[row] = {static_cast<double>(value_at<Number>(block, at + x)),
                       static_cast<double>(value_at<Number>(block, at + y)),
                       static_cast<double>(value_at<Number>(block, at + z))};
    raw.doppler[row] = static_cast<double>(value_at<Number>(block, at + layout.doppler));
  }
}

/// A field that a scan has a place for.
struct ChannelValues {
  const RecordField* field;
  std::vector<double> values;
};

std::vector<ChannelValues> channels_of(const RecordLayout& layout, std::size_t records) {
  std::vector<ChannelValues> channels;
  for (const RecordField& field : layout.fields) {
    if (field.channel != Channel::kNone) {
      channels.push_back({&field, {}});
      channels.back().values.reserve(records);
    }
  }
  return channels;
}

/// Calls `use` with all records of a file, block by block.
template <class Use>
void for_blocks(RecordFile& file, const RecordLayout& layout, const Use& use) {
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    if (layout.is_half) {
      use(std::string_view(widened_halves(block)));
    } else {
      use(block);
    }
  }
}

RawScan points_of(const std::filesystem::path& path, const RecordLayout& layout) {
  RecordFile file(path, layout.stored_bytes());
  RawScan raw;
  raw.points.resize(file.records());
  raw.doppler.resize(file.records());
  raw.times.resize(layout.time_type == RecordTime::kNone ? 0 : file.records());
  std::vector<ChannelValues> channels = channels_of(layout, file.records());
  std::size_t row = 0;
  for_blocks(file, layout, [&](std::string_view block) {
    if (!raw.times.empty()) {
      read_times(block, layout, raw.times.data() + row);
    }
    with_type(layout.type, [&](auto zero) { read_measurements<decltype(zero)>(block, layout, row, raw); });
    row += block.size() / layout.bytes;
    for (ChannelValues& channel : channels) {
      append_field(block, layout, *channel.field, channel.values);
    }
  });
  const bool counts_nanoseconds =
      layout.time_type == RecordTime::kSecondsOrNanoseconds &&
      std::any_of(raw.times.begin(), raw.times.end(), [](double t) { return t > kLongestScanSeconds; });
  if (counts_nanoseconds) {
    std::for_each(raw.times.begin(), raw.times.end(), [](double& t) { t *= kNanosecond; });
  }
  raw.warning = file.warning();
  for (const auto& [field, values] : channels) {
    warn_of_column(raw, path, field->name, set_channel(raw, field->channel, values));
  }
  return raw;
}

std::vector<double> field_of(const std::filesystem::path& path, const RecordLayout& layout, const RecordField& field) {
  RecordFile file(path, layout.stored_bytes());
  std::vector<double> values;
  values.reserve(file.records());
  for_blocks(file, layout, [&](std::string_view block) { append_field(block, layout, field, values); });
  return values;
}

}  // namespace

const RecordLayout kXyzd = {"xyzd", 16, 12};
const RecordLayout kAeva25 = {"aeva25", 25, 16, RecordTime::kNanoseconds, 20, kAeva25Fields};
const RecordLayout kAeva29 = {"aeva29", 29, 16, RecordTime::kNanoseconds, 20, kAeva29Fields};
const RecordLayout kBoreas40 = {"boreas40", 40, 12, RecordTime::kSecondsOrNanoseconds, 28, kBoreas40Fields};
const RecordLayout kBoreas24 = {"boreas24", 24, 16, RecordTime::kSeconds, 20, std::span(kBoreasFields).first(1)};
const RecordLayout kBoreas28 = {"boreas28", 28, 16, RecordTime::kSeconds, 20, std::span(kBoreasFields).first(2)};
const RecordLayout kBoreas28BeamThenTime = {
    "boreas28 with the beam before the time", 28, 16, RecordTime::kSeconds, 24, kBoreasBeamFirstFields};
const RecordLayout kBoreas32 = {"boreas32", 32, 16, RecordTime::kSeconds, 20, kBoreasFields};
const RecordLayout kXyzdTime = {"xyzd with times", 20, 12, RecordTime::kSeconds, 16};
const RecordLayout kVod28 = {"radar of View-of-Delft", 28, 16, RecordTime::kNone, 0, kVodFields};

RawScan read_points(const std::filesystem::path& path, const RecordLayout& layout) {
  return with_memory_for(path, [&] { return points_of(path, layout); });
}

std::vector<double> read_field(const std::filesystem::path& path, const RecordLayout& layout,
                               const RecordField& field) {
  return with_memory_for(path, [&] { return field_of(path, layout, field); });
}

}  // namespace dynamic_icp::formats
