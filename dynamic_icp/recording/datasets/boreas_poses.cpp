// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::string_view kColumns = "t (us), x, y, z, vx, vy, vz, roll, pitch, yaw, ...";

/// C_enu_sensor = Rx(roll) Ry(pitch) Rz(yaw) with elementary rotations that turn the axes, not the vector: each the
/// transpose of what Eigen's AngleAxis makes of the same angle.
Eigen::Matrix3d rotation_of(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(-roll, Vector3d::UnitX()) * AngleAxisd(-pitch, Vector3d::UnitY()) *
          AngleAxisd(-yaw, Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// The stamp in front of the first comma, and the numbers after it.
formats::StampedPose pose_in(std::string_view line, const std::string& place) {
  const std::size_t comma = line.find_first_of(", \t");
  const std::optional<Stamp> stamp = parse_unix_time(line.substr(0, comma));
  if (!stamp || comma == std::string_view::npos) {
    throw DataError(fmt::format("{}: the time stamp is {}, expected Unix time in whole microseconds ({})", place,
                                formats::quoted_text(line.substr(0, comma)), kColumns));
  }
  const std::vector<double> numbers = numbers_in(line.substr(comma), place);
  if (numbers.size() < 9) {
    throw DataError(fmt::format("{}: {} columns, expected at least 10: {}", place, numbers.size() + 1, kColumns));
  }
  formats::StampedPose pose;
  pose.stamp = *stamp;
  pose.T_world_sensor.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  pose.T_world_sensor.linear() = rotation_of(numbers[6], numbers[7], numbers[8]);
  if (!pose.T_world_sensor.matrix().allFinite()) {
    throw DataError(fmt::format("{}: a number is not finite", place));
  }
  return pose;
}

}  // namespace

formats::Trajectory read_boreas_poses(const std::filesystem::path& path) {
  formats::Trajectory poses;
  bool may_be_header = true;
  for (const auto& [place, line] : formats::read_lines(path)) {
    const bool is_header = std::exchange(may_be_header, false) && line.find_first_of("0123456789") != 0;
    if (is_header) {
      continue;
    }
    const formats::StampedPose pose = pose_in(line, place);
    if (!poses.empty() && pose.stamp <= poses.back().stamp) {
      throw DataError(fmt::format("{}: the time stamp {} comes after {}, expected increasing stamps", place,
                                  format_seconds(pose.stamp), format_seconds(poses.back().stamp)));
    }
    poses.push_back(pose);
  }
  if (poses.empty()) {
    throw DataError(fmt::format("{}: no pose in this file, expected lines: {}", path.string(), kColumns));
  }
  return near_origin(std::move(poses));
}

}  // namespace dynamic_icp::datasets
