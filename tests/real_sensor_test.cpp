// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

// Sensors as they are: several LiDARs on a vehicle, errors that preset `default` follows.
#include <cmath>
#include <numeric>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace dynamic_icp::tests {
namespace {

constexpr const char* kVibration =
    "--set vibration.wheel.low_hz=7 --set vibration.wheel.high_hz=13 --set vibration.wheel.amplitude_mm=1.5 "
    "--set vibration.wheel.amplitude_deg=0.03";

// What the Doppler says of a car at rest in `hercules-rest`.
constexpr double kAtRest_mps = 0.29;

/// Three numbers of each line that has numbers, from a column on.
std::vector<Eigen::Vector3d> columns(const std::string& text, std::size_t first) {
  std::vector<Eigen::Vector3d> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (double number = 0.0; words >> number;) {
      numbers.push_back(number);
    }
    if (numbers.size() >= first + 3) {
      result.emplace_back(numbers[first], numbers[first + 1], numbers[first + 2]);
    }
  }
  return result;
}

Eigen::Vector3d mean_of_columns(const std::string& text, std::size_t first) {
  const std::vector<Eigen::Vector3d> rows = columns(text, first);
  return std::accumulate(rows.begin(), rows.end(), Eigen::Vector3d(0.0, 0.0, 0.0)) / static_cast<double>(rows.size());
}

/// Root mean square errors from scan to scan.
struct Errors {
  double rte_mm = 0.0;
  double rre_deg = 0.0;
};

class RealSensorTest : public ProgramTest {
 protected:
  /// Simulates a drive of few rays and scans, and runs preset `default` over it.
  Errors simulate_and_run(const std::string& scene, const std::string& simulate, const std::string& run = "") {
    const std::string drive = (folder_ / "drive").string();
    if (!fs::exists(drive)) {
      const Outcome made = run_program("simulate " + scene + " --seed 5 --frames 24 --quiet --set lidar.columns=400 " +
                                       "--set lidar.rows=32 " + simulate + " --output " + drive);
      EXPECT_EQ(made.status, 0) << made.text;
    }
    const nlohmann::json summary = run_and_summarise(drive + " " + run);
    return {1e3 * summary.at("rte_rmse_m").get<double>(), summary.at("rre_rmse_deg").get<double>()};
  }
};

TEST_F(RealSensorTest, TwoLidarsAreNoWorseThanTheirLeverArms) {
  // 0.6 rad/s with the sensors 1.5 m ahead of the origin: without lever arms this drive costs 5 cm a scan.
  const Errors merged = simulate_and_run("roundabout", "--sensor front-pair --layout aevascenes");
  const Errors alone = simulate_and_run("roundabout", "", "--lidar front_wide_lidar");
  EXPECT_LT(merged.rte_mm, 3.0 * alone.rte_mm);
  EXPECT_LT(merged.rre_deg, 2.0 * alone.rre_deg);
}

TEST_F(RealSensorTest, SixLidarsHoldTheRotationInATunnel) {
  const Errors merged =
      simulate_and_run("tunnel", "--sensor aevascenes-six --layout aevascenes",
                       "--lidar front_wide_lidar --lidar right_lidar --lidar left_lidar --lidar rear_wide_lidar");
  const Errors alone = simulate_and_run("tunnel", "", "--lidar front_wide_lidar");
  EXPECT_LT(merged.rre_deg, alone.rre_deg);
}

// What preset `default` reaches on these drives, and some room.
TEST_F(RealSensorTest, LearnsAnErrorThatVariesWithDirection) {
  EXPECT_LT(simulate_and_run("city", "--set lidar.doppler_error.direction_mps=0.15").rte_mm, 6.0);
}

TEST_F(RealSensorTest, LearnsAnErrorOfEachMirrorFace) {
  EXPECT_LT(simulate_and_run("city", "--set lidar.faces=6 --set lidar.doppler_error.face_mps=0.1").rte_mm, 3.0);
}

TEST_F(RealSensorTest, NoticesAnErrorThatAppears) {
  EXPECT_LT(
      simulate_and_run("city", "--set lidar.doppler_error.restart_s=1.2 --set lidar.doppler_error.restart_mps=0.2")
          .rte_mm,
      2.0);
}

// In `hercules-rest` a car stands, within 1 mm/s by its ground truth, with 75 to 123 ms from scan to scan, and its
// Doppler says 0.29 m/s, 29 mm a scan: an error that varies with direction looks like a motion.
TEST_F(RealSensorTest, AnErrorAsThatOfHerculesMovesNoCarThatStands) {
  const fs::path by_authors =
      source_folder() / ".." / "shared" / "data" / "hercules-rest" / "ego_velocity_by_authors.csv";
  if (fs::exists(by_authors)) {
    // points, vx, vy, vz, share of dynamic points
    EXPECT_NEAR(mean_of_columns(std::regex_replace(read_file(by_authors), std::regex(","), " "), 1).norm(), kAtRest_mps,
                0.01);
  }
  simulate_and_run("stationary",
                   "--set lidar.unit=2 --set lidar.doppler_error.direction_mps=0.15 "
                   "--set lidar.timing.period_jitter_s=0.012",
                   "--preset paper");
  std::string seen;
  std::istringstream frames(read_file(folder_ / "out" / "frames.jsonl"));
  for (std::string line; std::getline(frames, line);) {
    const auto velocity = nlohmann::json::parse(line).at("ego_velocity").get<std::vector<double>>();
    seen += fmt::format("{}\n", fmt::join(velocity, " "));
  }
  EXPECT_GT(mean_of_columns(seen, 0).norm(), kAtRest_mps) << "the simulated error is no smaller";

  simulate_and_run("stationary", "");
  const std::vector<Eigen::Vector3d> positions = columns(read_file(folder_ / "out" / "trajectory.tum"), 1);
  ASSERT_EQ(positions.size(), 24U);
  for (std::size_t k = 4; k < positions.size(); ++k) {
    EXPECT_LT((positions[k] - positions[k - 1]).norm(), 2e-3) << k;
  }
  EXPECT_LT((positions.back() - positions.front()).norm(), 0.025) << "0.7 m by the Doppler";
}

// Traffic hides all that would show the motion across, and the Doppler errs by 0.5 m/s across the view that is left.
TEST_F(RealSensorTest, MovingBodiesTellAnErrorFromAMotionInAJam) {
  const std::string drive = (folder_ / "drive").string();
  const Outcome made =
      run_program("simulate traffic-jam --seed 607 --frames 40 --sensor aeries-ii-real --quiet --output " + drive);
  ASSERT_EQ(made.status, 0) << made.text;
  const auto rte_m = [&](const std::string& run) {
    return run_and_summarise(drive + run).at("rte_rmse_m").get<double>();
  };
  EXPECT_LT(rte_m(""), 0.6 * rte_m(" --ablation no-dpp"));
}

TEST_F(RealSensorTest, FindsStampsThatJitter) {
  EXPECT_LT(simulate_and_run("highway", "--set lidar.timing.stamp_jitter_s=0.001").rte_mm, 18.0);
}

TEST_F(RealSensorTest, FollowsVibration) {
  const Errors errors = simulate_and_run("city", kVibration);
  EXPECT_LT(errors.rte_mm, 4.0);
  EXPECT_LT(errors.rre_deg, 0.05);
}

TEST_F(RealSensorTest, LearnsADirectionalErrorInATunnel) {
  EXPECT_LT(simulate_and_run("tunnel", "--set lidar.doppler_error.direction_mps=0.15").rte_mm, 12.0);
}

TEST_F(RealSensorTest, UsesWhatItLearnedInAnotherDrive) {
  const std::string error = "--set lidar.doppler_error.direction_mps=0.15";
  simulate_and_run("city", error);
  const fs::path learned = folder_ / "learned.yaml";
  fs::copy_file(folder_ / "out" / "calibration.yaml", learned);
  fs::remove_all(folder_ / "drive");
  // Between curved walls planes do not tell the error from a motion.
  const double alone_mm = simulate_and_run("curved-walls", error).rte_mm;
  const Errors calibrated = simulate_and_run("curved-walls", error, "--calibration " + learned.string());
  EXPECT_LT(calibrated.rte_mm, 0.5 * alone_mm);

  const std::string run = "run " + (folder_ / "drive").string() + " --output " + (folder_ / "refused").string();
  const Outcome other_preset = run_program(run + " --preset paper --calibration " + learned.string());
  EXPECT_EQ(other_preset.status, 2);
  EXPECT_NE(other_preset.text.find("preset 'default'"), std::string::npos) << other_preset.text;
  const Outcome no_file = run_program(run + " --calibration " + (folder_ / "none.yaml").string());
  EXPECT_NE(no_file.status, 0);
  EXPECT_NE(no_file.text.find("none.yaml"), std::string::npos) << no_file.text;
  EXPECT_FALSE(fs::exists(folder_ / "refused"));
}

// What follows does not hold yet: CTest expects these tests to measure an error beyond the limit (CMakeLists.txt), and
// says so when one is within it.
// The limits are those of an estimator that learns what the sensor does wrong.
class KnownShortfall : public RealSensorTest {};

TEST_F(KnownShortfall, AnErrorThatVariesWithDirection) {
  EXPECT_LT(simulate_and_run("city", "--set lidar.doppler_error.direction_mps=0.15").rte_mm, 3.0);
}

TEST_F(KnownShortfall, StampsThatJitter) {
  EXPECT_LT(simulate_and_run("highway", "--set lidar.timing.stamp_jitter_s=0.001").rte_mm, 3.0);
}

}  // namespace
}  // namespace dynamic_icp::tests
