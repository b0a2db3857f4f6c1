// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_folder.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/sample_run.hpp"

namespace dynamic_icp::runs {
namespace {

std::string message_of(const TestFolder& folder) {
  try {
    read_run(folder.path() / "run");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

void replace(const TestFolder& folder, const std::string& file, const std::string& from, const std::string& to) {
  std::string content = folder.read(file);
  ASSERT_NE(content.find(from), std::string::npos) << from;
  content.replace(content.find(from), from.size(), to);
  folder.write(file, content);
}

TEST(RunFolder, ReadsAllThatARunWrote) {
  const TestFolder folder;
  SampleRun().write_run(folder);
  const RunFiles run = read_run(folder.path() / "run");
  ASSERT_EQ(run.frames.size(), 5u);
  ASSERT_EQ(run.trajectory.size(), 5u);
  ASSERT_EQ(run.objects.size(), 5u);
  EXPECT_EQ(run.trajectory[1].stamp.ns, 100'100'000'000);
  EXPECT_DOUBLE_EQ(run.seconds(4), 0.4);
  EXPECT_EQ(run.frames[0].status, "first");
  EXPECT_TRUE(std::isnan(run.frames[0].fitness)) << "null";
  EXPECT_FALSE(run.frames[0].converged);
  EXPECT_EQ(run.frames[3].index, 3u);
  EXPECT_EQ(run.frames[3].points, 8.0);
  EXPECT_EQ(run.frames[3].dynamic_refined, 3.0);
  EXPECT_EQ(run.frames[3].ego_velocity, Eigen::Vector3d(10.0, 0.0, 0.0));
  EXPECT_EQ(run.frames[3].milliseconds.back(), std::pair(std::string("total"), 4.0));
  ASSERT_EQ(run.objects[2].size(), 1u);
  EXPECT_EQ(run.objects[2][0].id, 1);
  EXPECT_EQ(run.objects[2][0].centroid, Eigen::Vector3d(27.0, 0.9, 0.25));
  EXPECT_EQ(text_of(run.summary, "frames"), "5");
  EXPECT_EQ(text_of(run.summary, "ate_rmse_m"), "") << "null";
  EXPECT_EQ(text_of(run.run, "input.format"), "dicp");
  EXPECT_EQ(text_of(run.configuration, "preprocess.voxel_size_m"), "0.3");
  EXPECT_EQ(text_of(run.run, "configuration.preprocess.voxel_size_m"), "");
}

TEST(RunFolder, ReadsWhatATrackerStatesOfAnObject) {
  const TestFolder folder;
  SampleRun().write_run(folder);
  EXPECT_FALSE(read_run(folder.path() / "run").objects[2][0].track) << "without an age it is not tracked";
  const std::string box =
      R"("age_scans":9,"tangential_observed":true,"velocity_covariance":[[1,2,3],[2,5,6],[3,6,9]],"box":{"center":[27,0,0],)"
      R"("center_covariance":[[4,0,0],[0,5,0],[0,0,null]],"size":[4,2,1],"orientation_xyzw":[0,0,0,1],)"
      R"("faces":{"front":"hidden","rear":"seen","left":"unknown","right":"seen","top":"seen","bottom":"unknown"}},)";
  replace(folder, "run/objects.jsonl", R"("velocity":[12,0,0])", box + R"("velocity":[12,0,0])");
  const std::optional<ObjectRow::Track> track = read_run(folder.path() / "run").objects[0][0].track;
  ASSERT_TRUE(track);
  EXPECT_EQ(track->age_scans, 9);
  EXPECT_TRUE(track->tangential_observed);
  EXPECT_EQ(track->velocity_covariance(1, 2), 6.0);
  EXPECT_EQ(track->centre_covariance(1, 1), 5.0);
  EXPECT_TRUE(std::isnan(track->centre_covariance(2, 2))) << "null";
  EXPECT_EQ(track->faces, (std::array<std::string, 6>{"hidden", "seen", "unknown", "seen", "seen", "unknown"}));
  replace(folder, "run/objects.jsonl", "[3,6,9]]", "[3,6]]");
  EXPECT_NE(message_of(folder).find("3 lists of 3 numbers"), std::string::npos) << message_of(folder);
}

TEST(RunFolder, IsToldByTheFilesOfEveryRun) {
  const TestFolder folder;
  EXPECT_FALSE(is_run_folder(folder.path() / "run"));
  SampleRun().write_run(folder);
  EXPECT_TRUE(is_run_folder(folder.path() / "run"));
  EXPECT_FALSE(is_run_folder(folder.path()));
  std::filesystem::remove(folder.path() / "run" / "run.json");
  EXPECT_FALSE(is_run_folder(folder.path() / "run"));
}

TEST(RunFolder, VelocityThatCouldNotBeEstimatedIsUnknown) {
  const TestFolder folder;
  SampleRun().write_run(folder);
  replace(folder, "run/frames.jsonl",
          "\"ego_velocity\":", "\"ego_velocity_status\":\"too_few_points\",\"ego_velocity\":");
  const RunFiles run = read_run(folder.path() / "run");
  EXPECT_TRUE(run.frames[0].ego_velocity.hasNaN());
  EXPECT_FALSE(run.frames[1].ego_velocity.hasNaN());
}

TEST(RunFolder, TakesARunWithoutScans) {
  const TestFolder folder;
  SampleRun sample;
  sample.frames = 0;
  sample.write_run(folder);
  EXPECT_TRUE(read_run(folder.path() / "run").frames.empty());
}

TEST(RunFolder, NamesTheFileThatIsMissing) {
  for (const char* file : {"trajectory.tum", "frames.jsonl", "objects.jsonl", "summary.json", "run.json"}) {
    const TestFolder folder;
    SampleRun().write_run(folder);
    std::filesystem::remove(folder.path() / "run" / file);
    EXPECT_NE(message_of(folder).find(file), std::string::npos) << message_of(folder);
    EXPECT_NE(message_of(folder).find("no such file"), std::string::npos) << message_of(folder);
  }
  const TestFolder folder;
  EXPECT_NE(message_of(folder).find("no such folder"), std::string::npos);
}

TEST(RunFolder, NamesTheLineThatIsCutOff) {
  for (const char* file : {"frames.jsonl", "objects.jsonl"}) {
    const TestFolder folder;
    SampleRun().write_run(folder);
    const std::string content = folder.read(std::string("run/") + file);
    folder.write(std::string("run/") + file, content.substr(0, content.size() - 20));
    EXPECT_NE(message_of(folder).find(std::string(file) + ", line 5"), std::string::npos) << message_of(folder);
  }
  const TestFolder folder;
  SampleRun().write_run(folder);
  folder.write("run/run.json", "{\"version\":");
  EXPECT_NE(message_of(folder).find("run.json"), std::string::npos);
}

TEST(RunFolder, NamesTheKeyThatIsMissingOrWrong) {
  const std::pair<const char*, const char*> faults[] = {{"\"points\":8,", ""},
                                                        {"\"points\":8,", "\"points\":\"8\","},
                                                        {"[10,0,0]", "[10,0]"},
                                                        {"[10,0,0]", "[10,0,\"x\"]"},
                                                        {"\"iterations\":0", "\"iterations\":{}"},
                                                        {"\"status\":\"first\"", "\"status\":1"},
                                                        {"\"converged\":false", "\"converged\":0"},
                                                        {"\"index\":0,", "\"index\":0.5,"},
                                                        {"\"ms\":{", "\"ms\":[], \"x\":{"}};
  const char* keys[] = {"points", "points", "ego_velocity", "ego_velocity", "iterations", "status", "converged",
                        "index",  "ms"};
  for (std::size_t k = 0; k < std::size(faults); ++k) {
    const TestFolder folder;
    SampleRun().write_run(folder);
    replace(folder, "run/frames.jsonl", faults[k].first, faults[k].second);
    const std::string message = message_of(folder);
    EXPECT_NE(message.find("frames.jsonl, line 1"), std::string::npos) << message;
    EXPECT_NE(message.find(fmt::format("\"{}\"", keys[k])), std::string::npos) << message;
  }
}

TEST(RunFolder, RefusesWhatIsNoObjectAndWhatIsTooDeep) {
  const TestFolder folder;
  SampleRun().write_run(folder);
  folder.write("run/summary.json", "[1, 2]");
  EXPECT_NE(message_of(folder).find("summary.json: expected a JSON object"), std::string::npos);
  folder.write("run/summary.json", "{\"a\":" + std::string(200'000, '[') + std::string(200'000, ']') + "}");
  EXPECT_NE(message_of(folder).find("nested deeper"), std::string::npos) << message_of(folder);
}

TEST(RunFolder, FilesMustAgreeOnTheNumberOfScans) {
  for (const char* file : {"trajectory.tum", "objects.jsonl"}) {
    const TestFolder folder;
    SampleRun().write_run(folder);
    const std::string name = std::string("run/") + file;
    const std::string content = folder.read(name);
    folder.write(name, content.substr(0, content.rfind('\n', content.size() - 2) + 1));
    EXPECT_NE(message_of(folder).find(std::string(file) + ": 4 "), std::string::npos) << message_of(folder);
    EXPECT_NE(message_of(folder).find("5 scans"), std::string::npos) << message_of(folder);
  }
}

TEST(RunFolder, ReadsLabelsOfTheScan) {
  const TestFolder folder;
  SampleRun().write_run(folder);
  const RunFiles run = read_run(folder.path() / "run");
  EXPECT_FALSE(read_labels(run, 1, 3));
  folder.write("run/labels/00002.bin", std::string("\xFF\xFF\xFF\xFF\0\0\0\0\x01\x02\0\0", 12));
  EXPECT_EQ(read_labels(run, 1, 3), (std::vector<std::int32_t>{-1, 0, 513}));
  EXPECT_THROW(read_labels(run, 1, 4), DataError);
}

}  // namespace
}  // namespace dynamic_icp::runs
