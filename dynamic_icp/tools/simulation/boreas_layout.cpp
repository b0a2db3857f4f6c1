// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/simulation/point_layout.hpp"
#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMicrosecond = 1'000;  // ns
constexpr int kLineShift = 8;                 // where line, beam and face lie among the flags
constexpr int kBeamShift = 16;
constexpr int kFaceShift = 22;
constexpr float kBestSignal = 1.0F;  // the simulation knows no other
// The recordings' positions are in a frame of the whole region.
const Eigen::Vector3d kScene(600'000.0, 4'800'000.0, 100.0);

/// The flags as the number they are, in float32: exact, as the lowest 8 bits are 0.
float flags_of(std::uint16_t line, std::uint8_t beam, std::uint8_t face) {
  constexpr auto kLast = std::numeric_limits<std::uint8_t>::max();
  if (line > kLast) {
    throw UsageError(fmt::format("layout boreas: lidar.rows: line {} does not fit, lines 0 to {} do", line, kLast));
  }
  return static_cast<float>(line << kLineShift | beam << kBeamShift | face << kFaceShift);
}

std::vector<float> values_of(const SimulatedScan& scan) {
  constexpr std::size_t kNumbers = 10;
  std::vector<float> values;
  values.reserve(kNumbers * scan.measured.points.size());
  for (std::size_t i = 0; i < scan.measured.points.size(); ++i) {
    const Eigen::Vector3f p = scan.measured.points[i].cast<float>();
    values.insert(values.end(), {p.x(), p.y(), p.z(), static_cast<float>(scan.measured.doppler[i]),
                                 scan.intensity_db[i], kBestSignal, kPercent * scan.reflectivity[i],
                                 static_cast<float>(std::round(kNanoseconds * scan.measured.times[i])),
                                 flags_of(scan.lines[i], scan.beams[i], scan.faces[i]), 0.0F});
  }
  return values;
}

/// Roll, pitch and yaw (rad) of Rx(roll) Ry(pitch) Rz(yaw), each of which turns the axes: its product is
///   cp cy               cp sy               -sp
///   ...                 ...                 sr cp
///   ...                 ...                 cr cp
std::array<double, 3> angles_of(const Eigen::Matrix3d& C) {
  return {std::atan2(C(1, 2), C(2, 2)), -std::asin(std::clamp(C(0, 2), -1.0, 1.0)), std::atan2(C(0, 1), C(0, 0))};
}

class BoreasLayout : public PointLayout {
 public:
  explicit BoreasLayout(const fs::path& folder) : points_(folder / "aeva"), poses_(poses_file(folder)) {
    formats::make_folder(points_);
    poses_.write(
        "GPSTime,easting,northing,altitude,vel_east,vel_north,vel_up,roll,pitch,heading,angvel_z,angvel_y,angvel_x\n");
  }

  void add(const SimulatedFrame& frame, std::size_t /*sensor*/) override {
    const std::int64_t stamp_ns = frame.scan.measured.stamp.ns + kUnixTimeOfStart;
    if (stamp_ns % kMicrosecond != 0) {
      throw UsageError(fmt::format(
          "layout boreas: lidar.rate_hz: scan {} begins at {} ns, its files are named by whole microseconds",
          frame.index, frame.scan.measured.stamp.ns));
    }
    const std::int64_t stamp_us = stamp_ns / kMicrosecond;
    formats::write_values<float>(points_ / fmt::format("{}.bin", stamp_us), values_of(frame.scan));
    poses_.write(pose_line(stamp_us, frame.sensor));
  }

  void finish() override { poses_.close(); }

 private:
  static fs::path poses_file(const fs::path& folder) {
    formats::make_folder(folder / "applanix");
    return folder / "applanix" / "aeva_poses.csv";
  }

  static std::string pose_line(std::int64_t stamp_us, const SensorState& sensor) {
    const Eigen::Matrix3d C = sensor.T_world_sensor.linear();
    const Eigen::Vector3d p = sensor.T_world_sensor.translation() + kScene;
    const Eigen::Vector3d v = C * sensor.velocity_sensor;
    const Eigen::Vector3d& w = sensor.angular_velocity_sensor;
    const auto [roll, pitch, yaw] = angles_of(C);
    return fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.12f},{:.9f},{:.9f},{:.9f}\n",
                       stamp_us, p.x(), p.y(), p.z(), v.x(), v.y(), v.z(), roll, pitch, yaw, w.z(), w.y(), w.x());
  }

  fs::path points_;
  formats::OutputFile poses_;
};

}  // namespace

std::unique_ptr<PointLayout> make_boreas_layout(const fs::path& folder) {
  return std::make_unique<BoreasLayout>(folder);
}

}  // namespace dynamic_icp::simulation
