// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/correction.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/spherical_fields.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr long double kStampEnd = 9223372036854775808.0L;  // ns, the first that 64 bits do not hold

void check_scale(const char* what, std::optional<double> scale) {
  if (scale && !(std::isfinite(*scale) && *scale > 0.0)) {
    throw UsageError(fmt::format("{} is {}, expected a finite number above 0", what, *scale));
  }
}

/// The axes of the sensors change as those of the scan do, so that swapped axes leave a mounting a rotation.
void reorder_axes(std::vector<Eigen::Isometry3d>& mountings, const std::array<int, 4>& columns) {
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    P(axis, columns[static_cast<std::size_t>(axis)]) = 1.0;
  }
  for (Eigen::Isometry3d& T_scan_sensor : mountings) {
    T_scan_sensor.linear() = P * T_scan_sensor.linear() * P.transpose();
    T_scan_sensor.translation() = P * T_scan_sensor.translation();
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
    scan.mountings.clear();
    return;
  }
  reorder_axes(scan.mountings, columns);
  for (Eigen::Vector3d& direction : scan.directions) {
    direction = Eigen::Vector3d(direction[columns[0]], direction[columns[1]], direction[columns[2]]);
  }
}

void make_spherical_cartesian(RawScan& scan, double radians_per_unit) {
  for (Eigen::Vector3d& point : scan.points) {
    point = from_spherical(radians_per_unit * point.x(), radians_per_unit * point.y(), point.z());
  }
  scan.directions.clear();
  scan.mountings.clear();
}

class CorrectedDataset final : public Dataset {
 public:
  CorrectedDataset(std::unique_ptr<Dataset> dataset, const Correction& correction)
      : dataset_(std::move(dataset)),
        correction_(correction),
        time_scale_(correction.time_scale.value_or(1.0)),
        ground_truth_(dataset_->ground_truth()) {
    for (std::size_t i = 0; i < dataset_->size(); ++i) {
      const Stamp stamp = dataset_->stamp(i);
      stamps_.emplace(stamp, scaled(stamp, i));
    }
    if (stamped_by_scans()) {
      for (formats::StampedPose& pose : ground_truth_) {
        pose.stamp = stamps_.at(pose.stamp);
      }
    }
  }

  [[nodiscard]] std::string_view format() const override { return dataset_->format(); }
  [[nodiscard]] std::size_t size() const override { return dataset_->size(); }
  /// Not looked up: a recording that grows gets more.
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return scaled(dataset_->stamp(index), index); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return dataset_->scan_file(index); }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    RawScan scan = corrected(dataset_->scan(index), correction_);
    scan.stamp = stamp(index);
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
  /// The stamp of a scan with its time since the first scan scaled. Throws DataError where no stamp can say it.
  [[nodiscard]] Stamp scaled(Stamp stamp, std::size_t index) const {
    if (time_scale_ == 1.0) {
      return stamp;  // exact, however long the recording is
    }
    const Stamp first = dataset_->stamp(0);
    // Not by way of a double: the nanoseconds of a long recording fit into a long double.
    const long double since_first = static_cast<long double>(stamp.ns) - static_cast<long double>(first.ns);
    const long double ns = std::round(since_first * static_cast<long double>(time_scale_));
    Stamp result;
    if (std::abs(ns) >= kStampEnd || __builtin_add_overflow(first.ns, static_cast<std::int64_t>(ns), &result.ns)) {
      throw DataError(fmt::format(
          "{}: scan {} is {:.9g} s after the first one; {:.9g} times that is beyond what a time stamp holds (292 "
          "years)",
          dataset_->scan_file(index).string(), index, static_cast<double>(since_first) * 1e-9, time_scale_));
    }
    return result;
  }

  [[nodiscard]] bool stamped_by_scans() const {
    return std::all_of(ground_truth_.begin(), ground_truth_.end(),
                       [&](const formats::StampedPose& pose) { return stamps_.contains(pose.stamp); });
  }

  std::unique_ptr<Dataset> dataset_;
  Correction correction_;
  double time_scale_;
  std::map<Stamp, Stamp> stamps_;  ///< of the scans that were there when it was opened, by those of the recording
  formats::Trajectory ground_truth_;
};

}  // namespace

void Correction::apply(const Correction& other) {
  const auto assign = [](auto& value, const auto& from) { value = from ? from : value; };
  assign(doppler_kind, other.doppler_kind);
  assign(doppler_sign, other.doppler_sign);
  assign(doppler_scale, other.doppler_scale);
  assign(point_scale, other.point_scale);
  assign(time_scale, other.time_scale);
  assign(columns, other.columns);
  assign(coordinates, other.coordinates);
}

void check(const Correction& correction) {
  check_scale("the scale of the Doppler", correction.doppler_scale);
  check_scale("the scale of the points", correction.point_scale);
  check_scale("the scale of the time", correction.time_scale);
  const std::array<int, 4> columns = correction.columns.value_or(Correction::kInOrder);
  if (!std::is_permutation(columns.begin(), columns.end(), Correction::kInOrder.begin())) {
    throw UsageError(fmt::format("the columns are {}, expected each of 0, 1, 2, 3 once", fmt::join(columns, ", ")));
  }
}

RawScan corrected(RawScan scan, const Correction& correction) {
  if (correction.columns && *correction.columns != Correction::kInOrder) {
    reorder_columns(scan, *correction.columns);
  }
  if (const Coordinates stored = correction.coordinates.value_or(Coordinates::kCartesian);
      stored != Coordinates::kCartesian) {
    make_spherical_cartesian(scan, stored == Coordinates::kSphericalDegrees ? std::numbers::pi / 180.0 : 1.0);
  }
  if (correction.point_scale) {
    for (Eigen::Vector3d& point : scan.points) {
      point *= *correction.point_scale;
    }
    for (Eigen::Isometry3d& T_scan_sensor : scan.mountings) {
      T_scan_sensor.translation() *= *correction.point_scale;
    }
  }
  const double sign = correction.doppler_sign == DopplerSign::kTowards ? -1.0 : 1.0;
  const double doppler_factor = sign * correction.doppler_scale.value_or(1.0);
  if (doppler_factor != 1.0) {
    for (double& doppler : scan.doppler) {
      doppler *= doppler_factor;
    }
  }
  if (correction.time_scale) {
    for (double& time : scan.times) {
      time *= *correction.time_scale;
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
