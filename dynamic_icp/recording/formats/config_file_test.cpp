// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/config_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

class ConfigFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  void load(const std::string& text) {
    write_whole_file(path_, text);
    load_config_file(path_, fields_);
  }
  std::string message(const std::string& text) {
    try {
      load(text);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }

  double size_ = 0.3;
  int count_ = 10;
  bool enabled_ = true;
  ConfigFields fields_{{"grid.size_m", &size_, 0.01, 100.0, "m", "edge length"},
                       {"grid.deep.count", &count_, 1, 100, "", "how many"},
                       {"enabled", &enabled_, 0, 0, "", "whether at all"}};
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("config_file_test-" + std::to_string(::getpid()) + ".yaml");
};

TEST_F(ConfigFile, ReadsNestedAndDottedKeys) {
  load("grid:\n  size_m: 0.5\n  deep:\n    count: 7\nenabled: false\n");
  EXPECT_EQ(size_, 0.5);
  EXPECT_EQ(count_, 7);
  EXPECT_FALSE(enabled_);
  load("grid.size_m: 1\n");
  EXPECT_EQ(size_, 1.0);
  load("");
  load("# nothing but a comment\n");
  EXPECT_EQ(size_, 1.0);
}

TEST_F(ConfigFile, WhatIsWrittenReadsBack) {
  size_ = 0.1 + 0.2;
  count_ = 42;
  const std::string yaml = config_yaml(fields_);
  size_ = 1.0;
  count_ = 1;
  load(yaml);
  EXPECT_EQ(size_, 0.1 + 0.2);
  EXPECT_EQ(count_, 42);
}

TEST_F(ConfigFile, ErrorsNameFileLineAndKey) {
  const std::string unknown = message("enabled: true\ngrid:\n  sise_m: 1\n");
  EXPECT_NE(unknown.find(path_.string() + ": line 3"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("'grid.sise_m'"), std::string::npos) << unknown;
  EXPECT_NE(message("grid:\n  size_m: 1000\n").find("expected 0.01 to 100 m"), std::string::npos);
  EXPECT_NE(message("enabled: [1, 2]\n").find("'enabled'"), std::string::npos);
  EXPECT_NE(message("enabled:\n").find("'enabled'"), std::string::npos);
  EXPECT_NE(message("enabled: true\nenabled: false\n").find("set twice"), std::string::npos);
  EXPECT_NE(message("- 1\n- 2\n").find("expected a map"), std::string::npos);
  EXPECT_NE(message("grid: {size_m: 1\n").find("is no YAML"), std::string::npos);
  EXPECT_THROW(load_config_file("/nonexistent/file.yaml", fields_), DataError);
}

TEST_F(ConfigFile, AliasesThatUnfoldWithoutEndAreRefused) {
  std::string doubling = "a0: &a0 {}\n";
  std::string known = "grid: {deep: &deep {}";
  for (int i = 1; i <= 30; ++i) {
    doubling += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " {x: *a" + std::to_string(i - 1) + ", y: *a" +
                std::to_string(i - 1) + "}\n";
  }
  EXPECT_NE(message(doubling).find("unknown configuration key"), std::string::npos) << message(doubling);
  for (int i = 0; i < 10'000; ++i) {
    known += ", deep: *deep";
  }
  EXPECT_NE(message(known + "}\n").find("line 1: more than 10000 keys"), std::string::npos) << message(known + "}\n");
}

TEST_F(ConfigFile, AMapWithoutKeysIsNoWayPastTheChecks) {
  load("grid: {}\n");  // all its keys are left out
  EXPECT_NE(message("grit: {}\n").find("unknown configuration key 'grit'"), std::string::npos);
  EXPECT_NE(message("enabled: {}\n").find("'enabled'"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::formats
