// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "dynamic_icp/tools/simulation/point_layout.hpp"
#include "dynamic_icp/tools/simulation/simulation.hpp"
#include "dynamic_icp/tools/simulation/truth_writer.hpp"

namespace dynamic_icp::simulation {

/// The layout of the points.
enum class Layout { kDicp, kHercules, kHelipr, kBoreas, kAevaScenes };

/// The layout of that name: dicp, hercules, helipr, boreas or aevascenes. Throws UsageError with the known names.
Layout find_layout(std::string_view name);

struct SequenceOptions {
  Layout layout = Layout::kDicp;
  bool point_truth = false;  ///< true range and Doppler of every point
  bool calibration = false;  ///< dicp: poses of the vehicle, and calibration.json with the mounting
};

/// What was written, for a summary.
struct SequenceCounts {
  std::size_t scans = 0;  ///< of all sensors
  std::size_t rays = 0;
  std::size_t points = 0;
  std::size_t moving_points = 0;
  std::size_t mixed_points = 0;
  std::size_t rain_points = 0;
  std::size_t false_points = 0;  ///< spray, the window, mirror images
  std::size_t objects = 0;       ///< object records: one object in two scans counts twice
  double path_length_m = 0.0;    ///< of the first sensor, from scan to scan
};

/// Writes a sequence scan by scan with its truth (docs/simulator.md): points in the chosen layout, the truth of each
/// sensor, scene.json last. With several sensors the truth of each, and its points in the layouts for one sensor, lie
/// in a folder of the sensor's name. Every failure of the machine is a DataError that names the file and the reason.
class SequenceWriter {
 public:
  /// Writes into an existing, empty folder. Keeps a reference to the simulation.
  SequenceWriter(const std::filesystem::path& folder, const Simulation& simulation,
                 const SequenceOptions& options = {});

  /// The scans of each sensor must come in order.
  void add(const SimulatedFrame& frame, std::size_t sensor = 0);

  /// Completes the files and writes scene.json. Nothing can be added afterwards.
  void finish(std::string_view version);

  [[nodiscard]] const SequenceCounts& counts() const { return counts_; }

 private:
  std::filesystem::path folder_;
  const Simulation& simulation_;
  SequenceOptions options_;
  std::vector<std::unique_ptr<PointLayout>> points_;  ///< one for each sensor, or one for all
  std::vector<std::unique_ptr<TruthWriter>> truth_;   ///< one for each sensor
  std::optional<Eigen::Vector3d> last_position_;
  SequenceCounts counts_;
};

}  // namespace dynamic_icp::simulation
