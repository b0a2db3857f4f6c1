// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

#include <stdexcept>
#include <vector>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/point_records.hpp"

namespace dynamic_icp::formats {

RawScan read_xyzd(const std::filesystem::path& path) { return read_points(path, kXyzd); }

void write_xyzd(const std::filesystem::path& path, const RawScan& scan) {
  if (scan.doppler.size() != scan.points.size()) {
    throw std::invalid_argument("points and Doppler differ in length");
  }
  std::vector<float> values;
  values.reserve(4 * scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3f p = scan.points[i].cast<float>();
    values.insert(values.end(), {p.x(), p.y(), p.z(), static_cast<float>(scan.doppler[i])});
  }
  write_values<float>(path, values);
}

}  // namespace dynamic_icp::formats
