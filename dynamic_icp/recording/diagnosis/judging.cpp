// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/judging.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

namespace dynamic_icp::diagnosis {
namespace {

// Radar and repeated poses scatter by some per cent; nobody calibrates a clock by driving.
constexpr double kUsual = 0.08;
constexpr std::size_t kEnough = 5;
constexpr double kUnitMatch = 0.05;
constexpr double kUnitWrongBy = 0.3;

struct Unit {
  std::string_view name;
  double per_mps;
};

constexpr Unit kUnits[] = {{"km/h", 3.6},    {"mm/s", 1000.0},   {"cm/s", 100.0},
                           {"mph", 2.23694}, {"knots", 1.94384}, {"ft/s", 3.28084}};

/// The one whose ratio is known better; metres that are guessed are no measure.
const Comparison* best_reference(const Evidence& evidence) {
  if (!evidence.truth.tells() || !evidence.matching.tells()) {
    return evidence.truth.tells() ? &evidence.truth : evidence.reference();
  }
  const bool points_are_better =
      evidence.units.points == 1.0 && evidence.matching.ratio_error < evidence.truth.ratio_error;
  return points_are_better && evidence.matching.moving >= kEnough ? &evidence.matching : &evidence.truth;
}

constexpr std::size_t kMinScans = 2;
constexpr std::size_t kMinValues = 200;
constexpr double kOneSign = 0.001;  // share of the values that have the other one

// Gaussian noise around a constant that leaves 0.1 % of the values with the other sign has a median standard deviation
// of 0.22 of that constant.
constexpr double kMinScatter = 0.3;

// A velocity explains most of the scatter of a relative Doppler.
constexpr double kUnexplained = 0.6;

/// What the looks hold together.
struct Total {
  std::size_t scans = 0;
  std::size_t values = 0;
  std::size_t zeros = 0;
  std::size_t negative = 0;
  std::size_t positive = 0;
  std::vector<double> medians;
  std::vector<double> scatters;
  std::vector<double> left;
};

Total total_of(const Evidence& evidence) {
  Total total;
  for (const ScanLook& look : evidence.looks) {
    const DopplerValues& values = look.values;
    if (values.count == 0) {
      continue;
    }
    ++total.scans;
    total.values += values.count;
    total.zeros += values.count - values.negative - values.positive;
    total.negative += values.negative;
    total.positive += values.positive;
    total.medians.push_back(std::abs(values.median));
    total.scatters.push_back(values.scatter);
    total.left.push_back(values.scatter_left);
  }
  return total;
}

/// The reference that knows a speed, whether it is enough to compare or not; none: null.
const Comparison* any_reference(const Evidence& evidence) {
  for (const Comparison* comparison : {&evidence.matching, &evidence.truth}) {
    if (comparison->motions > 0) {
      return comparison;
    }
  }
  return nullptr;
}

NoDoppler zeros(const Evidence& evidence, const Total& total) {
  NoDoppler none;
  none.is_zero = true;
  const Comparison* const reference = any_reference(evidence);
  none.may_be_static = reference != nullptr && reference->reference_speed_mps < kStandsStill_mps;
  none.sentence = fmt::format("all {} values of {} scans are exactly zero", total.values, total.scans);
  if (reference != nullptr) {
    none.sentence += fmt::format(" while the sensor moves at {:.1f} m/s {}", reference->reference_speed_mps,
                                 reference_name(evidence, *reference));
    none.evidence.emplace_back("reference_speed_mps", reference->reference_speed_mps);
  }
  none.evidence.emplace_back("values", static_cast<double>(total.values));
  return none;
}

}  // namespace

std::string reference_name(const Evidence& evidence, const Comparison& comparison) {
  return &comparison == &evidence.matching ? "by matching scans" : "by ground truth";
}

std::vector<std::pair<std::string, double>> comparison_numbers(const Comparison& comparison) {
  return {{"motions", static_cast<double>(comparison.motions)},
          {"reference_speed_mps", comparison.reference_speed_mps},
          {"doppler_speed_mps", comparison.doppler_speed_mps},
          {"ratio", comparison.ratio},
          {"ratio_error", comparison.ratio_error}};
}

double rounded(double value, int digits) { return std::stod(fmt::format("{:.{}g}", value, digits)); }

std::string why_unknown(const Evidence& evidence) {
  for (const Comparison* comparison : {&evidence.matching, &evidence.truth}) {
    if (comparison->motions == 0) {
      continue;
    }
    if (comparison->reference_speed_mps > kDirectionKnown_mps) {
      return fmt::format("only {} of {} motions {} could be compared", comparison->moving, comparison->motions,
                         reference_name(evidence, *comparison));
    }
    return fmt::format("the sensor moves at {:.1f} m/s {}: too slow to decide", comparison->reference_speed_mps,
                       reference_name(evidence, *comparison));
  }
  return evidence.dataset->ground_truth().empty()
             ? "there is no ground truth, and no scans that can be matched beyond doubt"
             : "ground truth and Doppler give no motion that could be compared";
}

std::optional<SpeedRatio> speed_ratio(const Evidence& evidence) {
  SpeedRatio result;
  result.reference = best_reference(evidence);
  // By the reference and the Doppler both, along or against each other: the size is what counts here.
  if (result.reference == nullptr || result.reference->doppler_speed_mps < kMoves_mps) {
    return std::nullopt;
  }
  const Comparison& reference = *result.reference;
  const double turned = std::cos(reference.turned_deg * std::numbers::pi / 180.0);
  const double guessed = std::abs(turned) > 0.5
                             ? std::abs(reference.ratio)
                             : reference.doppler_speed_mps / std::max(1e-6, reference.reference_speed_mps);
  result.ratio = guessed / evidence.units.doppler;
  const double allowed = std::max(kUsual, kCertain * reference.ratio_error);
  result.is_one = std::abs(std::log(result.ratio)) < std::log1p(allowed);
  // A few odd motions out of many, at walking pace in a jam, prove nothing.
  if (!result.is_one && 2 * reference.moving <= evidence.probes.size()) {
    return std::nullopt;
  }
  for (const Unit& unit : kUnits) {
    const double off = std::abs(std::log(result.ratio / unit.per_mps));
    if (!result.is_one && off < std::max(kUnitMatch, std::min(kUnitWrongBy, allowed))) {
      result.unit = unit.name;
      result.unit_factor = unit.per_mps;
      break;
    }
  }
  return result;
}

std::optional<NoDoppler> no_doppler(const Evidence& evidence) {
  const Total total = total_of(evidence);
  // Where the columns changed places the last one is another's, and `columns` says so.
  if (total.scans < kMinScans || total.values < kMinValues || evidence.columns.doppler != 3) {
    return std::nullopt;
  }
  if (total.zeros == total.values) {
    return zeros(evidence, total);
  }
  const auto others = static_cast<double>(std::min(total.negative, total.positive));
  const double median = quantile(total.medians, 0.5);
  const double scatter = quantile(total.scatters, 0.5);
  const double left = quantile(total.left, 0.5);
  const bool is_one_sided = others <= kOneSign * static_cast<double>(total.values);
  if (!is_one_sided || scatter < kMinScatter * median || left < kUnexplained * scatter) {
    return std::nullopt;
  }
  const double unit = evidence.units.doppler;  // as stored
  return NoDoppler{
      fmt::format(
          "of {} values {} are {}, and no velocity explains why they scatter by {:.3g} around {:.3g}: reflectance, "
          "intensity or a range?",
          total.values, std::min(total.negative, total.positive),
          total.positive > total.negative ? "negative" : "positive", scatter / unit, median / unit),
      {{"values", static_cast<double>(total.values)},
       {"median", median / unit},
       {"scatter", scatter / unit},
       {"scatter_left_by_velocity", left / unit}}};
}

}  // namespace dynamic_icp::diagnosis
