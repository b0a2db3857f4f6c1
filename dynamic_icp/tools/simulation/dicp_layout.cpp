// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/tools/simulation/point_layout.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

/// x, y, z, Doppler, one point after the other.
std::vector<float> values_of(const RawScan& scan) {
  std::vector<float> values;
  values.reserve(4 * scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3f p = scan.points[i].cast<float>();
    values.insert(values.end(), {p.x(), p.y(), p.z(), static_cast<float>(scan.doppler[i])});
  }
  return values;
}

class DicpLayout : public PointLayout {
 public:
  DicpLayout(const fs::path& folder, bool takes_time)
      : points_(folder / "point_clouds"), times_(folder / "times"), takes_time_(takes_time) {
    formats::make_folder(points_);
    if (takes_time_) {
      formats::make_folder(times_);
    }
  }

  void add(const SimulatedFrame& frame, std::size_t /*sensor*/) override {
    const RawScan& scan = frame.scan.measured;
    const std::string name = fmt::format("{:05}.bin", ++scans_);
    formats::write_values<float>(points_ / name, values_of(scan));
    if (takes_time_) {
      formats::write_values<float>(times_ / name, std::vector<float>(scan.times.begin(), scan.times.end()));
    }
  }

 private:
  fs::path points_;
  fs::path times_;
  bool takes_time_;
  std::size_t scans_ = 0;
};

}  // namespace

std::unique_ptr<PointLayout> make_dicp_layout(const fs::path& folder, bool takes_time) {
  return std::make_unique<DicpLayout>(folder, takes_time);
}

}  // namespace dynamic_icp::simulation
