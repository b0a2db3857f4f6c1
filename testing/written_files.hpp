// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "dynamic_icp/tools/simulation/simulation.hpp"

// For tests: a folder, a small simulation, and what was written.
namespace dynamic_icp::simulation {

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class Value>
std::vector<Value> binary(const std::filesystem::path& path) {
  const std::string bytes = content(path);
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
  return values;
}

inline std::vector<nlohmann::json> json_lines(const std::filesystem::path& path) {
  std::istringstream lines(content(path));
  std::vector<nlohmann::json> result;
  for (std::string line; std::getline(lines, line);) {
    result.push_back(nlohmann::json::parse(line));
  }
  return result;
}

/// Gives each test an empty folder of its own and a street of four small scans.
class WrittenFiles : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("dynamic_icp_" + std::string(test.test_suite_name()) + "_" +
                                                        test.name() + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static SimulationConfig config() {
    SimulationConfig config = default_config(scenes::find_scene("street"));
    config.frames = 4;
    config.rig.sensors.front().lidar.columns = 300;
    config.rig.sensors.front().lidar.rows = 32;
    return config;
  }

  std::filesystem::path folder_;
  const Simulation simulation_{scenes::find_scene("street"), config()};
  const Workers workers_{2};
};

}  // namespace dynamic_icp::simulation
