// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;

TEST(Evaluation, MeasuresOverTheMatchedPosesOnly) {
  const Trajectory estimate = along_x({0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
  Trajectory reference = along_x({0.0, 2.0, 4.0, 6.0, 8.0, 10.0});
  reference.erase(reference.begin());  // the first estimated pose has no reference, the last reference pose no estimate
  const Evaluation evaluation = evaluate({estimate.begin(), estimate.end() - 1}, reference);
  EXPECT_EQ(evaluation.matched.size(), 4u);
  EXPECT_EQ(evaluation.matched.estimate_count, 5u);
  EXPECT_NEAR(evaluation.time_span_s, 0.3, 1e-15);
  EXPECT_EQ(evaluation.reference_path_length_m, 6.0);
  EXPECT_EQ(evaluation.estimate_path_length_m, 3.0);
  EXPECT_NEAR(evaluation.relative.translation_m->rmse, 1.0, 1e-15);
}

TEST(Evaluation, NoticesAReferenceThatRepeatsItsPoses) {
  // 0.5 m a scan; the reference repeats every third position and jumps after it.
  const Trajectory estimate = along_x({0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0});
  const Trajectory repeating = along_x({0.0, 0.5, 0.5, 1.5, 2.0, 2.0, 3.0});
  const Evaluation evaluation = evaluate(estimate, repeating);
  EXPECT_EQ(evaluation.repeated_reference_poses, 2u);
  EXPECT_NEAR(evaluation.relative.translation_m->max, 0.5, 1e-15);
  EXPECT_EQ(evaluate(estimate, estimate).repeated_reference_poses, 0u);
  // Standing still is no repetition, nor is the slow drift of an estimate.
  const Trajectory still = along_x({1.0, 1.0, 1.0});
  EXPECT_EQ(evaluate(still, still).repeated_reference_poses, 0u);
  EXPECT_EQ(evaluate(along_x({1.0, 1.04, 1.08}), still).repeated_reference_poses, 0u);
}

TEST(Evaluation, ChecksTheConfigurationFirst) {
  EvaluationConfig config;
  EXPECT_NO_THROW(check_config(config));
  config.gap = {GapUnit::kSeconds, 0.0};
  EXPECT_THROW(check_config(config), UsageError);
  EXPECT_THROW(evaluate({}, {}, config), UsageError);
  config = {};
  config.association.max_gap_s = -0.1;
  EXPECT_THROW(check_config(config), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
