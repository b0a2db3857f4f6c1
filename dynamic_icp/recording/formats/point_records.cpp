// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/point_records.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr double kNanosecond = 1e-9;        // s
constexpr double kLongestScanSeconds = 10;  // what is more counts nanoseconds
constexpr double kUint64End = 18446744073709551616.0;

constexpr std::array<RecordField, 3> kAevaFields = {{{"reflectivity", 12, NumberType::kFloat32},
                                                     {"line_index", 24, NumberType::kUint8, true},
                                                     {"intensity", 25, NumberType::kFloat32}}};

// The two words of flags are stored as the numbers they are, rounded to float32. The line lies above the bits that are
// lost by it.
constexpr std::array<RecordField, 6> kBoreas40Fields = {{{"intensity", 16},
                                                         {"signal_quality", 20},
                                                         {"reflectivity", 24},
                                                         {"point_flags_lsb", 32, NumberType::kFloat32, true},
                                                         {"point_flags_msb", 36, NumberType::kFloat32, true},
                                                         {"line_index", 32, NumberType::kFloat32, true, 8, 0xFF}}};

constexpr std::array<RecordField, 3> kBoreasFields = {
    {{"intensity", 12}, {"beam_id", 24, NumberType::kFloat32, true}, {"sensor_id", 28, NumberType::kFloat32, true}}};

constexpr std::array<RecordField, 2> kBoreasBeamFirstFields = {
    {{"intensity", 12}, {"beam_id", 20, NumberType::kFloat32, true}}};

template <class Number>
void read_times(std::string_view block, const RecordLayout& layout, double unit_s, double* times) {
  for (std::size_t at = layout.time; at < block.size(); at += layout.bytes) {
    *times++ = unit_s * static_cast<double>(value_at<Number>(block, at));
  }
}

void read_times(std::string_view block, const RecordLayout& layout, double* times) {
  if (layout.time_type == RecordTime::kNanoseconds) {
    read_times<std::int32_t>(block, layout, kNanosecond, times);
  } else if (layout.time_type != RecordTime::kNone) {
    read_times<float>(block, layout, 1.0, times);
  }
}

double field_at(std::string_view block, std::size_t at, const RecordField& field) {
  const double value = field.type == NumberType::kUint8 ? static_cast<double>(value_at<std::uint8_t>(block, at))
                                                        : static_cast<double>(value_at<float>(block, at));
  if (field.mask == 0) {
    return value;
  }
  const bool has_parts = value >= 0.0 && value < kUint64End;  // false for NaN
  return has_parts ? static_cast<double>(static_cast<std::uint64_t>(value) >> field.shift & field.mask) : 0.0;
}

RawScan points_of(const std::filesystem::path& path, const RecordLayout& layout) {
  RecordFile file(path, layout.bytes);
  RawScan raw;
  raw.points.resize(file.records());
  raw.doppler.resize(file.records());
  raw.times.resize(layout.time_type == RecordTime::kNone ? 0 : file.records());
  std::size_t row = 0;
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    if (!raw.times.empty()) {
      read_times(block, layout, raw.times.data() + row);
    }
    for (std::size_t at = 0; at < block.size(); at += layout.bytes, ++row) {
      raw.points[row] = {value_at<float>(block, at), value_at<float>(block, at + 4), value_at<float>(block, at + 8)};
      raw.doppler[row] = value_at<float>(block, at + layout.doppler);
    }
  }
  const bool counts_nanoseconds =
      layout.time_type == RecordTime::kSecondsOrNanoseconds &&
      std::any_of(raw.times.begin(), raw.times.end(), [](double t) { return t > kLongestScanSeconds; });
  if (counts_nanoseconds) {
    std::for_each(raw.times.begin(), raw.times.end(), [](double& t) { t *= kNanosecond; });
  }
  raw.warning = file.warning();
  return raw;
}

std::vector<double> field_of(const std::filesystem::path& path, const RecordLayout& layout, const RecordField& field) {
  RecordFile file(path, layout.bytes);
  std::vector<double> values;
  values.reserve(file.records());
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    for (std::size_t at = field.offset; at < block.size(); at += layout.bytes) {
      values.push_back(field_at(block, at, field));
    }
  }
  return values;
}

}  // namespace

const RecordLayout kXyzd = {"xyzd", 16, 12};
const RecordLayout kAeva25 = {"aeva25", 25, 16, RecordTime::kNanoseconds, 20, std::span(kAevaFields).first(2)};
const RecordLayout kAeva29 = {"aeva29", 29, 16, RecordTime::kNanoseconds, 20, kAevaFields};
const RecordLayout kBoreas40 = {"boreas40", 40, 12, RecordTime::kSecondsOrNanoseconds, 28, kBoreas40Fields};
const RecordLayout kBoreas24 = {"boreas24", 24, 16, RecordTime::kSeconds, 20, std::span(kBoreasFields).first(1)};
const RecordLayout kBoreas28 = {"boreas28", 28, 16, RecordTime::kSeconds, 20, std::span(kBoreasFields).first(2)};
const RecordLayout kBoreas28BeamThenTime = {
    "boreas28 with the beam before the time", 28, 16, RecordTime::kSeconds, 24, kBoreasBeamFirstFields};
const RecordLayout kBoreas32 = {"boreas32", 32, 16, RecordTime::kSeconds, 20, kBoreasFields};
const RecordLayout kXyzdTime = {"xyzd with times", 20, 12, RecordTime::kSeconds, 16};

RawScan read_points(const std::filesystem::path& path, const RecordLayout& layout) {
  return with_memory_for(path, [&] { return points_of(path, layout); });
}

std::vector<double> read_field(const std::filesystem::path& path, const RecordLayout& layout,
                               const RecordField& field) {
  return with_memory_for(path, [&] { return field_of(path, layout, field); });
}

}  // namespace dynamic_icp::formats
