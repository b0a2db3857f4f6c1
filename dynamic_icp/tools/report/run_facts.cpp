// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/run_facts.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "dynamic_icp/tools/drawing/markup.hpp"
#include "dynamic_icp/tools/report/summary_keys.hpp"

namespace dynamic_icp::report {
namespace {

using runs::RunFiles;
using runs::text_of;

const char* better_of(std::string_view key) {
  constexpr std::string_view kLower[] = {"rte_", "rre_", "ate_", "ms_", "mean_iterations"};
  const auto begins_key = [&](std::string_view begin) { return key.starts_with(begin); };
  if (std::any_of(std::begin(kLower), std::end(kLower), begins_key)) {
    return "lower";
  }
  return key == "fps" || key == "convergence_rate" ? "higher" : "";
}

/// "time_gap" as it is said.
std::string spoken(std::string word) {
  std::replace(word.begin(), word.end(), '_', ' ');
  return word;
}

std::string scans_that_went_wrong(const std::string& reason, const std::vector<std::size_t>& indices, std::size_t of) {
  constexpr std::size_t kNamed = 12;
  std::string names;
  for (std::size_t k = 0; k < std::min(indices.size(), kNamed); ++k) {
    names += fmt::format("{}{}", k == 0 ? "" : ", ", indices[k]);
  }
  return fmt::format("{} of {} scans: {} (scan {}{})", indices.size(), of, spoken(reason), names,
                     indices.size() > kNamed ? ", ..." : "");
}

/// What of a run may tell it apart from the others.
std::string fact(const RunFiles& run, const char* key) {
  const std::string value = text_of(run.run, key);
  return std::string_view(key) == "ablation" && value == "none" ? "in full" : value;
}

/// What stands among the warnings, and what did not happen.
bool is_left_out(const runs::Settings& summary, std::string_view key) {
  return key == "assumptions" || (key == "failure" && text_of(summary, key).empty()) ||
         (key == "stopped" && text_of(summary, key) == "false");
}

}  // namespace

std::string folder_name(const std::filesystem::path& folder) {
  return std::filesystem::absolute(folder / "").lexically_normal().parent_path().filename().string();
}

std::vector<std::string> distinguishing_names(const std::vector<RunFiles>& runs) {
  std::vector<std::string> names(runs.size());
  const auto add = [&](std::size_t k, const std::string& value) {
    names[k] += value.empty() || names[k].empty() ? value : ", " + value;
  };
  for (const char* key : {"method", "preset", "ablation"}) {
    const bool differs = std::any_of(runs.begin(), runs.end(),
                                     [&](const RunFiles& run) { return fact(run, key) != fact(runs.front(), key); });
    for (std::size_t k = 0; differs && k < runs.size(); ++k) {
      add(k, fact(runs[k], key));
    }
  }
  // The layout of the recording only where one method has read two.
  const std::vector<std::string> methods = names;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string layout = fact(runs[k], "input.format");
    for (std::size_t other = 0; other < runs.size(); ++other) {
      if (methods[other] == methods[k] && fact(runs[other], "input.format") != layout) {
        add(k, layout);
        break;
      }
    }
  }
  std::set<std::pair<std::string, std::string>> different;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    different.emplace(name_of(runs[k]), names[k]);
  }
  if (different.size() < runs.size() || std::find(names.begin(), names.end(), "") != names.end()) {
    for (std::size_t k = 0; k < runs.size(); ++k) {
      names[k] = folder_name(runs[k].folder);
    }
    if (std::set<std::string>(names.begin(), names.end()).size() < runs.size()) {
      std::transform(runs.begin(), runs.end(), names.begin(), [](const RunFiles& run) { return run.folder.string(); });
    }
  }
  return names;
}

std::string name_of(const RunFiles& run) {
  const std::string input = text_of(run.run, "input.path");
  const std::filesystem::path path = std::filesystem::path(input.empty() ? run.folder.string() : input);
  const std::filesystem::path whole = path.lexically_normal();
  const std::string name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  return name.empty() ? "run" : name;
}

Facts facts_of(const RunFiles& run) {
  Facts facts;
  for (const char* key : {"method", "preset", "ablation", "version"}) {
    if (const std::string value = text_of(run.run, key); !value.empty()) {
      facts.emplace_back(key, value);
    }
  }
  return facts;
}

std::vector<std::string> warnings_of(const RunFiles& run) {
  std::map<std::string, std::vector<std::size_t>> by_reason;
  for (const runs::FrameRow& frame : run.frames) {
    if (frame.reason != "converged" && frame.reason != "first") {
      by_reason[frame.reason].push_back(frame.index);
    }
  }
  std::vector<std::string> warnings;
  for (const auto& [reason, indices] : by_reason) {
    warnings.push_back(scans_that_went_wrong(reason, indices, run.frames.size()));
  }
  warnings.insert(warnings.end(), run.warnings.begin(), run.warnings.end());
  return warnings;
}

std::vector<SummaryRow> summary_of(const RunFiles& run) {
  std::vector<SummaryRow> rows;
  for (const auto& [key, value] : run.summary) {
    if (is_left_out(run.summary, key)) {
      continue;
    }
    const double* number = std::get_if<double>(&value);
    rows.push_back({.key = key,
                    .value = value_with_unit(run.summary, key),
                    .meaning = meaning_of(key),
                    .number = number != nullptr ? *number : std::numeric_limits<double>::quiet_NaN(),
                    .better = better_of(key)});
  }
  return rows;
}

Facts texts_of(const runs::Settings& settings) {
  Facts facts;
  for (const auto& [key, value] : settings) {
    const std::string text = text_of(settings, key);
    facts.emplace_back(key, text.empty() ? "-" : text);
  }
  return facts;
}

std::string direction_text(const Vector6d& direction) {
  const Eigen::Vector3d turn = direction.head<3>();
  const Eigen::Vector3d shift = direction.tail<3>();
  const bool is_shift = shift.norm() >= turn.norm();
  const Eigen::Vector3d axis = (is_shift ? shift : turn).normalized();
  constexpr const char* kAlong[] = {"forwards", "sideways", "up"};
  constexpr const char* kAbout[] = {"roll", "pitch", "yaw"};
  constexpr double kNearly = 0.97;  // within 14 degrees
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) > kNearly) {
      return is_shift ? fmt::format("position {}", kAlong[k]) : kAbout[k];
    }
  }
  const std::string components = fmt::format("({}, {}, {})", drawing::compact_number(axis.x()),
                                             drawing::compact_number(axis.y()), drawing::compact_number(axis.z()));
  return (is_shift ? "position along " : "rotation about ") + components;
}

}  // namespace dynamic_icp::report
