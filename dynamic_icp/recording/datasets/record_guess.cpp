// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_guess.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::RecordLayout;
using formats::value_at;

constexpr std::size_t kSampledRecords = 200;
constexpr double kNeededShare = 0.99;

/// Some records from all over the content, in its order.
std::vector<std::string_view> samples_of(std::string_view content, std::size_t record_bytes) {
  const std::size_t records = content.size() / record_bytes;
  const std::size_t count = std::min(records, kSampledRecords);
  std::vector<std::string_view> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t record = count == 1 ? 0 : i * (records - 1) / (count - 1);
    samples.push_back(content.substr(record * record_bytes, record_bytes));
  }
  return samples;
}

template <class Test>
bool most(const std::vector<std::string_view>& samples, const Test& test) {
  const auto passed = std::count_if(samples.begin(), samples.end(), test);
  return !samples.empty() && static_cast<double>(passed) >= kNeededShare * static_cast<double>(samples.size());
}

double number(std::string_view record, std::size_t at) { return static_cast<double>(value_at<float>(record, at)); }

bool is_coordinate(double value) {
  constexpr double kFarthest = 1000.0;                                                  // m
  constexpr double kSmallest = 1e-6;                                                    // m, of numbers that are not 0
  return std::abs(value) < kFarthest && (value == 0.0 || std::abs(value) > kSmallest);  // false for NaN
}

bool has_coordinates(std::string_view record) {
  return is_coordinate(number(record, 0)) && is_coordinate(number(record, 4)) && is_coordinate(number(record, 8));
}

bool is_point(std::string_view record, const RecordLayout& layout) {
  constexpr double kFastest = 120.0;  // m/s
  return has_coordinates(record) && std::abs(number(record, layout.doppler)) < kFastest;
}

/// A whole number, not negative.
bool is_count(double value, double last = INFINITY) {
  return value >= 0.0 && value <= last && value == std::floor(value);
}

bool is_aeva(std::string_view record, const RecordLayout& layout) {
  const auto time_ns = value_at<std::int32_t>(record, 20);
  const auto line = value_at<std::uint8_t>(record, 24);
  const bool possible = time_ns >= -1'000'000 && time_ns <= 200'000'000 && line <= 127;
  const double intensity_db = &layout == &formats::kAeva29 ? number(record, 25) : 0.0;
  return possible && intensity_db > -200.0 && intensity_db < 100.0;
}

bool is_boreas40(std::string_view record) {
  return is_count(number(record, 32)) && is_count(number(record, 36)) && number(record, 28) >= 0.0;
}

bool has_beam(std::string_view record, const RecordLayout& layout) {
  return is_count(number(record, layout.time == 20 ? 24 : 20), 3.0) && std::isfinite(number(record, layout.time));
}

/// Of View-of-Delft: a radar cross section in dB, two radial velocities, and 0 or the number of an earlier scan.
bool is_vod(std::string_view record) {
  constexpr double kLargest = 150.0;
  constexpr double kMaxScans = 10.0;
  return std::abs(number(record, 12)) < kLargest && std::abs(number(record, 20)) < kLargest &&
         is_count(-number(record, 24), kMaxScans);
}

/// Times of points in the order they were measured, of a scan that takes about 0.1 s.
bool times_pass(const std::vector<std::string_view>& samples, std::size_t at) {
  constexpr double kShortest = 0.02;
  constexpr double kLongest = 0.2;
  const double span = number(samples.back(), at) - number(samples.front(), at);
  std::size_t backwards = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    backwards += number(samples[i], at) >= number(samples[i - 1], at) ? 0 : 1;
  }
  return span >= kShortest && span <= kLongest && 10 * backwards <= samples.size();
}

/// Reflectances of KITTI lie in the same place, all within 0 to 1.
bool is_doppler(const std::vector<std::string_view>& samples) {
  const auto is_negative = [](std::string_view record) { return number(record, 12) < 0.0; };
  const auto is_large = [](std::string_view record) { return std::abs(number(record, 12)) > 1.0; };
  const auto is_positive = [](std::string_view record) { return number(record, 12) > 0.0; };
  return std::any_of(samples.begin(), samples.end(), is_large) ||
         (std::any_of(samples.begin(), samples.end(), is_negative) &&
          std::any_of(samples.begin(), samples.end(), is_positive));
}

bool fits(std::string_view content, std::size_t record_bytes) {
  return !content.empty() && content.size() % record_bytes == 0;
}

/// In records of that length others have times where View-of-Delft has its second velocity.
bool has_radar_values(const std::vector<std::string_view>& samples) {
  const auto is_measured = [](std::string_view record) { return number(record, 12) != 0.0; };
  return std::any_of(samples.begin(), samples.end(), is_measured) && !times_pass(samples, 20);
}

/// The radar of HeRCULES: the range at @16 is the distance of the point.
bool is_continental(std::string_view record) {
  const double range = std::hypot(number(record, 0), number(record, 4), number(record, 8));
  return has_coordinates(record) && std::abs(number(record, 16) - range) <= 0.01 * range;
}

}  // namespace

bool looks_like(std::string_view content, const RecordLayout& layout) {
  if (!fits(content, layout.bytes)) {
    return false;
  }
  const std::vector<std::string_view> samples = samples_of(content, layout.bytes);
  const auto has = [&](const auto& extra) {
    return most(samples, [&](std::string_view record) { return is_point(record, layout) && extra(record); });
  };
  const auto anything = [](std::string_view) { return true; };
  if (&layout == &formats::kAeva25 || &layout == &formats::kAeva29) {
    return has([&](std::string_view record) { return is_aeva(record, layout); });
  }
  if (&layout == &formats::kBoreas40) {
    return has(is_boreas40);
  }
  if (&layout == &formats::kVod28) {
    return has(is_vod) && has_radar_values(samples);
  }
  if (layout.bytes == formats::kBoreas28.bytes || &layout == &formats::kBoreas32) {
    return has([&](std::string_view record) { return has_beam(record, layout); });
  }
  if (layout.time_type != formats::RecordTime::kNone) {
    return has(anything) && times_pass(samples, layout.time);
  }
  return has(anything) && is_doppler(samples);
}

const RecordLayout* guess_layout(const fs::path& file, std::span<const RecordLayout* const> candidates) {
  const std::string content = formats::read_whole_file(file, formats::kMaxRecordFileBytes);
  formats::refuse_other_kind(file, content, formats::FileKind::kUnknown);
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [&](const RecordLayout* layout) { return looks_like(content, *layout); });
  return found == candidates.end() ? nullptr : *found;
}

std::string without_doppler(std::string_view content) {
  const RecordLayout& plain = formats::kXyzd;
  constexpr std::size_t kContinentalBytes = 29;
  if (fits(content, kContinentalBytes) && most(samples_of(content, kContinentalBytes), is_continental)) {
    return "holds points of the Continental radar of HeRCULES, not of its LiDAR";
  }
  if (fits(content, plain.bytes)) {
    const std::vector<std::string_view> samples = samples_of(content, plain.bytes);
    if (most(samples, [&](std::string_view record) { return is_point(record, plain); }) && !is_doppler(samples)) {
      return "holds records of four numbers whose last lies between 0 and 1: the reflectance of KITTI, not Doppler "
             "(format dicp reads it as Doppler all the same)";
    }
  }
  return "";
}

}  // namespace dynamic_icp::datasets
