// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_dataset.hpp"

#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

/// Seconds after the stamp, one float32 per point.
std::vector<double> read_times(const fs::path& path, const RawScan& scan, const fs::path& scan_file) {
  const std::size_t points = scan.points.size();
  formats::RecordFile file(path, sizeof(float));
  if (file.records() != points || (points > 0 && !file.warning().empty())) {
    // A scan that was cut has fewer points than it had times; so has one that is empty, or ends within a record.
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

class RecordDataset final : public Dataset {
 public:
  explicit RecordDataset(RecordRecording recording) : recording_(std::move(recording)) {}

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
      raw.times = read_times(recording_.times / file.filename(), raw, file);
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
  RecordRecording recording_;
};

}  // namespace

std::unique_ptr<Dataset> make_record_dataset(RecordRecording recording) {
  return std::make_unique<RecordDataset>(std::move(recording));
}

}  // namespace dynamic_icp::datasets
