// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"

namespace dynamic_icp::diagnosis {

/// That the last column is no Doppler at all.
struct NoDoppler {
  std::string sentence;                                  ///< what it is instead, and by what numbers
  std::vector<std::pair<std::string, double>> evidence;  ///< numbers by name
  bool is_zero = false;                                  ///< a column of zeros; else other numbers
  bool may_stand = false;                                ///< zeros would also be those of a sensor that stands still
};

/// Nothing where the last column may be a Doppler. Zeros in every point of several scans are a column that was never
/// filled in. Numbers of one sign that no velocity explains and that scatter as widely as they are large are a
/// reflectance, an intensity or a range: what a velocity does not explain in a Doppler is noise and traffic, around
/// zero or around a constant error that is large against the noise.
std::optional<NoDoppler> no_doppler(const Evidence& evidence);

}  // namespace dynamic_icp::diagnosis
