// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::conversion {

/// What values the numbers of a column take over a whole recording.
struct ValueSurvey {
  bool fits_float32 = true;  ///< every number is one, NaN and infinity too
  bool is_integer = true;    ///< and within 2^53
  double smallest = 0.0;     ///< with 0, of the integers
  double largest = 0.0;

  void add(double value);

  /// The smallest type that holds all of them exactly: uint8, int32, uint32 or int64 where `prefer_integers` and it can
  /// be, else float32, else float64.
  [[nodiscard]] formats::NpyType type(bool prefer_integers) const;
};

/// How the times of points are written so that the same doubles are read again.
enum class TimeColumn : std::uint8_t {
  kNone,         ///< there are none, or some scans lack them
  kSeconds,      ///< float32 or float64
  kNanoseconds,  ///< whole ones: every time is 1e-9 times an integer, rounded as a double
};

/// What all scans of a recording have in common, so that all files get columns of the same types.
class ColumnTypes {
 public:
  void add(const RawScan& scan, const std::vector<datasets::PointColumn>& columns);

  [[nodiscard]] formats::NpyType point() const { return point_.type(false); }
  [[nodiscard]] formats::NpyType doppler() const { return doppler_.type(false); }
  [[nodiscard]] formats::NpyType line_of_sight() const { return line_of_sight_.type(false); }
  [[nodiscard]] formats::NpyType other(const std::string& name) const;

  [[nodiscard]] TimeColumn time_column() const;
  [[nodiscard]] formats::NpyType time_type() const;  ///< of the numbers of that column

  [[nodiscard]] bool has_lines_of_sight() const { return with_lines_of_sight_ > 0 && with_lines_of_sight_ == scans_; }
  [[nodiscard]] bool some_times_missing() const { return with_times_ > 0 && with_times_ < scans_; }
  [[nodiscard]] bool some_lines_of_sight_missing() const {
    return with_lines_of_sight_ > 0 && with_lines_of_sight_ < scans_;
  }

 private:
  struct Other {
    ValueSurvey values;
    bool is_integer = true;  ///< by what the recording says of it
  };

  std::size_t scans_ = 0;  ///< with points
  std::size_t with_times_ = 0;
  std::size_t with_lines_of_sight_ = 0;
  ValueSurvey point_;
  ValueSurvey doppler_;
  ValueSurvey line_of_sight_;
  ValueSurvey time_;
  ValueSurvey time_ns_;
  bool whole_nanoseconds_ = true;
  std::map<std::string, Other> others_;
};

/// The time as whole nanoseconds; only for times that are.
std::int64_t nanoseconds(double time_s);

}  // namespace dynamic_icp::conversion
