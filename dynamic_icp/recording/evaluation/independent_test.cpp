// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// The whole evaluation against a second one, written in Python on NumPy and SciPy (evaluation_oracle.py).
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/recording/evaluation/evaluation.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

namespace fs = std::filesystem;
using formats::Trajectory;
using nlohmann::json;

constexpr int kMissingModules = 77;
constexpr const char* kPython = "/usr/bin/python3";
constexpr const char* kOracle = DYNAMIC_ICP_EVALUATION_FOLDER "/evaluation_oracle.py";

struct Output {
  int status = 0;
  std::string text;
};

Output run_oracle(const fs::path& estimate, const fs::path& reference) {
  const std::string command =
      std::string(kPython) + " '" + kOracle + "' '" + estimate.string() + "' '" + reference.string() + "'";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  Output output;
  char buffer[4096];
  for (std::size_t got = 0; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
    output.text.append(buffer, got);
  }
  output.status = WEXITSTATUS(::pclose(pipe));
  return output;
}

void expect_statistics(const std::optional<Statistics>& ours, const json& theirs) {
  ASSERT_TRUE(ours);
  EXPECT_NEAR(ours->rmse, theirs["rmse"], 1e-6);
  EXPECT_NEAR(ours->mean, theirs["mean"], 1e-6);
  EXPECT_NEAR(ours->median, theirs["median"], 1e-6);
  EXPECT_NEAR(ours->p95, theirs["p95"], 1e-6);
  EXPECT_NEAR(ours->max, theirs["max"], 1e-6);
}

void compare(const Trajectory& estimate, const Trajectory& reference, const json& oracle) {
  const Evaluation se3 = evaluate(estimate, reference);
  EvaluationConfig config;
  config.gap = {GapUnit::kSeconds, 1.0};
  config.alignment = Alignment::kSim3;
  const Evaluation sim3 = evaluate(estimate, reference, config);
  EXPECT_EQ(se3.matched.size(), oracle["matched"]);
  EXPECT_EQ(se3.relative.steps.size(), oracle["frames"]["steps"]);
  expect_statistics(se3.relative.translation_m, oracle["frames"]["translation_m"]);
  expect_statistics(se3.relative.rotation_deg, oracle["frames"]["rotation_deg"]);
  EXPECT_EQ(sim3.relative.steps.size(), oracle["seconds"]["steps"]);
  expect_statistics(sim3.relative.translation_m, oracle["seconds"]["translation_m"]);
  expect_statistics(sim3.relative.rotation_deg, oracle["seconds"]["rotation_deg"]);
  expect_statistics(se3.absolute.translation_m, oracle["absolute"]["se3"]);
  expect_statistics(sim3.absolute.translation_m, oracle["absolute"]["sim3"]);
  EXPECT_NEAR(sim3.absolute.scale, oracle["absolute"]["scale"], 1e-9);
  EXPECT_EQ(se3.segments.all.count, oracle["segments"]["count"]);
  EXPECT_NEAR(*se3.segments.all.translation_percent, oracle["segments"]["translation_percent"], 1e-6);
  EXPECT_NEAR(*se3.segments.all.rotation_deg_per_100m, oracle["segments"]["rotation_deg_per_100m"], 1e-6);
  EXPECT_NEAR(*se3.reference_path_length_m, oracle["segments"]["path_length_m"], 1e-6);
}

/// Writes both, runs the oracle on the files and compares with what we make of the same files.
void check_against_oracle(const Trajectory& estimate, const Trajectory& reference) {
  const fs::path folder = fs::temp_directory_path() / ("independent_test-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  formats::write_tum(folder / "estimate.tum", estimate);
  formats::write_tum(folder / "reference.tum", reference);
  const Output output = run_oracle(folder / "estimate.tum", folder / "reference.tum");
  const Trajectory read_estimate = formats::read_tum(folder / "estimate.tum").trajectory;
  const Trajectory read_reference = formats::read_tum(folder / "reference.tum").trajectory;
  fs::remove_all(folder);
  if (output.status == kMissingModules) {
    GTEST_SKIP() << "NumPy or SciPy is missing: apt-get install python3-scipy";
  }
  ASSERT_EQ(output.status, 0) << output.text;
  compare(read_estimate, read_reference, json::parse(output.text));
}

class Independent : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kPython)) {
      GTEST_SKIP() << kPython << " is missing";
    }
  }
};

TEST_F(Independent, EqualStamps) {
  std::mt19937 random(11);
  const Trajectory reference = random_drive(random, 600);
  check_against_oracle(moved(disturbed(random, reference, 0.01, 0.1), random_motion(random, 3.0, 100.0)), reference);
}

TEST_F(Independent, InterpolatedReferenceWithGapsAndJitter) {
  std::mt19937 random(12);
  Trajectory truth = random_drive(random, 600);
  std::uniform_int_distribution<std::int64_t> jitter(-30'000'000, 30'000'000);
  for (formats::StampedPose& pose : truth) {
    pose.stamp.ns += jitter(random);
  }
  Trajectory estimate;
  Trajectory reference;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const bool hole = (k > 200 && k < 230) || k < 5 || k > 590;
    if (!hole) {
      reference.push_back(truth[k]);
    }
  }
  for (formats::StampedPose pose : disturbed(random, truth, 0.02, 0.1)) {
    pose.stamp.ns += 17'000'000;
    estimate.push_back(pose);
  }
  check_against_oracle(scaled(estimate, 0.8), reference);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
