// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/object_comparison.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/sample_run.hpp"

namespace dynamic_icp::runs {
namespace {

std::string label_bytes(const std::vector<std::int32_t>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(std::int32_t) * values.size()};
}

/// The recording of SampleRun, 20 scans of it, with the truth of its car: points 5 to 8 of each scan. It drives at
/// 12 m/s but does not come nearer, for the sensor moves like it. The run saw all of it as it is, and expects the
/// centre 0.25 m too far ahead 1 s later.
class ObjectComparison : public testing::Test {
 protected:
  ObjectComparison() {
    SampleRun{.frames = 20}.write_recording(folder_);
    std::string truth;
    std::string reported;
    for (int k = 0; k < 20; ++k) {
      const std::string start =
          fmt::format(R"({{"index":{},"timestamp":{}.{}00000000,"objects":[{{"id":)", k, 100 + k / 10, k % 10);
      truth += start + R"(1,"velocity_sensor":[12,0,0],"center_sensor":[27,0.9,0.5],"size":[4,1.8,1],)"
                       R"("orientation_sensor_xyzw":[0,0,0,1],"yaw_rate":0,"points":60}]})"
                       "\n";
      // The sensor is 10 m farther after 10 scans, see SampleRun.
      reported += start + R"(4,"velocity":[12,0,0],"velocity_covariance":null,"points":60,)"
                          R"("box":{"center":[27,0.9,0.5],"size":[4,1.8,1],"orientation_xyzw":[0,0,0,1],)"
                          R"("center_covariance":[[1,0,0],[0,1,0],[0,0,1]]},)"
                          R"("prediction":{"after_s":1,"center":[37.25,0.9,0.5],)"
                          R"("center_covariance":[[0.0625,0,0],[0,1,0],[0,0,1]]}}]})"
                          "\n";
    }
    folder_.write("drive/objects.jsonl", truth);
    folder_.write("run/objects.jsonl", reported);
  }

  /// The truth in all scans, and what the run says of one.
  void write_labels() const {
    for (int k = 1; k <= 20; ++k) {
      folder_.write(fmt::format("drive/labels/{:05}.bin", k), label_bytes({0, 0, 0, 0, 1, 1, 1, 1}));
    }
    folder_.write("run/labels/00007.bin", label_bytes({0, 0, 0, -1, 4, 4, 4, 0}));
  }

  [[nodiscard]] evaluation::ObjectTracking compare() const {
    return compare_run_objects(folder_.path() / "run", folder_.path() / "drive");
  }

  [[nodiscard]] std::string refusal() const {
    try {
      return fmt::format("{} pairs", compare().pairs.size());
    } catch (const DataError& error) {
      return error.what();
    }
  }

  TestFolder folder_;
};

TEST_F(ObjectComparison, PredictionsNeedPosesAlone) {
  const evaluation::ObjectTracking tracking = compare();
  EXPECT_EQ(tracking.pairs.size(), 15U);
  EXPECT_EQ(tracking.prediction.count, 5U) << "of scans 5 to 9: there is none 1 s after later ones";
  EXPECT_NEAR(*tracking.prediction.center_m, 0.25, 1e-6);
  EXPECT_NEAR(*tracking.prediction.nees, 1.0, 1e-4);
  EXPECT_EQ(tracking.nees_center, 0.0);
  EXPECT_FALSE(tracking.held.median) << "no labels";
  EXPECT_FALSE(tracking.map_ghosts);
}

TEST_F(ObjectComparison, LabelsTellOfPoints) {
  write_labels();
  const evaluation::ObjectTracking tracking = compare();
  EXPECT_EQ(tracking.held.median, 1.0);
  EXPECT_EQ(tracking.held.p5, 1.0);
  EXPECT_EQ(tracking.map_ghosts, 0.25) << "one of four static points of the scan that the run has labels of";
}

TEST_F(ObjectComparison, FilesMayBeNamedInsteadOfFolders) {
  write_labels();
  const evaluation::ObjectTracking tracking =
      compare_run_objects(folder_.path() / "run/objects.jsonl", folder_.path() / "drive/objects.jsonl");
  EXPECT_EQ(tracking.map_ghosts, 0.25);
  EXPECT_EQ(tracking.held.median, 1.0);
}

TEST_F(ObjectComparison, NoPointsAreReadWithoutLabels) {
  for (int k = 2; k <= 20; ++k) {  // the first is read to tell the layout
    folder_.write(fmt::format("drive/point_clouds/{:05}.bin", k), "damaged");
  }
  EXPECT_FALSE(compare().held.median);
  write_labels();
  EXPECT_THROW(static_cast<void>(compare()), DataError);
}

TEST_F(ObjectComparison, WithoutScansBodiesAndLabelsAreCompared) {
  write_labels();
  std::filesystem::remove_all(folder_.path() / "drive/point_clouds");
  std::filesystem::remove(folder_.path() / "drive/ref_poses.txt");
  const evaluation::ObjectTracking tracking = compare();
  EXPECT_EQ(tracking.pairs.size(), 15U);
  EXPECT_EQ(tracking.prediction.count, 0U);
  EXPECT_EQ(tracking.map_ghosts, 0.25);
}

TEST_F(ObjectComparison, ScansThatTakeTimeNeedTheMotionOfTheSensor) {
  write_labels();
  // All points of the car are measured 0.05 s after the stamp: 1.1 m nearer than they lay at the stamp, if the sensor
  // moves at 10 m/s and the car at -12 m/s.
  const std::vector<float> times = {0.0F, 0.0F, 0.0F, 0.0F, 0.05F, 0.05F, 0.05F, 0.05F};
  for (int k = 1; k <= 20; ++k) {
    folder_.write(fmt::format("drive/times/{:05}.bin", k),
                  {reinterpret_cast<const char*>(times.data()), sizeof(float) * times.size()});
  }
  std::string truth = folder_.read("drive/objects.jsonl");
  std::string reported = folder_.read("run/objects.jsonl");
  for (std::size_t at = 0; (at = truth.find("[12,0,0]", at)) != std::string::npos; ++at) {
    truth.replace(at, 8, "[-12,0,0]");
  }
  folder_.write("drive/objects.jsonl", truth);
  for (const char* center : {"[27,0.9,0.5]", "[28.1,0.9,0.5]"}) {
    std::string moved = reported;
    for (std::size_t at = 0; (at = moved.find("[27,0.9,0.5]", at)) != std::string::npos; ++at) {
      moved.replace(at, 12, center);
    }
    folder_.write("run/objects.jsonl", moved);
    EXPECT_FALSE(compare().held.median) << "motion.csv is missing";
    std::string motion = "timestamp,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n";
    for (int k = 0; k < 200; ++k) {
      motion += fmt::format("{:.3f},{:.3f},2,0,0,0,0,1,10,0,0,0,0,0\n", 100.0 + 0.01 * k, 0.1 * k);
    }
    folder_.write("drive/motion.csv", motion);
    // Beyond 0.15 m, of a box that is 1.1 m too near, lie the two points at the far end.
    EXPECT_EQ(compare().held.median, std::string(center) == "[27,0.9,0.5]" ? 0.5 : 1.0);
    std::filesystem::remove(folder_.path() / "drive/motion.csv");
  }
}

TEST_F(ObjectComparison, RefusalsNameTheFile) {
  write_labels();
  folder_.write("run/labels/00007.bin", label_bytes({0, 0, 0}));
  EXPECT_NE(refusal().find("run/labels/00007.bin"), std::string::npos) << refusal();
  write_labels();
  folder_.write("drive/motion.csv", "timestamp,x\n1,2\n");
  EXPECT_NE(refusal().find("motion.csv: line 2"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace dynamic_icp::runs
