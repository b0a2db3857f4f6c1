// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/page.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"

namespace dynamic_icp::report {
namespace {

using drawing::escape_markup;

// Scripts and styles of the page itself, pictures that it draws itself; nothing from anywhere else.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; "
    "form-action 'none'";

std::string text(const Json& value) { return value.is_string() ? escape_markup(value.get<std::string>()) : ""; }

std::string list_of(const Json& texts) {
  std::string html;
  for (const Json& entry : texts) {
    html += fmt::format("<li>{}</li>\n", text(entry));
  }
  return html.empty() ? "" : "<ul>\n" + html + "</ul>\n";
}

std::string plain_run(const Json& run) {
  std::string html = fmt::format("<section>\n<h2>{}</h2>\n<p>", text(run["name"]));
  for (const Json& fact : run["facts"]) {
    html += fmt::format("{}: {}. ", text(fact[0]), text(fact[1]));
  }
  html += fmt::format("</p>\n{}<table>\n", list_of(run["warnings"]));
  for (const Json& row : run["summary"]) {
    html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td></tr>\n", text(row["key"]), text(row["value"]),
                        text(row["meaning"]));
  }
  return html + "</table>\n</section>\n";
}

std::string plain_table(const Json& table) {
  std::string html = fmt::format("<section>\n<h2>{}</h2>\n<table>\n<tr>", text(table["title"]));
  for (const Json& column : table["columns"]) {
    html += fmt::format("<th>{}</th>", text(column));
  }
  html += "</tr>\n";
  for (const Json& row : table["rows"]) {
    html += "<tr>";
    for (const Json& cell : row) {
      html += fmt::format("<td>{}</td>", text(cell));
    }
    html += "</tr>\n";
  }
  return html + fmt::format("</table>\n<p>{}</p>\n</section>\n", text(table["caption"]));
}

/// What is shown without JavaScript.
std::string plain_content(const Json& report) {
  std::string html = fmt::format("<h1>{}</h1>\n<noscript><p>Plots and the 3D view need JavaScript.</p></noscript>\n{}",
                                 text(report["title"]), list_of(report["notes"]));
  for (const Json& table : report.value("tables", Json::array())) {
    html += plain_table(table);
  }
  // Of a benchmark the tables say it all.
  if (report["kind"] != "benchmark") {
    for (const Json& run : report["runs"]) {
      html += plain_run(run);
    }
  }
  return html;
}

void check_bundle(const ViewerBundle& viewer) {
  if (viewer.script.find("</script") != std::string_view::npos ||
      viewer.style.find("</style") != std::string_view::npos) {
    throw std::runtime_error("the viewer holds the end of its own element: build it again");
  }
}

}  // namespace

std::string generator() { return fmt::format("dynamic-icp {}", version()); }

std::string page_head(std::string_view policy, std::string_view title, const ViewerBundle& viewer) {
  check_bundle(viewer);
  const std::string policy_line =
      policy.empty() ? std::string()
                     : fmt::format("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n", policy);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{}"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<meta name=\"generator\" content=\"{}\">\n<title>{}</title>\n<style>\n",
      policy_line, escape_markup(generator()), escape_markup(std::string(title)));
  html += viewer.style;
  return html += "\n</style>\n</head>\n";
}

std::string html_page(const PageContent& content, const ViewerBundle& viewer) {
  std::size_t size = viewer.script.size() + viewer.style.size();
  for (const auto& [id, bytes] : content.blobs) {
    size += bytes.size() + 80;
  }
  const std::string data = embeddable(content.report);
  const std::string plain = plain_content(content.report);
  std::string html;
  html.reserve(size + data.size() + plain.size() + 2000);
  html +=
      page_head(kPolicy, content.report["title"].is_string() ? content.report["title"].get<std::string>() : "", viewer);
  html += "<body>\n<div id=\"app\">\n" + plain + "</div>\n";
  html += "<script type=\"application/json\" id=\"report\">";
  html += data;
  html += "</script>\n";
  const auto append = [&](std::span<const std::pair<std::string, std::string>> blobs) {
    for (const auto& [id, bytes] : blobs) {
      html += fmt::format("<script type=\"text/plain\" id=\"{}\">", id);
      html += bytes;
      html += "</script>\n";
    }
  };
  const std::span<const std::pair<std::string, std::string>> blobs = content.blobs;
  const std::size_t first = std::min(content.first_blobs, blobs.size());
  append(blobs.first(first));
  html += "<script>\n";  // no module: those wait for the end of the page
  html += viewer.script;
  html += "\n</script>\n";
  append(blobs.subspan(first));
  html += "</body>\n</html>\n";
  return html;
}

}  // namespace dynamic_icp::report
