// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/figures/report_page.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/drawing/well_formed.hpp"
#include "dynamic_icp/figures/sample_run.hpp"
#include "dynamic_icp/figures/summary_keys.hpp"

namespace dynamic_icp::figures {
namespace {

std::string page_of(const RunFiles& run) {
  const std::string page = report_page(run, read_context(run));
  EXPECT_EQ(drawing::WellFormed::fault_of(page), "");
  EXPECT_FALSE(drawing::holds_non_finite(page));
  return page;
}

std::string page_of(const SampleRun& sample) {
  const TestFolder folder;
  sample.write_recording(folder);
  sample.write_run(folder);
  return page_of(read_run(folder.path() / "run"));
}

TEST(ReportPage, ShowsEveryFigureAndEveryKey) {
  const std::string page = page_of(SampleRun());
  EXPECT_EQ(drawing::count_of(page, "<figure"), 7u);
  for (const char* text : {"rte_rmse_m", ">0.01 m<", ">100 %<", "250 1/s", "preprocess.voxel_size_m", ">0.3<",
                           "dynamic-icp run drive --output run", "<h1>drive</h1>", "No warnings"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  EXPECT_NE(page.find("ate_rmse_m</th><td class=\"value\">-</td>"), std::string::npos) << "null is a dash";
}

TEST(ReportPage, NeedsNothingFromOutside) {
  const std::string page = page_of(SampleRun());
  EXPECT_EQ(drawing::count_of(page, "<script"), 0u);
  EXPECT_EQ(drawing::count_of(page, "src="), 0u);
  EXPECT_EQ(drawing::count_of(page, "href="), 0u);
  EXPECT_EQ(drawing::count_of(page, "url("), 0u);
  EXPECT_EQ(drawing::count_of(page, "@import"), 0u);
  EXPECT_EQ(drawing::count_of(page, "http"), drawing::count_of(page, "xmlns=\"http://www.w3.org/2000/svg\"") + 1)
      << "http-equiv";
}

TEST(ReportPage, DefinesEveryColourItUses) {
  const std::string page = page_of(SampleRun());
  for (std::size_t at = page.find("var("); at != std::string::npos; at = page.find("var(", at + 1)) {
    const std::string name = page.substr(at + 4, page.find(')', at) - at - 4);
    EXPECT_EQ(drawing::count_of(page, name + ":"), 2u) << name << ": once for light, once for dark";
  }
}

TEST(ReportPage, ShowsHostileTextAsText) {
  const TestFolder folder;
  SampleRun sample;
  sample.command = "<script>alert(1)</script> & 'quotes'";
  sample.write_recording(folder);
  sample.write_run(folder);
  RunFiles run = read_run(folder.path() / "run");
  const std::string hostile = "\"><img src=x onerror=alert(1)>\x01\xFF";
  run.configuration.emplace_back(hostile, hostile);
  run.summary.emplace_back(hostile, hostile);
  run.run.emplace_back(hostile, hostile);
  run.run.insert(run.run.begin(), {"input.path", "/data/<b>\"drive\"&"});
  run.warnings.push_back(hostile);
  run.frames[2].status = hostile;
  run.frames[0].milliseconds.emplace_back(hostile, 1.0);
  const std::string page = page_of(run);
  EXPECT_EQ(drawing::count_of(page, "<script"), 0u);
  EXPECT_EQ(drawing::count_of(page, "<img"), 0u);
  EXPECT_EQ(drawing::count_of(page, "<b>\"drive"), 0u);
  EXPECT_NE(page.find("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &#39;quotes&#39;"), std::string::npos);
}

TEST(ReportPage, CountsScansThatWentWrong) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  RunFiles run = read_run(folder.path() / "run");
  run.frames[1].status = "degenerate";
  run.frames[4].status = "degenerate";
  run.frames[2].status = "time_gap";
  const std::string page = page_of(run);
  EXPECT_NE(page.find("2 of 5 scans: degenerate</b> <span class=\"muted\">scan 1, 4<"), std::string::npos);
  EXPECT_NE(page.find("1 of 5 scans: time_gap</b>"), std::string::npos);
  EXPECT_EQ(page.find("No warnings"), std::string::npos);
}

TEST(ReportPage, TakesRunsWithNoneAndOneScan) {
  for (const std::size_t frames : {0u, 1u, 2u}) {
    const TestFolder folder;
    SampleRun sample;
    sample.frames = frames;
    sample.write_run(folder);
    if (frames > 0) {
      sample.write_recording(folder);
    }
    page_of(read_run(folder.path() / "run"));
  }
}

TEST(SummaryKeys, HaveUnits) {
  const Settings summary = {
      {"rte_rmse_m", 0.012345},     {"rre_rmse_deg", 0.5}, {"ms_p95", 1234.5}, {"fps", 12.0},
      {"convergence_rate", 0.9876}, {"frames", 123456.0},  {"method", "gicp"}, {"ate_rmse_m", {}}};
  EXPECT_EQ(value_with_unit(summary, "rte_rmse_m"), "0.01235 m");
  EXPECT_EQ(value_with_unit(summary, "rre_rmse_deg"), "0.5°");
  EXPECT_EQ(value_with_unit(summary, "fps"), "12 1/s");
  EXPECT_EQ(value_with_unit(summary, "convergence_rate"), "98.76 %");
  EXPECT_EQ(value_with_unit(summary, "frames"), "123456");
  EXPECT_EQ(value_with_unit(summary, "method"), "gicp");
  EXPECT_EQ(value_with_unit(summary, "ate_rmse_m"), "-");
  EXPECT_EQ(value_with_unit(summary, "absent"), "-");
  EXPECT_EQ(value_with_unit(summary, "ms_p95"), "1234 ms");
}

}  // namespace
}  // namespace dynamic_icp::figures
