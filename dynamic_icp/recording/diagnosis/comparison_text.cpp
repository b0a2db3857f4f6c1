// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/comparison_text.hpp"

#include <string>

#include <fmt/format.h>

namespace dynamic_icp::diagnosis {

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
    if (comparison->reference_speed_mps > Comparison::kMoving_mps) {
      return fmt::format("only {} of {} motions {} could be compared", comparison->moving, comparison->motions,
                         reference_name(evidence, *comparison));
    }
    return fmt::format("the sensor moves at {:.1f} m/s {}: too slow to tell", comparison->reference_speed_mps,
                       reference_name(evidence, *comparison));
  }
  return evidence.dataset->ground_truth().empty()
             ? "there is no ground truth, and no scans that can be matched beyond doubt"
             : "ground truth and Doppler give no motion that could be compared";
}

}  // namespace dynamic_icp::diagnosis
