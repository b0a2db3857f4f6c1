// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/evaluation_report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;
using nlohmann::json;

const EvaluationSource kSource = {"a \"quoted\".tum", "b\xff.tum", 0, 3};

/// No number may be written as text, and no "nan" or "inf" stand anywhere.
void expect_plain_numbers(const std::string& text) {
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_EQ(text.find("inf"), std::string::npos) << text;
}

TEST(EvaluationReport, JsonHoldsTheNumbers) {
  std::mt19937 random(1);
  const Trajectory reference = random_drive(random, 200);
  const Evaluation evaluation = evaluate(disturbed(random, reference, 0.01, 0.05), reference);
  const json parsed = json::parse(evaluation_json(evaluation, kSource));
  EXPECT_EQ(parsed["estimate"], "a \"quoted\".tum");
  EXPECT_EQ(parsed["reference_repeated_lines"], 3);
  EXPECT_EQ(parsed["matched"], 200);
  EXPECT_EQ(parsed["rte_rmse_m"], evaluation.relative.translation_m->rmse);
  EXPECT_EQ(parsed["rre_p95_deg"], evaluation.relative.rotation_deg->p95);
  EXPECT_EQ(parsed["ate_median_m"], evaluation.absolute.translation_m->median);
  EXPECT_EQ(parsed["path_length_m"], *evaluation.reference_path_length_m);
  EXPECT_EQ(parsed["alignment"]["kind"], "se3");
  EXPECT_EQ(parsed["alignment"]["status"], "unique");
  EXPECT_EQ(parsed["segments"]["count"], evaluation.segments.all.count);
  EXPECT_EQ(parsed["segments"]["translation_percent"], *evaluation.segments.all.translation_percent);
  ASSERT_EQ(parsed["segments"]["lengths"].size(), 8u);
  EXPECT_EQ(parsed["segments"]["lengths"][2]["length_m"], 300.0);
}

TEST(EvaluationReport, ShowsTheConsistencyWhereCovariancesAreStated) {
  const Trajectory reference = along_x({0.0, 1.0, 2.0});
  const std::vector<StatedMotion> stated(3, {Matrix6d::Identity() * 0.01, true, false});
  const Evaluation evaluation = evaluate(along_x({0.0, 1.2, 2.4}), reference, {}, stated);
  const json parsed = json::parse(evaluation_json(evaluation, kSource));
  EXPECT_EQ(parsed["consistency"]["motions"], 2);
  EXPECT_NEAR(parsed["consistency"]["nees_translation"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(parsed["consistency"]["nees_rotation"], 0.0);
  EXPECT_EQ(parsed["consistency"]["beyond_4_sigma"], 0.0);
  EXPECT_NE(evaluation_table(evaluation, kSource).find("beyond 4 sigma"), std::string::npos);
  const Evaluation without = evaluate(reference, reference);
  EXPECT_TRUE(json::parse(evaluation_json(without, kSource))["consistency"]["nees_rotation"].is_null());
  EXPECT_EQ(evaluation_table(without, kSource).find("sigma"), std::string::npos);
}

TEST(EvaluationReport, NullWhereNothingCanBeTold) {
  const Trajectory one = along_x({0.0});
  for (const Evaluation& evaluation : {evaluate(one, one), evaluate(along_x({0.0, 1e200}), along_x({0.0, 1.0}))}) {
    const json parsed = json::parse(evaluation_json(evaluation, kSource));
    for (const char* key : {"rte_rmse_m", "rte_max_m", "ate_rmse_m", "ate_p95_m"}) {
      EXPECT_TRUE(parsed.at(key).is_null()) << key;
    }
    EXPECT_TRUE(parsed["segments"]["translation_percent"].is_null());
    expect_plain_numbers(evaluation_json(evaluation, kSource));
    expect_plain_numbers(evaluation_table(evaluation, kSource));
  }
}

TEST(EvaluationReport, TableSaysWhatTheNumbersAre) {
  const Trajectory reference = along_x({0.0, 0.5, 0.5, 1.5});
  EvaluationConfig config;
  config.gap = {GapUnit::kFrames, 2.0};
  config.alignment = Alignment::kSim3;
  const std::string table = evaluation_table(evaluate(along_x({0.0, 0.5, 1.0, 1.5, 2.0}), reference, config), kSource);
  for (const char* part : {"4 of 5 estimated poses", "RTE  m, translation over 2 frames", "RRE  deg", "with scale",
                           "the path is not longer than 100 m", "repeats its position 1 times", "lie on one line",
                           "3 repeated lines dropped"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  }
}

TEST(EvaluationReport, TableWarnsOfAGapNobodyReaches) {
  EvaluationConfig config;
  config.gap = {GapUnit::kSeconds, 5.0};
  const Trajectory two = along_x({0.0, 1.0});
  EXPECT_NE(evaluation_table(evaluate(two, two, config), kSource).find("no two matched poses are 5 s apart"),
            std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
