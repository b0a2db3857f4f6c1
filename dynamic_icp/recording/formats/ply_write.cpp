// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/ply.hpp"
#include "dynamic_icp/recording/formats/ply_values.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
std::string ply_bytes(std::span<const Eigen::Vector3d> points) { return ply_table_bytes(point_table(points)); }

std::string ply_table_bytes(std::span<const NamedArray> columns) {
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

void write_ply(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points) {
  write_whole_file(path, ply_bytes(points));
}

}  // namespace dynamic_icp::formats
