// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/no_doppler.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/comparison_text.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr std::size_t kFewestScans = 2;
constexpr std::size_t kFewestValues = 200;
constexpr double kStands_mps = 0.5;
constexpr double kOneSign = 0.001;  // share of the values that have the other one

// Gaussian noise around a constant that leaves 0.1 % of the values with the other sign has a median deviation of 0.22
// of that constant.
constexpr double kLeastScatter = 0.3;

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
  none.may_stand = reference != nullptr && reference->reference_speed_mps < kStands_mps;
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

std::optional<NoDoppler> no_doppler(const Evidence& evidence) {
  const Total total = total_of(evidence);
  // Where the columns changed places the last one is another's, and `columns` says so.
  if (total.scans < kFewestScans || total.values < kFewestValues || evidence.columns.doppler != 3) {
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
  if (!is_one_sided || scatter < kLeastScatter * median || left < kUnexplained * scatter) {
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
