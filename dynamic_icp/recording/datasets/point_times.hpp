// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::datasets {

/// What the numbers of a column of times mean.
struct TimeUnit {
  std::int64_t ns = 1;     ///< nanoseconds that a 1 stands for
  bool is_unix = false;    ///< the time itself, not that since the scan's stamp
  std::string assumption;  ///< how this was found, in a sentence, where the name does not say it; else empty
};

/// Finds the unit of a column by its name ("..._ns", "..._nsecs", "nanosecs_since_frame", "..._us", "..._ms", "..._s"),
/// else by its type and by the numbers of a scan: floating-point numbers that span less than 10 are seconds; others are
/// nano-, micro- or milliseconds, the first of these in which they span most of a period of `period_s`, else
/// nanoseconds. Numbers that can only be times since 1970 are taken as such, in the unit of their magnitude. `column`
/// is of the shape (N,) or (N, 1); infinite ones and NaN are left out.
TimeUnit time_unit(std::string_view name, const formats::NpyArray& column, double period_s);

/// The times of points in seconds after `stamp`. Unix times that are more than 10 s away from it, because the scan's
/// own stamp is a mere index, are counted from the earliest one of the scan.
std::vector<double> times_after(Stamp stamp, const formats::NpyArray& column, const TimeUnit& unit);

}  // namespace dynamic_icp::datasets
