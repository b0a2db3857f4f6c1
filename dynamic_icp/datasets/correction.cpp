// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/datasets/correction.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::array<int, 4> kInOrder = {0, 1, 2, 3};

void check_scale(const char* what, double scale) {
  if (!(std::isfinite(scale) && scale > 0.0)) {
    throw UsageError(fmt::format("{} is {}, expected a finite number above 0", what, scale));
  }
}

void reorder_columns(RawScan& scan, const std::array<int, 4>& columns) {
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d p = scan.points[i];
    const std::array<double, 4> read = {p.x(), p.y(), p.z(), scan.doppler.at(i)};
    const auto column = [&](std::size_t k) { return read[static_cast<std::size_t>(columns[k])]; };
    scan.points[i] = {column(0), column(1), column(2)};
    scan.doppler[i] = column(3);
  }
  if (columns[3] != 3) {
    scan.directions.clear();
  }
  for (Eigen::Vector3d& direction : scan.directions) {
    direction = Eigen::Vector3d(direction[columns[0]], direction[columns[1]], direction[columns[2]]);
  }
}

class CorrectedDataset final : public Dataset {
 public:
  CorrectedDataset(std::unique_ptr<Dataset> dataset, const Correction& correction)
      : dataset_(std::move(dataset)), correction_(correction), ground_truth_(dataset_->ground_truth()) {
    if (correction_.time_scale != 1.0 && stamped_by_scans()) {
      for (formats::StampedPose& pose : ground_truth_) {
        pose.stamp = scaled(pose.stamp);
      }
    }
  }

  [[nodiscard]] std::string_view format() const override { return dataset_->format(); }
  [[nodiscard]] std::size_t size() const override { return dataset_->size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return scaled(dataset_->stamp(index)); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return dataset_->scan_file(index); }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    RawScan scan = corrected(dataset_->scan(index), correction_);
    scan.stamp = scaled(scan.stamp);
    return scan;
  }

  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override { return dataset_->columns(index); }

  [[nodiscard]] DopplerKind doppler_kind() const override {
    return correction_.doppler_kind.value_or(dataset_->doppler_kind());
  }

  [[nodiscard]] std::optional<std::vector<AnnotatedBox>> boxes(std::size_t index) const override {
    return dataset_->boxes(index);
  }

  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return ground_truth_; }
  [[nodiscard]] fs::path ground_truth_file() const override { return dataset_->ground_truth_file(); }

  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override {
    return dataset_->T_vehicle_sensor();
  }

  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return dataset_->assumptions(); }

 private:
  [[nodiscard]] Stamp scaled(Stamp stamp) const {
    if (correction_.time_scale == 1.0) {
      return stamp;  // exact, however long the recording is
    }
    const Stamp first = dataset_->stamp(0);
    // Not by way of a double: the nanoseconds of a long recording fit into a long double.
    const auto since_first = static_cast<long double>(stamp.ns - first.ns);
    return {first.ns + std::llround(since_first * static_cast<long double>(correction_.time_scale))};
  }

  [[nodiscard]] bool stamped_by_scans() const {
    std::set<Stamp> stamps;
    for (std::size_t i = 0; i < dataset_->size(); ++i) {
      stamps.insert(dataset_->stamp(i));
    }
    return std::all_of(ground_truth_.begin(), ground_truth_.end(),
                       [&](const formats::StampedPose& pose) { return stamps.contains(pose.stamp); });
  }

  std::unique_ptr<Dataset> dataset_;
  Correction correction_;
  formats::Trajectory ground_truth_;
};

}  // namespace

void check(const Correction& correction) {
  check_scale("the scale of the Doppler", correction.doppler_scale);
  check_scale("the scale of the points", correction.point_scale);
  check_scale("the scale of the time", correction.time_scale);
  std::array<int, 4> sorted = correction.columns;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != kInOrder) {
    throw UsageError(
        fmt::format("the columns are {}, expected each of 0, 1, 2, 3 once", fmt::join(correction.columns, ", ")));
  }
}

RawScan corrected(RawScan scan, const Correction& correction) {
  if (correction.columns != kInOrder) {
    reorder_columns(scan, correction.columns);
  }
  if (correction.point_scale != 1.0) {
    for (Eigen::Vector3d& point : scan.points) {
      point *= correction.point_scale;
    }
  }
  const double doppler_factor = (correction.doppler_is_towards ? -1.0 : 1.0) * correction.doppler_scale;
  if (doppler_factor != 1.0) {
    for (double& doppler : scan.doppler) {
      doppler *= doppler_factor;
    }
  }
  if (correction.time_scale != 1.0) {
    for (double& time : scan.times) {
      time *= correction.time_scale;
    }
  }
  scan.doppler_kind = correction.doppler_kind.value_or(scan.doppler_kind);
  return scan;
}

std::unique_ptr<Dataset> corrected(std::unique_ptr<Dataset> dataset, const Correction& correction) {
  check(correction);
  if (correction == Correction{}) {
    return dataset;
  }
  return std::make_unique<CorrectedDataset>(std::move(dataset), correction);
}

}  // namespace dynamic_icp::datasets
