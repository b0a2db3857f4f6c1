// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

/// Nothing but stamps.
class Stamps final : public datasets::Dataset {
 public:
  explicit Stamps(std::vector<double> seconds) : seconds_(std::move(seconds)) {}
  [[nodiscard]] std::string_view format() const override { return "test"; }
  [[nodiscard]] std::size_t size() const override { return seconds_.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return {std::llround(1e9 * seconds_.at(index))}; }
  [[nodiscard]] std::filesystem::path scan_file(std::size_t) const override { return "scan"; }
  [[nodiscard]] RawScan scan(std::size_t) const override { return {}; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_; }
  [[nodiscard]] std::filesystem::path ground_truth_file() const override { return {}; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return none_; }

 private:
  std::vector<double> seconds_;
  formats::Trajectory truth_;
  std::vector<std::string> none_;
};

Finding answer(std::vector<double> seconds, double period_s, const datasets::Correction& applied = {}) {
  const Stamps recording(std::move(seconds));
  Evidence evidence;
  evidence.dataset = &recording;
  evidence.end = recording.size();
  evidence.period_s = period_s;
  evidence.applied = applied;
  return stamps(evidence);
}

TEST(Stamps, EvenOnesAreRight) {
  EXPECT_EQ(answer({0.0, 0.1, 0.2, 0.31}, 0.1).verdict, Verdict::kOk);
  EXPECT_EQ(answer({0.0}, 0.0).verdict, Verdict::kCannotTell);
}

TEST(Stamps, AGapIsNamedByTheScanAfterIt) {
  const Finding finding = answer({0.0, 0.1, 0.4, 0.5, 0.8}, 0.1);
  EXPECT_EQ(finding.verdict, Verdict::kSuspicious);
  EXPECT_NE(finding.sentence.find("2 gaps"), std::string::npos) << finding.sentence;
  EXPECT_NE(finding.sentence.find("before scan 2"), std::string::npos) << finding.sentence;
}

TEST(Stamps, AScanThatIsNotLaterIsWrong) {
  const Finding finding = answer({0.0, 0.1, 0.1, 0.2}, 0.1);
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_NE(finding.sentence.find("the first is scan 2"), std::string::npos) << finding.sentence;
}

TEST(Stamps, CountsAreToldByPeriodsNoSensorHas) {
  EXPECT_EQ(answer({0.0, 100.0, 200.0}, 100.0).fix, datasets::Correction{.time_scale = 1e-3}) << "milliseconds";
  EXPECT_EQ(answer({0.0, 1e5, 2e5}, 1e5).fix, datasets::Correction{.time_scale = 1e-6}) << "microseconds";
  EXPECT_EQ(answer({0.0, 1e8, 2e8}, 1e8).fix, datasets::Correction{.time_scale = 1e-9}) << "nanoseconds";
  EXPECT_EQ(answer({0.0, 100.0, 200.0}, 100.0, {.time_scale = 1000.0}).fix, datasets::Correction{.time_scale = 1.0});
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
