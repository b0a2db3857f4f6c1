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
    {"method", "how scans were registered"},
    {"frames", "scans processed"},
    {"rte_rmse_m", "translation error from scan to scan, root mean square"},
    {"rte_mean_m", "the same, mean"},
    {"rte_median_m", "the same, median"},
    {"rre_rmse_deg", "rotation error from scan to scan, root mean square"},
    {"rre_mean_deg", "the same, mean"},
    {"rre_median_deg", "the same, median"},
    {"ate_rmse_m", "distance to the true path after rigid alignment, root mean square"},
    {"path_length_m", "length of the path"},
    {"mean_iterations", "iterations of the registration, mean"},
    {"convergence_rate", "share of registrations that converged"},
    {"ms_mean", "computing time per scan, mean; files excluded"},
    {"ms_median", "the same, median"},
    {"ms_p95", "the same, 95 % of the scans stay below"},
    {"fps", "scans per second of computing time"},
    {"dynamic_ratio_mean", "points flagged as moving, of those used, mean"},
    {"dynamic_ratio_max", "the same, largest"},
    {"clustered_ratio_mean", "of those, points in a cluster, mean"},
    {"refined_ratio_mean", "of those, points on an object with a velocity, mean"},
    {"matched_poses", "poses compared with the ground truth"},
};

bool has_part(std::string_view key, std::string_view part) { return key.find(part) != std::string_view::npos; }

/// Four significant digits, whole numbers in full, no trailing zeros.
std::string rounded(double number) {
  return number == std::round(number) && std::abs(number) < 1e15 ? fmt::format("{:.0f}", number)
                                                                 : fmt::format("{:.4g}", number);
}

}  // namespace

std::string value_with_unit(const runs::Settings& summary, std::string_view key) {
  for (const auto& [name, value] : summary) {
    const double* number = name == key ? std::get_if<double>(&value) : nullptr;
    if (number == nullptr) {
      continue;
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
  const std::string text = runs::text_of(summary, key);
  return text.empty() ? "-" : text;
}

std::string_view meaning_of(std::string_view key) {
  for (const Meaning& meaning : kMeanings) {
    if (meaning.key == key) {
      return meaning.text;
    }
  }
  return key.starts_with("statuses.") ? "scans with this status" : "";
}

}  // namespace dynamic_icp::report
