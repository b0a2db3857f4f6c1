// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::report {

using Facts = std::vector<std::pair<std::string, std::string>>;

/// What the run is called: by its recording, since the folder may still be under construction under another name.
std::string name_of(const runs::RunFiles& run);

/// The last part of a path, also of one that ends in a slash.
std::string folder_name(const std::filesystem::path& folder);

/// What distinguishes the runs: method, preset, ablation and layout of the recording as far as they differ; else their
/// folders.
std::vector<std::string> distinguishing_names(const std::vector<runs::RunFiles>& runs);

/// Method, preset, ablation and version, as far as the run states them.
Facts facts_of(const runs::RunFiles& run);

/// What a reader should know before trusting the numbers: scans that went wrong, and the warnings of the run.
std::vector<std::string> warnings_of(const runs::RunFiles& run);

/// A line of the summary.
struct SummaryRow {
  std::string key;
  std::string value;  ///< rounded, with unit
  std::string meaning;
  double number = 0.0;      ///< as it stands in the file; NaN where it is no number
  const char* better = "";  ///< "lower", "higher" or empty where neither is
};

std::vector<SummaryRow> summary_of(const runs::RunFiles& run);

/// The values as texts, "-" where there is none.
Facts texts_of(const runs::Settings& settings);

/// The direction of a pose [rotation; translation] that nothing holds, in words.
std::string direction_text(const Vector6d& direction);

}  // namespace dynamic_icp::report
