// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/diagnosis/column_scores.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"
#include "dynamic_icp/recording/diagnosis/scan_look.hpp"
#include "dynamic_icp/recording/diagnosis/sweep_search.hpp"

namespace dynamic_icp::diagnosis {

// What counts as motion, by the Doppler or by a reference.
inline constexpr double kStandsStill_mps = 0.5;     ///< slower, the sensor may stand
inline constexpr double kMoves_mps = 1.0;           ///< faster, a Doppler shows its motion
inline constexpr double kDirectionKnown_mps = 1.5;  ///< faster, direction and speed can be compared

/// How the sensor moved from one scan to a later one by a reference.
struct Motion {
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();  ///< pose of the later sensor in the axes of the earlier
  double dt_s = 0.0;                                            ///< by the stamps
  Eigen::Vector3d doppler_translation =
      Eigen::Vector3d::Zero();  ///< m, the same way by the Doppler, where it is relative
  bool has_doppler = false;     ///< every fit that `doppler_translation` is made of holds
};

/// As many scans of a stretch are looked at, one after the other in Evidence::looks.
inline constexpr std::size_t kLooksOfStretch = 4;

/// A stretch of the recording.
struct Probe {
  std::optional<Motion> by_truth;
  std::optional<Motion> by_matching;
  bool match_was_tried = false;
};

/// What the motions of all probes by one reference say of the Doppler.
struct Comparison {
  std::size_t motions = 0;           ///< that have a velocity from the Doppler
  std::size_t moving = 0;            ///< of those, faster than kDirectionKnown_mps by the reference
  double reference_speed_mps = 0.0;  ///< medians over all motions
  double doppler_speed_mps = 0.0;
  double ratio = 0.0;             ///< Doppler over reference along the reference, median of the moving
  double ratio_error = 0.0;       ///< standard error of that median
  double turned_deg = 0.0;        ///< angle from the reference's direction to the Doppler's, of the mean directions
  double turned_error_deg = 0.0;  ///< standard error of the angles of the motions one by one
  double yaw_rate_rps = 0.0;      ///< median of the absolute angular velocity

  /// By the ratio: the Doppler moves the sensor as the reference does, or certainly not so.
  [[nodiscard]] bool is_same() const { return std::abs(ratio - 1.0) <= 0.08; }
  [[nodiscard]] bool is_other() const { return ratio > 0.0 && std::abs(std::log(ratio)) >= 0.25; }

  [[nodiscard]] bool tells() const { return moving >= 3 || (moving > 0 && moving == motions); }
};

/// All that the questions are answered from, gathered once.
struct Evidence {
  datasets::Dataset const* dataset = nullptr;
  std::size_t begin = 0;
  std::size_t end = 0;
  double period_s = 0.0;  ///< median; 0 of one scan
  datasets::Correction applied;

  /// Factors that bring numbers into the order of metres and m/s before they are looked at; 1 where they are already.
  UnitGuess units;
  ColumnScores columns;
  std::vector<ScanLook> looks;  ///< in the order of the scans; in guessed units, the Doppler column in its place
  std::vector<Probe> probes;
  Comparison truth;
  Comparison matching;
  std::optional<SweepSearch> sweep;  ///< of points without times, where it was asked for

  /// The reference that tells, matching first: it has the axes of the points. Nothing without any.
  [[nodiscard]] const Comparison* reference() const;
  /// Whether columns and units are those that they should be, so that scans can be used as they are.
  [[nodiscard]] bool is_in_metres() const;
  /// Median over the looks.
  [[nodiscard]] double median_of(double ScanLook::*value) const;
  /// Median over the looks of the speed that the Doppler gives, m/s; nothing where no fit holds.
  [[nodiscard]] std::optional<double> doppler_speed_mps() const;
};

Evidence gather(const datasets::Dataset& dataset, const DiagnosisConfig& config, const Workers& workers);

}  // namespace dynamic_icp::diagnosis
