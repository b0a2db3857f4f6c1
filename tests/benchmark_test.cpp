// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The command benchmark as a user meets it, on tiny simulated recordings.
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Benchmark : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    for (const char* scene : {"street", "jam"}) {
      const Outcome made =
          run_program(std::string("simulate ") + scene + " --frames 7 --instant --set lidar.columns=150 --quiet " +
                      "--output " + (data() / scene).string());
      ASSERT_EQ(made.status, 0) << made.text;
    }
  }

  [[nodiscard]] fs::path data() const { return folder_ / "data"; }
  [[nodiscard]] fs::path out() const { return folder_ / "out"; }

  /// Benchmarks both recordings into the folder "out".
  [[nodiscard]] Outcome benchmark(const std::string& arguments) const {
    return run_program("benchmark " + data().string() + " --output " + out().string() + " " + arguments);
  }

  /// When each cell of the folder was run last.
  [[nodiscard]] std::map<std::string, fs::file_time_type> run_times() const {
    std::map<std::string, fs::file_time_type> times;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out())) {
      if (entry.path().filename() == "cell.json") {
        times[entry.path().lexically_relative(out()).parent_path().string()] = entry.last_write_time();
      }
    }
    return times;
  }

  /// Everything that must not depend on when and how often a benchmark was interrupted: no times, no memory.
  static std::string lasting_results(const fs::path& folder) {
    std::string text;
    json results = json::parse(read_file(folder / "results.json"));
    for (json& cell : results["cells"]) {
      for (const char* key : {"ms_mean", "ms_median", "ms_p95", "fps", "peak_memory_mib"}) {
        EXPECT_GT(cell[key].get<double>(), 0.0) << key;
        cell.erase(key);
      }
      const fs::path run = folder / cell["folder"].get<std::string>() / "run";
      text += cell.dump() + "\n" + read_file(run / "trajectory.tum") + read_file(run / "objects.jsonl");
    }
    return text;
  }

  const std::string kOurs = "--methods dynamic-icp ";
};

TEST_F(Benchmark, MakesTheTablesOfAllMethodsAndAblations) {
  const Outcome outcome = benchmark("");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const json results = json::parse(read_file(out() / "results.json"));
  EXPECT_GE(results["cells"].size(), 2u * 4u);
  for (const json& cell : results["cells"]) {
    EXPECT_TRUE(cell["finished"]) << cell;
    EXPECT_EQ(cell["frames"], 7);
    const fs::path run = out() / cell["folder"].get<std::string>() / "run";
    const json summary = json::parse(read_file(run / "summary.json"));
    EXPECT_EQ(cell["rte_rmse_m"], summary["rte_rmse_m"]);
    EXPECT_EQ(summary["method"], cell["method"]);
    EXPECT_EQ(json::parse(read_file(run / "run.json"))["ablation"], cell["ablation"]);
  }
  std::string all;
  for (const char* name : {"accuracy", "consistency", "runtime", "ablation", "dynamics", "objects", "tracks"}) {
    all += (all.empty() ? "" : "\n") + read_file(out() / "tables" / (std::string(name) + ".md"));
    EXPECT_GT(read_file(out() / "tables" / (std::string(name) + ".csv")).size(), 20u) << name;
    EXPECT_NE(read_file(out() / "tables" / (std::string(name) + ".tex")).find("\\toprule"), std::string::npos) << name;
  }
  EXPECT_EQ(read_file(out() / "tables.md"), all);
  EXPECT_EQ(outcome.text.find("<u>"), std::string::npos) << "Markdown is for files";
  const std::size_t setup = outcome.text.find("Measured with dynamic-icp");
  EXPECT_NE(setup, std::string::npos) << outcome.text;
  EXPECT_EQ(outcome.text.find("Measured with dynamic-icp", setup + 1), std::string::npos) << "said once";
  EXPECT_NE(outcome.text.find("\nDynamic-ICP "), std::string::npos) << outcome.text;
  EXPECT_NE(all.find("| Dynamic-ICP"), std::string::npos);
  EXPECT_NE(all.find("Inputs: jam, street in "), std::string::npos);
  EXPECT_EQ(results["info"]["sequences"][1]["path"], (data() / "street").string());
}

TEST_F(Benchmark, TablesComeFromTheSavedResults) {
  ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet").status, 0);
  json results = json::parse(read_file(out() / "results.json"));
  results["cells"][0]["rte_rmse_m"] = 12.3456;
  write_file(out() / "results.json", results.dump());
  fs::remove_all(out() / "jam");
  fs::remove(out() / "benchmark.lock");
  write_file(out() / "tables" / "ablation.md", "of an earlier benchmark");
  for (const char* name : {"my_table.tex", "notes.md", "numbers.csv"}) {
    write_file(out() / "tables" / name, "of the user");
  }
  const Outcome outcome = run_program("benchmark --tables " + out().string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("12.3456"), std::string::npos) << outcome.text;
  EXPECT_NE(read_file(out() / "tables.md").find("12.3456"), std::string::npos);
  EXPECT_FALSE(fs::exists(out() / "tables" / "ablation.md"));
  for (const char* name : {"my_table.tex", "notes.md", "numbers.csv"}) {
    EXPECT_TRUE(fs::exists(out() / "tables" / name)) << name;
  }
}

TEST_F(Benchmark, RunsTheMethodsThatAreNamedAndNoAblations) {
  ASSERT_EQ(benchmark("--methods kiss-icp,dynamic-icp --quiet").status, 0);
  std::set<std::string> cells;
  for (const auto& [cell, time] : run_times()) {
    cells.insert(cell);
  }
  EXPECT_EQ(cells, (std::set<std::string>{"jam/dynamic-icp", "jam/kiss-icp", "street/dynamic-icp", "street/kiss-icp"}));
}

TEST_F(Benchmark, AMethodThatLosesMostScansHasItsNumbersAndIsNamed) {
  for (int scan = 2; scan <= 7; ++scan) {
    fs::resize_file(data() / "jam" / "point_clouds" / ("0000" + std::to_string(scan) + ".bin"), 3 * 16);
  }
  const Outcome outcome = benchmark(kOurs);
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("jam dynamic-icp: done, ODOMETRY FAILED on 6 of 7 scans"), std::string::npos)
      << outcome.text;
  const json results = json::parse(read_file(out() / "results.json"));
  EXPECT_EQ(results["cells"][0]["finished"], true);
  EXPECT_TRUE(results["cells"][0]["rte_rmse_m"].is_number());
  EXPECT_EQ(results["cells"][1]["failure"], "");
}

TEST_F(Benchmark, FinishedCellsStayChangedOnesRunAgain) {
  ASSERT_EQ(benchmark(kOurs + "--ablations no-dr").status, 0);
  const auto first = run_times();
  EXPECT_EQ(first.size(), 4u);
  const Outcome again = benchmark(kOurs + "--ablations no-dr");
  ASSERT_EQ(again.status, 0) << again.text;
  EXPECT_NE(again.text.find("jam dynamic-icp no-dr: done before"), std::string::npos) << again.text;
  EXPECT_EQ(run_times(), first);
  ASSERT_EQ(benchmark(kOurs + "--ablations no-dr,no-vf --jobs 2").status, 0);
  EXPECT_EQ(run_times().size(), 6u);
  for (const auto& [cell, time] : first) {
    EXPECT_EQ(run_times()[cell], time) << cell << " does not depend on its neighbours";
  }

  write_file(folder_ / "my.yaml", "preprocess:\n  voxel:\n    voxel_size_m: 0.5\n");
  for (const std::string& change :
       {std::string("--max-frames 5"), std::string("--start 1"), std::string("--preset paper"),
        std::string("--threads 1"), std::string("--set window.max_iterations=3"),
        "--config " + (folder_ / "my.yaml").string(), std::string("--force")}) {
    const auto before = run_times();
    ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet " + change).status, 0) << change;
    for (const char* cell : {"jam/dynamic-icp", "street/dynamic-icp"}) {
      EXPECT_NE(run_times()[cell], before.at(cell)) << change;
    }
  }
}

TEST_F(Benchmark, AChangedRecordingRunsAgain) {
  ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet").status, 0);
  const auto before = run_times();
  const fs::path scan = data() / "jam" / "point_clouds" / "00007.bin";
  fs::resize_file(scan, fs::file_size(scan) - 16);
  ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet").status, 0);
  EXPECT_NE(run_times()["jam/dynamic-icp"], before.at("jam/dynamic-icp"));
  EXPECT_EQ(run_times()["street/dynamic-icp"], before.at("street/dynamic-icp"));
}

TEST_F(Benchmark, AChangeWithinAScanInTheMiddleIsSeen) {
  ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet").status, 0);
  const auto before = run_times();
  const fs::path scan = data() / "jam" / "point_clouds" / "00003.bin";
  std::string content = read_file(scan);
  content[content.size() / 2] = static_cast<char>(content[content.size() / 2] ^ 1);
  const fs::file_time_type time = fs::last_write_time(scan);
  write_file(scan, content);
  fs::last_write_time(scan, time);
  ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet").status, 0);
  EXPECT_NE(run_times()["jam/dynamic-icp"], before.at("jam/dynamic-icp"));
  EXPECT_EQ(run_times()["street/dynamic-icp"], before.at("street/dynamic-icp"));
}

TEST_F(Benchmark, ADamagedRecordingIsAnErrorAndNotTakenApart) {
  const fs::path rec = data() / "jam";
  const fs::path poses = rec / "ref_poses.txt";
  fs::create_directories(rec / "parts");
  fs::copy_file(rec / "point_clouds" / "00001.bin", rec / "parts" / "00001.bin");  // would do as a recording
  write_file(poses, read_file(poses) + "bad\n");
  const Outcome outcome = run_program("benchmark " + rec.string() + " --output " + out().string());
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  EXPECT_NE(outcome.text.find(poses.string() + ": line "), std::string::npos) << outcome.text;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Benchmark, NamesOfAManifestStayInTheFolder) {
  for (const std::string name : {"'..'", "tables", "results.json", R"("\e[31m")"}) {
    write_file(folder_ / "list.yaml",
               "description: d\nformat: dicp\nsequences:\n  - {name: " + name + ", folders: [jam]}\n");
    const Outcome outcome = run_program("benchmark --manifest " + (folder_ / "list.yaml").string() + " --root " +
                                        data().string() + " --output " + out().string());
    EXPECT_EQ(outcome.status, 2) << name << outcome.text;
    EXPECT_NE(outcome.text.find("list.yaml: line 4: "), std::string::npos) << outcome.text;
    EXPECT_FALSE(fs::exists(out())) << name;
  }
}

TEST_F(Benchmark, RunsWhereTheSignalOfEndedChildrenIsIgnored) {
  const Outcome outcome =
      run_shell(std::string("env --ignore-signal=CHLD '") + DYNAMIC_ICP_PROGRAM + "' benchmark " + data().string() +
                " --output " + out().string() + " --quiet --ablations none " + kOurs);
  EXPECT_EQ(outcome.status, 0) << outcome.text;
}

TEST_F(Benchmark, ABrokenScanFailsItsCellsOnly) {
  write_file(data() / "jam" / "point_clouds" / "00004.bin", "version https://git-lfs.github.com/spec/v1\n");
  for (const char* when : {"first", "again"}) {
    const Outcome outcome = benchmark(kOurs + "--ablations none");
    EXPECT_EQ(outcome.status, 1) << when;
    EXPECT_NE(outcome.text.find("jam dynamic-icp: failed: exit status 1: "), std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find("00004.bin"), std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find("1 of 2 cells failed"), std::string::npos) << outcome.text;
    EXPECT_NE(read_file(out() / "tables" / "dynamics.csv").find("jam,failed"), std::string::npos);
    EXPECT_EQ(read_file(out() / "tables" / "dynamics.csv").find("street,failed"), std::string::npos);
  }
}

TEST_F(Benchmark, GoesOnAfterKillAsIfNothingHadHappened) {
  ASSERT_EQ(benchmark("--quiet").status, 0);
  const std::string undisturbed = lasting_results(out());
  fs::remove_all(out());
  // Killed as soon as so many cells are there, with the next one running.
  for (const int cells : {1, 3, 6}) {
    const Outcome killed =
        run_shell(std::string("'") + DYNAMIC_ICP_PROGRAM + "' benchmark " + data().string() + " --quiet --output " +
                  out().string() + " & benchmark=$!; while [ $(ls " + out().string() +
                  "/*/*/cell.json 2>/dev/null | wc -l) -lt " + std::to_string(cells) +
                  " ]; do sleep 0.01; done; kill -9 $benchmark; "
                  "wait $benchmark; echo status $?");
    ASSERT_NE(killed.text.find("status 137"), std::string::npos) << killed.text;
  }
  const auto before = run_times();
  const Outcome outcome = benchmark("");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_EQ(lasting_results(out()), undisturbed);
  EXPECT_GE(before.size(), 6u);
  for (const auto& [cell, time] : before) {
    EXPECT_EQ(run_times()[cell], time) << cell;
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out())) {
    EXPECT_EQ(entry.path().filename().string().find(".partial-"), std::string::npos) << entry.path();
  }
}

TEST_F(Benchmark, CellsRunOneByOneGiveTheTablesOfOneMachine) {
  const std::string methods = "--methods dynamic-icp,kiss-icp ";
  ASSERT_EQ(benchmark(methods + "--quiet").status, 0);
  const fs::path whole = folder_ / "whole";
  fs::rename(out(), whole);
  ASSERT_EQ(benchmark(methods + "--plan").status, 0);
  EXPECT_TRUE(run_times().empty()) << "nothing was run";
  const json plan = json::parse(read_file(out() / "plan.json"));
  ASSERT_EQ(plan["cells"].size(), 4u);
  EXPECT_EQ(plan["cells"][0]["scans"], 7);
  const Outcome early = run_program("benchmark --collect " + out().string());
  EXPECT_EQ(early.status, 1);
  EXPECT_NE(early.text.find("4 of 4 cells failed"), std::string::npos) << early.text;
  // The last one first, and two at the same time.
  const auto cell = [&](std::size_t index) {
    return "'" + std::string(DYNAMIC_ICP_PROGRAM) + "' benchmark --output " + out().string() + " --cell " +
           plan["cells"][index]["folder"].get<std::string>();
  };
  EXPECT_EQ(run_shell(cell(3) + " & " + cell(2) + "; status=$?; wait $! && exit $status").status, 0);
  EXPECT_EQ(run_shell(cell(1) + " && " + cell(0)).status, 0);
  const Outcome again = run_shell(cell(1));
  EXPECT_NE(again.text.find("done before"), std::string::npos) << again.text;
  const Outcome collected = run_program("benchmark --collect " + out().string());
  EXPECT_EQ(collected.status, 0) << collected.text;
  EXPECT_EQ(lasting_results(out()), lasting_results(whole));
  for (const fs::directory_entry& table : fs::directory_iterator(whole / "tables")) {
    const fs::path name = table.path().filename();
    if (name.stem() != "runtime") {
      EXPECT_EQ(read_file(out() / "tables" / name), read_file(table.path())) << name;
    }
  }
}

TEST_F(Benchmark, ACellIsOneOfThePlanOfThisProgram) {
  ASSERT_EQ(benchmark(kOurs + "--plan").status, 0);
  const std::string at = "benchmark --output " + out().string() + " --cell ";
  EXPECT_EQ(run_program(at + "street/gicp").status, 2) << "not in the plan";
  const Outcome locked = run_shell("mkdir -p " + (out() / "street" / "dynamic-icp").string() + "; flock " +
                                   (out() / "street" / "dynamic-icp" / "cell.lock").string() + " '" +
                                   DYNAMIC_ICP_PROGRAM + "' " + at + "street/dynamic-icp");
  EXPECT_EQ(locked.status, 1) << locked.text;
  write_file(data() / "jam" / "point_clouds" / "00003.bin", "version https://git-lfs.github.com/spec/v1\n");
  const Outcome failed = run_program(at + "jam/dynamic-icp");
  EXPECT_EQ(failed.status, 1) << failed.text;
  EXPECT_NE(failed.text.find("00003.bin"), std::string::npos) << failed.text;
  json plan = json::parse(read_file(out() / "plan.json"));
  plan["program"]["checksum"] = "of another build";
  write_file(out() / "plan.json", plan.dump());
  const Outcome other = run_program(at + "street/dynamic-icp");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.text.find("another build"), std::string::npos) << other.text;
  EXPECT_EQ(run_program("benchmark --output " + (folder_ / "nowhere").string() + " --cell a/b").status, 1);
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
  for (const char* both : {" --plan", " --collect x", " --tables x", " --manifest x"}) {
    EXPECT_EQ(run_program(at + "street/dynamic-icp" + both).status, 2) << both;
  }
}

TEST_F(Benchmark, TwoInOneFolderAreRefused) {
  ASSERT_EQ(benchmark(kOurs + "--ablations none --quiet").status, 0);
  const Outcome outcome = run_shell("flock " + (out() / "benchmark.lock").string() + " '" + DYNAMIC_ICP_PROGRAM +
                                    "' benchmark " + data().string() + " --output " + out().string());
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("another benchmark is running in this folder"), std::string::npos) << outcome.text;
}

TEST_F(Benchmark, WrongUseIsRefusedBeforeAnythingIsMade) {
  const std::map<std::string, std::string> wrong = {{"--methods walking", "dynamic-icp"},
                                                    {"--methods ''", "no name"},
                                                    {"--ablations no-sense", "no-dpp"},
                                                    {"--methods point-to-plane --ablations no-vf", "dynamic-icp"},
                                                    {"--preset nice", "paper"},
                                                    {"--set registration.max_iterations=0", "max_iterations"},
                                                    {"--format vhs", "dicp"},
                                                    {"--jobs 0", "jobs"},
                                                    {"--max-frames 0", "max-frames"},
                                                    {data().string() + "/jam", "given twice"}};
  for (const auto& [arguments, words] : wrong) {
    const Outcome outcome = benchmark(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << arguments << "\n" << outcome.text;
    EXPECT_FALSE(fs::exists(out())) << arguments;
  }
  EXPECT_EQ(run_program("benchmark").status, 2);
  EXPECT_EQ(run_program("benchmark " + data().string()).status, 2) << "--output is missing";
  EXPECT_EQ(run_program("benchmark --output " + out().string()).status, 2) << "INPUT is missing";
  const std::string before_input =
      run_program("benchmark --output " + out().string() + " --set nonsense=1 " + data().string()).text;
  EXPECT_NE(before_input.find("unknown configuration key"), std::string::npos)
      << "--set takes one value: " << before_input;
  EXPECT_EQ(benchmark("--tables " + out().string()).status, 2);
}

TEST_F(Benchmark, WrongFoldersAreRefused) {
  write_file(folder_ / "mine" / "thesis.txt", "years of work");
  const std::string inputs = "benchmark " + data().string() + " ";
  EXPECT_EQ(run_program(inputs + "--output " + (folder_ / "mine").string()).status, 1);
  EXPECT_EQ(run_program("benchmark " + (folder_ / "mine").string() + " --output " + out().string()).status, 1);
  EXPECT_EQ(run_program("benchmark --tables " + (folder_ / "mine").string()).status, 1);
  EXPECT_EQ(run_program("benchmark --tables " + (folder_ / "nowhere").string()).status, 1);
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
  EXPECT_FALSE(fs::exists(out()));
}

}  // namespace
}  // namespace dynamic_icp::tests
