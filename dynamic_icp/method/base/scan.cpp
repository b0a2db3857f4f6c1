// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/scan.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp {
namespace {

enum class Verdict { kKept, kNonFinite, kImplausible, kZeroRange, kOutOfRange, kFlagged };

/// What becomes of one record.
struct Record {
  Verdict verdict;
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
  double doppler;
};

/// Its square is neither so small nor so large that digits are lost; false for NaN.
bool is_ordinary(double squared_length) { return squared_length > 1e-24 && squared_length < 1e300; }

/// Its length; stableNorm, because directions beyond 1e154 must not turn into an infinite length unnoticed.
double length_of(const Eigen::Vector3d& line_of_sight) {
  const double squared = line_of_sight.squaredNorm();
  return is_ordinary(squared) ? std::sqrt(squared) : line_of_sight.stableNorm();
}

/// From the sensor that measured the point to the point, any length.
Eigen::Vector3d line_of_sight(const ScanView& raw, std::size_t i, const Eigen::Vector3d& point) {
  if (!raw.directions.empty()) {
    return raw.directions[i];
  }
  return raw.mountings.empty() ? point : Eigen::Vector3d(point - raw.mountings[raw.sensor[i]].translation());
}

Record evaluate(const ScanView& raw, std::size_t i, const Scan::RangeLimits& limits, const TimeWindow& window) {
  const Eigen::Vector3d point = raw.points[i];
  const Eigen::Vector3d sight = line_of_sight(raw, i, point);
  const double doppler = raw.doppler[i];
  const double length = length_of(sight);
  const auto record = [&](Verdict verdict) { return Record{verdict, point, sight / length, doppler}; };
  if (!raw.is_unusable.empty() && raw.is_unusable[i] != 0) {
    return record(Verdict::kFlagged);
  }
  const bool plausible = std::abs(point.x()) <= kMaxCoordinate_m && std::abs(point.y()) <= kMaxCoordinate_m &&
                         std::abs(point.z()) <= kMaxCoordinate_m && std::abs(doppler) <= kMaxDoppler_mps &&
                         std::isfinite(length) && (raw.times.empty() || window.contains(raw.times[i]));
  if (!plausible) {
    const bool finite = point.allFinite() && std::isfinite(doppler) && std::isfinite(length) &&
                        (raw.times.empty() || std::isfinite(raw.times[i]));
    return record(finite ? Verdict::kImplausible : Verdict::kNonFinite);
  }
  if (length < 1e-12 || point.isZero(0.0)) {
    return record(Verdict::kZeroRange);
  }
  const bool from_origin = raw.directions.empty() && raw.mountings.empty();
  const double range = from_origin ? length : point.norm();
  return record(range >= limits.min_m && range <= limits.max_m ? Verdict::kKept : Verdict::kOutOfRange);
}

void count(Verdict verdict, Scan::Dropped& dropped) {
  dropped.non_finite += verdict == Verdict::kNonFinite ? 1 : 0;
  dropped.implausible += verdict == Verdict::kImplausible ? 1 : 0;
  dropped.zero_range += verdict == Verdict::kZeroRange ? 1 : 0;
  dropped.out_of_range += verdict == Verdict::kOutOfRange ? 1 : 0;
  dropped.flagged += verdict == Verdict::kFlagged ? 1 : 0;
}

/// Moves rows of a column to a place before them; an empty column stays empty.
template <class Value>
void move_within(std::vector<Value>& column, std::size_t from, std::size_t to, std::size_t count) {
  if (from != to && !column.empty()) {
    const auto first = column.begin() + static_cast<std::ptrdiff_t>(from);
    std::copy(first, first + static_cast<std::ptrdiff_t>(count), column.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

/// Copies a value of an optional column.
template <class Value>
void copy_value(std::span<const Value> from, std::size_t i, std::vector<Value>& to, std::size_t row) {
  if (!from.empty()) {
    to[row] = from[i];
  }
}

}  // namespace

Scan Scan::from_raw(const ScanView& raw, Dropped* dropped) { return from_raw(raw, {}, Workers(1), dropped); }

Scan Scan::from_raw(const ScanView& raw, const RangeLimits& limits, const Workers& workers, Dropped* dropped) {
  Scan scan;
  scan.assign(raw, limits, workers, dropped);
  return scan;
}

void Scan::assign(const ScanView& raw, const RangeLimits& limits, const Workers& workers, Dropped* dropped) {
  check_columns(raw);
  const TimeWindow window = plausible_times(raw.times);
  const std::size_t n = raw.points.size();
  stamp_ = raw.stamp;
  doppler_kind_ = raw.doppler_kind;
  mountings_.assign(raw.mountings.begin(), raw.mountings.end());
  resize(n, raw);
  // Each block fills the beginning of its own rows; gaps, which are rare, are closed afterwards.
  std::vector<Dropped> counts(Workers::block_count(n, kPointBlock));
  workers.for_blocks(n, kPointBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::size_t row = begin;
    for (std::size_t i = begin; i < end; ++i) {
      const Record record = evaluate(raw, i, limits, window);
      if (record.verdict != Verdict::kKept) {
        count(record.verdict, counts[block]);
        continue;
      }
      points_[row] = record.point;
      directions_[row] = record.direction;
      doppler_[row] = record.doppler;
      if (!raw.times.empty()) {
        times_[row] = raw.times[i];
      }
      records_[row] = static_cast<std::uint32_t>(i);
      copy_value(raw.sensor, i, channels_.sensor, row);
      copy_value(raw.line, i, channels_.line, row);
      copy_value(raw.face, i, channels_.face, row);
      if (!raw.intensity.empty()) {  // one that is no number must not take the point with it, nor the mean of others
        channels_.intensity[row] = std::isfinite(raw.intensity[i]) ? raw.intensity[i] : 0.0F;
      }
      copy_value(raw.return_number, i, channels_.return_number, row);
      ++row;
    }
  });
  Dropped sum;
  std::size_t rows = 0;
  for (std::size_t block = 0; block < counts.size(); ++block) {
    const Dropped& lost = counts[block];
    const std::size_t begin = block * kPointBlock;
    const std::size_t kept = std::min(n, begin + kPointBlock) - begin - lost.total();
    for_each_column([&](auto& column) { move_within(column, begin, rows, kept); });
    rows += kept;
    sum += lost;
  }
  for_each_column([&](auto& column) { column.resize(column.empty() ? 0 : rows); });
  if (dropped != nullptr) {
    *dropped = sum;
  }
}

Scan::Dropped& Scan::Dropped::operator+=(const Dropped& other) {
  non_finite += other.non_finite;
  implausible += other.implausible;
  zero_range += other.zero_range;
  out_of_range += other.out_of_range;
  flagged += other.flagged;
  return *this;
}

template <class Visit>
void Scan::for_each_column(Visit visit) {
  visit(points_);
  visit(directions_);
  visit(doppler_);
  visit(times_);
  visit(records_);
  visit(channels_.sensor);
  visit(channels_.line);
  visit(channels_.face);
  visit(channels_.intensity);
  visit(channels_.return_number);
}

void Scan::resize(std::size_t rows, const ScanView& raw) {
  points_.resize(rows);
  directions_.resize(rows);
  doppler_.resize(rows);
  times_.resize(raw.times.empty() ? 0 : rows);
  records_.resize(rows);
  channels_.sensor.resize(raw.sensor.empty() ? 0 : rows);
  channels_.line.resize(raw.line.empty() ? 0 : rows);
  channels_.face.resize(raw.face.empty() ? 0 : rows);
  channels_.intensity.resize(raw.intensity.empty() ? 0 : rows);
  channels_.return_number.resize(raw.return_number.empty() ? 0 : rows);
}

Scan Scan::transformed(const Eigen::Isometry3d& T_target_this) const {
  Scan result = *this;
  for (std::size_t row = 0; row < size(); ++row) {
    const Eigen::Vector3d direction = T_target_this.linear() * directions_[row];
    result.points_[row] = T_target_this * points_[row];
    result.directions_[row] = direction / length_of(direction);
  }
  for (Eigen::Isometry3d& T_scan_sensor : result.mountings_) {
    T_scan_sensor = T_target_this * T_scan_sensor;
  }
  return result;
}

Scan Scan::select(std::span<const std::uint32_t> rows) const {
  Scan result;
  result.stamp_ = stamp_;
  result.doppler_kind_ = doppler_kind_;
  result.mountings_ = mountings_;
  const auto select = [&](const auto& from, auto& to) {
    if (from.empty()) {
      return;
    }
    to.reserve(rows.size());
    for (const std::uint32_t row : rows) {
      to.push_back(from[row]);
    }
  };
  select(points_, result.points_);
  select(directions_, result.directions_);
  select(doppler_, result.doppler_);
  select(times_, result.times_);
  select(records_, result.records_);
  select(channels_.sensor, result.channels_.sensor);
  select(channels_.line, result.channels_.line);
  select(channels_.face, result.channels_.face);
  select(channels_.intensity, result.channels_.intensity);
  select(channels_.return_number, result.channels_.return_number);
  return result;
}

void Scan::state(StateArchive& archive) {
  archive(stamp_, doppler_kind_, points_, directions_, doppler_, times_, records_, channels_.sensor, channels_.line,
          channels_.face);
  archive.any_numbers(channels_.intensity);
  archive(channels_.return_number, mountings_);
  check_read(archive);
}

/// Whether `from_raw` may have made it, or `transformed` of that.
void Scan::check_read(const StateArchive& archive) {
  if (!archive.reads()) {
    return;
  }
  const auto is_point = [](const Eigen::Vector3d& point) {
    return point.squaredNorm() > 0.0 && point.cwiseAbs().maxCoeff() <= 4.0 * kMaxCoordinate_m;
  };
  const auto is_direction = [](const Eigen::Vector3d& u) { return std::abs(u.squaredNorm() - 1.0) < 1e-3; };
  for_each_column([&](const auto& column) { archive.require(column.empty() || column.size() == size(), "a column"); });
  archive.require(directions_.size() == size() && doppler_.size() == size() && records_.size() == size(), "a column");
  archive.require(std::ranges::all_of(points_, is_point), "a point");
  archive.require(std::ranges::all_of(directions_, is_direction), "a line of sight");
  archive.require(
      std::ranges::all_of(doppler_, [](double doppler) { return std::abs(doppler) <= 2.0 * kMaxDoppler_mps; }),
      "a Doppler value");
  archive.require(std::ranges::all_of(times_, [](double time_s) { return std::abs(time_s) <= 4.0 * kMaxPointTime_s; }),
                  "a time of a point");
  archive.require(
      mountings_.empty() ||
          (channels_.sensor.size() == size() &&
           std::ranges::all_of(channels_.sensor, [&](std::uint8_t one) { return one < mountings_.size(); })),
      "a sensor of a point");
}

}  // namespace dynamic_icp
