// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/eigen_layout.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp {

class StateArchive;

/// The set P_t of the paper, Eq. (1): points p_i, lines of sight u_i and Doppler velocities s_i of one scan, with the
/// time each was measured and the record of the file it came from.
///
/// The columns belong together: a scan can only be made whole and only be reduced or reordered by whole rows, so no
/// stage can separate a point from its measurement. Moving a point (`displace`) leaves line of sight and Doppler as
/// they were measured, which is what the method needs of predicted points.
///
/// Guarantees: every value is finite and within the limits of scan_limits.hpp; |u_i| = 1; all columns have `size()`
/// rows (`times` may be empty instead).
class Scan {
 public:
  /// Why records of a scan as read did not become rows of the Scan.
  struct Dropped {
    std::size_t non_finite = 0;    ///< NaN or infinity in a coordinate, the Doppler, the time or the direction
    std::size_t implausible = 0;   ///< finite, but beyond what a measurement can be (scan_limits.hpp)
    std::size_t zero_range = 0;    ///< at the sensor's origin: no line of sight
    std::size_t out_of_range = 0;  ///< nearer or farther than the limits
    std::size_t flagged = 0;       ///< the sensor itself says that they are no measurements

    [[nodiscard]] std::size_t total() const { return non_finite + implausible + zero_range + out_of_range + flagged; }
    Dropped& operator+=(const Dropped& other);
  };

  /// The distances from the sensor's origin that points may have, m; both belong to it.
  struct RangeLimits {
    double min_m = 0.0;
    double max_m = std::numeric_limits<double>::infinity();
  };

  Scan() = default;

  /// Takes over the records that are finite, plausible and away from the origin and counts the others in `dropped` (if
  /// given). Throws std::invalid_argument when the columns differ in length (check_columns).
  static Scan from_raw(const ScanView& raw, Dropped* dropped = nullptr);

  /// The same for what is within the limits, by several threads.
  static Scan from_raw(const ScanView& raw, const RangeLimits& limits, const Workers& workers,
                       Dropped* dropped = nullptr);

  /// The same in the place of what this scan was, whose memory is used again.
  void assign(const ScanView& raw, const RangeLimits& limits, const Workers& workers, Dropped* dropped = nullptr);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] bool has_times() const { return !times_.empty(); }
  [[nodiscard]] Stamp stamp() const { return stamp_; }
  [[nodiscard]] DopplerKind doppler_kind() const { return doppler_kind_; }

  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }          ///< m, sensor frame
  [[nodiscard]] const std::vector<Eigen::Vector3d>& directions() const { return directions_; }  ///< unit, as measured
  [[nodiscard]] const std::vector<double>& doppler() const { return doppler_; }                 ///< m/s, + away
  [[nodiscard]] const std::vector<double>& times() const { return times_; }                     ///< s after stamp
  [[nodiscard]] const std::vector<std::uint32_t>& records() const { return records_; }  ///< row of the scan as read
  [[nodiscard]] const Channels& channels() const { return channels_; }

  /// T_scan_sensor of the sensors of a rig, by `channels().sensor`; empty: one sensor at the origin.
  [[nodiscard]] const std::vector<Eigen::Isometry3d>& mountings() const { return mountings_; }

  /// The rows named by `rows`, in that order.
  [[nodiscard]] Scan select(std::span<const std::uint32_t> rows) const;

  /// The same rows seen from another frame: points, lines of sight and mountings moved by T_target_this, the rest kept.
  [[nodiscard]] Scan transformed(const Eigen::Isometry3d& T_target_this) const;

  /// Moves the point of one row by `displacement` (m, sensor frame).
  void displace(std::size_t row, const Eigen::Vector3d& displacement) { points_[row] += displacement; }

  /// Corrects the Doppler of one row by `change_mps`, for an error that is known by now.
  void shift_doppler(std::size_t row, double change_mps) { doppler_[row] += change_mps; }

  /// Whether several sensors measured the points, each from a known place.
  [[nodiscard]] bool is_of_rig() const { return !mountings_.empty(); }

  /// All of it.
  void state(StateArchive& archive);

 private:
  template <class Visit>
  void for_each_column(Visit visit);
  void resize(std::size_t rows, const ScanView& raw);
  void check_read(const StateArchive& archive);

  Stamp stamp_;
  DopplerKind doppler_kind_ = DopplerKind::kRelative;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> doppler_;
  std::vector<double> times_;
  std::vector<std::uint32_t> records_;
  Channels channels_;
  std::vector<Eigen::Isometry3d> mountings_;
};

}  // namespace dynamic_icp
