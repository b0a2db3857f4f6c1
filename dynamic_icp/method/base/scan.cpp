// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/scan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp {
namespace {

void check_lengths(const RawScan& raw) {
  const std::size_t n = raw.points.size();
  const bool matching = raw.doppler.size() == n && (raw.times.empty() || raw.times.size() == n) &&
                        (raw.directions.empty() || raw.directions.size() == n);
  if (!matching) {
    throw std::invalid_argument("scan columns differ in length: " + std::to_string(n) + " points, " +
                                std::to_string(raw.doppler.size()) + " Doppler values, " +
                                std::to_string(raw.times.size()) + " times, " + std::to_string(raw.directions.size()) +
                                " directions");
  }
}

constexpr std::size_t kBlock = 4096;

enum class Verdict { kKept, kNonFinite, kImplausible, kZeroRange, kOutOfRange };

/// What becomes of one record.
struct Record {
  Verdict verdict;
  Eigen::Vector3d direction;
};

/// Its square is neither so small nor so large that digits are lost; false for NaN.
bool is_ordinary(double squared_length) { return squared_length > 1e-24 && squared_length < 1e300; }

/// Its length; stableNorm, because directions beyond 1e154 must not turn into an infinite length unnoticed.
double length_of(const Eigen::Vector3d& line_of_sight) {
  const double squared = line_of_sight.squaredNorm();
  return is_ordinary(squared) ? std::sqrt(squared) : line_of_sight.stableNorm();
}

/// What a record that exceeds some limit is counted as.
Verdict beyond_limits(const RawScan& raw, std::size_t i, double length) {
  const bool finite = raw.points[i].allFinite() && std::isfinite(raw.doppler[i]) && std::isfinite(length) &&
                      (raw.times.empty() || std::isfinite(raw.times[i]));
  return finite ? Verdict::kImplausible : Verdict::kNonFinite;
}

Record evaluate(const RawScan& raw, std::size_t i, const Scan::RangeLimits& limits, const TimeWindow& window) {
  const Eigen::Vector3d& point = raw.points[i];
  const Eigen::Vector3d& line_of_sight = raw.directions.empty() ? point : raw.directions[i];
  const double length = length_of(line_of_sight);
  const bool plausible = std::abs(point.x()) <= kMaxCoordinate_m && std::abs(point.y()) <= kMaxCoordinate_m &&
                         std::abs(point.z()) <= kMaxCoordinate_m && std::abs(raw.doppler[i]) <= kMaxDoppler_mps &&
                         std::isfinite(length) && (raw.times.empty() || window.contains(raw.times[i]));
  if (!plausible) {
    return {beyond_limits(raw, i, length), line_of_sight};
  }
  if (length < 1e-12 || point.isZero(0.0)) {
    return {Verdict::kZeroRange, line_of_sight};
  }
  const double range = raw.directions.empty() ? length : point.norm();
  const bool in_range = range >= limits.min_m && range <= limits.max_m;
  return {in_range ? Verdict::kKept : Verdict::kOutOfRange, line_of_sight / length};
}

}  // namespace

Scan Scan::from_raw(const RawScan& raw, Dropped* dropped) { return from_raw(raw, {}, Workers(1), dropped); }

Scan Scan::from_raw(const RawScan& raw, const RangeLimits& limits, const Workers& workers, Dropped* dropped) {
  Scan scan;
  scan.assign(raw, limits, workers, dropped);
  return scan;
}

void Scan::assign(const RawScan& raw, const RangeLimits& limits, const Workers& workers, Dropped* dropped) {
  check_lengths(raw);
  const TimeWindow window = plausible_times(raw.times);
  const std::size_t n = raw.points.size();
  stamp_ = raw.stamp;
  doppler_kind_ = raw.doppler_kind;
  resize(n, !raw.times.empty());
  // Each block fills the beginning of its own rows; gaps, which are rare, are closed afterwards.
  std::vector<Dropped> counts(Workers::block_count(n, kBlock));
  workers.for_blocks(n, kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    Dropped& count = counts[block];
    std::size_t row = begin;
    for (std::size_t i = begin; i < end; ++i) {
      const Record record = evaluate(raw, i, limits, window);
      if (record.verdict != Verdict::kKept) {
        count.non_finite += record.verdict == Verdict::kNonFinite ? 1 : 0;
        count.implausible += record.verdict == Verdict::kImplausible ? 1 : 0;
        count.zero_range += record.verdict == Verdict::kZeroRange ? 1 : 0;
        count.out_of_range += record.verdict == Verdict::kOutOfRange ? 1 : 0;
        continue;
      }
      points_[row] = raw.points[i];
      directions_[row] = record.direction;
      doppler_[row] = raw.doppler[i];
      if (!raw.times.empty()) {
        times_[row] = raw.times[i];
      }
      records_[row] = static_cast<std::uint32_t>(i);
      ++row;
    }
  });
  Dropped sum;
  std::size_t rows = 0;
  for (std::size_t block = 0; block < counts.size(); ++block) {
    const Dropped& count = counts[block];
    const std::size_t begin = block * kBlock;
    const std::size_t kept = std::min(n, begin + kBlock) - begin - count.total();
    move_rows(begin, rows, kept);
    rows += kept;
    sum += count;
  }
  resize(rows, !raw.times.empty());
  if (dropped != nullptr) {
    *dropped = sum;
  }
}

Scan::Dropped& Scan::Dropped::operator+=(const Dropped& other) {
  non_finite += other.non_finite;
  implausible += other.implausible;
  zero_range += other.zero_range;
  out_of_range += other.out_of_range;
  return *this;
}

void Scan::resize(std::size_t rows, bool with_times) {
  points_.resize(rows);
  directions_.resize(rows);
  doppler_.resize(rows);
  times_.resize(with_times ? rows : 0);
  records_.resize(rows);
}

/// Moves rows to a place before them.
void Scan::move_rows(std::size_t from, std::size_t to, std::size_t count) {
  const auto move = [&](auto& column) {
    const auto first = column.begin() + static_cast<std::ptrdiff_t>(from);
    std::copy(first, first + static_cast<std::ptrdiff_t>(count), column.begin() + static_cast<std::ptrdiff_t>(to));
  };
  if (from != to) {
    move(points_);
    move(directions_);
    move(doppler_);
    if (has_times()) {
      move(times_);
    }
    move(records_);
  }
}

Scan Scan::transformed(const Eigen::Isometry3d& T_target_this) const {
  Scan result = *this;
  for (std::size_t row = 0; row < size(); ++row) {
    const Eigen::Vector3d direction = T_target_this.linear() * directions_[row];
    result.points_[row] = T_target_this * points_[row];
    result.directions_[row] = direction / length_of(direction);
  }
  return result;
}

Scan Scan::select(std::span<const std::uint32_t> rows) const {
  Scan result;
  result.stamp_ = stamp_;
  result.doppler_kind_ = doppler_kind_;
  result.points_.reserve(rows.size());
  result.directions_.reserve(rows.size());
  result.doppler_.reserve(rows.size());
  result.times_.reserve(has_times() ? rows.size() : 0);
  result.records_.reserve(rows.size());
  for (const std::uint32_t row : rows) {
    result.points_.push_back(points_[row]);
    result.directions_.push_back(directions_[row]);
    result.doppler_.push_back(doppler_[row]);
    if (has_times()) {
      result.times_.push_back(times_[row]);
    }
    result.records_.push_back(records_[row]);
  }
  return result;
}

}  // namespace dynamic_icp
