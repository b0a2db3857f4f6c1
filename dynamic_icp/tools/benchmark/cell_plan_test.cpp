// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_plan.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

namespace dynamic_icp::benchmark {
namespace {

/// All that goes into a plan.
struct Ingredients {
  Program program{"/bin/dynamic-icp", "0.1.0", "abc", "a processor"};
  Sequence sequence{"street", "/data/street", 10, {0}, {900'000'000}, "123", {}};
  std::string method = "dynamic-icp";
  std::string ablation = "none";
  RunSettings settings;
  std::vector<std::string> configuration = {"a=1", "b=2"};
};

CellPlan plan(const Ingredients& from) {
  return plan_cell(from.program, from.sequence, from.method, from.ablation, from.settings, from.configuration);
}

TEST(CellPlan, SaysWhereAndHow) {
  Ingredients from;
  from.settings = {"paper", "/my.yaml", {"x=1", "y=2"}, {}, 3, 5, 2};
  for (const auto& [name, text] : {std::pair{"format", "dicp"}, {"field.x", "px"}, {"doppler-sign", "towards"}}) {
    datasets::set(from.settings.input, name, text);
  }
  from.ablation = "no-dr";
  const CellPlan planned = plan(from);
  EXPECT_EQ(planned.folder, "street/dynamic-icp_no-dr");
  EXPECT_EQ(
      planned.arguments,
      (std::vector<std::string>{
          "run",        "/data/street", "--method",       "dynamic-icp", "--preset", "paper", "--format",     "dicp",
          "--field",    "x=px",         "--doppler-sign", "towards",     "--start",  "3",     "--threads",    "2",
          "--ablation", "no-dr",        "--set",          "x=1",         "--set",    "y=2",   "--max-frames", "5"}));
  from.ablation = "none";
  EXPECT_EQ(plan(from).folder, "street/dynamic-icp");
}

TEST(CellPlan, SaysHowMuchItIs) {
  Ingredients from;
  from.sequence.bytes = 1000;
  EXPECT_EQ(plan(from).scans, 10u);
  EXPECT_EQ(plan(from).bytes_per_scan, 100u);
  from.settings.start = 3;
  EXPECT_EQ(plan(from).scans, 7u);
  from.settings.max_frames = 5;
  EXPECT_EQ(plan(from).scans, 5u);
  from.settings.start = 8;
  EXPECT_EQ(plan(from).scans, 2u);
}

TEST(CellPlan, TheFingerprintIsThatOfWhatDecidesTheResult) {
  const std::string before = plan({}).fingerprint;
  EXPECT_EQ(plan({}).fingerprint, before);
  const std::vector<std::function<void(Ingredients&)>> changes = {
      [](Ingredients& from) { from.program.version = "0.2.0"; },
      [](Ingredients& from) { from.program.checksum = "abd"; },
      [](Ingredients& from) { from.program.processor = "another"; },
      [](Ingredients& from) { from.sequence.path = "/data/other/street"; },
      [](Ingredients& from) { from.sequence.scans = 11; },
      [](Ingredients& from) { from.sequence.first_stamp.ns = 1; },
      [](Ingredients& from) { from.sequence.last_stamp.ns = 900'000'001; },
      [](Ingredients& from) { from.sequence.content = "124"; },
      [](Ingredients& from) { from.method = "gicp"; },
      [](Ingredients& from) { from.ablation = "no-vf"; },
      [](Ingredients& from) { from.settings.preset = "paper"; },
      [](Ingredients& from) { from.settings.input.open.format = "dicp"; },
      [](Ingredients& from) { datasets::set(from.settings.input, "doppler-sign", "towards"); },
      [](Ingredients& from) { from.settings.start = 1; },
      [](Ingredients& from) { from.settings.max_frames = 10; },
      [](Ingredients& from) { from.settings.threads = 1; },
      [](Ingredients& from) { from.configuration[1] = "b=3"; }};
  std::vector<std::string> fingerprints = {before};
  for (const auto& change : changes) {
    Ingredients from;
    change(from);
    fingerprints.push_back(plan(from).fingerprint);
  }
  std::sort(fingerprints.begin(), fingerprints.end());
  EXPECT_EQ(std::adjacent_find(fingerprints.begin(), fingerprints.end()), fingerprints.end()) << "all differ";
}

TEST(CellPlan, WhereASettingCameFromDoesNotMatter) {
  Ingredients from;
  from.settings.settings = {"b=2"};
  from.settings.config_file = "/my.yaml";
  EXPECT_EQ(plan(from).fingerprint, plan({}).fingerprint) << "the resolved configuration is the same";
}

}  // namespace
}  // namespace dynamic_icp::benchmark
