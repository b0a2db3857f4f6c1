// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/aevascenes_sequence.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/formats/channel.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRawFolder = "pointcloud_raw";
constexpr const char* kCompensatedFolder = "pointcloud_compensated";
constexpr const char* kSequenceFile = "sequence.json";
constexpr double kNanosecond_s = 1e-9;
/// Columns beside point, Doppler and time.
struct OtherColumn {
  const char* name;
  formats::Channel channel;
};
constexpr std::array<OtherColumn, 3> kOtherColumns = {{{"reflectivity", formats::Channel::kIntensity},
                                                       {"line_index", formats::Channel::kLine},
                                                       {"semantic_labels_idx", formats::Channel::kNone}}};

bool is_sequence(const fs::path& folder) {
  return fs::is_regular_file(folder / kSequenceFile) &&
         (fs::is_directory(folder / kCompensatedFolder) || fs::is_directory(folder / kRawFolder));
}

/// Points without what says when and where they were measured.
bool lacks_sequence(const fs::path& folder) {
  return !fs::exists(folder / kSequenceFile) &&
         (holds_files(folder / kCompensatedFolder, ".npz") || holds_files(folder / kRawFolder, ".npz"));
}

/// One member of an archive, (N,) or (N, 1); of any type. Throws DataError for another number of rows.
formats::NpyArray read_column(const formats::NpzFile& file, const char* name, std::size_t rows) {
  formats::NpyArray array = file.read(name);
  if (formats::rows_of(array) != rows || formats::columns_of(array) != 1) {
    throw DataError(fmt::format("{}: has {} x {} values, expected one for each of the {} points", array.origin,
                                formats::rows_of(array), formats::columns_of(array), rows));
  }
  return array;
}

class AevaScenesDataset final : public Dataset {
 public:
  AevaScenesDataset(const fs::path& found, const OpenOptions& options)
      : folder_(is_sequence(found) ? found : fs::absolute(found).lexically_normal().parent_path()),
        sequence_(read_aevascenes_sequence(folder_ / kSequenceFile)) {
    if (!options.fields.empty()) {
      throw UsageError(
          fmt::format("aevascenes knows its columns by name, field '{}' was given", options.fields.begin()->first));
    }
    assumptions_ = sequence_.warnings;
    choose_lidars(options.sensors);
    choose_doppler(found == folder_ ? fs::path() : found.filename());
    const Eigen::Isometry3d T_vehicle_sensor = *this->T_vehicle_sensor();
    for (const AevaScenesFrame& frame : sequence_.frames) {
      if (frame.T_world_vehicle) {
        ground_truth_.push_back({frame.stamp, *frame.T_world_vehicle * T_vehicle_sensor});
      }
    }
    if (const std::size_t without = sequence_.frames.size() - ground_truth_.size(); without > 0) {
      assumptions_.push_back(fmt::format("{}: {} of {} frames have no ego_pose: no ground truth for them",
                                         (folder_ / kSequenceFile).string(), without, sequence_.frames.size()));
    }
  }

  [[nodiscard]] std::string_view format() const override { return "aevascenes"; }
  [[nodiscard]] std::size_t size() const override { return sequence_.frames.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return sequence_.frames.at(index).stamp; }
  [[nodiscard]] DopplerKind doppler_kind() const override { return doppler_kind_; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return ground_truth_; }
  [[nodiscard]] fs::path ground_truth_file() const override {
    return ground_truth_.empty() ? fs::path() : folder_ / kSequenceFile;
  }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return assumptions_; }

  [[nodiscard]] fs::path scan_file(std::size_t index) const override {
    const std::vector<Cloud> clouds = clouds_of(index);
    return clouds.empty() ? folder_ / kSequenceFile : clouds.front().path;
  }

  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override {
    return merges() ? Eigen::Isometry3d::Identity() : sequence_.T_vehicle_lidar.at(lidars_.front());
  }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    RawScan raw;
    raw.stamp = sequence_.frames.at(index).stamp;
    raw.doppler_kind = doppler_kind_;
    const std::vector<Cloud> clouds = clouds_of(index);
    ChannelValues channels;
    for (const Cloud& cloud : clouds) {
      append(cloud, raw, channels);
      refuse_foreign_numbers(raw, cloud.path);
    }
    set_channels(channels, index, raw);
    // Some without times: those of the others would be of no use.
    raw.times.resize(raw.times.size() == raw.points.size() ? raw.times.size() : 0);
    if (clouds.empty()) {
      raw.warning = fmt::format("{}: frame at {} s has no points of {}", (folder_ / kSequenceFile).string(),
                                format_seconds(raw.stamp), fmt::join(lidars_, ", "));
    }
    return raw;
  }

  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override {
    std::vector<PointColumn> columns;
    std::size_t rows = 0;
    PointColumn lidar{"lidar", {}, true};
    for (const Cloud& cloud : clouds_of(index)) {
      const formats::NpzFile file(cloud.path);
      const std::size_t points = formats::column_as_doubles(file.read("xyz"), 2).size();  // checks the shape as well
      for (const OtherColumn& other : kOtherColumns) {
        if (file.contains(other.name)) {
          append_column(columns, rows, read_column(file, other.name, points), other.name);
        }
      }
      rows += points;
      lidar.values.resize(rows, static_cast<double>(cloud.number));
    }
    // A column that one of the LiDARs lacks is none of the scan.
    std::erase_if(columns, [&](const PointColumn& column) { return column.values.size() != rows; });
    if (merges()) {
      columns.push_back(std::move(lidar));
    }
    return columns;
  }

  [[nodiscard]] std::optional<std::vector<AnnotatedBox>> boxes(std::size_t index) const override {
    const Eigen::Isometry3d T_sensor_vehicle = T_vehicle_sensor()->inverse();
    std::vector<AnnotatedBox> boxes;
    for (const AevaScenesBox& box : sequence_.frames.at(index).boxes) {
      boxes.push_back({box.id, box.class_name, T_sensor_vehicle * box.T_vehicle_box, box.dimensions,
                       T_sensor_vehicle.linear() * box.velocity_vehicle});
    }
    return boxes;
  }

 private:
  /// The points of one LiDAR in one frame.
  struct Cloud {
    std::size_t number = 0;  ///< of the LiDAR among those taken
    fs::path path;
  };

  /// The numbers of kOtherColumns, of one LiDAR after the other; fewer than points where one of them has none.
  using ChannelValues = std::array<std::vector<double>, kOtherColumns.size()>;

  [[nodiscard]] bool merges() const { return lidars_.size() > 1; }

  void choose_lidars(const std::vector<std::string>& wanted) {
    const auto known = [&](const std::string& lidar) {
      return std::find(sequence_.lidars.begin(), sequence_.lidars.end(), lidar) != sequence_.lidars.end();
    };
    for (const std::string& lidar : wanted) {
      if (!known(lidar)) {
        throw UsageError(fmt::format("{}: no sensor '{}', there are: {}", folder_.string(), lidar,
                                     fmt::join(sequence_.lidars, ", ")));
      }
      if (std::find(lidars_.begin(), lidars_.end(), lidar) != lidars_.end()) {
        throw UsageError(fmt::format("sensor '{}' for the second time", lidar));
      }
      lidars_.push_back(lidar);
    }
    if (!lidars_.empty()) {
      return;
    }
    if (sequence_.lidars.empty()) {
      throw DataError(fmt::format("{}: metadata: no LiDAR with extrinsics, expected at least one",
                                  (folder_ / kSequenceFile).string()));
    }
    for (const char* lidar : {"front_wide_lidar", "front_narrow_lidar"}) {
      if (known(lidar)) {
        lidars_.emplace_back(lidar);
      }
    }
    if (lidars_.empty()) {
      lidars_.push_back(sequence_.lidars.front());
    }
    if (sequence_.lidars.size() > 1) {
      assumptions_.push_back(fmt::format("of {} LiDARs {} taken{}", sequence_.lidars.size(),
                                         fmt::join(lidars_, " and "),
                                         merges() ? ", merged into the frame of the vehicle" : ""));
    }
  }

  /// Which of the two folders is read; `asked` is the one the user named, if any.
  void choose_doppler(const fs::path& asked) {
    const auto exists = [&](std::string AevaScenesPaths::*path) {
      return std::any_of(sequence_.frames.begin(), sequence_.frames.end(), [&](const AevaScenesFrame& frame) {
        return std::any_of(lidars_.begin(), lidars_.end(), [&](const std::string& lidar) {
          const auto found = frame.clouds.find(lidar);
          return found != frame.clouds.end() && !(found->second.*path).empty() &&
                 fs::is_directory((folder_ / (found->second.*path)).parent_path());
        });
      });
    };
    const bool has_raw = exists(&AevaScenesPaths::raw);
    const bool has_compensated = exists(&AevaScenesPaths::compensated);
    const bool takes_raw = asked.empty() ? has_raw : asked == kRawFolder;
    if (!(takes_raw ? has_raw : has_compensated)) {
      throw DataError(fmt::format("{}: names no points of {} that lie in {}", (folder_ / kSequenceFile).string(),
                                  fmt::join(lidars_, " or "), folder_.string()));
    }
    path_ = takes_raw ? &AevaScenesPaths::raw : &AevaScenesPaths::compensated;
    doppler_kind_ = takes_raw ? DopplerKind::kRelative : DopplerKind::kCompensated;
    if (takes_raw && has_compensated && asked.empty()) {
      assumptions_.push_back(
          fmt::format("there are both {} and {}: the raw points are taken; name the folder for the "
                      "others",
                      kRawFolder, kCompensatedFolder));
    }
    if (takes_raw) {
      assumptions_.push_back("the Doppler of raw points is taken as relative: the data set does not document it");
    }
  }

  [[nodiscard]] std::vector<Cloud> clouds_of(std::size_t index) const {
    std::vector<Cloud> clouds;
    const AevaScenesFrame& frame = sequence_.frames.at(index);
    for (std::size_t k = 0; k < lidars_.size(); ++k) {
      const auto found = frame.clouds.find(lidars_[k]);
      if (found != frame.clouds.end() && !(found->second.*path_).empty()) {
        clouds.push_back({k, folder_ / (found->second.*path_)});
      }
    }
    return clouds;
  }

  /// A channel that one of the LiDARs lacks is none of the scan.
  void set_channels(const ChannelValues& channels, std::size_t index, RawScan& raw) const {
    for (std::size_t k = 0; k < kOtherColumns.size(); ++k) {
      if (channels[k].size() == raw.points.size()) {
        formats::warn_of_column(raw, scan_file(index), kOtherColumns[k].name,
                                formats::set_channel(raw, kOtherColumns[k].channel, channels[k]));
      }
    }
    for (std::size_t k = 0; merges() && k < lidars_.size(); ++k) {
      raw.mountings.push_back(sequence_.T_vehicle_lidar.at(lidars_[k]));
    }
  }

  void append(const Cloud& cloud, RawScan& raw, ChannelValues& channels) const {
    const formats::NpzFile file(cloud.path);
    const formats::NpyArray xyz = file.read("xyz");
    const std::array<std::vector<double>, 3> axes = {
        formats::column_as_doubles(xyz, 0), formats::column_as_doubles(xyz, 1), formats::column_as_doubles(xyz, 2)};
    const std::size_t rows = axes[0].size();
    const std::vector<double> velocity = formats::column_as_doubles(read_column(file, "velocity", rows));
    const Eigen::Isometry3d& T_vehicle_lidar = sequence_.T_vehicle_lidar.at(lidars_[cloud.number]);
    for (std::size_t i = 0; i < rows; ++i) {
      const Eigen::Vector3d point(axes[0][i], axes[1][i], axes[2][i]);
      if (merges()) {
        // No line of sight leads to the LiDAR's own origin: Scan drops such points by the zero that stays here.
        raw.directions.emplace_back(T_vehicle_lidar.linear() * point.stableNormalized());
        raw.points.emplace_back(T_vehicle_lidar * point);
      } else {
        raw.points.push_back(point);
      }
    }
    raw.doppler.insert(raw.doppler.end(), velocity.begin(), velocity.end());
    raw.channels.sensor.resize(merges() ? raw.points.size() : 0, static_cast<std::uint8_t>(cloud.number));
    for (std::size_t k = 0; k < kOtherColumns.size(); ++k) {
      if (kOtherColumns[k].channel != formats::Channel::kNone && file.contains(kOtherColumns[k].name)) {
        const std::vector<double> values = formats::column_as_doubles(read_column(file, kOtherColumns[k].name, rows));
        channels[k].insert(channels[k].end(), values.begin(), values.end());
      }
    }
    if (file.contains("time_offset_ns")) {
      for (const double ns : formats::column_as_doubles(read_column(file, "time_offset_ns", rows))) {
        raw.times.push_back(kNanosecond_s * ns);
      }
    }
  }

  static void append_column(std::vector<PointColumn>& columns, std::size_t rows_before, const formats::NpyArray& array,
                            const char* name) {
    auto found = std::find_if(columns.begin(), columns.end(), [&](const PointColumn& c) { return c.name == name; });
    if (found == columns.end()) {
      columns.push_back({name, {}, true});
      found = std::prev(columns.end());
    }
    if (found->values.size() == rows_before) {
      const std::vector<double> values = formats::column_as_doubles(array);
      found->values.insert(found->values.end(), values.begin(), values.end());
      found->is_integer = found->is_integer && !formats::is_float(array.type);
    }
  }

  fs::path folder_;
  AevaScenesSequence sequence_;
  std::vector<std::string> lidars_;  ///< those that are taken
  std::string AevaScenesPaths::*path_ = nullptr;
  DopplerKind doppler_kind_ = DopplerKind::kRelative;
  formats::Trajectory ground_truth_;
  std::vector<std::string> assumptions_;
};

}  // namespace

fs::path find_aevascenes(const fs::path& input) {
  if (input.filename() == kSequenceFile && is_sequence(input.parent_path())) {
    return input.parent_path();
  }
  const fs::path whole = named_path(input);
  const bool holds_points = whole.filename() == kRawFolder || whole.filename() == kCompensatedFolder;
  if (holds_points && is_sequence(whole.parent_path())) {
    return whole;
  }
  const fs::path found = fs::is_directory(input) ? find_folder(input, is_sequence) : fs::path();
  if (found.empty() && lacks_sequence(input)) {
    throw DataError(fmt::format(
        "{}: holds points of AevaScenes, expected {} beside {}; name the folder of points to read them without it",
        input.string(), kSequenceFile, fs::is_directory(input / kRawFolder) ? kRawFolder : kCompensatedFolder));
  }
  return found;
}

std::unique_ptr<Dataset> open_aevascenes(const fs::path& found, const OpenOptions& options) {
  return std::make_unique<AevaScenesDataset>(found, options);
}

}  // namespace dynamic_icp::datasets
