// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

// For tests that read runs: a folder of its own for each test, and a small recording with its run in it.
namespace dynamic_icp::runs {

/// An empty folder named after the running test, removed with its content at the end.
class TestFolder {
 public:
  TestFolder() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / fmt::format("dynamic-icp-{}-{}-{}", test->test_suite_name(),
                                                                 test->name(),
                                                                 testing::UnitTest::GetInstance()->random_seed());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  void write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
  }

  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::filesystem::path path_;
};

/// A sensor that drives along x at 10 m/s, one scan each 0.1 s, in a scene of four standing points and four points of a
/// car ahead that drives at 12 m/s. The estimated poses are 1 cm too far per scan.
struct SampleRun {
  std::size_t frames = 5;
  std::string command = "dynamic-icp run drive --output run";

  void write_recording(const TestFolder& folder) const {
    std::string poses;
    for (std::size_t k = 0; k < frames; ++k) {
      poses += fmt::format("{}.{}00000000 {} 2 0 0 0 0 1\n", 100 + k / 10, k % 10, static_cast<double>(k));
      const double scene[8][4] = {{10, 5, 0, 0},  {20, -5, 0, 0},   {30, 5, 1, 0},  {40, -5, 1, 0},
                                  {25, 0, 0, 12}, {25, 1.8, 0, 12}, {29, 0, 0, 12}, {29, 1.8, 1, 12}};
      std::string bytes;
      for (const auto& [x, y, z, speed] : scene) {
        const double range = std::sqrt(x * x + y * y + z * z);
        for (const double value : {x, y, z, (speed - 10.0) * x / range}) {
          const auto single = static_cast<float>(value);
          char raw[sizeof single];
          std::memcpy(raw, &single, sizeof single);
          bytes.append(raw, sizeof single);
        }
      }
      folder.write(fmt::format("drive/point_clouds/{:05}.bin", k + 1), bytes);
    }
    folder.write("drive/ref_poses.txt", poses);
  }

  void write_run(const TestFolder& folder) const {
    std::string poses;
    std::string rows;
    std::string objects;
    for (std::size_t k = 0; k < frames; ++k) {
      const std::string stamp = fmt::format("{}.{}00000000", 100 + k / 10, k % 10);
      poses += fmt::format("{} {} 0 0 0 0 0 1\n", stamp, 1.01 * static_cast<double>(k));
      rows += fmt::format(
          R"({{"index":{0},"timestamp":{1},"points":8,"points_used":8,"ego_velocity":[10,0,0],"dynamic_candidates":4,)"
          R"("dynamic_clustered":4,"dynamic_refined":3,"iterations":{2},"converged":{3},"status":"{4}","fitness":{5},)"
          R"("inlier_rmse":{5},"ms":{{"preprocess":1.5,"registration":2.5,"total":4}}}})"
          "\n",
          k, stamp, k == 0 ? 0 : 7, k != 0, k == 0 ? "first" : "converged", k == 0 ? "null" : "0.05");
      objects +=
          fmt::format(R"({{"index":{},"timestamp":{},"objects":[{{"id":1,"velocity":[12,0,0],"centroid":[27,0.9,0.25],)"
                      R"("extent":[4,1.8,1],"points":4}}]}})"
                      "\n",
                      k, stamp);
    }
    folder.write("run/trajectory.tum", poses);
    folder.write("run/frames.jsonl", rows);
    folder.write("run/objects.jsonl", objects);
    folder.write("run/summary.json", fmt::format(R"({{"method":"dynamic-icp","frames":{},"rte_rmse_m":0.01,)"
                                                 R"("convergence_rate":1,"fps":250,"ate_rmse_m":null}})",
                                                 frames));
    folder.write(
        "run/run.json",
        fmt::format(R"({{"version":"0.1.0","command":"{}","input":{{"path":"{}","format":"dicp"}},)"
                    R"("method":"dynamic-icp","configuration":{{"preprocess.voxel_size_m":0.3}},)"
                    R"("ground_truth":"{}","start":0,"max_frames":null}})",
                    command, (folder.path() / "drive").string(), (folder.path() / "drive/ref_poses.txt").string()));
  }
};

}  // namespace dynamic_icp::runs
