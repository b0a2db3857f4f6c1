// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/eigen_layout.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp {

/// What the Doppler of a recording says.
enum class DopplerKind : std::uint8_t {
  kRelative,    ///< as measured: the sensor's own motion is in it, s = u.(v_object - v_sensor)
  kCompensated  ///< the sensor's own motion was taken out before, s = u.v_object
};

/// A scan as a reader hands it over: columns of equal length, nothing checked yet.
struct RawScan {
  Stamp stamp;                              ///< when the scan begins
  std::vector<Eigen::Vector3d> points;      ///< m, sensor frame
  std::vector<double> doppler;              ///< m/s, range rate, positive away from the sensor
  std::vector<double> times;                ///< s after `stamp`, per point; empty where the data has none
  std::vector<Eigen::Vector3d> directions;  ///< lines of sight where they are not points/|points|; else empty
  DopplerKind doppler_kind = DopplerKind::kRelative;
  std::string warning;  ///< what the reader found odd but could live with; empty: nothing
};

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
  /// Why records of a RawScan did not become rows of the Scan.
  struct Dropped {
    std::size_t non_finite = 0;    ///< NaN or infinity in a coordinate, the Doppler, the time or the direction
    std::size_t implausible = 0;   ///< finite, but beyond what a measurement can be (scan_limits.hpp)
    std::size_t zero_range = 0;    ///< at the sensor's origin: no line of sight
    std::size_t out_of_range = 0;  ///< nearer or farther than the limits

    [[nodiscard]] std::size_t total() const { return non_finite + implausible + zero_range + out_of_range; }
    Dropped& operator+=(const Dropped& other);
  };

  /// The distances from the sensor's origin that points may have, m; both belong to it.
  struct RangeLimits {
    double min_m = 0.0;
    double max_m = std::numeric_limits<double>::infinity();
  };

  Scan() = default;

  /// Takes over the records that are finite, plausible and away from the origin and counts the others in `dropped` (if
  /// given). Throws std::invalid_argument when the columns differ in length.
  static Scan from_raw(const RawScan& raw, Dropped* dropped = nullptr);

  /// The same for what is within the limits, by several threads.
  static Scan from_raw(const RawScan& raw, const RangeLimits& limits, const Workers& workers,
                       Dropped* dropped = nullptr);

  /// The same in the place of what this scan was, whose memory is used again.
  void assign(const RawScan& raw, const RangeLimits& limits, const Workers& workers, Dropped* dropped = nullptr);

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

  /// The rows named by `rows`, in that order.
  [[nodiscard]] Scan select(std::span<const std::uint32_t> rows) const;

  /// The same rows seen from another frame: points and lines of sight moved by T_target_this, Doppler and times kept.
  [[nodiscard]] Scan transformed(const Eigen::Isometry3d& T_target_this) const;

  /// Moves the point of one row by `displacement` (m, sensor frame).
  void displace(std::size_t row, const Eigen::Vector3d& displacement) { points_[row] += displacement; }

 private:
  void resize(std::size_t rows, bool with_times);
  void move_rows(std::size_t from, std::size_t to, std::size_t count);

  Stamp stamp_;
  DopplerKind doppler_kind_ = DopplerKind::kRelative;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> doppler_;
  std::vector<double> times_;
  std::vector<std::uint32_t> records_;
};

}  // namespace dynamic_icp
