// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/column_file.hpp"
#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"
#include "dynamic_icp/recording/datasets/truth_search.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDopplerEnding = "_dop.npy";

std::string_view extension(ColumnFileKind kind) {
  switch (kind) {
    case ColumnFileKind::kNpz:
      return ".npz";
    case ColumnFileKind::kPcd:
      return ".pcd";
    case ColumnFileKind::kPly:
      return ".ply";
    case ColumnFileKind::kNpyPair:
      break;
  }
  return ".npy";
}

/// The name of the layout, as --format takes it.
std::string_view format_name(ColumnFileKind kind) {
  return kind == ColumnFileKind::kNpyPair ? "npz" : extension(kind).substr(1);
}

bool is_npy_pair(const fs::path& points) {
  return points.extension() == ".npy" && fs::is_regular_file(points) &&
         fs::is_regular_file(ColumnFile::doppler_file(points));
}

class ColumnDataset final : public Dataset {
 public:
  ColumnDataset(ColumnFileKind kind, const fs::path& found, const OpenOptions& options) : kind_(kind) {
    if (!options.sensors.empty()) {
      throw UsageError(fmt::format("{} has no sensors to choose from, sensor '{}' was asked for", format_name(kind),
                                   options.sensors.front()));
    }
    const bool is_folder = fs::is_directory(found);
    const fs::path folder = is_folder ? found : fs::absolute(found).parent_path();
    files_ = is_folder ? scan_files(found) : std::vector<fs::path>{found};
    if (is_folder && kind_ == ColumnFileKind::kNpyPair) {
      say_what_has_no_doppler(found);
    }
    find_stamps(folder, options.period_s);
    const ColumnFile first(kind_, files_.front());
    meaning_ = find_meaning(
        map_fields(first.names(), options.fields, files_.front().string(), first.unusable()), files_.size(),
        [&](std::size_t i) {
          return ColumnsOfScan{std::make_unique<ColumnFile>(kind_, files_[i]), files_[i]};
        },
        options.period_s, assumptions_);
    take_calibration(folder);
    if (folder.filename().string().find("compensated") != std::string::npos) {
      doppler_kind_ = DopplerKind::kCompensated;
      assumptions_.push_back(
          fmt::format("the Doppler is taken as compensated, by the name of the folder {}", folder.filename().string()));
    }
  }

  [[nodiscard]] std::string_view format() const override { return format_name(kind_); }
  [[nodiscard]] std::size_t size() const override { return files_.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return stamps_.at(index); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return files_.at(index); }
  [[nodiscard]] DopplerKind doppler_kind() const override { return doppler_kind_; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_.poses; }
  [[nodiscard]] fs::path ground_truth_file() const override { return truth_.file; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return assumptions_; }
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override {
    return calibration_.T_vehicle_sensor;
  }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    const fs::path& path = files_.at(index);
    RawScan raw = read_scan(ColumnFile(kind_, path), meaning_, stamps_[index], path);
    raw.doppler_kind = doppler_kind_;
    set_mountings(path, raw);
    return raw;
  }

  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override {
    const fs::path& path = files_.at(index);
    return other_columns(ColumnFile(kind_, path), meaning_.fields, path);
  }

 private:
  [[nodiscard]] std::vector<fs::path> scan_files(const fs::path& folder) const {
    const bool pairs = kind_ == ColumnFileKind::kNpyPair;
    std::vector<fs::path> files = numbered_files(folder, pairs ? kDopplerEnding : extension(kind_));
    if (pairs) {
      for (fs::path& file : files) {
        const std::string name = file.filename().string();
        file = folder / (name.substr(0, name.size() - kDopplerEnding.size()) + ".npy");
      }
    }
    if (files.empty()) {
      throw DataError(
          fmt::format("{}: no *{} has a number in its name to order the scans by; name one file for a "
                      "single scan",
                      folder.string(), extension(kind_)));
    }
    return files;
  }

  void say_what_has_no_doppler(const fs::path& folder) {
    const std::vector<fs::path> alone = entries_of(folder, [](const fs::directory_entry& entry) {
      const fs::path& path = entry.path();
      return path.extension() == ".npy" && !path.filename().string().ends_with(kDopplerEnding) && !is_npy_pair(path);
    });
    if (!alone.empty()) {
      assumptions_.push_back(
          fmt::format("{}: {} of the *.npy have no *{} beside them and are left out, this is the first",
                      alone.front().string(), alone.size(), kDopplerEnding));
    }
  }

  void find_stamps(const fs::path& folder, double period_s) {
    StampedFiles stamped = stamped_files(files_, period_s);
    files_ = std::move(stamped.files);
    stamps_ = std::move(stamped.stamps);
    std::vector<std::string>& said = stamped.assumptions;
    const bool are_indices = stamped.are_indices;
    truth_ = search_truth(folder, stamps_, are_indices, assumptions_);
    if (are_indices && !truth_.poses.empty()) {
      std::transform(truth_.poses.begin(), truth_.poses.end(), stamps_.begin(),
                     [](const formats::StampedPose& pose) { return pose.stamp; });
      said = {fmt::format("the names of the scans are no times: those of the poses are taken, one for one")};
    }
    assumptions_.insert(assumptions_.end(), said.begin(), said.end());
  }

  void set_mountings(const fs::path& path, RawScan& raw) const {
    const std::vector<std::uint8_t>& sensor = raw.channels.sensor;
    const std::size_t sensors = calibration_.mountings.size();
    const auto unknown = std::find_if(sensor.begin(), sensor.end(), [&](std::size_t k) { return k >= sensors; });
    if (sensors == 0 || (sensor.empty() && !raw.points.empty())) {
      return;
    }
    if (unknown != sensor.end()) {
      throw DataError(fmt::format("{}: point {} is of sensor {}, but {} has {} sensors, counted from 0", path.string(),
                                  unknown - sensor.begin(), *unknown, kCalibrationFile, sensors));
    }
    raw.mountings = calibration_.mountings;
  }

  void take_calibration(const fs::path& folder) {
    calibration_ = find_calibration(folder, assumptions_).value_or(Calibration{});
    const auto is_sensor = [](const ChannelColumn& column) { return column.channel == formats::Channel::kSensor; };
    if (!calibration_.mountings.empty() &&
        std::none_of(meaning_.fields.channels.begin(), meaning_.fields.channels.end(), is_sensor)) {
      assumptions_.push_back(
          fmt::format("{}: the mountings of its {} sensors are not used: no column says which of them measured a point",
                      (folder / kCalibrationFile).string(), calibration_.mountings.size()));
      calibration_.mountings.clear();
    }
  }

  ColumnFileKind kind_;
  std::vector<fs::path> files_;
  std::vector<Stamp> stamps_;
  ColumnMeaning meaning_;
  Calibration calibration_;
  DopplerKind doppler_kind_ = DopplerKind::kRelative;
  Truth truth_;
  std::vector<std::string> assumptions_;
};

bool holds_npy_pairs(const fs::path& folder) {
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored); !ignored && entry != fs::directory_iterator();
       entry.increment(ignored)) {
    if (is_npy_pair(entry->path())) {
      return true;
    }
  }
  return false;
}

fs::path find_files_of(ColumnFileKind kind, const fs::path& input) {
  if (fs::is_regular_file(input)) {
    return input.extension() == extension(kind) ? input : fs::path();
  }
  return find_folder(input, [&](const fs::path& folder) { return holds_files(folder, extension(kind)); });
}

}  // namespace

fs::path find_npz(const fs::path& input) {
  if (is_npy_pair(input)) {
    return input;
  }
  const fs::path found = find_files_of(ColumnFileKind::kNpz, input);
  return found.empty() && fs::is_directory(input) ? find_folder(input, holds_npy_pairs) : found;
}

fs::path find_pcd(const fs::path& input) { return find_files_of(ColumnFileKind::kPcd, input); }

fs::path find_ply(const fs::path& input) { return find_files_of(ColumnFileKind::kPly, input); }

std::unique_ptr<Dataset> open_npz(const fs::path& found, const OpenOptions& options) {
  const bool pairs = fs::is_directory(found) ? !holds_files(found, ".npz") : found.extension() == ".npy";
  return std::make_unique<ColumnDataset>(pairs ? ColumnFileKind::kNpyPair : ColumnFileKind::kNpz, found, options);
}

std::unique_ptr<Dataset> open_pcd(const fs::path& found, const OpenOptions& options) {
  return std::make_unique<ColumnDataset>(ColumnFileKind::kPcd, found, options);
}

std::unique_ptr<Dataset> open_ply(const fs::path& found, const OpenOptions& options) {
  return std::make_unique<ColumnDataset>(ColumnFileKind::kPly, found, options);
}

}  // namespace dynamic_icp::datasets
