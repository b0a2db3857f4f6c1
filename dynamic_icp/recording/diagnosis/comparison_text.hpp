// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"

namespace dynamic_icp::diagnosis {

/// "by matching scans" or "by ground truth".
std::string reference_name(const Evidence& evidence, const Comparison& comparison);

/// The numbers of a comparison as evidence.
std::vector<std::pair<std::string, double>> comparison_numbers(const Comparison& comparison);

/// To so many significant digits: a factor that was measured, or is typed in again, has no more.
double rounded(double value, int digits);

/// Where nothing tells: why.
std::string why_unknown(const Evidence& evidence);

}  // namespace dynamic_icp::diagnosis
