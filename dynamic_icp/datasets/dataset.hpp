// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/base/scan.hpp"
#include "dynamic_icp/formats/trajectory.hpp"

namespace dynamic_icp::datasets {

/// A recording: scans by index, their time stamps, and the ground truth where the recording has one.
///
/// Opening reads no points; `scan` reads one scan. Doppler leaves a dataset in m/s, positive away from the sensor.
class Dataset {
 public:
  virtual ~Dataset() = default;

  /// The name of the layout, as `--format` takes it.
  [[nodiscard]] virtual std::string_view format() const = 0;

  [[nodiscard]] virtual std::size_t size() const = 0;

  /// When scan `index` begins. Strictly increasing over the recording.
  [[nodiscard]] virtual Stamp stamp(std::size_t index) const = 0;

  /// The file of scan `index`, for messages.
  [[nodiscard]] virtual std::filesystem::path scan_file(std::size_t index) const = 0;

  /// Reads scan `index`. Throws DataError naming the file, the place and what was expected.
  [[nodiscard]] virtual RawScan scan(std::size_t index) const = 0;

  /// Poses T_world_sensor, stamped; empty without ground truth.
  [[nodiscard]] virtual const formats::Trajectory& ground_truth() const = 0;

  /// The file the ground truth came from; empty without ground truth.
  [[nodiscard]] virtual std::filesystem::path ground_truth_file() const = 0;

  /// Where the sensor sits on the vehicle, where the recording says so.
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> T_vehicle_sensor() const { return std::nullopt; }

  /// What had to be assumed about the recording (for instance a scan period), in sentences for the user.
  [[nodiscard]] virtual const std::vector<std::string>& assumptions() const = 0;
};

/// Opens a recording. `format` is "auto" or one of `known_formats()`. Throws DataError when the input is missing, is
/// of no known layout (saying what was looked for) or is damaged; UsageError for an unknown format name.
std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& input, std::string_view format = "auto");

/// The layouts that can be read, for `--format` and its help.
std::vector<std::string> known_formats();

}  // namespace dynamic_icp::datasets
