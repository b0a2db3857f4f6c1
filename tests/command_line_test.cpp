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
  expect_usage_error("", "Usage: dynamic-icp");
  expect_usage_error("", "benchmark");
  expect_usage_error("fly", "unknown command 'fly'; known are: run, ");
  expect_usage_error("evalute x y", "unknown command 'evalute' (did you mean 'evaluate'?)");
  expect_usage_error("rnu x --output y", "unknown command 'rnu' (did you mean 'run'?)");
  expect_usage_error("help evalute", "(did you mean 'evaluate'?)");
  expect_usage_error("run " + in, "see 'dynamic-icp run --help'");
  expect_usage_error("run " + in + out + " --max-frame 5",
                     "'run' has no option '--max-frame'; did you mean '--max-frames'?; see 'dynamic-icp run --help'");
  expect_usage_error("run " + in + out + " -z 5", "'run' has no option '-z'; see");
  expect_usage_error("run " + in + out + " more words", "'run' takes no further arguments: 'more', 'words'");
  expect_usage_error("run " + in + out + " --method kis-icp", "unknown method 'kis-icp' (did you mean 'kiss-icp'?)");
  expect_usage_error("run " + in + out + " --method KISS", "(did you mean 'kiss-icp'?)");
  expect_usage_error("run " + in + out + " --preset papr", "(did you mean 'paper'?)");
  expect_usage_error("run " + in + out + " --format npzz", "(did you mean 'npz'?)");
  expect_usage_error("convert " + in + out + " --to dcip", "(did you mean 'dicp'?)");
  expect_usage_error("simulate stret --frames 2 " + out, "(did you mean 'street'?)");
  expect_usage_error("simulate street --sensor aeries-i --frames 2 " + out, "did you mean 'aeries");
  write_file(folder_ / "scene.json", "{\n  \"scene\": {\"name\": \"street\"}\n}\n");
  expect_usage_error("run " + in + out + " --config " + (folder_ / "scene.json").string(),
                     "scene.json: is a JSON file and no configuration; expected YAML with lines 'key: value'");
  expect_usage_error("run " + in, "--output");
  expect_usage_error("run " + in + out + " --wrong", "--wrong");
  expect_usage_error("run " + in + " --ouput " + (folder_ / "out").string(),
                     "no option '--ouput'; did you mean '--output'");
  expect_usage_error("run " + in + " --out x", "no option '--out'; did you mean '--output'");
  expect_usage_error("run " + in + " -output x", "no option '-output'; did you mean '--output'");
  expect_usage_error("help rnu", "(did you mean 'run'?)");
  expect_usage_error("run " + in + out + " --set window.knot=1", "did you mean 'window.knot_spacing_s'");
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

TEST_F(CommandLine, HelpAndVersionAreCommandsToo) {
  const Outcome help = run_program("help");
  EXPECT_EQ(help.status, kDone);
  EXPECT_EQ(help.text, run_program("--help").text);
  EXPECT_EQ(help.text, run_program("-h").text);
  EXPECT_EQ(run_program("help run").text, run_program("run --help").text);
  EXPECT_NE(run_program("help run").text.find("Exit status: "), std::string::npos);
  EXPECT_EQ(run_program("version").text, run_program("--version").text);
  EXPECT_EQ(run_program("version").text, run_program("-v").text);
  EXPECT_EQ(run_program("version").status, kDone);
}

TEST_F(CommandLine, ShortAndOtherNamesMeanTheSame) {
  for (const char* name : {"--max-frames", "--max-scans", "--frames"}) {
    const fs::path out = folder_ / name;
    const Outcome run = run_program("run " + street().string() + " --quiet -o '" + out.string() + "' " + name + " 2");
    ASSERT_EQ(run.status, kDone) << run.text;
    EXPECT_EQ(json::parse(read_file(out / "summary.json"))["frames"], 2);
  }
}

TEST_F(CommandLine, BlanksAroundKeyAndValueAreTrimmed) {
  run_and_summarise("--max-frames 2 --set ' window.max_iterations = 9 ' " + street().string());
  EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["configuration"]["window.max_iterations"], 9);
}

TEST_F(CommandLine, EvaluateTakesFolders) {
  run_and_summarise(street().string());
  const std::string run = (folder_ / "out").string();
  const auto numbers = [](const std::string& arguments) {
    const Outcome outcome = run_program("evaluate --json " + arguments);
    EXPECT_EQ(outcome.status, kDone) << outcome.text;
    return json::parse(outcome.text)["rte_rmse_m"];
  };
  const json by_files = numbers(run + "/trajectory.tum " + (street() / "ref_poses.txt").string());
  EXPECT_EQ(numbers(run + " " + street().string()), by_files);
  EXPECT_EQ(numbers(run + " " + run), 0.0);
}

TEST_F(CommandLine, OnePoseHasNoError) {
  const Outcome one = run_program("run " + street().string() + " --max-frames 1 -o " + (folder_ / "out").string());
  EXPECT_EQ(one.status, kDone) << one.text;
  EXPECT_EQ(one.text.find("RTE"), std::string::npos) << one.text;
  EXPECT_NE(one.text.find("1 ok, 0 degenerate, 0 lost"), std::string::npos) << one.text;
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
