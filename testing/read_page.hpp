// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

// For the tests of this room: takes a page apart as a browser would.
namespace dynamic_icp::report {

struct ReadPage {
  std::map<std::string, std::string> data;  ///< content of the <script> elements with an id that are no programs
  int programs = 0;
  nlohmann::json report;
};

/// A <script> ends at the first "</script", whatever is in it.
inline ReadPage read_page(const std::string& html) {
  ReadPage page;
  for (std::size_t at = html.find("<script"); at != std::string::npos; at = html.find("<script", at)) {
    const std::size_t open_end = html.find('>', at);
    const std::size_t close = html.find("</script", open_end);
    if (open_end == std::string::npos || close == std::string::npos) {
      throw std::runtime_error("an element without an end");
    }
    const std::string tag = html.substr(at, open_end - at);
    if (const std::size_t id = tag.find(" id=\""); id != std::string::npos) {
      const std::string name = tag.substr(id + 5, tag.find('"', id + 5) - id - 5);
      if (!page.data.emplace(name, html.substr(open_end + 1, close - open_end - 1)).second) {
        throw std::runtime_error("two elements called " + name);
      }
    } else {
      ++page.programs;
    }
    at = close;
  }
  page.report = nlohmann::json::parse(page.data.at("report"));
  return page;
}

}  // namespace dynamic_icp::report
