// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The same simulated drive in the layouts of several data sets: opened without a word about the layout it is the same
// recording, and `run` makes the same trajectory of it. Readers and the simulator's writers share no code.
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/datasets/dataset.hpp"

#include "testing/dense_algebra.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

/// m, of the translation between scans that only the shape of the scene tells; some 1 m are driven.
constexpr double kByShapeAlone_m = 0.05;

/// How a layout is to be opened and how exactly it holds what the simulation made.
struct WrittenLayout {
  const char* name;
  const char* truth_file;
  double time_step_s;  ///< of the times of points: those of two layouts differ by no more than both together
  DopplerKind doppler = DopplerKind::kRelative;
};

constexpr WrittenLayout kReference = {"dicp", "ref_poses.txt", 8e-9};
constexpr WrittenLayout kOthers[] = {{"hercules", "PR_GT/Aeva_gt.txt", 1e-9},
                                     {"helipr", "LiDAR_GT/Aeva_gt.txt", 1e-9, DopplerKind::kCompensated},
                                     {"boreas", "applanix/aeva_poses.csv", 8e-9},
                                     {"aevascenes", "sequence.json", 1e-9}};

class Layouts : public ProgramTest {
 protected:
  fs::path drive(const WrittenLayout& layout) {
    const fs::path path = folder_ / layout.name;
    const Outcome made =
        run_program("simulate city --quiet --frames 5 --set lidar.columns=300 --set lidar.rows=40 --layout " +
                    std::string(layout.name) + " --output " + path.string());
    EXPECT_EQ(made.status, 0) << made.text;
    return path;
  }

  /// The rows of the trajectory that `run` makes. Preset `paper` does not look at lines and faces, which not all
  /// layouts have.
  std::vector<std::vector<double>> trajectory(const fs::path& input) {
    const fs::path out = input.string() + "-run";
    const Outcome outcome = run_program("run --quiet --preset paper " + input.string() + " --output " + out.string());
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    std::vector<std::vector<double>> rows;
    std::istringstream lines(read_file(out / "trajectory.tum"));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream numbers(line);
      rows.emplace_back();
      for (double number = 0.0; numbers >> number;) {
        rows.back().push_back(number);
      }
    }
    summary_ = json::parse(read_file(out / "summary.json"));
    run_ = json::parse(read_file(out / "run.json"));
    return rows;
  }

  json summary_;  ///< of the last run
  json run_;
};

/// One velocity of the sensor explains the difference of the two kinds of Doppler, but for the sensor's acceleration
/// during the scan.
void expect_compensated(const RawScan& scan, const RawScan& reference) {
  Eigen::MatrixX3d directions(scan.points.size(), 3);
  Eigen::VectorXd taken_out(scan.points.size());
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    directions.row(static_cast<Eigen::Index>(k)) = scan.points[k].normalized().transpose();
    taken_out[static_cast<Eigen::Index>(k)] = scan.doppler[k] - reference.doppler[k];
  }
  const Eigen::Vector3d velocity = dense::least_squares(directions, taken_out);
  EXPECT_GT(velocity.norm(), 3.0) << "nothing is shown by a sensor that stands still";
  EXPECT_LT((directions * velocity - taken_out).cwiseAbs().maxCoeff(), 0.3);
}

void expect_same_scan(const RawScan& scan, const RawScan& reference, double time_tolerance_s) {
  ASSERT_EQ(scan.points.size(), reference.points.size());
  if (scan.doppler_kind != reference.doppler_kind) {
    expect_compensated(scan, reference);
  }
  ASSERT_EQ(scan.times.size(), reference.times.size());
  ASSERT_FALSE(scan.points.empty());
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    ASSERT_EQ(scan.points[k], reference.points[k]) << k;
    if (scan.doppler_kind == reference.doppler_kind) {
      ASSERT_EQ(scan.doppler[k], reference.doppler[k]) << k;
    }
    ASSERT_NEAR(scan.times[k], reference.times[k], time_tolerance_s) << k;
  }
}

void expect_same_recording(const datasets::Dataset& dataset, const datasets::Dataset& reference,
                           double time_tolerance_s) {
  ASSERT_EQ(dataset.size(), reference.size());
  ASSERT_EQ(dataset.ground_truth().size(), reference.size());
  const auto motion = [](const datasets::Dataset& of, std::size_t i) {
    const formats::Trajectory& truth = of.ground_truth();
    return Eigen::Matrix4d((truth[0].T_world_sensor.inverse() * truth[i].T_world_sensor).matrix());
  };
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    EXPECT_EQ(dataset.stamp(i).ns - dataset.stamp(0).ns, reference.stamp(i).ns - reference.stamp(0).ns);
    EXPECT_EQ(dataset.ground_truth()[i].stamp, dataset.stamp(i));
    EXPECT_LT((motion(dataset, i) - motion(reference, i)).norm(), 1e-7);
    expect_same_scan(dataset.scan(i), reference.scan(i), time_tolerance_s);
  }
}

TEST_F(Layouts, HoldTheSameDriveAndAreToldApart) {
  const fs::path reference = drive(kReference);
  const std::unique_ptr<datasets::Dataset> expected = datasets::open_dataset(reference);
  EXPECT_EQ(expected->format(), kReference.name);
  for (const WrittenLayout& layout : kOthers) {
    SCOPED_TRACE(layout.name);
    const fs::path path = drive(layout);
    const std::unique_ptr<datasets::Dataset> dataset = datasets::open_dataset(path);
    EXPECT_EQ(dataset->format(), layout.name);
    EXPECT_EQ(dataset->doppler_kind(), layout.doppler);
    EXPECT_EQ(dataset->ground_truth_file(), path / layout.truth_file);
    expect_same_recording(*dataset, *expected, layout.time_step_s + kReference.time_step_s);
  }
}

// Times of points that differ by nanoseconds move points by less than a micrometre; the search for pairs may multiply
// it.
TEST_F(Layouts, GiveTheSameTrajectory) {
  const std::vector<std::vector<double>> expected = trajectory(drive(kReference));
  const double expected_error = summary_["rte_rmse_m"];
  ASSERT_EQ(expected.size(), 5U);
  for (const WrittenLayout& layout : kOthers) {
    SCOPED_TRACE(layout.name);
    const std::vector<std::vector<double>> rows = trajectory(drive(layout));
    EXPECT_EQ(run_["input"]["format"], layout.name);
    ASSERT_EQ(rows.size(), expected.size());
    if (layout.doppler == DopplerKind::kCompensated) {
      EXPECT_LT(summary_["rte_rmse_m"], kByShapeAlone_m);
      continue;
    }
    EXPECT_NEAR(summary_["rte_rmse_m"], expected_error, 1e-6) << "the truth was found";
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].size(), 8U);
      EXPECT_NEAR(rows[i][0] - rows[0][0], expected[i][0] - expected[0][0], 1e-6);
      for (std::size_t k = 1; k < rows[i].size(); ++k) {
        EXPECT_NEAR(rows[i][k], expected[i][k], 1e-6) << i << ' ' << k;
      }
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::tests
