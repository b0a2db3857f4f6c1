// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/plan_file.hpp"

#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "testing/temporary_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class PlanFileTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    write_plan(folder_, {"/bin/dynamic-icp", "0.1.0", "abc", "a processor"}, {cell("gicp"), cell("kiss-icp")});
  }

  static CellPlan cell(const std::string& method) {
    CellPlan plan;
    plan.key = {"street", method, "none"};
    plan.folder = fs::path("street") / method;
    plan.arguments = {"run", "/data/my street", "--method", method};
    plan.fingerprint = R"({"method": ")" + method + R"("})";
    plan.object_truth = "/data/my street/objects.jsonl";
    plan.scans = 70;
    plan.bytes_per_scan = 5'000'000'000;
    return plan;
  }

  /// The file with `change` made to it.
  template <class Change>
  void rewrite(const Change& change) {
    json plan = json::parse(formats::read_whole_file(folder_ / kPlanName));
    change(plan);
    write_file(folder_ / kPlanName, plan.dump());
  }

  /// What reading it says is wrong.
  [[nodiscard]] std::string fault() const {
    try {
      read_plan(folder_);
    } catch (const DataError& error) {
      return error.what();
    }
    return "nothing";
  }
};

TEST_F(PlanFileTest, ReadsBackAsItWas) {
  const PlanFile plan = read_plan(folder_);
  EXPECT_EQ(plan.version, "0.1.0");
  EXPECT_EQ(plan.checksum, "abc");
  ASSERT_EQ(plan.cells.size(), 2u);
  const CellPlan expected = cell("gicp");
  const CellPlan& read = plan.cells[0];
  EXPECT_EQ(read.key, expected.key);
  EXPECT_EQ(read.folder, expected.folder);
  EXPECT_EQ(read.arguments, expected.arguments);
  EXPECT_EQ(json::parse(read.fingerprint), json::parse(expected.fingerprint));
  EXPECT_EQ(read.object_truth, expected.object_truth);
  EXPECT_EQ(read.scans, expected.scans);
  EXPECT_EQ(read.bytes_per_scan, expected.bytes_per_scan);
}

TEST_F(PlanFileTest, ACellIsFoundByItsFolder) {
  const PlanFile plan = read_plan(folder_);
  EXPECT_EQ(find_cell(plan, "street/kiss-icp").key.method, "kiss-icp");
  EXPECT_EQ(find_cell(plan, "./street//kiss-icp").key.method, "kiss-icp");
  EXPECT_THROW(find_cell(plan, "street/icp"), UsageError);
}

TEST_F(PlanFileTest, WhatIsWrongIsNamed) {
  const std::string path = (folder_ / kPlanName).string();
  for (const char* key : {"folder", "arguments", "fingerprint", "scans"}) {
    rewrite([&](json& plan) { plan["cells"][1].erase(key); });
    EXPECT_EQ(fault().find(path), 0u) << fault();
    EXPECT_NE(fault().find(key), std::string::npos) << fault();
    SetUp();
  }
  for (const char* outside : {"../street/gicp", "/tmp/street", "street/../../x", "", "."}) {
    rewrite([&](json& plan) { plan["cells"][1]["folder"] = outside; });
    EXPECT_NE(fault().find("not below"), std::string::npos) << outside << ": " << fault();
  }
  write_file(folder_ / kPlanName, "[]");
  EXPECT_EQ(fault().find(path), 0u) << fault();
  fs::remove(folder_ / kPlanName);
  EXPECT_NE(fault().find(path), std::string::npos) << fault();
}

TEST_F(PlanFileTest, NamesThatNoJsonHoldsAreRefused) {
  CellPlan strange = cell("gicp");
  strange.arguments[1] = "/data/\xff";
  EXPECT_THROW(write_plan(folder_, {}, {strange}), DataError) << "another name would be run";
  EXPECT_EQ(read_plan(folder_).cells.size(), 2u) << "the plan before is kept";
}

TEST_F(PlanFileTest, CellsThatWereNotRunAreFailures) {
  const std::vector<CellResult> results = collect_results(folder_, read_plan(folder_));
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[1].key, cell("kiss-icp").key);
  EXPECT_FALSE(results[1].finished);
  EXPECT_EQ(results[1].failure, "not run");
}

}  // namespace
}  // namespace dynamic_icp::benchmark
