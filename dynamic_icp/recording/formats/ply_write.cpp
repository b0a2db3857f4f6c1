// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

/// The name of a type in the header.
std::string_view ply_name(NpyType type, std::string_view column) {
  switch (type) {
    case NpyType::kFloat32:
      return "float";
    case NpyType::kFloat64:
      return "double";
    case NpyType::kInt8:
      return "char";
    case NpyType::kInt16:
      return "short";
    case NpyType::kInt32:
      return "int";
    case NpyType::kUint8:
      return "uchar";
    case NpyType::kUint16:
      return "ushort";
    case NpyType::kUint32:
      return "uint";
    case NpyType::kInt64:
    case NpyType::kUint64:
      break;
  }
  throw std::invalid_argument(
      fmt::format("the property '{}' has integers of 64 bits, which PLY does not know", column));
}

void check_column(const NamedArray& column, std::size_t points, std::set<std::string_view>& taken) {
  if (column.name.empty() || column.name.find_first_of(" \t\r\n") != std::string::npos) {
    throw std::invalid_argument(fmt::format("'{}' cannot name a property of a PLY file", column.name));
  }
  if (!taken.insert(column.name).second) {
    throw std::invalid_argument(fmt::format("the property '{}' would be in the PLY file twice", column.name));
  }
  if (rows_of(column.array) != points || columns_of(column.array) != 1) {
    throw std::invalid_argument(fmt::format("the property '{}' has {} x {} values for {} points", column.name,
                                            rows_of(column.array), columns_of(column.array), points));
  }
}

}  // namespace

std::string ply_bytes(std::span<const Eigen::Vector3d> points) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n",
      points.size());
  bytes.reserve(bytes.size() + points.size() * 3 * sizeof(float));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double coordinate : points[i]) {
      // Written so that NaN fails as well.
      if (!(std::abs(coordinate) <= std::numeric_limits<float>::max())) {
        throw std::invalid_argument(fmt::format("point {} of a PLY file has a number that is no finite float32", i));
      }
      append_value(bytes, static_cast<float>(coordinate));
    }
  }
  return bytes;
}

std::string ply_table_bytes(std::span<const NamedArray> columns) {
  if (columns.empty()) {
    throw std::invalid_argument("a PLY file needs at least one property");
  }
  const std::size_t points = rows_of(columns.front().array);
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points);
  std::set<std::string_view> taken;
  std::size_t record_bytes = 0;
  for (const NamedArray& column : columns) {
    check_column(column, points, taken);
    bytes += fmt::format("property {} {}\n", ply_name(column.array.type, column.name), column.name);
    record_bytes += size_of(column.array.type);
  }
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + points * record_bytes);
  for (std::size_t i = 0; i < points; ++i) {
    for (const NamedArray& column : columns) {
      const std::size_t width = size_of(column.array.type);
      bytes.append(column.array.bytes, i * width, width);
    }
  }
  return bytes;
}

void write_ply(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points) {
  write_whole_file(path, ply_bytes(points));
}

}  // namespace dynamic_icp::formats
