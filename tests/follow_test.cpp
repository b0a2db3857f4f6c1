// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Recordings that come bit by bit, as a user meets them, and what becomes of a run when they stop doing so.
#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Follow : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    size_ = fs::file_size(drive());
  }

  /// More scans than are looked at before the first is processed, also where the last chunk is cut.
  static const std::string& drive() {
    static const std::string file = [] {
      const fs::path folder = street().parent_path();
      const Outcome made = run_program("simulate street --frames " + std::to_string(kScans) +
                                       " --instant --quiet --output " + (folder / "long_street").string());
      EXPECT_EQ(made.status, kDone) << made.text;
      const std::string converted = (folder / "long_street.mcap").string();
      const Outcome written =
          run_program("convert " + (folder / "long_street").string() + " --to mcap --quiet --output " + converted);
      EXPECT_EQ(written.status, kDone) << written.text;
      return converted;
    }();
    return file;
  }

  static constexpr int kScans = 20;

  [[nodiscard]] std::string growing() const { return (folder_ / "growing.mcap").string(); }
  [[nodiscard]] fs::path out() const { return folder_ / "out"; }

  /// The program with what it takes to follow something; `words` begin with the input.
  [[nodiscard]] std::string follow(const std::string& words) const {
    return std::string("env --default-signal=INT '") + DYNAMIC_ICP_PROGRAM + "' run --follow --threads 1 --output " +
           out().string() + " " + words;
  }

  /// What a shell does while part of the drive is there and followed, once the first scans are processed. The status of
  /// the run is that of the shell.
  [[nodiscard]] Outcome while_following(const std::string& doing) const {
    return run_shell("head -c " + std::to_string(size_ * 9 / 10) + " " + drive() + " >" + growing() + "; " +
                     follow(growing()) + " & pid=$!; until find " + folder_.string() +
                     " -name frames.jsonl -size +0 | grep -q . || ! kill -0 $pid; do sleep 0.05; done; " + doing +
                     "; wait $pid");
  }

  void expect_part_of_the_drive() const {
    const json summary = json::parse(read_file(out() / "summary.json"));
    EXPECT_GE(summary["frames"].get<int>(), 1);
    EXPECT_LT(summary["frames"].get<int>(), kScans);
    EXPECT_TRUE(fs::exists(out() / "run.json"));
  }

  std::uintmax_t size_ = 0;
};

TEST_F(Follow, ThroughAPipeTheRunOfTheFinishedFile) {
  const fs::path finished = folder_ / "finished";
  ASSERT_EQ(run_program("run --quiet --threads 1 " + drive() + " --output " + finished.string()).status, kDone);
  const Outcome outcome = run_shell("cat " + drive() + " | " + follow("-"));
  ASSERT_EQ(outcome.status, kDone) << outcome.text;
  for (const char* const name : {"trajectory.tum", "objects.jsonl"}) {
    EXPECT_EQ(read_file(out() / name), read_file(finished / name)) << name;
  }
  EXPECT_EQ(json::parse(read_file(out() / "run.json"))["input"]["path"], "-");
  EXPECT_NE(outcome.text.find("latency"), std::string::npos) << outcome.text;
  const Outcome again = run_program("run - --output " + (folder_ / "other").string());
  EXPECT_EQ(again.status, kFailed);
  EXPECT_NE(again.text.find("standard input cannot be read twice: it can only be followed"), std::string::npos)
      << again.text;
  EXPECT_EQ(run_shell("cat " + drive() + " | " + follow("- --report --force")).status, kWrongUsage);
}

TEST_F(Follow, AFileThatGrowsHasItsGroundTruthAtTheEnd) {
  const Outcome outcome = run_shell("(head -c 70001 " + drive() + "; sleep 0.2; tail -c +70002 " + drive() + ") >" +
                                    growing() + " & sleep 0.1; " + follow(growing() + " --report"));
  ASSERT_EQ(outcome.status, kDone) << outcome.text;
  const json summary = json::parse(read_file(out() / "summary.json"));
  EXPECT_EQ(summary["frames"], kScans);
  EXPECT_NE(outcome.text.find("RTE"), std::string::npos) << outcome.text;
}

TEST_F(Follow, AStreamThatIsCutSaysWhere) {
  const std::uintmax_t cut = size_ * 9 / 10;
  const Outcome outcome = run_shell("head -c " + std::to_string(cut) + " " + drive() + " | " + follow("-"));
  EXPECT_EQ(outcome.status, kDone) << outcome.text;
  EXPECT_NE(outcome.text.find("standard input: cut short at byte " + std::to_string(cut)), std::string::npos)
      << outcome.text;
  expect_part_of_the_drive();
}

TEST_F(Follow, WhatIsNoMcapSaysTheByte) {
  const Outcome outcome = run_shell("echo 'no MCAP at all' | " + follow("-"));
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_NE(outcome.text.find("standard input: byte 0: expected the mark of an MCAP file"), std::string::npos)
      << outcome.text;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Follow, AnInterruptKeepsTheResultsSoFar) {
  const Outcome outcome = while_following("kill -INT $pid");
  EXPECT_EQ(outcome.status, 130) << outcome.text;
  expect_part_of_the_drive();
}

TEST_F(Follow, AKillLeavesNoHalfResultAndTheNextRunNone) {
  EXPECT_EQ(while_following("kill -KILL $pid").status, 137);
  EXPECT_FALSE(fs::exists(out()));
  const Outcome next = run_program("run --quiet --max-frames 2 " + drive() + " --output " + out().string());
  EXPECT_EQ(next.status, kDone) << next.text;
  std::size_t there = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    there += entry.is_directory() ? 1 : 0;
  }
  EXPECT_EQ(there, 1U);
}

TEST_F(Follow, AFileThatGoesAwayEndsTheRunWithTheResultsSoFar) {
  const Outcome outcome = while_following("rm " + growing());
  EXPECT_EQ(outcome.status, kFailed) << outcome.text;
  EXPECT_NE(outcome.text.find("growing.mcap: was removed or renamed while it was followed"), std::string::npos)
      << outcome.text;
  expect_part_of_the_drive();
}

TEST_F(Follow, SilenceEndsItWhereThatIsAskedFor) {
  fs::copy_file(drive(), growing());
  fs::resize_file(growing(), size_ * 9 / 10);
  const Outcome outcome = run_shell(follow(growing() + " --follow-timeout 1"));
  EXPECT_EQ(outcome.status, kDone) << outcome.text;
  EXPECT_NE(outcome.text.find("no scan came for 1 s"), std::string::npos) << outcome.text;
  expect_part_of_the_drive();
}

TEST_F(Follow, AFolderThatGoesAwayOrGetsScansOfThePastEndsTheRunWithTheResultsSoFar) {
  for (const char* const doing : {"rm -r FOLDER", "cp SCAN FOLDER/point_clouds/00000.bin"}) {
    const fs::path folder = folder_ / "folder";
    fs::create_directories(folder / "point_clouds");
    fs::path last;
    for (const fs::directory_entry& scan : fs::directory_iterator(street() / "point_clouds")) {
      last = std::max(last, scan.path());
      fs::copy_file(scan.path(), folder / "point_clouds" / scan.path().filename());
    }
    std::string words = doing;
    words.replace(words.find("FOLDER"), 6, folder.string());
    if (const std::size_t at = words.find("SCAN"); at != std::string::npos) {
      words.replace(at, 4, last.string());
    }
    const Outcome outcome = run_shell(
        follow(folder.string()) + " --force & pid=$!; until find " + folder_.string() +
        " -name frames.jsonl -size +0 | grep -q . || ! kill -0 $pid; do sleep 0.05; done; " + words + "; wait $pid");
    EXPECT_EQ(outcome.status, kFailed) << outcome.text;
    EXPECT_NE(outcome.text.find("the run is there, but it ended early: "), std::string::npos) << outcome.text;
    EXPECT_TRUE(fs::exists(out() / "summary.json"));
    fs::remove_all(folder);
    fs::remove_all(out());
  }
}

}  // namespace
}  // namespace dynamic_icp::tests
