// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/conversion/column_types.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dynamic_icp::conversion {
namespace {

constexpr double kNanosecond = 1e-9;
constexpr double kLargestInteger = 9007199254740992.0;  // 2^53

bool is_float32(double value) {
  if (!std::isfinite(value)) {
    return true;
  }
  return std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()) &&
         static_cast<double>(static_cast<float>(value)) == value;
}

template <class Number>
bool holds(double smallest, double largest) {
  return smallest >= static_cast<double>(std::numeric_limits<Number>::min()) &&
         largest <= static_cast<double>(std::numeric_limits<Number>::max());
}

}  // namespace

void ValueSurvey::add(double value) {
  fits_float32 = fits_float32 && is_float32(value);
  is_integer = is_integer && std::abs(value) <= kLargestInteger && value == std::floor(value) &&
               !(value == 0.0 && std::signbit(value));  // an integer has no negative zero
  if (is_integer) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
}

formats::NpyType ValueSurvey::type(bool prefer_integers) const {
  if (prefer_integers && is_integer) {
    return holds<std::uint8_t>(smallest, largest)    ? formats::NpyType::kUint8
           : holds<std::int32_t>(smallest, largest)  ? formats::NpyType::kInt32
           : holds<std::uint32_t>(smallest, largest) ? formats::NpyType::kUint32
                                                     : formats::NpyType::kInt64;
  }
  return fits_float32 ? formats::NpyType::kFloat32 : formats::NpyType::kFloat64;
}

void ColumnTypes::add(const RawScan& scan, const std::vector<datasets::PointColumn>& columns) {
  scans_ += scan.points.empty() ? 0 : 1;
  with_times_ += scan.times.empty() ? 0 : 1;
  with_lines_of_sight_ += scan.directions.empty() ? 0 : 1;
  for (const Eigen::Vector3d& point : scan.points) {
    std::for_each(point.begin(), point.end(), [&](double value) { point_.add(value); });
  }
  for (const Eigen::Vector3d& direction : scan.directions) {
    std::for_each(direction.begin(), direction.end(), [&](double value) { line_of_sight_.add(value); });
  }
  std::for_each(scan.doppler.begin(), scan.doppler.end(), [&](double value) { doppler_.add(value); });
  for (const double time : scan.times) {
    time_.add(time);
    const double ns = std::round(time / kNanosecond);
    whole_nanoseconds_ = whole_nanoseconds_ && std::abs(ns) <= kLargestInteger && kNanosecond * ns == time;
    time_ns_.add(whole_nanoseconds_ ? ns + 0.0 : 0.0);
  }
  for (const datasets::PointColumn& column : columns) {
    Other& other = others_[column.name];
    other.is_integer = other.is_integer && column.is_integer;
    std::for_each(column.values.begin(), column.values.end(), [&](double value) { other.values.add(value); });
  }
}

formats::NpyType ColumnTypes::other(const std::string& name) const {
  const Other& other = others_.at(name);
  return other.values.type(other.is_integer);
}

TimeColumn ColumnTypes::time_column() const {
  if (with_times_ == 0 || with_times_ < scans_) {
    return TimeColumn::kNone;
  }
  return !time_.fits_float32 && whole_nanoseconds_ ? TimeColumn::kNanoseconds : TimeColumn::kSeconds;
}

formats::NpyType ColumnTypes::time_type() const {
  if (time_column() != TimeColumn::kNanoseconds) {
    return time_.type(false);
  }
  // What other programs expect of a column of this name.
  return holds<std::int32_t>(time_ns_.smallest, time_ns_.largest) ? formats::NpyType::kInt32 : time_ns_.type(true);
}

std::int64_t nanoseconds(double time_s) { return std::llround(time_s / kNanosecond); }

}  // namespace dynamic_icp::conversion
