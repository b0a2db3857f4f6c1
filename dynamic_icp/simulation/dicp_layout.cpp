// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/formats/binary_file.hpp"
#include "dynamic_icp/formats/xyzd_bin.hpp"
#include "dynamic_icp/simulation/point_layout.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

class DicpLayout : public PointLayout {
 public:
  explicit DicpLayout(const fs::path& folder) : points_(folder / "point_clouds"), times_(folder / "times") {
    formats::make_folder(points_);
  }

  void add(const SimulatedFrame& frame, std::size_t /*sensor*/) override {
    const RawScan& scan = frame.scan.measured;
    const std::string name = fmt::format("{:05}.bin", frame.index + 1);
    formats::write_xyzd(points_ / name, scan);
    if (!takes_time_ && std::any_of(scan.times.begin(), scan.times.end(), [](double time) { return time != 0.0; })) {
      begin_times();
    }
    if (takes_time_) {
      write_times(name, {scan.times.begin(), scan.times.end()});
    } else {
      instant_.push_back({name, scan.times.size()});
    }
  }

 private:
  struct InstantScan {
    std::string name;
    std::size_t points = 0;
  };

  /// A sweeping sensor whose first scans gave no returns, or only some at the stamp, shows late that it sweeps.
  void begin_times() {
    takes_time_ = true;
    formats::make_folder(times_);
    for (const InstantScan& scan : instant_) {
      write_times(scan.name, std::vector<float>(scan.points, 0.0F));
    }
  }

  void write_times(const std::string& name, const std::vector<float>& times) const {
    formats::write_values<float>(times_ / name, times);
  }

  fs::path points_;
  fs::path times_;
  bool takes_time_ = false;
  std::vector<InstantScan> instant_;  ///< scans without a file of times so far
};

}  // namespace

std::unique_ptr<PointLayout> make_dicp_layout(const fs::path& folder) { return std::make_unique<DicpLayout>(folder); }

}  // namespace dynamic_icp::simulation
