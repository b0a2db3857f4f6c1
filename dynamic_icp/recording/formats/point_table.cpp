// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/point_table.hpp"

#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/ply_values.hpp"

namespace dynamic_icp::formats {
namespace {

/// The number of rows. Throws where columns do not belong together; `format` is named in the message.
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

/// The records of a checked table: the columns of each point, one after the other, bit by bit.
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

}  // namespace

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

std::string pcd_bytes(std::span<const NamedArray> columns) {
  const std::size_t points = checked_rows(columns, "PCD");
  std::string names;
  std::string sizes;
  std::string types;
  std::string counts;
  for (const auto& [name, array] : columns) {
    names += fmt::format(" {}", name);
    sizes += fmt::format(" {}", size_of(array.type));
    types += fmt::format(" {:c}", static_cast<char>(std::toupper(code_of(array.type).front())));
    counts += fmt::format(" {}", columns_of(array));
  }
  std::string bytes = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      names, sizes, types, counts, points, points);
  append_records(bytes, columns, points);
  return bytes;
}

std::string ply_bytes(std::span<const NamedArray> columns) {
  const std::size_t points = checked_rows(columns, "PLY");
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points);
  for (const auto& [name, array] : columns) {
    if (columns_of(array) != 1) {
      throw std::invalid_argument(
          fmt::format("the property '{}' has {} values a point, PLY takes one", name, columns_of(array)));
    }
    const std::string_view type = ply_name(array.type);
    if (type.empty()) {
      throw std::invalid_argument(
          fmt::format("the property '{}' has integers of 64 bits, which PLY does not know", name));
    }
    bytes += fmt::format("property {} {}\n", type, name);
  }
  bytes += "end_header\n";
  append_records(bytes, columns, points);
  return bytes;
}

}  // namespace dynamic_icp::formats
