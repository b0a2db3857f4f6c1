// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/summary_keys.hpp"

#include <cmath>

#include <fmt/format.h>

namespace dynamic_icp::report {
namespace {

struct Meaning {
  std::string_view key;
  std::string_view text;
};

constexpr Meaning kMeanings[] = {
    {"method", "method"},
    {"frames", "scans processed"},
    {"rte_rmse_m", "RTE RMSE, scan to scan"},
    {"rte_mean_m", "RTE mean"},
    {"rte_median_m", "RTE median"},
    {"rre_rmse_deg", "RRE RMSE, scan to scan"},
    {"rre_mean_deg", "RRE mean"},
    {"rre_median_deg", "RRE median"},
    {"ate_rmse_m", "ATE RMSE (SE(3) aligned)"},
    {"path_length_m", "path length"},
    {"mean_iterations", "registration iterations, mean"},
    {"convergence_rate", "converged registrations"},
    {"ms_mean", "time per scan, mean; reading and writing excluded"},
    {"ms_median", "time per scan, median"},
    {"ms_p95", "time per scan, p95"},
    {"fps", "scans per second of computing time"},
    {"dynamic_ratio_mean", "moving points, of those used, mean"},
    {"dynamic_ratio_max", "moving points, of those used, maximum"},
    {"clustered_ratio_mean", "clustered, of the moving points, mean"},
    {"refined_ratio_mean", "on an object with a velocity, of the clustered points, mean"},
    {"matched_poses", "poses compared with the ground truth"},
    {"failure", "why most scans are lost"},
    {"stopped", "whether it was stopped before its last scan"},
};

bool has_part(std::string_view key, std::string_view part) { return key.find(part) != std::string_view::npos; }

/// Four significant digits, whole numbers in full, no trailing zeros.
std::string rounded(double number) {
  return number == std::round(number) && std::abs(number) < 1e15 ? fmt::format("{:.0f}", number)
                                                                 : fmt::format("{:.4g}", number);
}

}  // namespace

std::string value_with_unit(const runs::Settings& summary, std::string_view key) {
  const std::optional<double> number = runs::number_of(summary, key);
  if (!number) {
    const std::string text = runs::text_of(summary, key);
    return text.empty() ? "-" : text;
  }
  if (has_part(key, "_ratio") || has_part(key, "_rate")) {
    return rounded(100.0 * *number) + " %";
  }
  const std::string_view unit = key.ends_with("_m")      ? " m"
                                : key.ends_with("_deg")  ? "°"
                                : key.starts_with("ms_") ? " ms"
                                : key == "fps"           ? " 1/s"
                                                         : "";
  return fmt::format("{}{}", rounded(*number), unit);
}

std::string_view meaning_of(std::string_view key) {
  for (const Meaning& meaning : kMeanings) {
    if (meaning.key == key) {
      return meaning.text;
    }
  }
  return key.starts_with("statuses.")  ? "scans with this status"
         : key.starts_with("reasons.") ? "scans with this reason for their status"
                                       : "";
}

}  // namespace dynamic_icp::report
