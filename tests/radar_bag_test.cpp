// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// A recorded 4D radar in the hand, 40 s, that stays where it is for its first 14 s: all its Doppler is 0 there.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/datasets/bag_imu.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

#include "testing/ros1_bag.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

constexpr std::size_t kAtRest = 130;  // scans

/// Velocity of the sensor by three points that most others agree with, then by all of these: s = -u.v.
Eigen::Vector3d velocity_by_ransac(const ros1::BagCloud& cloud, std::mt19937& random) {
  constexpr double kInlier_mps = 0.2;
  const std::vector<float> x = cloud.values("x");
  const std::vector<float> y = cloud.values("y");
  const std::vector<float> z = cloud.values("z");
  const std::vector<float> doppler = cloud.values("velocity");
  std::vector<Eigen::Vector3d> u;
  for (std::size_t i = 0; i < x.size(); ++i) {
    u.push_back(Eigen::Vector3d(x[i], y[i], z[i]).normalized());
  }
  const auto agreeing = [&](const Eigen::Vector3d& v) {
    std::vector<std::size_t> inliers;
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (std::abs(u[i].dot(v) + static_cast<double>(doppler[i])) < kInlier_mps) {
        inliers.push_back(i);
      }
    }
    return inliers;
  };
  const auto fit = [&](const std::vector<std::size_t>& points) -> Eigen::Vector3d {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const std::size_t i : points) {
      squares += u[i] * u[i].transpose();
      right -= u[i] * static_cast<double>(doppler[i]);
    }
    return squares.inverse() * right;
  };
  std::uniform_int_distribution<std::size_t> any(0, u.size() - 1);
  std::vector<std::size_t> best;
  for (int k = 0; k < 300; ++k) {
    std::vector<std::size_t> inliers = agreeing(fit({any(random), any(random), any(random)}));
    if (inliers.size() > best.size()) {
      best = std::move(inliers);
    }
  }
  for (int k = 0; k < 10; ++k) {
    best = agreeing(fit(best));
  }
  return fit(best);
}

double median(std::vector<double> numbers) {
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end());
  return numbers[numbers.size() / 2];
}

class RadarBag : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    bag_ = source_folder() / ".." / "shared" / "data" / "radar-ti" / "demo_ti_mmwave_rospkg_format.bag";
    if (!fs::exists(bag_)) {
      GTEST_SKIP() << "no recording beside the sources";
    }
    clouds_ = ros1::clouds_of(read_file(bag_));
    ASSERT_EQ(clouds_.size(), 412U);
  }

  /// The first scans as *.pcd, named by the times of their messages: their stamps are 0.
  fs::path pcd_folder(const std::string& name, std::size_t scans) const {
    fs::create_directories(folder_ / name);
    for (std::size_t k = 0; k < scans; ++k) {
      const ros1::BagCloud& cloud = clouds_[k];
      std::ostringstream text;
      text << "FIELDS x y z intensity velocity\nSIZE 4 4 4 4 4\nTYPE F F F F F\nPOINTS " << cloud.values("x").size()
           << "\nDATA ascii\n";
      for (std::size_t i = 0; i < cloud.values("x").size(); ++i) {
        for (const char* field : {"x", "y", "z", "intensity", "velocity"}) {
          char number[32];
          std::snprintf(number, sizeof number, "%.9g ", static_cast<double>(cloud.values(field)[i]));
          text << number;
        }
        text << '\n';
      }
      write_file(folder_ / name / (std::to_string(cloud.recorded_ns) + ".pcd"), text.str());
    }
    return folder_ / name;
  }

  [[nodiscard]] Outcome run(const fs::path& recording) const {
    return run_program("run " + recording.string() + " --output " + recording.string() + "-run");
  }

  fs::path bag_;
  std::vector<ros1::BagCloud> clouds_;
};

TEST_F(RadarBag, IsWhatItIs) {
  const json info = json::parse(run_program("info --json " + bag_.string()).text);
  EXPECT_EQ(info["format"], "rosbag");
  EXPECT_EQ(info["scans"], 412);
  std::map<std::string, json> topics;
  for (const json& topic : info["topics"]) {
    topics[topic["name"]] = topic;
  }
  EXPECT_EQ(topics.at("/sensor_platform/imu")["messages"], 8270);
  EXPECT_NEAR(topics.at("/sensor_platform/imu")["rate_hz"].get<double>(), 205.4, 0.1);
  EXPECT_EQ(topics.at("/ti_mmwave/radar_scan_pcl")["messages"], 412);
  EXPECT_EQ(topics.at("/ti_mmwave/radar_scan_pcl")["fields"].size(), 5U);
}

TEST_F(RadarBag, HoldsTheNumbersThatAnotherReaderFinds) {
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_dataset(bag_);
  ASSERT_EQ(dataset->size(), clouds_.size());
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    const RawScan scan = dataset->scan(i);
    ASSERT_EQ(scan.stamp.ns, clouds_[i].recorded_ns);  // headers are 0
    const std::vector<float> x = clouds_[i].values("x");
    const std::vector<float> velocity = clouds_[i].values("velocity");
    ASSERT_EQ(scan.points.size(), x.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      ASSERT_EQ(scan.points[k].x(), static_cast<double>(x[k]));
      ASSERT_EQ(scan.doppler[k], static_cast<double>(velocity[k]));
    }
  }
  const datasets::ImuRecording imu = datasets::read_imu(bag_);
  ASSERT_EQ(imu.measurements.size(), 8270U);
  // Their headers are of another clock, 3.9 days earlier.
  EXPECT_GT(seconds_between(imu.measurements.front().header.stamp, dataset->stamp(0)), -5.0);
  EXPECT_LT(seconds_between(imu.measurements.front().header.stamp, dataset->stamp(0)), 5.0);
  double gravity = 0.0;
  for (const messages::Imu& one : imu.measurements) {
    gravity += one.linear_acceleration.norm() / 8270.0;
  }
  EXPECT_NEAR(gravity, 9.81, 0.3);
}

TEST_F(RadarBag, TheEgoVelocityIsThatOfAnIndependentConsensus) {
  const Outcome ran = run_program("run --quiet " + bag_.string() + " --output " + (folder_ / "run").string());
  ASSERT_EQ(ran.status, 3) << "41 points a scan give no planes, but a velocity\n" << ran.text;
  std::istringstream lines(read_file(folder_ / "run" / "frames.jsonl"));
  std::mt19937 random(1);
  std::vector<double> differences;
  std::vector<double> at_rest;
  std::string line;
  for (const ros1::BagCloud& cloud : clouds_) {
    ASSERT_TRUE(std::getline(lines, line));
    const Eigen::Vector3d expected = velocity_by_ransac(cloud, random);
    const json velocity = json::parse(line)["ego_velocity"];
    const Eigen::Vector3d found(velocity[0].get<double>(), velocity[1].get<double>(), velocity[2].get<double>());
    (expected.norm() > 0.3 ? differences : at_rest).push_back((found - expected).norm());
  }
  ASSERT_GT(differences.size(), 150U);
  EXPECT_LT(median(differences), 0.02);
  // It ends at rest, and every Doppler is 0 again: what planes that do not fit said of the sensor must not be learned.
  ASSERT_GT(at_rest.size(), 200U);
  EXPECT_LT(median({at_rest.end() - 50, at_rest.end()}), 0.03);
}

TEST_F(RadarBag, ConvertsToNpz) {
  const fs::path out = folder_ / "npz";
  const Outcome converted =
      run_program("convert " + bag_.string() + " --to npz --max-frames 20 --output " + out.string());
  ASSERT_EQ(converted.status, 0) << converted.text;
  const std::unique_ptr<datasets::Dataset> from = datasets::open_dataset(bag_);
  const std::unique_ptr<datasets::Dataset> to = datasets::open_dataset(out);
  ASSERT_EQ(to->size(), 20U);
  for (const std::size_t i : {0U, 19U}) {
    EXPECT_EQ(to->stamp(i), from->stamp(i));
    EXPECT_EQ(to->scan(i).points, from->scan(i).points);
    EXPECT_EQ(to->scan(i).doppler, from->scan(i).doppler);
    EXPECT_EQ(to->scan(i).channels.intensity, from->scan(i).channels.intensity);
  }
}

TEST_F(RadarBag, ABeginAtRestIsNoReasonToRefuseTheDoppler) {
  const fs::path whole = pcd_folder("whole", clouds_.size());
  const Outcome ran = run(whole);
  // It is not refused; that 41 points a scan give no planes is another matter.
  ASSERT_EQ(ran.status, kMostScansLost) << ran.text;
  EXPECT_NE(ran.text.find("of 412 scans: 41 points a scan give no planes"), std::string::npos) << ran.text;
  const json summary = json::parse(read_file(whole.string() + "-run/summary.json"));
  EXPECT_EQ(summary["frames"], clouds_.size()) << summary;

  const Outcome refused = run(pcd_folder("rest", kAtRest));
  EXPECT_EQ(refused.status, 1) << refused.text;
  EXPECT_NE(refused.text.find("are exactly zero"), std::string::npos) << refused.text;
}

}  // namespace
}  // namespace dynamic_icp::tests
