// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace dynamic_icp::tests {

namespace fs = std::filesystem;

// Exit statuses.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kWrongUsage = 2;
inline constexpr int kMostScansLost = 3;

/// What a run of the program gave.
struct Outcome {
  int status = -1;   ///< exit status; 128 + the signal when it was killed
  std::string text;  ///< standard output and error together
};

/// Runs the program under test with these arguments, as a shell takes them.
Outcome run_program(const std::string& arguments);

/// Runs a shell command.
Outcome run_shell(const std::string& command);

std::string read_file(const fs::path& path);
void write_file(const fs::path& path, const std::string& content);

/// The folder of the sources.
fs::path source_folder();

/// A test with a folder of its own, removed at the end.
class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// A simulated street of a few scans, made once per process and shared by the tests.
  static fs::path street();

  /// What summary.json says of a run into `out` of the folder, which must succeed.
  nlohmann::json run_and_summarise(const std::string& arguments);

  fs::path folder_;
};

}  // namespace dynamic_icp::tests
