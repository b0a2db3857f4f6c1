// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/recording_check.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::runs {
namespace {

/// A radar that rounds its Doppler to whole dm/s and stays where it is before it moves along x, s = -u.v.
class LateStart final : public datasets::Dataset {
 public:
  /// `unit`: as many units of its Doppler are 1 m/s.
  explicit LateStart(double unit = 1.0, formats::Trajectory truth = {}) : truth_(std::move(truth)), unit_(unit) {}

  static constexpr std::size_t kScans = 120;
  static constexpr std::size_t kFirstMoving = 70;

  [[nodiscard]] std::string_view format() const override { return "test"; }
  [[nodiscard]] std::size_t size() const override { return kScans; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override {
    return Stamp{static_cast<std::int64_t>(index) * 100'000'000};
  }
  [[nodiscard]] std::filesystem::path scan_file(std::size_t /*index*/) const override { return "scan"; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_; }
  [[nodiscard]] std::filesystem::path ground_truth_file() const override { return {}; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return none_; }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    constexpr double kSpeed_mps = 5.0;
    const bool moves = index >= kFirstMoving;
    const double x_m = moves ? 0.1 * kSpeed_mps * static_cast<double>(index - kFirstMoving) : 0.0;
    const RandomSource source(7);
    RawScan raw;
    raw.stamp = stamp(index);
    for (std::uint64_t k = 0; k < 300; ++k) {
      const Eigen::Vector3d point(80.0 * source.uniform(3 * k) - 10.0 - x_m, 40.0 * source.uniform(3 * k + 1) - 20.0,
                                  6.0 * source.uniform(3 * k + 2) - 2.0);
      raw.points.push_back(point);
      raw.doppler.push_back(moves ? unit_ * 0.1 * std::round(-10.0 * kSpeed_mps * point.normalized().x()) : 0.0);
    }
    return raw;
  }

 private:
  formats::Trajectory truth_;
  double unit_;
  std::vector<std::string> none_;
};

TEST(RecordingCheck, TheDopplerOfASensorThatMovesLaterIsNotRefused) {
  const LateStart recording;
  const RecordingCheck check = check_recording(recording, {}, {0, LateStart::kScans, 1}, {true});
  EXPECT_NE(check.doppler.find("relative"), std::string::npos) << check.doppler;
  EXPECT_NEAR(check.period_s, 0.1, 1e-9);
}

TEST(RecordingCheck, ThatOfASensorThatNeverMovesIs) {
  const LateStart recording(0.0);
  EXPECT_THROW(check_recording(recording, {}, {0, LateStart::kScans, 1}, {true}), DataError);
  EXPECT_THROW(check_recording(recording, {}, {0, LateStart::kFirstMoving, 1}, {true}), DataError);
  EXPECT_NO_THROW(check_recording(recording, {}, {0, LateStart::kFirstMoving, 1}, {false}));
}

TEST(RecordingCheck, ARunOverScansAtRestAloneIsNotRefusedWhereTheOthersMove) {
  const LateStart recording;
  const RecordingCheck check = check_recording(recording, {}, {0, LateStart::kFirstMoving, 1}, {true});
  ASSERT_FALSE(check.warnings.empty());
  EXPECT_NE(check.warnings[0].find("at rest"), std::string::npos) << check.warnings[0];
}

/// The ground truth of LateStart while it moves.
formats::Trajectory moving_truth() {
  formats::Trajectory truth;
  for (std::size_t i = LateStart::kFirstMoving; i < LateStart::kScans; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = 0.5 * static_cast<double>(i - LateStart::kFirstMoving);
    truth.push_back({Stamp{static_cast<std::int64_t>(i) * 100'000'000}, pose});
  }
  return truth;
}

std::string refusal(const LateStart& recording, const datasets::InputSettings& settings, const Needs& needs) {
  const FixInWords in_words = [](const diagnosis::Finding& finding) {
    std::string text;
    for (const auto& [name, value] : datasets::texts({.open = {}, .correction = finding.fix})) {
      text += name + "=" + value + " ";
    }
    return text;
  };
  try {
    check_recording(recording, settings, {LateStart::kFirstMoving, LateStart::kScans, 1}, needs, in_words);
    return "none";
  } catch (const DataError& error) {
    return error.what();
  }
}

// 3.6 km/h are 1 m/s.
TEST(RecordingCheck, DopplerInAnotherUnitIsRefusedWithWhatFixesIt) {
  const LateStart recording(3.6, moving_truth());
  const std::string text = refusal(recording, {}, {true});
  EXPECT_NE(text.find("km/h"), std::string::npos) << text;
  EXPECT_NE(text.find("Run with doppler-scale=0.277778"), std::string::npos) << text;
  EXPECT_NE(text.find("state that it is not so with doppler-scale=1 "), std::string::npos) << text;
}

TEST(RecordingCheck, AUnitThatTheUserStatesIsBelieved) {
  const LateStart recording(3.6, moving_truth());
  datasets::InputSettings settings;
  settings.correction.doppler_scale = 1.0;
  EXPECT_EQ(refusal(recording, settings, {true}), "none");
  const RecordingCheck check =
      check_recording(recording, settings, {LateStart::kFirstMoving, LateStart::kScans, 1}, {true});
  EXPECT_TRUE(std::ranges::any_of(check.warnings, [](const std::string& text) {
    return text.starts_with("doppler_units");
  })) << "it is still said";
}

TEST(RecordingCheck, AMethodWithoutDopplerDoesNotMindItsUnit) {
  EXPECT_EQ(refusal(LateStart(3.6, moving_truth()), {}, {false}), "none");
}

}  // namespace
}  // namespace dynamic_icp::runs
