// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/tools/report/json_text.hpp"
#include "dynamic_icp/tools/report/viewer_bundle.hpp"

namespace dynamic_icp::report {

/// All that a page holds, see docs/report.md.
struct PageContent {
  Json report;
  std::vector<std::pair<std::string, std::string>> blobs;  ///< id of the element and its base64 text
  std::size_t first_blobs =
      0;  ///< so many of them stand before the viewer, which begins with them; the others behind it
};

/// "dynamic-icp 0.1.0".
std::string generator();

/// All of a page up to its body. `policy`: what it may load, for the browser; empty: who serves the page says it.
/// Throws std::runtime_error where the bundle holds the end of its own element.
std::string page_head(std::string_view policy, std::string_view title, const ViewerBundle& viewer);

/// The HTML page: needs no other file and no network, and says so to the browser. Without JavaScript it still shows
/// title, facts, notes, warnings, summaries and tables. All text of `content` is shown as text whatever is in it.
std::string html_page(const PageContent& content, const ViewerBundle& viewer);

}  // namespace dynamic_icp::report
