// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/recording/runs/run_recording.hpp"

namespace dynamic_icp::apps {

/// "146 ok, 3 degenerate (3 ambiguous), 1 lost (1 time_gap)": scans by status, with the reasons of those that are not
/// ok. docs/method.md says what the words mean.
std::string status_text(const runs::RunSummary& summary);

/// What is printed of a run at its end, a line each of label and value; without the names of its files.
std::string summary_text(const runs::RunResult& result);

}  // namespace dynamic_icp::apps
