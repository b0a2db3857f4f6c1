// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/figures/report_page.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/drawing/markup.hpp"
#include "dynamic_icp/drawing/theme.hpp"
#include "dynamic_icp/figures/page_style.hpp"
#include "dynamic_icp/figures/summary_keys.hpp"

namespace dynamic_icp::figures {
namespace {

/// What the run is called: by its recording, since the folder may still be under construction under another name.
std::string name_of(const RunFiles& run) {
  const std::string input = text_of(run.run, "input.path");
  const std::filesystem::path path = std::filesystem::path(input.empty() ? run.folder.string() : input);
  const std::filesystem::path whole = path.lexically_normal();
  const std::string name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  return name.empty() ? "run" : name;
}

std::string table_row(std::string_view name, std::string_view value, std::string_view explanation = {}) {
  const std::string last = explanation.empty() ? "" : fmt::format("<td>{}</td>", drawing::escape_markup(explanation));
  return fmt::format("<tr><th scope=\"row\">{}</th><td class=\"value\">{}</td>{}</tr>\n", drawing::escape_markup(name),
                     drawing::escape_markup(value), last);
}

std::string section(std::string_view title, std::string_view content) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", drawing::escape_markup(title), content);
}

/// The few numbers to see first.
std::string tiles(const RunFiles& run) {
  constexpr std::pair<const char*, const char*> kTiles[] = {{"frames", "scans"},
                                                            {"path_length_m", "path"},
                                                            {"rte_rmse_m", "RTE (RMSE)"},
                                                            {"rre_rmse_deg", "RRE (RMSE)"},
                                                            {"ms_median", "time per scan"},
                                                            {"convergence_rate", "converged"},
                                                            {"dynamic_ratio_mean", "moving points"}};
  std::string html = "<div class=\"tiles\">\n";
  for (const auto& [key, name] : kTiles) {
    html += fmt::format("<div><b>{}</b><span>{}</span></div>\n",
                        drawing::escape_markup(value_with_unit(run.summary, key)), name);
  }
  return html + "</div>\n";
}

std::string header(const RunFiles& run) {
  std::string html = fmt::format("<header>\n<p class=\"kind\">Dynamic-ICP run</p>\n<h1>{}</h1>\n",
                                 drawing::escape_markup(name_of(run)));
  html += "<p class=\"facts\">";
  for (const auto& [key, name] : {std::pair("method", "method"), std::pair("preset", "preset"),
                                  std::pair("ablation", "ablation"), std::pair("version", "version")}) {
    if (const std::string value = text_of(run.run, key); !value.empty()) {
      html += fmt::format("<span>{} <b>{}</b></span> ", name, drawing::escape_markup(value));
    }
  }
  return html + "</p>\n</header>\n" + tiles(run);
}

/// What a reader should know before trusting the numbers.
std::string warnings(const RunFiles& run, std::vector<std::string> notes) {
  notes.insert(notes.end(), run.warnings.begin(), run.warnings.end());
  std::map<std::string, std::vector<std::size_t>> by_status;
  for (const FrameRow& frame : run.frames) {
    if (frame.status != "converged" && frame.status != "first") {
      by_status[frame.status].push_back(frame.index);
    }
  }
  std::string items;
  constexpr std::size_t kNamed = 12;
  for (const auto& [status, indices] : by_status) {
    std::string names;
    for (std::size_t k = 0; k < std::min(indices.size(), kNamed); ++k) {
      names += fmt::format("{}{}", k == 0 ? "" : ", ", indices[k]);
    }
    items +=
        fmt::format("<li><b>{} of {} scans: {}</b> <span class=\"muted\">scan {}{}</span></li>\n", indices.size(),
                    run.frames.size(), drawing::escape_markup(status), names, indices.size() > kNamed ? ", ..." : "");
  }
  for (const std::string& note : notes) {
    items += fmt::format("<li>{}</li>\n", drawing::escape_markup(note));
  }
  return items.empty() ? "<p class=\"muted\">No warnings: every scan was aligned and converged.</p>\n"
                       : section("Warnings", "<ul class=\"warnings\">\n" + items + "</ul>\n");
}

std::string summary(const RunFiles& run) {
  std::string rows;
  for (const auto& [key, value] : run.summary) {
    rows += table_row(key, value_with_unit(run.summary, key), meaning_of(key));
  }
  return section("Summary", "<div class=\"scroll\"><table class=\"numbers\">\n" + rows + "</table></div>\n");
}

std::string figure_grid(const RunFiles& run, const RunContext& context) {
  std::string wide;
  std::string narrow;
  for (const Figure& figure : draw_figures(run, context, drawing::page_theme())) {
    const bool is_wide = figure.name == "scan";
    (is_wide ? wide : narrow) +=
        fmt::format("<figure class=\"{}\">\n{}</figure>\n", is_wide ? "wide" : "narrow", figure.svg.element());
  }
  return wide + "<div class=\"grid\">\n" + narrow + "</div>\n";
}

std::string settings_table(const Settings& settings) {
  std::string rows;
  for (const auto& [key, value] : settings) {
    const std::string text = text_of(settings, key);
    rows += table_row(key, text.empty() ? "-" : text);
  }
  return "<div class=\"scroll\"><table>\n" + rows + "</table></div>\n";
}

std::string origin(const RunFiles& run) {
  Settings rest = run.run;
  std::erase_if(rest, [](const auto& entry) { return entry.first == "command"; });
  return section(
      "How it was made",
      fmt::format("<pre>{}</pre>\n", drawing::escape_markup(text_of(run.run, "command"))) + settings_table(rest));
}

}  // namespace

std::string report_page(const RunFiles& run, const RunContext& context) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
      drawing::escape_markup(name_of(run) + " - Dynamic-ICP run"), page_style());
  html += header(run) + warnings(run, context.notes);
  html += figure_grid(run, context);
  html += "<div class=\"columns\">\n<div>\n" + summary(run) + "</div>\n<div>\n";
  html += origin(run) + section("Configuration", settings_table(run.configuration));
  return html + "</div>\n</div>\n</body>\n</html>\n";
}

}  // namespace dynamic_icp::figures
