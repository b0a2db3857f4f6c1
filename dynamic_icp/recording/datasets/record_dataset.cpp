// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_dataset.hpp"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"
#include "dynamic_icp/recording/datasets/point_times.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

const TimeUnit kSeconds{1'000'000'000, false, {}};
constexpr std::size_t kScansWithTimes = 20;  // for times

/// As stored, one float32 per point.
std::vector<double> read_times(const fs::path& path, const RawScan& scan, const fs::path& scan_file) {
  const std::size_t points = scan.points.size();
  formats::RecordFile file(path, sizeof(float));
  if (file.records() != points || (points > 0 && !file.warning().empty())) {
    // A scan that was cut has fewer points than it had times; so has one that is empty, or ends within a record.
    if (file.records() == 2 * points && file.warning().empty() && scan.warning.empty()) {
      throw DataError(
          fmt::format("{}: {} bytes for the {} points of {}, expected 4 a point, float32: are they float64?",
                      path.string(), 2 * sizeof(float) * points, points, scan_file.string()));
    }
    const bool is_cut = !scan.warning.empty() || points < file.records();
    throw DataError(is_cut ? fmt::format("{}: {} points, expected {} as there are times in {}: the scan is cut short{}",
                                         scan_file.string(), points, file.records(), path.string(),
                                         scan.warning.empty() ? "" : fmt::format(" ({})", scan.warning))
                           : fmt::format("{}: {} times for the {} points of {}, expected one float32 per point",
                                         path.string(), file.records(), points, scan_file.string()));
  }
  std::vector<double> times;
  times.reserve(points);
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    for (std::size_t at = 0; at < block.size(); at += sizeof(float)) {
      times.push_back(formats::value_at<float>(block, at));
    }
  }
  return times;
}

/// The times as the array that says their unit.
formats::NpyArray times_as_stored(const std::vector<double>& times) {
  return formats::array_of(formats::NpyType::kFloat32, {times.size()}, times);
}

/// Before and after nine tenths of the times in a file; empty where there are too few, or the file is not there.
std::vector<double> ends_of_times(const fs::path& path) {
  std::error_code missing;
  std::vector<double> times;
  if (fs::file_size(path, missing) < 2 * sizeof(float) || missing) {
    return times;
  }
  formats::RecordFile file(path, sizeof(float));
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    for (std::size_t at = 0; at < block.size(); at += sizeof(float)) {
      if (const double time = formats::value_at<float>(block, at); std::isfinite(time)) {
        times.push_back(time);
      }
    }
  }
  if (times.size() < 2) {
    return {};
  }
  std::sort(times.begin(), times.end());
  const std::size_t odd = times.size() / 20;
  return {times[odd], times[times.size() - 1 - odd]};
}

class RecordDataset final : public Dataset {
 public:
  explicit RecordDataset(RecordRecording recording) : recording_(std::move(recording)) {
    if (!recording_.times.empty()) {
      find_unit_of_times();
    }
  }

  [[nodiscard]] std::string_view format() const override { return recording_.format; }
  [[nodiscard]] std::size_t size() const override { return recording_.scans.files.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return recording_.scans.stamps.at(index); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return recording_.scans.files.at(index); }
  [[nodiscard]] DopplerKind doppler_kind() const override { return recording_.doppler_kind; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return recording_.truth.poses; }
  [[nodiscard]] fs::path ground_truth_file() const override { return recording_.truth.file; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return recording_.scans.assumptions; }

  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override {
    return recording_.T_vehicle_sensor;
  }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    const fs::path& file = recording_.scans.files.at(index);
    const formats::RecordLayout& layout = recording_.layout_of(file, recording_.scans.stamps[index]);
    RawScan raw = formats::read_points(file, layout);
    refuse_foreign_numbers(raw, file, layout);
    raw.stamp = recording_.scans.stamps[index];
    raw.doppler_kind = recording_.doppler_kind;
    if (!recording_.times.empty()) {
      raw.times = times_after(raw.stamp, times_as_stored(read_times(recording_.times / file.filename(), raw, file)),
                              unit_of_times_);
    }
    if (recording_.correct) {
      recording_.correct(raw, file);
    }
    return raw;
  }

  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override {
    const fs::path& file = recording_.scans.files.at(index);
    const formats::RecordLayout& layout = recording_.layout_of(file, recording_.scans.stamps[index]);
    std::vector<PointColumn> columns;
    for (const formats::RecordField& field : layout.fields) {
      columns.push_back({std::string(field.name), formats::read_field(file, layout, field), field.is_integer});
    }
    return columns;
  }

 private:
  /// Seconds, unless the first scan that has times spans most of a period in another unit; a few odd times say nothing.
  void find_unit_of_times() {
    StampedFiles& scans = recording_.scans;
    for (std::size_t i = 0; i + 1 < std::min(kScansWithTimes, scans.files.size()); ++i) {
      const std::vector<double> ends = ends_of_times(recording_.times / scans.files[i].filename());
      if (ends.empty()) {
        continue;
      }
      const double period_s = seconds_between(scans.stamps[i], scans.stamps[i + 1]);
      const TimeUnit unit = time_unit(recording_.times.filename().string(), times_as_stored(ends), period_s);
      const double span_s = 1e-9 * static_cast<double>(unit.ns) * (ends[1] - ends[0]);
      if (unit.ns != kSeconds.ns && !unit.is_unix && span_s > 0.1 * period_s && span_s < 2.0 * period_s) {
        unit_of_times_ = unit;
        scans.assumptions.push_back(unit.assumption);
      }
      return;
    }
  }

  RecordRecording recording_;
  TimeUnit unit_of_times_ = kSeconds;
};

}  // namespace

std::unique_ptr<Dataset> make_record_dataset(RecordRecording recording) {
  return std::make_unique<RecordDataset>(std::move(recording));
}

}  // namespace dynamic_icp::datasets
