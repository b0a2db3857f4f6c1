// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "tests/program.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>

#include <sys/wait.h>
#include <unistd.h>

namespace dynamic_icp::tests {
namespace {

/// Removed when the process ends.
struct SharedFolder {
  SharedFolder() { fs::create_directories(path); }
  ~SharedFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path = fs::temp_directory_path() / ("dynamic_icp_tests-" + std::to_string(::getpid()));
};

const fs::path& shared_folder() {
  static const SharedFolder folder;
  return folder.path;
}

}  // namespace

Outcome run_shell(const std::string& command) {
  Outcome outcome;
  FILE* pipe = ::popen(("{ " + command + "; } 2>&1").c_str(), "r");
  if (pipe == nullptr) {
    return outcome;
  }
  std::array<char, 4096> buffer{};
  std::size_t got = 0;
  while ((got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    outcome.text.append(buffer.data(), got);
  }
  const int status = ::pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

Outcome run_program(const std::string& arguments) {
  return run_shell(std::string("'") + DYNAMIC_ICP_PROGRAM + "' " + arguments);
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_file(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

fs::path source_folder() { return DYNAMIC_ICP_SOURCE_FOLDER; }

void ProgramTest::SetUp() {
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ = shared_folder() / (std::string(test->test_suite_name()) + "." + test->name());
  fs::create_directories(folder_);
}

void ProgramTest::TearDown() {
  std::error_code ignored;
  fs::permissions(folder_, fs::perms::owner_all, ignored);
  fs::remove_all(folder_, ignored);
}

nlohmann::json ProgramTest::run_and_summarise(const std::string& arguments) {
  const fs::path out = folder_ / "out";
  const Outcome outcome = run_program("run --quiet --force --output " + out.string() + " " + arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  return nlohmann::json::parse(read_file(out / "summary.json"));
}

fs::path ProgramTest::street() {
  static const fs::path path = [] {
    const fs::path drive = shared_folder() / "street";
    const Outcome made = run_program("simulate street --frames 12 --instant --quiet --output " + drive.string());
    EXPECT_EQ(made.status, 0) << made.text;
    return drive;
  }();
  return path;
}

}  // namespace dynamic_icp::tests
