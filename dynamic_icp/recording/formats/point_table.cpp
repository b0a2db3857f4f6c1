// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/point_table.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace dynamic_icp::formats {

std::vector<NamedArray> point_table(std::span<const Eigen::Vector3d> points) {
  std::vector<NamedArray> table;
  for (const int axis : {0, 1, 2}) {
    std::vector<float> values;
    values.reserve(points.size());
    for (const Eigen::Vector3d& point : points) {
      // Written so that NaN fails as well.
      if (!(std::abs(point[axis]) <= std::numeric_limits<float>::max())) {
        throw std::invalid_argument(
            fmt::format("point {} to be written has a number that is no finite float32", values.size()));
      }
      values.push_back(static_cast<float>(point[axis]));
    }
    table.push_back({std::string(1, "xyz"[axis]), npy_array<float>({values.size()}, values)});
  }
  return table;
}

std::size_t checked_rows(std::span<const NamedArray> columns, std::string_view format) {
  if (columns.empty()) {
    throw std::invalid_argument(fmt::format("a {} file needs at least one column", format));
  }
  const std::size_t rows = rows_of(columns.front().array);
  std::set<std::string_view> taken;
  for (const auto& [name, array] : columns) {
    if (name.empty() || name.find_first_of(" \t\r\n") != std::string::npos) {
      throw std::invalid_argument(fmt::format("'{}' cannot name a column of a {} file", name, format));
    }
    if (!taken.insert(name).second) {
      throw std::invalid_argument(fmt::format("the column '{}' would be in the {} file twice", name, format));
    }
    if (rows_of(array) != rows) {
      throw std::invalid_argument(
          fmt::format("the column '{}' has {} values for {} points", name, rows_of(array), rows));
    }
  }
  return rows;
}

void append_records(std::string& bytes, std::span<const NamedArray> columns, std::size_t rows) {
  std::size_t record_bytes = 0;
  for (const NamedArray& column : columns) {
    record_bytes += columns_of(column.array) * size_of(column.array.type);
  }
  bytes.reserve(bytes.size() + rows * record_bytes);
  for (std::size_t row = 0; row < rows; ++row) {
    for (const NamedArray& column : columns) {
      const std::size_t width = columns_of(column.array) * size_of(column.array.type);
      bytes.append(column.array.bytes, row * width, width);
    }
  }
}

}  // namespace dynamic_icp::formats
