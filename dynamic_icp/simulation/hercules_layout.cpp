// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/aeva_bin.hpp"
#include "dynamic_icp/formats/binary_file.hpp"
#include "dynamic_icp/formats/whole_file.hpp"
#include "dynamic_icp/simulation/point_layout.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

constexpr float kPercent = 100.0F;
constexpr double kNanoseconds = 1e9;  // in a second

std::uint8_t line_index(std::uint16_t line) {
  constexpr auto kLast = std::numeric_limits<std::uint8_t>::max();
  if (line > kLast) {
    throw UsageError(fmt::format("layout hercules: lidar.rows: line {} does not fit, lines 0 to {} do", line, kLast));
  }
  return static_cast<std::uint8_t>(line);
}

std::vector<formats::AevaRecord> records_of(const SimulatedScan& scan) {
  std::vector<formats::AevaRecord> records;
  records.reserve(scan.measured.points.size());
  for (std::size_t i = 0; i < scan.measured.points.size(); ++i) {
    const Eigen::Vector3f p = scan.measured.points[i].cast<float>();
    formats::AevaRecord record{p.x(), p.y(), p.z()};
    record.reflectivity = kPercent * scan.reflectivity[i];
    record.velocity = static_cast<float>(scan.measured.doppler[i]);
    record.time_offset_ns = static_cast<std::int32_t>(std::lround(kNanoseconds * scan.measured.times[i]));
    record.line_index = line_index(scan.lines[i]);
    record.intensity = scan.intensity_db[i];
    records.push_back(record);
  }
  return records;
}

/// A file in this folder, which is made.
fs::path file_in(const fs::path& folder, const char* name) {
  formats::make_folder(folder);
  return folder / name;
}

class HerculesLayout : public PointLayout {
 public:
  explicit HerculesLayout(const fs::path& folder)
      : points_(folder / "LiDAR" / "Aeva"), poses_(file_in(folder / "PR_GT", "Aeva_gt.txt")) {
    formats::make_folder(points_);
  }

  void add(const SimulatedFrame& frame, std::size_t /*sensor*/) override {
    const std::int64_t stamp_ns = frame.scan.measured.stamp.ns + kUnixTimeOfStart;
    formats::write_aeva(points_ / fmt::format("{}.bin", stamp_ns), records_of(frame.scan));
    poses_.write(pose_line(stamp_ns, frame.sensor.T_world_sensor));
  }

  void finish() override { poses_.close(); }

 private:
  std::string pose_line(std::int64_t stamp_ns, const Eigen::Isometry3d& T_world_sensor) {
    Eigen::Isometry3d T_first_sensor = Eigen::Isometry3d::Identity();
    if (T_first_world_) {
      T_first_sensor = *T_first_world_ * T_world_sensor;
    } else {
      T_first_world_ = T_world_sensor.inverse();
    }
    const Eigen::Vector3d t = T_first_sensor.translation();
    const Eigen::Quaterniond q(T_first_sensor.linear());
    return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n", stamp_ns, t.x(), t.y(), t.z(),
                       q.x(), q.y(), q.z(), q.w());
  }

  fs::path points_;
  formats::OutputFile poses_;
  std::optional<Eigen::Isometry3d> T_first_world_;
};

}  // namespace

std::unique_ptr<PointLayout> make_hercules_layout(const fs::path& folder) {
  return std::make_unique<HerculesLayout>(folder);
}

}  // namespace dynamic_icp::simulation
