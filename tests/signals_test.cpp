// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// A run that is asked to end: the first signal lets it finish its scan and keep what there is, a second one ends it.
#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

/// A run whose standard error is full from the start: it gets no further than to its first message, which it prints
/// within its first scans, until someone reads. So signals come in time however fast it is.
class HeldRun {
 public:
  HeldRun(const fs::path& input, const fs::path& folder) {
    int ends[2] = {};
    EXPECT_EQ(::pipe(ends), 0);
    messages_ = ends[0];
    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
    const std::string filling(4096, '.');
    while (::write(ends[1], filling.data(), filling.size()) > 0) {
    }
    while (::write(ends[1], ".", 1) > 0) {
    }
    ::fcntl(ends[1], F_SETFL, 0);
    child_ = ::fork();
    if (child_ == 0) {
      ::signal(SIGINT, SIG_DFL);
      ::dup2(::open("/dev/null", O_RDWR), STDOUT_FILENO);
      ::dup2(ends[1], STDERR_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      const std::string out = (folder / "out").string();
      ::execl(DYNAMIC_ICP_PROGRAM, "dynamic-icp", "run", input.c_str(), "--threads", "1", "--output", out.c_str(),
              nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    while (!writes(folder)) {
      ::usleep(1000);
    }
  }
  ~HeldRun() { ::close(messages_); }
  HeldRun(const HeldRun&) = delete;
  HeldRun& operator=(const HeldRun&) = delete;

  void send(int signal) const { ::kill(child_, signal); }

  /// The stack of its main thread.
  [[nodiscard]] double stack_kib() const {
    std::ifstream status("/proc/" + std::to_string(child_) + "/status");
    for (std::string word; status >> word;) {
      double kib = 0;
      if (word == "VmStk:" && status >> kib) {
        return kib;
      }
    }
    ADD_FAILURE() << "no VmStk";
    return 0;
  }

  /// Lets it go on. Its status and messages.
  [[nodiscard]] Outcome finish() const {
    Outcome outcome;
    char buffer[4096];
    for (ssize_t got = 0; (got = ::read(messages_, buffer, sizeof(buffer))) > 0;) {
      outcome.text.append(buffer, static_cast<std::size_t>(got));
    }
    outcome.text.erase(0, outcome.text.find_first_not_of('.'));
    int status = 0;
    EXPECT_EQ(::waitpid(child_, &status, 0), child_);
    EXPECT_EQ(WIFSIGNALED(status), is_killed_);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
  }

  void expect_killed() { is_killed_ = true; }

 private:
  /// The folder where results are put together is made after the run has taken over the signals.
  static bool writes(const fs::path& folder) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (fs::exists(entry.path() / "frames.jsonl")) {
        return true;
      }
    }
    return false;
  }

  int messages_ = -1;
  pid_t child_ = -1;
  bool is_killed_ = false;
};

class Signals : public ProgramTest {};

TEST_F(Signals, TheFirstOneKeepsTheResultsSoFar) {
  for (const auto& [signal, status] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    const HeldRun run(street(), folder_);
    run.send(signal);
    const Outcome outcome = run.finish();
    EXPECT_EQ(outcome.status, status) << outcome.text;
    const fs::path out = folder_ / "out";
    const json summary = json::parse(read_file(out / "summary.json"));
    const auto scans = summary["frames"].get<std::size_t>();
    EXPECT_GE(scans, 1u);
    EXPECT_LT(scans, 12u);
    EXPECT_EQ(summary["stopped"], true);
    EXPECT_EQ(json::parse(read_file(out / "run.json"))["stopped"], true);
    const std::string trajectory = read_file(out / "trajectory.tum");
    EXPECT_EQ(static_cast<std::size_t>(std::count(trajectory.begin(), trajectory.end(), '\n')), scans);
    EXPECT_NE(
        outcome.text.find("stopped after " + std::to_string(scans) + " of 12 scans; results so far in " + out.string()),
        std::string::npos)
        << outcome.text;
    EXPECT_EQ(run_program("evaluate " + (out / "trajectory.tum").string() + " " + (street() / "ref_poses.txt").string())
                  .status,
              kDone);
    fs::remove_all(out);
    EXPECT_TRUE(fs::is_empty(folder_)) << "nothing else was left";
  }
}

// A stack that cannot grow ends a process by SIGSEGV, without a word: `ulimit -v` finds the moment, now and then.
TEST_F(Signals, TheStackIsThereBeforeMemoryCanEnd) {
#ifndef __linux__
  GTEST_SKIP() << "reads /proc";
#endif
  const HeldRun run(street(), folder_);
  EXPECT_GE(run.stack_kib(), 1024);
  EXPECT_EQ(run.finish().status, kDone);
  const Outcome small = run_shell("ulimit -s 512 && " DYNAMIC_ICP_PROGRAM " --version");
  EXPECT_EQ(small.status, kDone) << small.text;
}

TEST_F(Signals, ASecondOneEndsItAtOnceAndLeavesNothing) {
  HeldRun run(street(), folder_);
  run.send(SIGINT);
  run.send(SIGTERM);  // after the first: the lower number is delivered first
  run.expect_killed();
  EXPECT_EQ(run.finish().status, 128 + SIGTERM);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Signals, WhatAKilledRunLeftIsRemovedByTheNextOneBesideIt) {
  HeldRun run(street(), folder_);
  run.send(SIGKILL);
  run.expect_killed();
  EXPECT_EQ(run.finish().status, 128 + SIGKILL);
  EXPECT_FALSE(fs::is_empty(folder_)) << "what it began to write";
  ASSERT_EQ(
      run_program("run --quiet --max-frames 2 " + street().string() + " -o " + (folder_ / "other").string()).status,
      kDone);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "only the result";
}

}  // namespace
}  // namespace dynamic_icp::tests
