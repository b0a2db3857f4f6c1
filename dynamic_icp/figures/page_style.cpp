// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/figures/page_style.hpp"

#include <fmt/format.h>

#include "dynamic_icp/drawing/theme.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr const char* kRules = R"css(
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 24px 20px 48px; max-width: 1200px; background: var(--page); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 28px; line-height: 1.2; overflow-wrap: anywhere; }
h2 { margin: 0 0 10px; font-size: 17px; }
.kind { margin: 0 0 2px; color: var(--muted); font-size: 13px; letter-spacing: .06em; text-transform: uppercase; }
.facts { margin: 6px 0 18px; color: var(--muted); }
.facts span { display: inline-block; margin-right: 18px; }
.facts b { color: var(--ink); font-weight: 600; }
.muted { color: var(--muted); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(128px, 1fr)); gap: 10px; margin-bottom: 16px; }
.tiles div { padding: 12px 14px; }
.tiles b { display: block; font-size: 19px; line-height: 1.25; font-variant-numeric: tabular-nums; }
.tiles span { color: var(--muted); font-size: 13px; }
.tiles div, section, figure { background: var(--background); border: 1px solid var(--grid); border-radius: 10px; }
section { padding: 16px 18px; margin-bottom: 16px; }
figure { margin: 0; padding: 4px; overflow-x: auto; }
figure svg { display: block; width: 100%; height: auto; }
.wide { margin-bottom: 16px; }
.wide svg { min-width: 760px; }
.grid { columns: 2 480px; column-gap: 16px; }
.grid figure { break-inside: avoid; margin-bottom: 16px; }
.columns { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 480px), 1fr)); gap: 0 16px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { padding: 4px 12px 4px 0; border-bottom: 1px solid var(--grid); text-align: left; vertical-align: top; }
tr:last-child th, tr:last-child td { border-bottom: 0; }
th { font-weight: 400; font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: 13px; }
td { color: var(--muted); }
.numbers td.value { white-space: nowrap; }
td.value { color: var(--ink); font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
pre { margin: 0 0 12px; padding: 10px 12px; border-radius: 6px; background: var(--panel); font-size: 13px;
  white-space: pre-wrap; overflow-wrap: anywhere; }
ul.warnings { margin: 0; padding-left: 18px; }
ul.warnings li { margin-bottom: 6px; overflow-wrap: anywhere; }
@media (max-width: 560px) {
  tr { display: grid; grid-template-columns: minmax(0, 1fr) fit-content(60%); column-gap: 12px;
    border-bottom: 1px solid var(--grid); }
  tr:last-child { border-bottom: 0; }
  th, td { border: 0; padding-right: 0; overflow-wrap: anywhere; }
  td + td { grid-column: 1 / -1; padding-top: 0; font-size: 13px; }
}
@media print { body { max-width: none; } }
)css";

}  // namespace

std::string page_style() {
  return fmt::format(":root{{--page:#eef0f4;{}}}\n@media (prefers-color-scheme: dark){{:root{{--page:#0a0d13;{}}}}}\n",
                     drawing::css_variables(drawing::Ground::kLight), drawing::css_variables(drawing::Ground::kDark)) +
         kRules;
}

}  // namespace dynamic_icp::figures
