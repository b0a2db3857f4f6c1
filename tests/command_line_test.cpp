// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// How options and settings are read, and what a wrong one is told.
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class CommandLine : public ProgramTest {};

TEST_F(CommandLine, AnOptionTakesOneValueAndLeavesTheRest) {
  run_and_summarise("--max-frames 2 --set window.max_iterations=9 " + street().string());
  EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["configuration"]["window.max_iterations"], 9);
}

// A file that lists the keys of other pipelines too, with the values they have, as earlier versions printed it.
TEST_F(CommandLine, AFileMayListWhatThePipelineDoesNotRead) {
  write_file(folder_ / "all.yaml",
             "odometry.scan_to_scan: true\nkiss_icp.voxel_size_m: 1\nego_motion.filter.tau_0_mps: 0.35\n"
             "registration.max_iterations: 7\n");
  run_and_summarise(street().string() + " --max-frames 2 --preset paper --config " + (folder_ / "all.yaml").string());
  const json configuration = json::parse(read_file(folder_ / "out" / "run.json"))["configuration"];
  EXPECT_EQ(configuration["registration.max_iterations"], 7);
  EXPECT_FALSE(configuration.contains("kiss_icp.voxel_size_m"));
}

TEST_F(CommandLine, KeysOfTheLastReleaseAreReadWithANote) {
  write_file(folder_ / "old.yaml", "tracking:\n  least_speed_mps: 0.25\n");
  const Outcome run =
      run_program("run " + street().string() + " --quiet --max-frames 2 --config " + (folder_ / "old.yaml").string() +
                  " --set odometry.unknown_deviation_m=0.2 --output " + (folder_ / "out").string());
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_NE(run.text.find("'odometry.unknown_deviation_m' is now 'odometry.unobservable_sigma_m'"), std::string::npos)
      << run.text;
  const json configuration = json::parse(read_file(folder_ / "out" / "run.json"))["configuration"];
  EXPECT_EQ(configuration["tracking.min_speed_mps"], 0.25);
  EXPECT_EQ(configuration["odometry.unobservable_sigma_m"], 0.2);
}

TEST_F(CommandLine, WrongUseIsStatusTwoAndNamesTheRemedy) {
  const std::string in = street().string();
  const std::string out = " --output " + (folder_ / "out").string();
  const auto expect_usage_error = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << arguments << "\n" << outcome.text;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  };
  expect_usage_error("", "subcommand");
  expect_usage_error("fly", "fly");
  expect_usage_error("run " + in, "--output");
  expect_usage_error("run " + in + out + " --wrong", "--wrong");
  expect_usage_error("run " + in + " --ouput " + (folder_ / "out").string(),
                     "no option '--ouput'; did you mean '--output'");
  expect_usage_error("run " + in + out + " --set voxel_sise_m=1", "did you mean 'preprocess.voxel.voxel_size_m'");
  expect_usage_error("run " + in + out + " --set preprocess.voxel.voxel_size_m=-1", "0 to 100 m");
  expect_usage_error("run " + in + out + " --set preprocess.voxel.voxel_size_m", "expected key=value");
  expect_usage_error("run " + in + out + " --preset best", "paper");
  expect_usage_error("run " + in + out + " --set kiss_icp.voxel_size_m=9",
                     "only on kiss-icp; did you mean 'preprocess.voxel.voxel_size_m'");
  write_file(folder_ / "paper.yaml", "odometry.scan_to_scan: true\n");  // of version 0.2
  expect_usage_error("run " + in + out + " --config " + (folder_ / "paper.yaml").string(), "--preset paper");
  expect_usage_error("run " + in + out + " --ablation no-such", "no-vf");
  expect_usage_error("run " + in + out + " --method magic", "dynamic-icp");
  expect_usage_error("run " + in + out + " --format vhs", "dicp");
  expect_usage_error("run " + in + out + " --start 500", "0 to 11");
  expect_usage_error("run " + in + out + " --start -1", "--start is '-1', expected a whole number, 0 or more");
  expect_usage_error("run " + in + out + " --max-frames 0", "--max-frames is '0', expected a whole number, 1 or more");
  expect_usage_error("run " + in + out + " --max-frames 1.5", "--max-frames is '1.5'");
  expect_usage_error("convert " + in + out + " --to npz --start -1", "--start is '-1'");
  expect_usage_error("benchmark " + in + out + " --max-frames 0", "--max-frames is '0'");
  expect_usage_error("run " + in + " --output ''", "the folder for the results is ''");
  expect_usage_error("convert " + in + " --to npz --output ''", "the folder for the results is ''");
  expect_usage_error("simulate street --frames 2 --output ''", "--output DIR is missing");
  expect_usage_error("run " + in + out + " --threads -1", "threads");
  write_file(folder_ / "bad.yaml", "preprocess:\n  voxel:\n    voxel_size_m: [1, 2]\n");
  expect_usage_error("run " + in + out + " --config " + (folder_ / "bad.yaml").string(), "line 3");
}

TEST_F(CommandLine, HelpDocumentsEveryOption) {
  for (const char* command : {"run", "register", "evaluate", "simulate", "info", "report", "plot", "config"}) {
    const Outcome outcome = run_program(std::string(command) + " --help");
    EXPECT_EQ(outcome.status, 0) << command;
    std::istringstream lines(outcome.text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("  --")) {
        EXPECT_GT(line.size(), 30u) << command << ": no description: " << line;
      }
    }
  }
  EXPECT_EQ(run_program("--version").status, 0);
}

}  // namespace
}  // namespace dynamic_icp::tests
