// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/summary_keys.hpp"

#include <algorithm>
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
    {"nees_rotation", "NEES of the rotation (3: as uncertain as stated)"},
    {"nees_translation", "NEES of the translation (3: as uncertain as stated)"},
    {"beyond_4_sigma", "errors beyond 4 sigma, share"},
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

constexpr double kMillimetres = 1000.0;

/// Errors from scan to scan are a matter of millimetres, those of a whole drive only below a metre.
bool in_millimetres(std::string_view key, double number) {
  return key.ends_with("_m") && (key.starts_with("rte_") || (key.starts_with("ate_") && std::abs(number) < 1.0));
}

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
  if (has_part(key, "_ratio") || has_part(key, "_rate") || key == "beyond_4_sigma") {
    return rounded(100.0 * *number) + " %";
  }
  if (in_millimetres(key, *number)) {
    return rounded(kMillimetres * *number) + " mm";
  }
  const std::string_view unit = key.ends_with("_m")      ? " m"
                                : key.ends_with("_deg")  ? "°"
                                : key.starts_with("ms_") ? " ms"
                                : key == "fps"           ? " 1/s"
                                                         : "";
  return fmt::format("{}{}", rounded(*number), unit);
}

std::string meaning_of(std::string_view key) {
  for (const Meaning& meaning : kMeanings) {
    if (meaning.key == key) {
      return std::string(meaning.text);
    }
  }
  for (const std::string_view group : {"statuses.", "reasons."}) {
    if (key.starts_with(group)) {
      std::string word(key.substr(group.size()));
      std::replace(word.begin(), word.end(), '_', ' ');
      return "scans: " + word;
    }
  }
  return "";
}

}  // namespace dynamic_icp::report
