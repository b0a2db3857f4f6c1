// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/column_file.hpp"
#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/named_rows.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/point_times.hpp"
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"
#include "dynamic_icp/recording/datasets/truth_search.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDopplerEnding = "_dop.npy";

/// Of texts that may be tables of points; the first that a folder has counts.
constexpr std::array<std::string_view, 4> kTextEndings = {".csv", ".txt", ".xyz", ".asc"};

std::string_view extension(ColumnFileKind kind) {
  switch (kind) {
    case ColumnFileKind::kNpz:
      return ".npz";
    case ColumnFileKind::kPcd:
      return ".pcd";
    case ColumnFileKind::kPly:
      return ".ply";
    case ColumnFileKind::kCsv:
      return ".csv";
    case ColumnFileKind::kNpy:
    case ColumnFileKind::kNpyPair:
      break;
  }
  return ".npy";
}

/// The name of the layout, as --format takes it.
std::string_view format_name(ColumnFileKind kind) {
  const bool is_npy = kind == ColumnFileKind::kNpyPair || kind == ColumnFileKind::kNpy;
  return is_npy ? "npz" : extension(kind).substr(1);
}

/// The first bytes of a file; empty where it cannot be read.
std::string head_of(const fs::path& file) {
  constexpr std::size_t kHeadBytes = 4096;
  std::string head(kHeadBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return head;
}

/// Whether a text may be a table of points, by its first lines: it is one of numbers, of four columns at least, and
/// neither named nor headed like one of poses.
bool is_cloud_table(const fs::path& file) {
  std::string head = head_of(file);
  const std::size_t last_line = head.rfind('\n');
  head.resize(last_line == std::string::npos ? head.size() : last_line);
  if (head.empty() || head.find('\0') != std::string::npos || is_truth_name(file) || !fs::is_regular_file(file)) {
    return false;
  }
  try {
    const formats::CsvTable table = formats::parse_csv(head, file.string());
    const auto is_rotation = [](const std::string& name) { return name == "qw" || name == "q_w" || name == "qx"; };
    return table.columns.size() >= 4 && formats::rows_of(table.columns.front()) > 0 &&
           std::none_of(table.names.begin(), table.names.end(), is_rotation);
  } catch (const DataError&) {
    return false;
  }
}

/// Whether a file is an array of points with their Doppler: of shape (N, 4) or wider.
bool is_npy_table(const fs::path& file) {
  if (file.extension() != ".npy" || !fs::is_regular_file(file)) {
    return false;
  }
  try {
    const formats::NpyHeader header = formats::parse_npy_header(head_of(file), file.string());
    return header.shape.size() == 2 && header.shape[1] >= 4 && formats::is_float(header.type);
  } catch (const DataError&) {
    return false;
  }
}

bool is_npy_pair(const fs::path& points) {
  return points.extension() == ".npy" && fs::is_regular_file(points) &&
         fs::is_regular_file(ColumnFile::doppler_file(points));
}

/// Whether the numbers of a column tell scans apart, by its name, or because it has the time of the scan and not that
/// of each point.
bool tells_scans_apart(const std::string& name, const formats::NpyArray& column, double period_s) {
  static const std::set<std::string> kNumbers = {"scan", "scan_id", "scan_index", "frame", "frame_id", "frame_index"};
  static const std::set<std::string> kTimes = {"timestamp", "time_stamp", "time", "stamp", "t"};
  if (kNumbers.contains(name)) {
    return true;
  }
  if (!kTimes.contains(name)) {
    return false;
  }
  constexpr double kFewPoints = 5.0;
  constexpr double kManyPoints = 300.0;  // more than sensors measure at once
  constexpr double kShortestPeriod_s = 0.01;
  constexpr double kLongestPeriod_s = 0.5;
  std::vector<double> times = formats::column_as_doubles(column);
  std::erase_if(times, [](double time) { return !std::isfinite(time); });
  const std::set<double> different(times.begin(), times.end());
  if (different.size() < 2) {
    return false;
  }
  const double of_each = static_cast<double>(times.size()) / static_cast<double>(different.size());
  const double gap = (*different.rbegin() - *different.begin()) / static_cast<double>(different.size() - 1);
  const double gap_s = 1e-9 * static_cast<double>(time_unit(name, column, period_s).ns) * gap;
  // What spans ten seconds and more is not taken for seconds by the rule for times of points.
  const bool are_seconds = formats::is_float(column.type) && of_each >= kManyPoints && gap <= kLongestPeriod_s;
  return of_each >= kFewPoints && (gap_s >= kShortestPeriod_s || (are_seconds && gap >= kShortestPeriod_s));
}

/// Refuses a table whose rows are those of several scans, by a column that tells them apart: as one scan they would be
/// nonsense.
void refuse_several_scans(const NamedColumns& table, const fs::path& path, double period_s) {
  const std::vector<std::string>& names = table.names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const formats::NpyArray column = table.read(names[k]);
    const std::vector<double> numbers = formats::column_as_doubles(column);
    const auto other =
        std::find_if(numbers.begin(), numbers.end(), [&](double number) { return number != numbers.front(); });
    if (other != numbers.end() && tells_scans_apart(names[k], column, period_s)) {
      throw DataError(fmt::format(
          "{}: holds several scans, told apart by its column '{}' ({}, {}, ...); write a file for each, e.g. where "
          "commas stand between the columns: mkdir scans; awk -F, 'NR == 1 {{ head = $0; next }} {{ file = \"scans/\" "
          "${} \".csv\"; if (!seen[file]++) print head > file; print > file }}' '{}'",
          path.string(), names[k], numbers.front(), *other, k + 1, path.string()));
    }
  }
}

/// Those of the first ending of which there are some.
std::vector<fs::path> cloud_tables(const fs::path& folder) {
  for (const std::string_view ending : kTextEndings) {
    std::vector<fs::path> files = files_ending_with(folder, ending);
    std::erase_if(files, [](const fs::path& file) { return !is_cloud_table(file); });
    if (!files.empty()) {
      return files;
    }
  }
  return {};
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
    auto first = std::make_unique<ColumnFile>(kind_, files_.front());
    const std::vector<std::string> unusable = first->unusable();
    if (kind_ == ColumnFileKind::kCsv) {
      refuse_several_scans(*first, files_.front(), options.period_s);
    }
    const ArrayReading reading = read_arrays_as(*first, options, files_.front());
    assumptions_.insert(assumptions_.end(), reading.assumptions.begin(), reading.assumptions.end());
    rows_ = reading.rows;
    FieldMap fields =
        map_columns(*with_rows(std::move(first), rows_), reading.fields, files_.front().string(), unusable);
    if (rows_.array.empty()) {
      refuse_stated_columns(fields, options, files_.front());
    }
    meaning_ = find_meaning(
        std::move(fields), files_.size(),
        [&](std::size_t i) {
          return ColumnsOfScan{open(files_[i]), files_[i]};
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
    RawScan raw = read_scan(*open(path), meaning_, stamps_[index], path);
    raw.doppler_kind = doppler_kind_;
    set_mountings(path, raw);
    return raw;
  }

  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override {
    const fs::path& path = files_.at(index);
    return other_columns(*open(path), meaning_.fields, path);
  }

 private:
  [[nodiscard]] std::unique_ptr<NamedColumns> open(const fs::path& path) const {
    return with_rows(std::make_unique<ColumnFile>(kind_, path), rows_);
  }

  [[nodiscard]] std::vector<fs::path> scan_files(const fs::path& folder) const {
    const bool pairs = kind_ == ColumnFileKind::kNpyPair;
    std::vector<fs::path> files = files_ending_with(folder, pairs ? kDopplerEnding : extension(kind_));
    if (kind_ == ColumnFileKind::kNpy) {
      std::erase_if(files, [](const fs::path& file) { return !is_npy_table(file); });
    }
    if (kind_ == ColumnFileKind::kCsv) {
      files = cloud_tables(folder);
    }
    files = order_names(std::move(files)).files;
    if (pairs) {
      for (fs::path& file : files) {
        const std::string name = file.filename().string();
        file = folder / (name.substr(0, name.size() - kDopplerEnding.size()) + ".npy");
      }
    }
    if (files.empty()) {
      throw DataError(fmt::format("{}: holds no scans, expected files *{}", folder.string(), extension(kind_)));
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
    truth_ = take_truth(folder, stamped);
    files_ = std::move(stamped.files);
    stamps_ = std::move(stamped.stamps);
    assumptions_.insert(assumptions_.end(), stamped.assumptions.begin(), stamped.assumptions.end());
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
  NamedRows rows_;
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

/// Whether a folder has a file of its own that passes.
bool holds_any(const fs::path& folder, bool (*test)(const fs::path&), std::string_view extension) {
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored); !ignored && entry != fs::directory_iterator();
       entry.increment(ignored)) {
    if (entry->path().extension() == extension && entry->path().filename().string().front() != '.' &&
        test(entry->path())) {
      return true;
    }
  }
  return false;
}

bool holds_npy_tables(const fs::path& folder) { return holds_any(folder, is_npy_table, ".npy"); }

bool holds_cloud_tables(const fs::path& folder) {
  return std::any_of(kTextEndings.begin(), kTextEndings.end(),
                     [&](std::string_view ending) { return holds_any(folder, is_cloud_table, ending); });
}

fs::path find_files_of(ColumnFileKind kind, const fs::path& input) {
  if (fs::is_regular_file(input)) {
    return input.extension() == extension(kind) ? input : fs::path();
  }
  return find_folder(input, [&](const fs::path& folder) { return holds_files(folder, extension(kind)); });
}

}  // namespace

fs::path find_npz(const fs::path& input) {
  if (fs::is_regular_file(input) && input.extension() == ".npy") {
    return input;
  }
  fs::path found = find_files_of(ColumnFileKind::kNpz, input);
  if (found.empty() && fs::is_directory(input)) {
    found = find_folder(input, holds_npy_pairs);
  }
  return found.empty() && fs::is_directory(input) ? find_folder(input, holds_npy_tables) : found;
}

fs::path find_csv(const fs::path& input) {
  if (fs::is_regular_file(input)) {
    const std::string ending = input.extension().string();
    const bool is_text = std::find(kTextEndings.begin(), kTextEndings.end(), ending) != kTextEndings.end();
    return ending == ".csv" || (is_text && is_cloud_table(input)) ? input : fs::path();
  }
  return find_folder(input, holds_cloud_tables);
}

fs::path find_pcd(const fs::path& input) { return find_files_of(ColumnFileKind::kPcd, input); }

fs::path find_ply(const fs::path& input) { return find_files_of(ColumnFileKind::kPly, input); }

std::unique_ptr<Dataset> open_npz(const fs::path& found, const OpenOptions& options) {
  ColumnFileKind kind = ColumnFileKind::kNpz;
  if (fs::is_directory(found) ? !holds_files(found, ".npz") : found.extension() == ".npy") {
    const bool pairs = fs::is_directory(found) ? holds_npy_pairs(found) : is_npy_pair(found);
    kind = pairs ? ColumnFileKind::kNpyPair : ColumnFileKind::kNpy;
  }
  return std::make_unique<ColumnDataset>(kind, found, options);
}

std::unique_ptr<Dataset> open_csv(const fs::path& found, const OpenOptions& options) {
  return std::make_unique<ColumnDataset>(ColumnFileKind::kCsv, found, options);
}

std::unique_ptr<Dataset> open_pcd(const fs::path& found, const OpenOptions& options) {
  return std::make_unique<ColumnDataset>(ColumnFileKind::kPcd, found, options);
}

std::unique_ptr<Dataset> open_ply(const fs::path& found, const OpenOptions& options) {
  return std::make_unique<ColumnDataset>(ColumnFileKind::kPly, found, options);
}

}  // namespace dynamic_icp::datasets
