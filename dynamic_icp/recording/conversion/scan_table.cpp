// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/conversion/scan_table.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace dynamic_icp::conversion {
namespace {

using formats::NamedArray;

class Table {
 public:
  Table(std::size_t points, bool arrays_of_vectors) : points_(points), arrays_of_vectors_(arrays_of_vectors) {}

  void add_vectors(const std::array<const char*, 3>& axes, const char* array, formats::NpyType type,
                   const std::vector<Eigen::Vector3d>& vectors) {
    std::vector<double> values(arrays_of_vectors_ ? 3 * points_ : points_);
    if (arrays_of_vectors_) {
      for (std::size_t i = 0; i < points_; ++i) {
        std::copy(vectors[i].begin(), vectors[i].end(), values.begin() + static_cast<std::ptrdiff_t>(3 * i));
      }
      columns_.push_back({array, array_of(type, {points_, 3}, values)});
      return;
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::transform(vectors.begin(), vectors.end(), values.begin(),
                     [axis](const Eigen::Vector3d& vector) { return vector[axis]; });
      add(axes[static_cast<std::size_t>(axis)], type, values);
    }
  }

  void add(const std::string& name, formats::NpyType type, const std::vector<double>& values) {
    columns_.push_back({name, array_of(type, {points_}, values)});
  }

  [[nodiscard]] bool has(const std::string& name) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const NamedArray& column) { return column.name == name; });
  }

  std::vector<NamedArray> take() { return std::move(columns_); }

 private:
  std::size_t points_;
  bool arrays_of_vectors_;
  std::vector<NamedArray> columns_;
};

void add_times(Table& table, const ScanToWrite& from) {
  const TimeColumn kind = from.types.time_column();
  if (kind == TimeColumn::kNone) {
    return;
  }
  std::vector<double> times = from.scan.times;
  if (kind == TimeColumn::kNanoseconds) {
    std::transform(times.begin(), times.end(), times.begin(),
                   [](double time) { return static_cast<double>(nanoseconds(time)); });
  }
  table.add(kind == TimeColumn::kNanoseconds ? "time_offset_ns" : "time_offset_s", from.types.time_type(), times);
}

}  // namespace

void Notes::add(const std::string& sentence) {
  if (std::find(sentences_.begin(), sentences_.end(), sentence) == sentences_.end()) {
    sentences_.push_back(sentence);
  }
}

std::vector<NamedArray> scan_table(const ScanToWrite& from, bool arrays_of_vectors, Notes& notes) {
  Table table(from.scan.points.size(), arrays_of_vectors);
  table.add_vectors({"x", "y", "z"}, "points", from.types.point(), from.scan.points);
  table.add("doppler", from.types.doppler(), from.scan.doppler);
  add_times(table, from);
  if (from.types.has_lines_of_sight()) {
    table.add_vectors({"los_x", "los_y", "los_z"}, "los", from.types.line_of_sight(), from.scan.directions);
  }
  if (from.types.some_times_missing()) {
    notes.add("the times of points are left out: some scans have none");
  }
  if (from.types.some_lines_of_sight_missing()) {
    notes.add("the lines of sight are left out: some scans have none");
  }
  for (const datasets::PointColumn& column : from.columns) {
    std::string name = column.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }, '_');
    while (name.empty() || table.has(name)) {
      name += "_other";
    }
    if (name != column.name) {
      notes.add(fmt::format("column '{}' is called '{}'", column.name, name));
    }
    table.add(name, from.types.other(column.name), column.values);
  }
  return table.take();
}

}  // namespace dynamic_icp::conversion
