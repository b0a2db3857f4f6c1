// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_queue.hpp"

#include <algorithm>
#include <csignal>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/tools/benchmark/cell_run.hpp"

#include "testing/temporary_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

/// Cells run by a script that takes the place of the program and does what the name of the method says.
class CellQueueTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    write_file(program(), R"(#!/bin/sh
method=$1
while [ "$1" != --output ]; do shift; done
echo "$method" >> ")" + log().string() +
                              R"("
case $method in
  fails) echo "dynamic-icp: 00001.bin: truncated" >&2; exit 1;;
  crashes) kill -SEGV $$;;
  garbage) mkdir -p "$2"; echo '{"frames": ' > "$2/summary.json"; exit 0;;
  talks) echo "to standard output";;
esac
mkdir -p "$2"
box='"box":{"center":[20,0,0],"size":[4,2,2],"orientation_xyzw":[0,0,0,1]},'
if [ $method = velocities ]; then box=; fi
echo '{"frames": 7, "rte_rmse_m": 0.5, "fps": null}' > "$2/summary.json"
echo '{"assumptions": ["assumed"], "warnings": ["warned", "warned"]}' > "$2/run.json"
for k in 0 1 2 3 4 5 6; do
  echo '{"index":'$k',"timestamp":0.'$k',"objects":[{"id":1,"velocity":[11,0,0],"centroid":[20,0,0],'"$box" \
       '"extent":[4,2,2],"points":60}]}'
done > "$2/objects.jsonl"
)");
    fs::permissions(program(), fs::perms::owner_all);
  }

  [[nodiscard]] static CellPlan plan(const std::string& method, const std::string& fingerprint = "{\"a\": 1}") {
    CellPlan planned;
    planned.key = {"s", method, "none"};
    planned.folder = fs::path("s") / method;
    planned.arguments = {method};
    planned.fingerprint = fingerprint;
    return planned;
  }

  std::vector<CellResult> run(const std::vector<CellPlan>& plans, int jobs = 1, bool repeat = false) {
    std::vector<CellResult> results(plans.size());
    QueueEvents events;
    events.started = [](std::size_t) {};
    events.ended = [&](std::size_t index, const CellResult& result, bool) { results[index] = result; };
    run_cells(plans, {folder_ / "bench", program(), jobs, repeat}, events);
    return results;
  }

  /// How often a cell was run since the last question.
  std::size_t runs() {
    const std::string content = fs::exists(log()) ? read(log()) : "";
    fs::remove(log());
    return static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n'));
  }

  static std::string read(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  [[nodiscard]] fs::path program() const { return folder_ / "program.sh"; }
  [[nodiscard]] fs::path log() const { return folder_ / "log"; }
};

TEST_F(CellQueueTest, NothingToDoIsDone) { EXPECT_TRUE(run({}).empty()); }

TEST_F(CellQueueTest, ChildrenAreWaitedForAlsoWhereTheSignalWasIgnored) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const CellResult result = run({plan("talks")})[0];
  std::signal(SIGCHLD, before);
  EXPECT_TRUE(result.finished) << result.failure;
}

TEST_F(CellQueueTest, AResultIsWhatTheRunLeft) {
  const CellResult result = run({plan("talks")})[0];
  EXPECT_TRUE(result.finished) << result.failure;
  EXPECT_EQ(result.frames, 7u);
  EXPECT_EQ(result.rte_rmse_m, 0.5);
  EXPECT_FALSE(result.fps);
  EXPECT_GT(result.peak_memory_mib.value_or(0.0), 0.1);
  EXPECT_EQ(result.notes, std::vector<std::string>{"assumed"});
  EXPECT_EQ(result.warnings, 2u);
  EXPECT_FALSE(result.objects.estimated_share) << "no truth";
}

TEST_F(CellQueueTest, FailuresDoNotStopTheOthersAndSayWhy) {
  for (const int jobs : {1, 3}) {
    const auto results = run({plan("fails"), plan("crashes"), plan("garbage"), plan("works")}, jobs, true);
    EXPECT_FALSE(results[0].finished);
    EXPECT_EQ(results[0].failure, "exit status 1: 00001.bin: truncated");
    EXPECT_FALSE(results[1].finished);
    EXPECT_NE(results[1].failure.find("killed by signal 11"), std::string::npos) << results[1].failure;
    EXPECT_FALSE(results[2].finished);
    EXPECT_NE(results[2].failure.find("summary.json"), std::string::npos) << results[2].failure;
    EXPECT_TRUE(results[3].finished);
    EXPECT_EQ(results[3].jobs, jobs);
  }
}

TEST_F(CellQueueTest, AProgramThatCannotBeExecutedIsAFailure) {
  fs::permissions(program(), fs::perms::owner_read);
  const CellResult result = run({plan("works")})[0];
  EXPECT_EQ(result.failure, "exit status 127");
}

TEST_F(CellQueueTest, FinishedCellsAreNotRunAgainOthersAre) {
  const std::vector<CellPlan> plans = {plan("works"), plan("fails")};
  run(plans);
  EXPECT_EQ(runs(), 2u);
  EXPECT_TRUE(run(plans)[0].finished);
  EXPECT_EQ(runs(), 1u) << "only the failed one";
  run({plan("works", "{\"a\": 2}")});
  EXPECT_EQ(runs(), 1u) << "another fingerprint";
  run({plan("works", "{\"a\": 2}")}, 1, true);
  EXPECT_EQ(runs(), 1u) << "asked to repeat";
}

TEST_F(CellQueueTest, DamagedOrMissingFilesMeanAnotherRun) {
  const fs::path cell = folder_ / "bench" / "s" / "works";
  run({plan("works")});
  EXPECT_TRUE(saved_result(folder_ / "bench", plan("works")));
  const std::string whole = read(cell / "cell.json");
  for (const std::string& content : {std::string(), std::string("[]"), whole.substr(0, whole.size() / 2)}) {
    write_file(cell / "cell.json", content);
    EXPECT_FALSE(saved_result(folder_ / "bench", plan("works"))) << content;
  }
  write_file(cell / "cell.json", whole);
  EXPECT_TRUE(saved_result(folder_ / "bench", plan("works")));
  fs::remove_all(cell / "run");
  EXPECT_FALSE(saved_result(folder_ / "bench", plan("works"))) << "the run is gone";
}

TEST_F(CellQueueTest, AnInterruptedRunLeavesNoResultOfAnEarlierOne) {
  run({plan("works")});
  const pid_t child = start_cell(folder_ / "bench", program(), plan("works", "{\"a\": 2}"));
  EXPECT_FALSE(fs::exists(folder_ / "bench" / "s" / "works" / "cell.json"));
  EXPECT_EQ(wait_for_child().pid, child);
}

TEST_F(CellQueueTest, BadTruthFailsTheCellAndNamesTheFile) {
  CellPlan planned = plan("works");
  planned.object_truth = folder_ / "objects.jsonl";
  write_file(planned.object_truth, "{}\n");
  const CellResult result = run({planned})[0];
  EXPECT_FALSE(result.finished);
  EXPECT_NE(result.failure.find(planned.object_truth.string() + ", line 1"), std::string::npos) << result.failure;
}

TEST_F(CellQueueTest, ObjectsAreScoredAsTracksWhereTheyHaveBoxes) {
  std::string truth;
  for (int k = 0; k < 7; ++k) {
    truth +=
        fmt::format(R"({{"index":{},"timestamp":0.{},"objects":[{{"id":9,"velocity_sensor":[10,0,0],)"
                    R"("center_sensor":[20,0,0],"size":[4,2,2],"orientation_sensor_xyzw":[0,0,0,1],"points":60}}]}})"
                    "\n",
                    k, k);
  }
  write_file(folder_ / "objects.jsonl", truth);
  CellPlan boxes = plan("works");
  CellPlan velocities = plan("velocities");
  boxes.object_truth = velocities.object_truth = folder_ / "objects.jsonl";
  const auto results = run({boxes, velocities});
  ASSERT_TRUE(results[0].finished) << results[0].failure;
  ASSERT_TRUE(results[1].finished) << results[1].failure;
  EXPECT_NEAR(*results[0].tracks.hota, 1.0, 1e-9);
  EXPECT_NEAR(*results[0].tracks.along_mps, 1.0, 1e-9);
  EXPECT_EQ(results[0].tracks.false_per_1000_scans, 0.0);
  EXPECT_EQ(results[1].objects.estimated_share, 1.0);
  EXPECT_FALSE(results[1].tracks.hota);
  EXPECT_FALSE(results[1].tracks.false_per_1000_scans);
}

}  // namespace
}  // namespace dynamic_icp::benchmark
