// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/size_prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dynamic_icp::tracking {
namespace {

constexpr double kScatter = 0.15;  // of sizes about the curves, as a share
constexpr double kLength_m = 2.4;
constexpr double kWidthPower = 0.9;
constexpr double kHeightSquare = 0.35;  // times the square of the logarithm of the height
constexpr double kMinSide_m = 0.3;
constexpr double kLongest = 1.75;  // of the typical length: none was found longer
constexpr double kHighestVehicle_m = 4.0;
constexpr double kLorryLength_m = 5.0;
constexpr double kLorryHeight_m = 2.8;
constexpr double kPersonSide_m = 1.2;
constexpr double kPersonHeight_m = 2.3;
constexpr double kPersonSpeed_mps = 2.5;

Belief about(double mean) { return {mean, kScatter * kScatter * mean * mean}; }

}  // namespace

Belief at_least(const Belief& belief, double least) {
  const double sigma = std::sqrt(belief.variance);
  const double a = (least - belief.mean) / sigma;
  const double mode = std::max(belief.mean, least);
  if (a > 5.0) {  // the tail: the asymptotic series of what follows
    const double b = 1.0 / (a * a);
    return {mode, belief.variance * b * (2.0 - b * (10.0 - 74.0 * b))};
  }
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
  const double hazard = density / (0.5 * std::erfc(a / std::numbers::sqrt2));
  const double bias = belief.mean + sigma * hazard - mode;
  return {mode, belief.variance * std::max(0.0, 1.0 + a * hazard - hazard * hazard) + bias * bias};
}

Belief typical_length(double width_m, double height_m) {
  const double log_height = std::log(std::max(1.0, height_m));
  return about(kLength_m * std::pow(std::max(kMinSide_m, width_m), kWidthPower) *
               std::exp(kHeightSquare * log_height * log_height));
}

double length_per_height(double width_m, double height_m) {
  const double height = std::max(1.0, height_m);
  return typical_length(width_m, height).mean * 2.0 * kHeightSquare * std::log(height) / height;
}

double longest_length(double width_m, double height_m) { return kLongest * typical_length(width_m, height_m).mean; }

Belief typical_width(double length_m) { return about(std::clamp(0.41 * length_m, kMinSide_m, 2.5)); }

Belief typical_width_by_height(double height_m) { return about(std::min(2.5, 1.3 + 0.33 * height_m)); }

Belief height_beyond(double seen_m) {
  const double more = std::max(0.0, kHighestVehicle_m - seen_m);
  return {seen_m + 0.5 * more, more * more / 12.0};
}

bool is_lorry_sized(double length_m, double height_m) { return length_m > kLorryLength_m && height_m > kLorryHeight_m; }

bool is_person_sized(double longest_side_m, double height_m) {
  return longest_side_m < kPersonSide_m && height_m < kPersonHeight_m;
}

bool is_walking_speed(double speed_mps) { return speed_mps < kPersonSpeed_mps; }

}  // namespace dynamic_icp::tracking
