// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/ply.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
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

}  // namespace

std::string ply_bytes(std::span<const Eigen::Vector3d> points) { return ply_table_bytes(point_table(points)); }

std::string ply_table_bytes(std::span<const NamedArray> columns) {
  const std::size_t points = checked_rows(columns, "PLY");
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points);
  for (const auto& [name, array] : columns) {
    if (columns_of(array) != 1) {
      throw std::invalid_argument(
          fmt::format("the property '{}' has {} values a point, PLY takes one", name, columns_of(array)));
    }
    bytes += fmt::format("property {} {}\n", ply_name(array.type, name), name);
  }
  bytes += "end_header\n";
  append_records(bytes, columns, points);
  return bytes;
}

void write_ply(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points) {
  write_whole_file(path, ply_bytes(points));
}

}  // namespace dynamic_icp::formats
