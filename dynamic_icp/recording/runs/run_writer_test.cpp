// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_writer.hpp"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/runs/frame_json.hpp"
#include "dynamic_icp/recording/runs/frame_rows.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

odometry::Frame frame_at(std::int64_t ns, double x, odometry::FrameStatus status) {
  odometry::Frame frame;
  frame.stamp = Stamp{ns};
  frame.status = status;
  frame.T_world_sensor.translation().x() = x;
  frame.points = 4;
  frame.points_used = 3;
  frame.labels = {-1, 0, 0, 1};
  frame.dynamic_candidates = 1;
  frame.times.total_ms = 10.0;
  return frame;
}

class RunWriterTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::vector<json> lines(const std::string& name) const {
    std::istringstream in(formats::read_whole_file(folder_ / name));
    std::vector<json> rows;
    for (std::string line; std::getline(in, line);) {
      rows.push_back(json::parse(line));
    }
    return rows;
  }
  fs::path folder_ = fs::temp_directory_path() / ("run_writer_test-" + std::to_string(::getpid()));
};

TEST_F(RunWriterTest, WritesTheFilesOfTheContract) {
  RunWriter writer(folder_, true);
  odometry::Frame first = frame_at(1724479779384729506, 0.0, odometry::FrameStatus::kFirst);
  dynamics::ObjectEstimate rejected;
  rejected.verdict = dynamics::ClusterVerdict::kIllConditioned;
  dynamics::ObjectEstimate object;
  object.verdict = dynamics::ClusterVerdict::kAccepted;
  object.velocity_sensor = {9.0, 0.5, 0.0};
  object.members = {2};
  first.clusters = {rejected, object};
  first.dynamic_clustered = 1;
  first.dynamic_refined = 1;
  writer.add(0, first);
  odometry::Frame second = frame_at(1724479779484729507, 1.0, odometry::FrameStatus::kConverged);
  second.alignment.status = registration::AlignStatus::kConverged;
  second.alignment.iterations = 7;
  second.times.total_ms = 20.0;
  writer.add(1, second);
  const formats::Trajectory truth = {{first.stamp, Eigen::Isometry3d::Identity()},
                                     {second.stamp, Eigen::Isometry3d(Eigen::Translation3d(1.1, 0.0, 0.0))}};
  const RunSummary summary = writer.finish("dynamic-icp", truth, {"taken for granted"});

  EXPECT_NEAR(*summary.accuracy.rte_rmse_m, 0.1, 1e-12);
  EXPECT_EQ(*summary.mean_iterations, 7.0);
  EXPECT_EQ(*summary.convergence_rate, 1.0);
  EXPECT_EQ(*summary.ms_mean, 15.0);
  EXPECT_NEAR(*summary.dynamic_ratio_max, 1.0 / 3.0, 1e-15);
  EXPECT_EQ(*summary.refined_ratio_mean, 1.0);

  const formats::Trajectory trajectory = formats::read_tum(folder_ / "trajectory.tum").trajectory;
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[1].stamp.ns, 1724479779484729507);
  const std::vector<json> frames = lines("frames.jsonl");
  ASSERT_EQ(frames.size(), 2u);
  for (const char* key :
       {"index", "timestamp", "points", "points_used", "ego_velocity", "dynamic_candidates", "dynamic_clustered",
        "dynamic_refined", "iterations", "converged", "status", "fitness", "inlier_rmse", "ms"}) {
    EXPECT_TRUE(frames[1].contains(key)) << key;
  }
  EXPECT_EQ(frames[1]["ms"]["total"], 20.0);
  EXPECT_EQ(frames[0]["clusters_rejected"]["ill_conditioned"], 1);
  EXPECT_NE(formats::read_whole_file(folder_ / "frames.jsonl").find("\"timestamp\":1724479779.384729506,"),
            std::string::npos)
      << "all nine decimals";
  const std::vector<json> objects = lines("objects.jsonl");
  ASSERT_EQ(objects[0]["objects"].size(), 1u);
  EXPECT_EQ(objects[0]["objects"][0]["id"], 1);
  EXPECT_EQ(objects[0]["objects"][0]["velocity"], (std::vector<double>{9.0, 0.5, 0.0}));
  EXPECT_EQ(formats::read_whole_file(folder_ / "labels" / "00001.bin"),
            std::string("\xff\xff\xff\xff\0\0\0\0\0\0\0\0\1\0\0\0", 16));
  const json stored = json::parse(formats::read_whole_file(folder_ / "summary.json"));
  EXPECT_EQ(stored["frames"], 2);
  EXPECT_EQ(stored["statuses"], json({{"ok", 2}, {"degenerate", 0}, {"lost", 0}}));
  EXPECT_EQ(stored["reasons"], json({{"first", 1}, {"converged", 1}}));
  EXPECT_TRUE(stored["failure"].is_null());
  EXPECT_EQ(stored["stopped"], false);
}

TEST_F(RunWriterTest, RemembersNoMoreOfMoreScans) {
  RunWriter writer(folder_, false);
  std::vector<std::size_t> bytes;
  for (int k = 0; k < 300; ++k) {
    odometry::Frame frame = frame_at(k, 0.1 * k, k == 0 ? odometry::FrameStatus::kFirst : odometry::FrameStatus::kLost);
    frame.alignment.covariance = Matrix6d::Identity();
    writer.add(static_cast<std::size_t>(k), frame);
    if (k == 0 || k == 299) {
      StateArchive state;
      writer.save(state);
      bytes.push_back(state.take().size());
    }
  }
  EXPECT_EQ(bytes[0], bytes[1]) << "of what a checkpoint holds";
  EXPECT_LE(bytes[1], 64U);
  EXPECT_EQ(fs::file_size(folder_ / kScanRecordsFile), record_file_bytes(300));
}

TEST_F(RunWriterTest, RecordsThatAreMissingAreTold) {
  RunWriter writer(folder_, false);
  writer.add(0, frame_at(0, 0.0, odometry::FrameStatus::kFirst));
  writer.add(1, frame_at(1, 0.0, odometry::FrameStatus::kLost));
  for (const std::uint64_t scans : {std::uint64_t{3}, ~std::uint64_t{0}, std::uint64_t{1} << 61U}) {
    StateArchive state;
    std::uint64_t frames = 0;
    std::uint64_t objects = 0;
    std::uint64_t number = scans;
    state(frames, objects, number);
    const std::string bytes = state.take();
    StateArchive read(bytes);
    EXPECT_THROW(RunWriter(folder_, false, 5, read), DataError) << scans;
  }
}

TEST_F(RunWriterTest, GroundTruthThatDoesNotFitCostsNoResult) {
  RunWriter writer(folder_, false);
  writer.add(0, frame_at(0, 0.0, odometry::FrameStatus::kFirst));
  writer.add(1, frame_at(100'000'000, 1.0, odometry::FrameStatus::kLost));
  const formats::Trajectory other_clock = {{Stamp{5'000'000'000'000}, Eigen::Isometry3d::Identity()}};
  const RunSummary summary = writer.finish("dynamic-icp", other_clock, {});
  EXPECT_NE(summary.no_accuracy.find("matches"), std::string::npos) << summary.no_accuracy;
  const json stored = json::parse(formats::read_whole_file(folder_ / "summary.json"));
  EXPECT_TRUE(stored["rte_rmse_m"].is_null());
  EXPECT_EQ(stored["statuses"], json({{"ok", 1}, {"degenerate", 0}, {"lost", 1}}));
  EXPECT_TRUE(fs::exists(folder_ / "trajectory.tum"));
}

TEST_F(RunWriterTest, ConsistencyIsThatOfTheFramesReadAgain) {
  using odometry::FrameStatus;
  RunWriter writer(folder_, false);
  formats::Trajectory truth;
  int k = 0;
  for (const FrameStatus status : {FrameStatus::kFirst, FrameStatus::kConverged, FrameStatus::kTooFewPoints,
                                   FrameStatus::kConverged, FrameStatus::kDegenerate}) {
    odometry::Frame frame = frame_at(k * 100'000'000, 1.0 * k, status);
    if (status == FrameStatus::kConverged || status == FrameStatus::kDegenerate) {
      frame.alignment.covariance = Matrix6d::Identity() * 0.01;
    }
    truth.push_back({frame.stamp, Eigen::Isometry3d(Eigen::Translation3d(1.5 * k, 0.0, 0.0))});
    writer.add(static_cast<std::size_t>(k++), frame);
  }
  const evaluation::Consistency written = writer.finish("dynamic-icp", truth, {}).accuracy.consistency;
  EXPECT_EQ(written.motions, 2u) << "the frame after the skipped one states the motion from the one before that";
  EXPECT_NEAR(*written.nees_translation, 25.0, 1e-9);
  EXPECT_EQ(written.beyond_4_sigma, 1.0) << "0.5 m beyond 0.1 m, of the one frame that is ok";
  std::vector<evaluation::StatedMotion> stated;
  for (const FrameRow& row : read_frames(folder_ / "frames.jsonl")) {
    stated.push_back(stated_motion(row));
  }
  const formats::Trajectory estimate = formats::read_tum(folder_ / "trajectory.tum").trajectory;
  const evaluation::Consistency read = evaluation::evaluate_run(estimate, truth, stated).consistency;
  EXPECT_EQ(read.motions, written.motions);
  EXPECT_EQ(read.nees_rotation, written.nees_rotation);
  EXPECT_EQ(read.nees_translation, written.nees_translation);
  EXPECT_EQ(read.beyond_4_sigma, written.beyond_4_sigma);
  const json stored = json::parse(formats::read_whole_file(folder_ / "summary.json"));
  EXPECT_EQ(stored["nees_translation"], *written.nees_translation);
  EXPECT_EQ(stored["nees_rotation"], 0.0);
  EXPECT_EQ(stored["beyond_4_sigma"], 1.0);
}

TEST_F(RunWriterTest, WithoutTruthOrFramesNumbersAreNull) {
  RunWriter writer(folder_, false);
  writer.add(0, frame_at(0, 0.0, odometry::FrameStatus::kFirst));
  const json stored = json::parse(summary_json(writer.finish("dynamic-icp", {}, {})));
  for (const char* key :
       {"rte_rmse_m", "rre_rmse_deg", "ate_rmse_m", "path_length_m", "mean_iterations", "convergence_rate",
        "refined_ratio_mean", "nees_rotation", "nees_translation", "beyond_4_sigma"}) {
    EXPECT_TRUE(stored[key].is_null()) << key;
  }
  EXPECT_FALSE(fs::exists(folder_ / "labels"));
}

TEST_F(RunWriterTest, PairDocumentHoldsTransformAndCovariance) {
  odometry::Frame target = frame_at(200'000'000, 1.0, odometry::FrameStatus::kConverged);
  target.T_target_source.translation() = Eigen::Vector3d(-1.0, 0.0, 0.0);
  target.alignment.covariance = Matrix6d::Identity();
  const json document = json::parse(pair_document(frame_at(100'000'000, 0.0, odometry::FrameStatus::kFirst), target));
  EXPECT_EQ(document["T_target_source"][0], (std::vector<double>{1.0, 0.0, 0.0, -1.0}));
  EXPECT_EQ(document["covariance"].size(), 6u);
  EXPECT_NEAR(document["dt"].get<double>(), 0.1, 1e-15);
  target.alignment.covariance.reset();
  EXPECT_TRUE(json::parse(pair_document(target, target))["covariance"].is_null());
}

}  // namespace
}  // namespace dynamic_icp::runs
