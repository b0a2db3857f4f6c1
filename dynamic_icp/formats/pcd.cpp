// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/pcd.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/formats/binary_file.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

void check_columns(std::size_t points, std::span<const PcdColumn> columns) {
  std::set<std::string_view> taken = {"x", "y", "z"};
  for (const PcdColumn& column : columns) {
    if (column.name.empty() || column.name.find_first_of(" \t\r\n") != std::string_view::npos) {
      throw std::invalid_argument(fmt::format("'{}' cannot name a field of a PCD file", column.name));
    }
    if (!taken.insert(column.name).second) {
      throw std::invalid_argument(fmt::format("the field '{}' would be in the PCD file twice", column.name));
    }
    if (column.values.size() != points) {
      throw std::invalid_argument(
          fmt::format("the field '{}' has {} values for {} points", column.name, column.values.size(), points));
    }
  }
}

std::string header(std::size_t points, std::span<const PcdColumn> columns) {
  std::string names = "x y z";
  std::string sizes = "4 4 4";
  std::string types = "F F F";
  std::string counts = "1 1 1";
  for (const PcdColumn& column : columns) {
    names += fmt::format(" {}", column.name);
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      names, sizes, types, counts, points, points);
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

void write_pcd(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points,
               std::span<const PcdColumn> columns) {
  write_whole_file(path, pcd_bytes(points, columns));
}

}  // namespace dynamic_icp::formats
