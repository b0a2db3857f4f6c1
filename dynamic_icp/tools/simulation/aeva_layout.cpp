// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/simulation/compensated_doppler.hpp"
#include "dynamic_icp/tools/simulation/point_layout.hpp"
#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

/// What differs between the recordings that hold scans of an Aeva sensor in these files.
struct AevaFiles {
  std::string_view name;
  const char* truth_folder;
  std::int64_t epoch_ns;
  bool has_intensity;  ///< in records of 29 bytes, else 25
};

constexpr AevaFiles kHercules = {"hercules", "PR_GT", kUnixTimeOfStart, true};
constexpr AevaFiles kHelipr = {"helipr", "LiDAR_GT", kHeliprTimeOfStart, false};

std::uint8_t line_index(std::uint16_t line, const AevaFiles& files) {
  constexpr auto kLast = std::numeric_limits<std::uint8_t>::max();
  if (line > kLast) {
    throw UsageError(
        fmt::format("layout {}: lidar.rows: line {} does not fit, lines 0 to {} do", files.name, line, kLast));
  }
  return static_cast<std::uint8_t>(line);
}

std::string records_of(const SimulatedScan& scan, const std::vector<double>& doppler, const AevaFiles& files) {
  constexpr std::size_t kRecordBytes = 29;
  std::string bytes;
  bytes.reserve(scan.measured.points.size() * kRecordBytes);
  for (std::size_t i = 0; i < scan.measured.points.size(); ++i) {
    for (const double coordinate : scan.measured.points[i]) {
      formats::append_value(bytes, static_cast<float>(coordinate));
    }
    formats::append_value(bytes, kPercent * scan.reflectivity[i]);
    formats::append_value(bytes, static_cast<float>(doppler[i]));
    formats::append_value(bytes, static_cast<std::int32_t>(std::lround(kNanoseconds * scan.measured.times[i])));
    formats::append_value(bytes, line_index(scan.lines[i], files));
    if (files.has_intensity) {
      formats::append_value(bytes, scan.intensity_db[i]);
    }
  }
  return bytes;
}

/// A file in this folder, which is made.
fs::path file_in(const fs::path& folder, const char* name) {
  formats::make_folder(folder);
  return folder / name;
}

class AevaLayout : public PointLayout {
 public:
  /// Compensates the Doppler where the simulation is given.
  AevaLayout(const fs::path& folder, const AevaFiles& files, const Simulation* simulation = nullptr)
      : files_(files),
        simulation_(simulation),
        points_(folder / "LiDAR" / "Aeva"),
        poses_(file_in(folder / files.truth_folder, "Aeva_gt.txt")) {
    formats::make_folder(points_);
  }

  void add(const SimulatedFrame& frame, std::size_t sensor) override {
    const RawScan& measured = frame.scan.measured;
    const std::int64_t stamp_ns = measured.stamp.ns + files_.epoch_ns;
    const std::string bytes = records_of(
        frame.scan, simulation_ == nullptr ? measured.doppler : compensated_doppler(measured, *simulation_, sensor),
        files_);
    formats::write_bytes(points_ / fmt::format("{}.bin", stamp_ns), std::as_bytes(std::span(bytes)));
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

  AevaFiles files_;
  const Simulation* simulation_;
  fs::path points_;
  formats::OutputFile poses_;
  std::optional<Eigen::Isometry3d> T_first_world_;
};

}  // namespace

std::unique_ptr<PointLayout> make_hercules_layout(const fs::path& folder) {
  return std::make_unique<AevaLayout>(folder, kHercules);
}

std::unique_ptr<PointLayout> make_helipr_layout(const fs::path& folder, const Simulation& simulation) {
  return std::make_unique<AevaLayout>(folder, kHelipr, &simulation);
}

}  // namespace dynamic_icp::simulation
