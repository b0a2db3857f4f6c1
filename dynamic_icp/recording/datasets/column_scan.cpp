// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/column_scan.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kScansSearched = 20;  // for points, to tell by them what columns mean

/// The arrays of one scan, each read once.
class Arrays {
 public:
  Arrays(const NamedColumns& columns, const fs::path& origin) : columns_(columns), origin_(origin) {}

  const formats::NpyArray& get(const FieldColumn& field) {
    auto found = arrays_.find(field.array);
    if (found == arrays_.end()) {
      found = arrays_.emplace(field.array, columns_.read(field.array)).first;
    }
    const formats::NpyArray& array = found->second;
    if (field.whole && formats::columns_of(array) != 1) {
      throw DataError(fmt::format("{}: has {} columns, expected one", array.origin, formats::columns_of(array)));
    }
    rows_ = arrays_.size() == 1 ? formats::rows_of(array) : rows_;
    if (formats::rows_of(array) != rows_) {
      throw DataError(fmt::format("{}: array '{}' of shape ({}) has {} rows, expected {} as in the others",
                                  origin_.string(), field.array, fmt::join(array.shape, ", "), formats::rows_of(array),
                                  rows_));
    }
    return array;
  }

  std::vector<double> values(const FieldColumn& field) { return formats::column_as_doubles(get(field), field.column); }

  std::vector<Eigen::Vector3d> vectors(const std::array<FieldColumn, 3>& fields) {
    const std::vector<double> x = values(fields[0]);
    const std::vector<double> y = values(fields[1]);
    const std::vector<double> z = values(fields[2]);
    std::vector<Eigen::Vector3d> vectors(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      vectors[i] = {x[i], y[i], z[i]};
    }
    return vectors;
  }

 private:
  const NamedColumns& columns_;
  const fs::path& origin_;
  std::map<std::string, formats::NpyArray> arrays_;
  std::size_t rows_ = 0;
};

/// Puts a column into the scan; why it is none of the channel where it is not, else empty.
std::string set_channel(const NamedColumns& columns, const ChannelColumn& column, RawScan& raw) {
  if (std::find(columns.names().begin(), columns.names().end(), column.array) == columns.names().end()) {
    return "is missing";
  }
  const formats::NpyArray array = columns.read(column.array);
  const bool is_column = array.shape.size() == 1 || (array.shape.size() == 2 && array.shape[1] == 1);
  return is_column
             ? formats::set_channel(raw, column.channel, formats::column_as_doubles(array))
             : fmt::format("has the shape ({}), expected one number for each point", fmt::join(array.shape, ", "));
}

/// The first scans may be empty.
void find_time_unit(ColumnMeaning& meaning, std::size_t scans, const std::function<ColumnsOfScan(std::size_t)>& open,
                    double period_s, std::vector<std::string>& assumptions) {
  if (!meaning.fields.time) {
    return;
  }
  for (std::size_t i = 0; i < std::min(scans, kScansSearched); ++i) {
    const ColumnsOfScan scan = open(i);
    Arrays arrays(*scan.columns, scan.origin);
    const formats::NpyArray& column = arrays.get(*meaning.fields.time);
    meaning.time_unit = time_unit(meaning.fields.time->array, column, period_s);
    if (formats::rows_of(column) > 0) {
      break;
    }
  }
  if (!meaning.time_unit.assumption.empty()) {
    assumptions.push_back(meaning.time_unit.assumption);
  }
}

/// What the names of spherical coordinates leave open is told by the first scan with points.
void find_coordinates(FieldMap& fields, std::size_t scans, const std::function<ColumnsOfScan(std::size_t)>& open,
                      std::vector<std::string>& assumptions) {
  if (!fields.spherical) {
    return;
  }
  std::vector<Eigen::Vector3d> points;
  std::string origin;
  for (std::size_t i = 0; points.empty() && i < std::min(scans, kScansSearched); ++i) {
    const ColumnsOfScan scan = open(i);
    origin = scan.origin.string();
    points = Arrays(*scan.columns, scan.origin).vectors(fields.point);
  }
  std::array<std::string, 3> names = {fields.point[0].array, fields.point[1].array, fields.point[2].array};
  const std::string first = names[0];
  assumptions.push_back(settle(*fields.spherical, names, points, origin));
  if (names[0] != first) {
    std::swap(fields.point[0], fields.point[1]);
  }
}

/// The points of a scan in x, y, z.
std::vector<Eigen::Vector3d> cartesian_points(Arrays& arrays, const FieldMap& fields) {
  std::vector<Eigen::Vector3d> points = arrays.vectors(fields.point);
  if (fields.spherical) {
    make_cartesian(points, *fields.spherical);
  }
  return points;
}

/// What the first scan with points contradicts is no channel of the recording.
void check_channels(ColumnMeaning& meaning, std::size_t scans, const std::function<ColumnsOfScan(std::size_t)>& open,
                    std::vector<std::string>& assumptions) {
  FieldMap& fields = meaning.fields;
  RawScan raw;
  for (std::size_t i = 0; !fields.channels.empty() && raw.points.empty() && i < std::min(scans, kScansSearched); ++i) {
    const ColumnsOfScan scan = open(i);
    Arrays arrays(*scan.columns, scan.origin);
    raw.points = cartesian_points(arrays, fields);
    raw.doppler = arrays.values(fields.doppler);
    std::erase_if(fields.channels, [&](const ChannelColumn& column) {
      const std::string reason = set_channel(*scan.columns, column, raw);
      if (!reason.empty()) {
        assumptions.push_back(
            fmt::format("{}: column '{}' is not used: it {}", scan.origin.string(), column.array, reason));
      }
      return !reason.empty();
    });
  }
}

}  // namespace

ColumnMeaning find_meaning(FieldMap fields, std::size_t scans, const std::function<ColumnsOfScan(std::size_t)>& open,
                           double period_s, std::vector<std::string>& assumptions) {
  ColumnMeaning meaning{std::move(fields), {}};
  assumptions.insert(assumptions.end(), meaning.fields.assumptions.begin(), meaning.fields.assumptions.end());
  find_coordinates(meaning.fields, scans, open, assumptions);
  find_time_unit(meaning, scans, open, period_s, assumptions);
  check_channels(meaning, scans, open, assumptions);
  return meaning;
}

RawScan read_scan(const NamedColumns& columns, const ColumnMeaning& meaning, Stamp stamp, const fs::path& origin) {
  const FieldMap& fields = meaning.fields;
  Arrays arrays(columns, origin);
  RawScan raw;
  raw.stamp = stamp;
  raw.warning = columns.warning();
  raw.points = cartesian_points(arrays, fields);
  raw.doppler = arrays.values(fields.doppler);
  refuse_foreign_numbers(raw, origin);
  for (const ChannelColumn& column : fields.channels) {
    formats::warn_of_column(raw, origin, column.array, set_channel(columns, column, raw));
  }
  if (fields.time) {
    raw.times = times_after(raw.stamp, arrays.get(*fields.time), meaning.time_unit);
  }
  if (fields.line_of_sight) {
    raw.directions = arrays.vectors(*fields.line_of_sight);
  }
  return raw;
}

std::vector<PointColumn> other_columns(const NamedColumns& columns, const FieldMap& fields, const fs::path& origin) {
  Arrays arrays(columns, origin);
  const std::size_t points = formats::rows_of(arrays.get(fields.doppler));
  std::vector<PointColumn> others;
  for (const std::string& name : columns.names()) {
    if (fields.uses(name)) {
      continue;
    }
    const formats::NpyArray array = columns.read(name);
    const bool of_points = (array.shape.size() == 1 || array.shape.size() == 2) && array.shape.front() == points;
    for (std::size_t k = 0; of_points && k < formats::columns_of(array); ++k) {
      others.push_back({formats::columns_of(array) == 1 ? name : fmt::format("{}[{}]", name, k),
                        formats::column_as_doubles(array, k), !formats::is_float(array.type)});
    }
  }
  return others;
}

}  // namespace dynamic_icp::datasets
