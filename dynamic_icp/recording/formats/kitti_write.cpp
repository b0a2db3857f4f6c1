// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/kitti_write.hpp"

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {

std::string format_kitti(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 4; ++column) {
        // + 0.0 turns -0 into 0.
        text += fmt::format("{}{}", row + column == 0 ? "" : " ", pose.T_world_sensor(row, column) + 0.0);
      }
    }
    text += '\n';
  }
  return text;
}

void write_kitti(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_whole_file(path, format_kitti(trajectory));
}

}  // namespace dynamic_icp::formats
