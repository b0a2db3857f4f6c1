// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/tools/report/json_text.hpp"
#include "dynamic_icp/tools/report/viewer_bundle.hpp"

namespace dynamic_icp::report {

/// All that a page holds, see docs/report.md.
struct PageContent {
  Json report;
  std::vector<std::pair<std::string, std::string>> blobs;  ///< id of the element and its base64 text
};

/// "dynamic-icp 0.1.0".
std::string generator();

/// The HTML page: needs no other file and no network, and says so to the browser. Without JavaScript it still shows
/// title, facts, notes, warnings, summaries and tables. All text of `content` is shown as text whatever is in it.
std::string html_page(const PageContent& content, const ViewerBundle& viewer);

}  // namespace dynamic_icp::report
