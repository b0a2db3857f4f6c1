// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pcd.hpp"

#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

/// Checks a name and adds it to those that are taken.
void take_name(std::set<std::string_view>& taken, std::string_view name) {
  if (name.empty() || name.find_first_of(" \t\r\n") != std::string_view::npos) {
    throw std::invalid_argument(fmt::format("'{}' cannot name a field of a PCD file", name));
  }
  if (!taken.insert(name).second) {
    throw std::invalid_argument(fmt::format("the field '{}' would be in the PCD file twice", name));
  }
}

void check_columns(std::size_t points, std::span<const PcdColumn> columns) {
  std::set<std::string_view> taken = {"x", "y", "z"};
  for (const PcdColumn& column : columns) {
    take_name(taken, column.name);
    if (column.values.size() != points) {
      throw std::invalid_argument(
          fmt::format("the field '{}' has {} values for {} points", column.name, column.values.size(), points));
    }
  }
}

/// The header, field by field.
class Header {
 public:
  void add(std::string_view name, NpyType type, std::size_t count) {
    names_ += fmt::format(" {}", name);
    sizes_ += fmt::format(" {}", size_of(type));
    types_ += fmt::format(" {:c}", static_cast<char>(std::toupper(code_of(type).front())));
    counts_ += fmt::format(" {}", count);
  }

  [[nodiscard]] std::string text(std::size_t points) const {
    return fmt::format(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\n"
        "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
        names_, sizes_, types_, counts_, points, points);
  }

 private:
  std::string names_;
  std::string sizes_;
  std::string types_;
  std::string counts_;
};

std::string header(std::size_t points, std::span<const PcdColumn> columns) {
  Header header;
  for (const std::string_view name : {"x", "y", "z"}) {
    header.add(name, NpyType::kFloat32, 1);
  }
  for (const PcdColumn& column : columns) {
    header.add(column.name, NpyType::kFloat32, 1);
  }
  return header.text(points);
}

void append_float(std::string& bytes, double value, std::size_t point) {
  // Written so that NaN fails as well.
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
    throw std::invalid_argument(fmt::format("point {} of a PCD file has a number that is no finite float32", point));
  }
  append_value(bytes, static_cast<float>(value));
}

}  // namespace

std::string pcd_bytes(std::span<const Eigen::Vector3d> points, std::span<const PcdColumn> columns) {
  check_columns(points.size(), columns);
  std::string bytes = header(points.size(), columns);
  bytes.reserve(bytes.size() + points.size() * (3 + columns.size()) * sizeof(float));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double coordinate : points[i]) {
      append_float(bytes, coordinate, i);
    }
    for (const PcdColumn& column : columns) {
      append_float(bytes, column.values[i], i);
    }
  }
  return bytes;
}

std::string pcd_table_bytes(std::span<const NamedArray> columns) {
  if (columns.empty()) {
    throw std::invalid_argument("a PCD file needs at least one field");
  }
  const std::size_t points = rows_of(columns.front().array);
  std::set<std::string_view> taken;
  Header header;
  std::size_t record_bytes = 0;
  for (const NamedArray& column : columns) {
    take_name(taken, column.name);
    if (rows_of(column.array) != points) {
      throw std::invalid_argument(
          fmt::format("the field '{}' has {} values for {} points", column.name, rows_of(column.array), points));
    }
    header.add(column.name, column.array.type, columns_of(column.array));
    record_bytes += columns_of(column.array) * size_of(column.array.type);
  }
  std::string bytes = header.text(points);
  bytes.reserve(bytes.size() + points * record_bytes);
  for (std::size_t i = 0; i < points; ++i) {
    for (const NamedArray& column : columns) {
      const std::size_t width = columns_of(column.array) * size_of(column.array.type);
      bytes.append(column.array.bytes, i * width, width);
    }
  }
  return bytes;
}

void write_pcd(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points,
               std::span<const PcdColumn> columns) {
  write_whole_file(path, pcd_bytes(points, columns));
}

}  // namespace dynamic_icp::formats
