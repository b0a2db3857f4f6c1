// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"

// What several questions ask of the evidence, and say alike.
namespace dynamic_icp::diagnosis {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

/// So many standard errors off is no chance.
inline constexpr double kCertain = 4.0;

/// "by matching scans" or "by ground truth".
std::string reference_name(const Evidence& evidence, const Comparison& comparison);

/// The numbers of a comparison as evidence.
std::vector<std::pair<std::string, double>> comparison_numbers(const Comparison& comparison);

/// To so many significant digits: a factor that was measured, or is typed in again, has no more.
double rounded(double value, int digits);

/// Where nothing tells: why.
std::string why_unknown(const Evidence& evidence);

/// How a speed can be told wrong.
struct SpeedRatio {
  const Comparison* reference = nullptr;
  double ratio = 1.0;          ///< Doppler speed as stored over the reference's by the stamps as stored
  bool is_one = true;          ///< within what is usual and what the evidence allows
  std::string_view unit = {};  ///< of the Doppler, where the ratio is the factor of a usual one
  double unit_factor = 1.0;    ///< as many of them are 1 m/s
};

/// Nothing where the Doppler gives no velocity along the reference's. The reference is ground truth or
/// matching scans, whichever gives the ratio better; but the metres of the latter are those of the points.
std::optional<SpeedRatio> speed_ratio(const Evidence& evidence);

/// That the last column is no Doppler at all.
struct NoDoppler {
  std::string sentence;                                  ///< what it is instead, and by what numbers
  std::vector<std::pair<std::string, double>> evidence;  ///< numbers by name
  bool is_zero = false;                                  ///< a column of zeros; else other numbers
  bool may_be_static = false;                            ///< zeros would also be those of a sensor that is static
};

/// Nothing where the last column may be a Doppler. Zeros in every point of several scans are a column that was never
/// filled in. Numbers of one sign that no velocity explains and that scatter as widely as they are large are a
/// reflectance, an intensity or a range: what a velocity does not explain in a Doppler is noise and traffic, around
/// zero or around a constant error that is large against the noise.
std::optional<NoDoppler> no_doppler(const Evidence& evidence);

}  // namespace dynamic_icp::diagnosis
