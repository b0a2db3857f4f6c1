// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_dataset.hpp"

#include <utility>

#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

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
