// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Where results go: nothing is removed that the program did not write, nothing is computed for a place that cannot be
// written, nothing is left behind by a run that is ended, and no failure is silent.
#include <algorithm>
#include <csignal>
#include <sstream>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Output : public ProgramTest {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  static Outcome run(const std::string& input, const std::string& output, const std::string& more = "") {
    return run_program("run --quiet --max-frames 2 " + input + " --output " + output + " " + more);
  }

  static std::string small_simulation(const std::string& scene, const std::string& output) {
    return "simulate --quiet --frames 2 --set lidar.columns=80 --set lidar.rows=16 " + scene + " --output " + output +
           " ";
  }

  /// The names in a folder, in order.
  static std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  static void expect(const Outcome& outcome, int status, const std::string& words) {
    EXPECT_EQ(outcome.status, status) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
    EXPECT_EQ(outcome.text.find(".partial"), std::string::npos) << outcome.text;
  }

  /// A small file system at disk_, unmounted in the end; false when it cannot be mounted.
  bool mount_disk(const std::string& size) {
    fs::create_directories(disk_);
    mounted_ = run_shell("mount -t tmpfs -o size=" + size + " tmpfs '" + disk_.string() + "'").status == 0;
    return mounted_;
  }

  void SetUp() override {
    ProgramTest::SetUp();
    disk_ = folder_ / "disk";
  }

  void TearDown() override {
    if (mounted_) {
      run_shell("umount '" + disk_.string() + "'");
    }
    ProgramTest::TearDown();
  }

  fs::path disk_;
  bool mounted_ = false;
};

TEST_F(Output, ForceReplacesAllThatTheProgramWrites) {
  const std::string out = at("out");
  for (int round = 0; round < 2; ++round) {
    const Outcome made = run(street().string(), out, "--force --save-labels --save-map " + at("out/maps/all.ply"));
    ASSERT_EQ(made.status, kDone) << made.text;
    ASSERT_EQ(run_program("plot " + out + " --pair 0").status, kDone);
    write_file(out + "/report.html", "as report makes it");
  }
  ASSERT_EQ(run(street().string(), out, "--force").status, kDone);
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"calibration.yaml", "frames.jsonl", "objects.jsonl", "run.json",
                                                     "summary.json", "trajectory.tum"}));
  for (const char* layout : {"dicp", "npz", "pcd", "ply"}) {
    const Outcome converted = run_program("convert --quiet --force " + street().string() + " --to " + layout +
                                          " --output " + at("converted"));
    EXPECT_EQ(converted.status, kDone) << layout << ": " << converted.text;
  }
  for (const char* layout : {"dicp --calibration", "hercules", "helipr", "boreas", "aevascenes"}) {
    for (const char* sensor : {"aeries-ii", "front-pair"}) {
      const Outcome simulated = run_program(small_simulation("street", at("drive")) +
                                            "--force --point-truth --sensor " + sensor + " --layout " + layout);
      EXPECT_EQ(simulated.status, kDone) << layout << ": " << simulated.text;
    }
  }
  EXPECT_EQ(names_in(folder_), (std::vector<std::string>{"converted", "drive", "out"}));
}

TEST_F(Output, ForceRemovesNothingElse) {
  const std::string out = at("out");
  ASSERT_EQ(run(street().string(), out).status, kDone);
  for (const char* name : {"notes.txt", "data/x", "labels/mine.bin", "plots/mine.svg", "map.ply"}) {
    write_file(fs::path(out) / name, "mine");
    expect(run(street().string(), out, "--force"), kFailed, (fs::path(out) / *fs::path(name).begin()).string());
    EXPECT_EQ(read_file(fs::path(out) / name), "mine");
    fs::remove_all(fs::path(out) / *fs::path(name).begin());
  }
  const std::string drive = at("drive");
  ASSERT_EQ(run_program(small_simulation("street", drive)).status, kDone);
  ASSERT_EQ(run(drive, drive + "/run").status, kDone);
  expect(run_program(small_simulation("street", drive) + "--force"), kFailed, drive + "/run");
  EXPECT_TRUE(fs::exists(drive + "/run/run.json"));
}

TEST_F(Output, WhatIsReadIsNotReplaced) {
  const std::string out = at("out");
  ASSERT_EQ(run(street().string(), out).status, kDone);
  fs::copy(street(), out + "/rec", fs::copy_options::recursive);
  expect(run(out + "/rec", out, "--force"), kWrongUsage, out + "/rec");
  EXPECT_TRUE(fs::exists(out + "/rec/point_clouds/00001.bin"));
  const std::string truth = "--force --ground-truth " + out + "/trajectory.tum";
  expect(run(street().string(), out, truth), kWrongUsage, out + "/trajectory.tum");

  const std::string converted = at("c");
  const std::string convert = "convert --quiet --output " + converted + " ";
  ASSERT_EQ(run_program(convert + street().string() + " --to dicp").status, kDone);
  const Outcome onto_itself = run_program(convert + converted + " --to npz --force");
  expect(onto_itself, kWrongUsage, converted);
  EXPECT_TRUE(fs::exists(converted + "/point_clouds/00001.bin"));

  const std::string scene = at("s/my.yaml");
  ASSERT_EQ(run_program(small_simulation("street", at("s"))).status, kDone);
  fs::copy_file(source_folder() / "examples" / "scenes" / "crossing.yaml", scene);
  expect(run_program(small_simulation(scene, at("s")) + "--force"), kWrongUsage, scene);
  EXPECT_TRUE(fs::exists(scene));
}

TEST_F(Output, ASceneAndItsFolderMayHaveOneName) {
  const std::string command =
      "cd '" + folder_.string() + "' && '" DYNAMIC_ICP_PROGRAM "' " + small_simulation("street", "street") + "--force";
  for (int round = 0; round < 2; ++round) {
    const Outcome made = run_shell(command);
    EXPECT_EQ(made.status, kDone) << made.text;
  }
}

TEST_F(Output, ALinkToAnEmptyFolderIsFollowed) {
  fs::create_directories(folder_ / "target");
  fs::create_directory_symlink(folder_ / "target", folder_ / "link");
  const Outcome made = run(street().string(), at("link"));
  EXPECT_EQ(made.status, kDone) << made.text;
  EXPECT_TRUE(fs::exists(folder_ / "target" / "run.json"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(Output, AnEmptyMountPointIsFilled) {
  if (!mount_disk("4m")) {
    GTEST_SKIP() << "needs the right to mount a small file system";
  }
  for (const char* more : {"", "--force"}) {
    const Outcome made = run(street().string(), disk_.string(), more);
    EXPECT_EQ(made.status, kDone) << made.text;
  }
  EXPECT_EQ(names_in(disk_).size(), 6u);
  expect(run(street().string(), disk_.string()), kFailed, "--force");
}

TEST_F(Output, TheFolderOfTheShellStaysWhereItIs) {
  fs::create_directories(folder_ / "here");
  const std::string command = "cd '" + at("here") + "' && '" DYNAMIC_ICP_PROGRAM "' run --quiet --max-frames 2 " +
                              street().string() + " --output . --force && cat run.json";
  for (int round = 0; round < 2; ++round) {
    const Outcome made = run_shell(command);
    EXPECT_EQ(made.status, kDone) << made.text;
    EXPECT_TRUE(json::accept(made.text)) << made.text;
  }
  EXPECT_EQ(names_in(folder_ / "here").size(), 6u);
}

TEST_F(Output, ClosedStreamsAreNoPlaceForFiles) {
  const std::string program = "'" DYNAMIC_ICP_PROGRAM "' ";
  const std::string command = program + "run --threads 1 --max-frames 2 " + street().string() + " --output ";
  for (const std::string closed : {"<&-", ">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-", "2>/dev/full"}) {
    const Outcome made = run_shell(command + at("out") + " --force " + closed);
    EXPECT_EQ(made.status, kDone) << closed << ": " << made.text;
    std::istringstream frames(read_file(folder_ / "out" / "frames.jsonl"));
    int lines = 0;
    for (std::string line; std::getline(frames, line); ++lines) {
      EXPECT_TRUE(json::accept(line)) << closed << ": " << line;
    }
    EXPECT_EQ(lines, 2) << closed;
  }
  for (const char* arguments : {"run /nowhere --output /nowhere", "info /nowhere", "report /nowhere", "plot /nowhere",
                                "simulate street --output /proc/x", "convert /nowhere --to npz --output /nowhere"}) {
    EXPECT_EQ(run_shell(program + arguments + " 2>&-").status, kFailed) << arguments;
    EXPECT_EQ(run_shell(program + arguments + " 2>/dev/full").status, kFailed) << arguments;
  }
  EXPECT_EQ(run_shell(program + "run 2>&-").status, kWrongUsage);
}

TEST_F(Output, WhatCannotBePrintedIsNotDone) {
  for (const char* arguments : {"--help", "--version", "run --help", "simulate --help"}) {
    expect(run_shell(std::string("'" DYNAMIC_ICP_PROGRAM "' ") + arguments + " > /dev/full"), kFailed,
           "standard output");
    EXPECT_EQ(run_program(arguments).status, kDone);
  }
}

/// Starts a run that takes long and gives its process once it has begun to write.
pid_t start_writing(const std::string& input, const fs::path& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    const std::string out = (folder / "out").string();
    ::execl(DYNAMIC_ICP_PROGRAM, "dynamic-icp", "simulate", input.c_str(), "--frames", "2000", "--output", out.c_str(),
            nullptr);
    ::_exit(127);
  }
  const auto writes = [&] {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().filename() == "00002.bin") {
        return true;
      }
    }
    return false;
  };
  while (::waitpid(child, nullptr, WNOHANG) == 0 && !writes()) {
    ::usleep(1000);
  }
  return child;
}

TEST_F(Output, ASignalLeavesNothingBehindAndIsTold) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    const pid_t child = start_writing("street", folder_);
    ::kill(child, signal);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child) << "it ended by itself";
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << signal << ": " << status;
    EXPECT_TRUE(fs::is_empty(folder_)) << signal;
  }
}

TEST_F(Output, AnEarlierResultOutlivesASignal) {
  ASSERT_EQ(run_program(small_simulation("street", at("out"))).status, kDone);
  const std::string before = read_file(folder_ / "out" / "scene.json");
  const std::string command =
      "'" DYNAMIC_ICP_PROGRAM "' simulate street --quiet --force --frames 2000 --output " + at("out");
  const Outcome ended = run_shell("timeout -s TERM 1 " + command);
  EXPECT_EQ(ended.status, 124) << ended.text;
  EXPECT_EQ(read_file(folder_ / "out" / "scene.json"), before);
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"out"});
}

TEST_F(Output, IgnoredSignalsStayIgnored) {
  const Outcome made = run_shell("trap '' HUP; '" DYNAMIC_ICP_PROGRAM "' " + small_simulation("street", at("out")) +
                                 "& child=$!; while kill -HUP $child 2>/dev/null; do sleep 0.01; done; wait $child");
  EXPECT_EQ(made.status, kDone) << made.text;
  EXPECT_TRUE(fs::exists(folder_ / "out" / "scene.json"));
}

TEST_F(Output, ABrokenPipeEndsTheRunAsUsual) {
  const Outcome broken = run_shell("{ '" DYNAMIC_ICP_PROGRAM "' run " + street().string() + " --output " + at("out") +
                                   " --threads 1 2>&1; echo $? > " + at("status") + "; } | true");
  EXPECT_EQ(broken.status, kDone);
  EXPECT_EQ(read_file(folder_ / "status"), "141\n");
  EXPECT_EQ(names_in(folder_), std::vector<std::string>{"status"});
}

TEST_F(Output, AMapThatFailsDoesNotCostTheRun) {
  if (!mount_disk("8k")) {
    GTEST_SKIP() << "needs the right to mount a small file system";
  }
  const std::string map = (disk_ / "map.ply").string();
  const Outcome outcome = run(street().string(), at("out"), "--save-map " + map);
  expect(outcome, kFailed, map + ": cannot write: No space left on device");
  expect(outcome, kFailed, "the run is there");
  const json record = json::parse(read_file(folder_ / "out" / "run.json"));
  EXPECT_TRUE(record["map"].is_null());
  EXPECT_NE(record["warnings"].dump().find("no map"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(disk_));
}

TEST_F(Output, AReportThatFailsDoesNotCostTheRunAndIsNotSilent) {
  if (!mount_disk("800k")) {  // room for the run, not for the page
    GTEST_SKIP() << "needs the right to mount a small file system";
  }
  const std::string out = (disk_ / "out").string();
  const Outcome outcome = run(street().string(), out, "--report");
  if (outcome.text.find("built without the viewer") != std::string::npos) {
    GTEST_SKIP() << "built without the viewer";
  }
  expect(outcome, kFailed, "no report.html: " + out + "/report.html: cannot write: No space left on device");
  EXPECT_TRUE(fs::exists(out + "/run.json"));
  EXPECT_FALSE(fs::exists(out + "/report.html"));
}

TEST_F(Output, MessagesNameTheFilesOfTheUser) {
  if (!mount_disk("64k")) {
    GTEST_SKIP() << "needs the right to mount a small file system";
  }
  const std::string out = (disk_ / "out").string();
  expect(run_program("run --quiet --save-labels " + street().string() + " --output " + out), kFailed, out + "/");
  expect(run_program("convert --quiet --to npz " + street().string() + " --output " + out), kFailed, out + "/");
  expect(run_program("simulate --quiet street --output " + out), kFailed, out + "/");
  EXPECT_TRUE(fs::is_empty(disk_));
  ASSERT_EQ(run(street().string(), at("out")).status, kDone);
  const std::string missing = at("missing/x.html");
  const Outcome report = run_program("report " + at("out") + " --output " + missing);
  EXPECT_EQ(report.status, kFailed) << report.text;
  EXPECT_EQ(report.text.find(".partial"), std::string::npos) << report.text;
}

TEST_F(Output, AThreadThatCannotBeStartedIsNamed) {
  const std::string program = "ulimit -v 400000; '" DYNAMIC_ICP_PROGRAM "' ";
  if (run_shell(program + "--version").status != kDone) {
    GTEST_SKIP() << "this build needs more memory than the test leaves";
  }
  const std::string output = at("out");
  expect(run_shell(program + "run --quiet --threads 1024 " + street().string() + " --output " + output), kFailed,
         "of 1024 threads and no more");
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace dynamic_icp::tests
