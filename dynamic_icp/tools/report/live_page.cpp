// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/live_page.hpp"

#include "dynamic_icp/tools/report/page.hpp"
#include "dynamic_icp/tools/report/viewer_bundle.hpp"

namespace dynamic_icp::report {

std::string live_page() {
  const std::optional<ViewerBundle> viewer = live_bundle();
  if (!viewer) {
    return {};
  }
  std::string html = page_head("", "Live view", *viewer);
  html += "<body>\n<div id=\"app\"><noscript><p>The live view needs JavaScript.</p></noscript></div>\n";
  html += "<script type=\"module\">\n";
  html += viewer->script;
  return html += "\n</script>\n</body>\n</html>\n";
}

}  // namespace dynamic_icp::report
