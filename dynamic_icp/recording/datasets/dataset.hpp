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

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/open_options.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::datasets {

/// What a recording says of each point beyond its measurement, by the name it has there: reflectivity, line, ..., also
/// where it is a channel of RawScan as well.
struct PointColumn {
  std::string name;
  std::vector<double> values;  ///< one per point, as stored: no unit is changed
  bool is_integer = false;
};

/// An object as the recording's annotators saw it, for evaluation only.
struct AnnotatedBox {
  std::string id;          ///< of the track
  std::string class_name;  ///< in the words of the data set
  Eigen::Isometry3d T_sensor_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();           ///< m, full lengths along the axes of the box
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();  ///< m/s over ground, in sensor axes
};

/// A recording: scans by index, their time stamps, and the ground truth where the recording has one.
///
/// Opening reads no points, but for one scan at most to tell how points are stored; `scan` reads one scan. Doppler
/// leaves a dataset in m/s, positive away from the sensor.
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

  /// The other columns of scan `index`, each as long as its points. Read anew at each call: not for the hot path.
  [[nodiscard]] virtual std::vector<PointColumn> columns(std::size_t /*index*/) const { return {}; }

  /// What the layout says of its Doppler; that it is so is for the diagnosis to find out.
  [[nodiscard]] virtual DopplerKind doppler_kind() const { return DopplerKind::kRelative; }

  /// The boxes at scan `index`, nothing where the recording has none at all.
  [[nodiscard]] virtual std::optional<std::vector<AnnotatedBox>> boxes(std::size_t /*index*/) const {
    return std::nullopt;
  }

  /// Poses T_world_sensor, stamped; empty without ground truth.
  [[nodiscard]] virtual const formats::Trajectory& ground_truth() const = 0;

  /// The file the ground truth came from; empty without ground truth.
  [[nodiscard]] virtual std::filesystem::path ground_truth_file() const = 0;

  /// Where the sensor sits on the vehicle, where the recording says so.
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> T_vehicle_sensor() const { return std::nullopt; }

  /// What had to be assumed about the recording (for instance a scan period), in sentences for the user.
  [[nodiscard]] virtual const std::vector<std::string>& assumptions() const = 0;
};

/// Opens a recording. Throws DataError when the input is missing or damaged; NotARecording when it is of no known
/// layout (saying what was looked for, and naming archives, Git LFS pointers and the like for what they are) or holds
/// several recordings; UsageError for an unknown format or options that the format does not have.
std::unique_ptr<Dataset> open_dataset(const std::filesystem::path& input, const OpenOptions& options = {});

/// Throws UsageError where the options are not those of a layout, by its name.
void check_options(std::string_view format, const OpenOptions& options);

/// Where a recording was found, and of which layout it is.
struct FoundDataset {
  std::string format;  ///< as `--format` takes it
  std::filesystem::path path;

  /// Whether it is one of messages in topics.
  [[nodiscard]] bool is_bag() const { return format == "rosbag" || format == "rosbag2" || format == "mcap"; }
};

/// What `open_dataset` would open. Throws as it does, but for what only opening shows.
FoundDataset find_dataset(const std::filesystem::path& input, const OpenOptions& options = {});

/// The layouts that can be read, for `--format` and its help.
std::vector<std::string> known_formats();

}  // namespace dynamic_icp::datasets
