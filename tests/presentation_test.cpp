// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Reports and pictures of runs.
#include <string>
#include <tuple>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Presentation : public ProgramTest {};

TEST_F(Presentation, ReportsShowRunsAloneAndTogether) {
  const std::string out = (folder_ / "out").string();
  const Outcome run = run_program("run " + street().string() + " --report --quiet --output " + out);
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_TRUE(fs::exists(folder_ / "out" / "labels" / "00001.bin")) << "what the page shows is there for the next one";
  const Outcome single = run_program("report --budget-mb 1 --frames 1-2 " + out);
  const Outcome both = run_program("report " + out + " " + out);
  if (!fs::exists(folder_ / "out" / "report.html")) {
    EXPECT_NE(run.text.find("no report.html: this program was built without the viewer"), std::string::npos)
        << run.text;
    EXPECT_EQ(single.status, 1) << single.text;
    EXPECT_NE(single.text.find("install_viewer.sh"), std::string::npos) << single.text;
    EXPECT_EQ(both.status, 1) << both.text;
    GTEST_SKIP() << "built without the viewer";
  }
  EXPECT_EQ(run.text, "");
  EXPECT_EQ(single.status, 0) << single.text;
  EXPECT_EQ(both.status, 0) << both.text;
  const std::string page = read_file(folder_ / "out" / "report.html");
  EXPECT_LT(page.size(), 4'000'000u) << "scans of 1 MB, the viewer, and the path";
  EXPECT_NE(page.find("<script type=\"text/plain\" id=\"scan-0-0\">"), std::string::npos);
  const std::string compared = read_file(folder_ / "comparison.html");
  EXPECT_NE(compared.find("\"kind\":\"comparison\""), std::string::npos);
}

TEST_F(Presentation, ReportRefusesWhatItCannotShow) {
  run_and_summarise(street().string() + " --save-labels");
  const std::string out = (folder_ / "out").string();
  if (run_program("report " + out).status != 0) {
    GTEST_SKIP() << "built without the viewer";
  }
  const std::tuple<std::string, int, std::string> cases[] = {
      {out + " --frames 1-", 2, "--frames is '1-'"},
      {out + " --frames 3-1", 2, "--frames is '3-1'"},
      {out + " --frames 1,,2", 2, "--frames is '1,,2'"},
      {out + " --frames 100000", 2, "scan 100000 is asked for"},
      {out + " --budget-mb 0", 2, "--budget-mb"},
      {out + " --budget-mb nan", 2, "--budget-mb is nan"},
      {out + " --threads 100000", 2, "--threads"},
      {out + " --output " + out + "/run.json", 2, "expected a file that ends in .html"},
      {out + " " + out + " --frames 1", 2, "are for the report of one run"},
      {street().string(), 1, "run.json: no such file"},
      {out + " " + street().string(), 1, "run.json: no such file"},
      {"", 2, "DIR"}};
  for (const auto& [arguments, status, text] : cases) {
    const Outcome outcome = run_program("report " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments << outcome.text;
    EXPECT_NE(outcome.text.find(text), std::string::npos) << arguments << ": " << outcome.text;
  }
}

TEST_F(Presentation, PlotsAreMadeFromARun) {
  run_and_summarise(street().string() + " --save-labels");
  const Outcome plots = run_program("plot " + (folder_ / "out").string());
  ASSERT_EQ(plots.status, 0) << plots.text;
  for (const char* name : {"trajectory.svg", "errors.svg", "speed.svg", "scan.svg"}) {
    EXPECT_TRUE(read_file(folder_ / "out" / "plots" / name).find("<svg") != std::string::npos) << name;
  }
  const std::string out = (folder_ / "out").string();
  const Outcome both = run_program("plot " + out + " " + out + " --output " + (folder_ / "both").string());
  ASSERT_EQ(both.status, 0) << both.text;
  EXPECT_TRUE(fs::exists(folder_ / "both" / "trajectory.svg") && fs::exists(folder_ / "both" / "errors.svg"));
  const Outcome png = run_program("plot " + out + " --format png --scale 1 --output " + (folder_ / "png").string());
  if (png.status == 0) {
    EXPECT_EQ(read_file(folder_ / "png" / "trajectory.png").substr(1, 3), "PNG");
    EXPECT_FALSE(fs::exists(folder_ / "png" / "trajectory.svg"));
    const auto pdf = [&](const char* name) {
      run_program("plot " + out + " --format pdf --output " + (folder_ / name).string());
      return read_file(folder_ / name / "trajectory.pdf");
    };
    const std::string first = pdf("pdf");
    EXPECT_EQ(first.substr(0, 5), "%PDF-");
    EXPECT_TRUE(first == pdf("pdf-again")) << "the same picture, the same bytes";
    run_program("plot " + out + " --paper --format pdf --output " + (folder_ / "paper").string());
    const std::string paper = read_file(folder_ / "paper" / "trajectory.pdf");
    const std::size_t box = paper.find("/MediaBox [ 0 0 ");
    ASSERT_NE(box, std::string::npos);
    EXPECT_NEAR(std::stod(paper.substr(box + 16)), 88.0 / 25.4 * 72.0, 0.1) << "a column of 88 mm, in points";
  } else {
    EXPECT_EQ(png.status, 1);
    EXPECT_NE(png.text.find("built without librsvg"), std::string::npos) << png.text;
  }
  EXPECT_EQ(run_program("plot " + out + " --format gif").status, 2);
}

}  // namespace
}  // namespace dynamic_icp::tests
