// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pcd.hpp"

#include <cctype>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {

std::string pcd_bytes(std::span<const Eigen::Vector3d> points) { return pcd_table_bytes(point_table(points)); }

std::string pcd_table_bytes(std::span<const NamedArray> columns) {
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

void write_pcd(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points) {
  write_whole_file(path, pcd_bytes(points));
}

}  // namespace dynamic_icp::formats
