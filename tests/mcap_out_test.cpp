// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Files for Foxglove and KITTI as a user meets them. What is in the MCAP files: tests/interop/mcap_out.test.mjs.
#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class McapOut : public ProgramTest {
 protected:
  Outcome run(const std::string& arguments) {
    return run_program("run " + street().string() + " --quiet --max-frames 3 --output " + (folder_ / "run").string() +
                       " " + arguments);
  }
  Outcome convert(const fs::path& output, const std::string& arguments = "") {
    return run_program("convert " + street().string() + " --to mcap --quiet --max-frames 2 --output " +
                       output.string() + " " + arguments);
  }
  [[nodiscard]] std::string option(const char* name, const fs::path& file) const {
    return std::string(name) + " " + (folder_ / file).string() + " ";
  }
  [[nodiscard]] static bool is_mcap(const fs::path& file) { return read_file(file).starts_with("\x89MCAP0\r\n"); }
  /// No file under a temporary name is left.
  void expect_no_leftovers() const {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
      EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
    }
  }
};

TEST_F(McapOut, BesideTheRun) {
  const Outcome outcome = run(option("--mcap", "drive.mcap") + option("--save-kitti", "kitti.txt"));
  ASSERT_EQ(outcome.status, kDone) << outcome.text;
  EXPECT_TRUE(is_mcap(folder_ / "drive.mcap"));
  EXPECT_EQ(read_file(folder_ / "foxglove_layout.json"), read_file(source_folder() / "docs" / "foxglove_layout.json"));
  const std::string kitti = read_file(folder_ / "kitti.txt");
  EXPECT_EQ(std::count(kitti.begin(), kitti.end(), '\n'), 3);
  EXPECT_TRUE(kitti.starts_with("1 0 0 0 0 1 0 0 0 0 1 0\n")) << kitti;
  const json record = json::parse(read_file(folder_ / "run" / "run.json"));
  EXPECT_EQ(record["mcap"]["path"], (folder_ / "drive.mcap").string());
  EXPECT_TRUE(record["mcap"]["file_in_run"].is_null());
  EXPECT_EQ(record["kitti"]["path"], (folder_ / "kitti.txt").string());
  expect_no_leftovers();
}

TEST_F(McapOut, WithinTheRunAndReplacedWithIt) {
  const std::string files = option("--mcap", "run/views/drive.mcap") + option("--save-kitti", "run/kitti.txt");
  ASSERT_EQ(run(files).status, kDone);
  EXPECT_TRUE(is_mcap(folder_ / "run" / "views" / "drive.mcap"));
  EXPECT_TRUE(fs::exists(folder_ / "run" / "views" / "foxglove_layout.json"));
  const Outcome again = run("--force");
  ASSERT_EQ(again.status, kDone) << again.text;
  EXPECT_FALSE(fs::exists(folder_ / "run" / "views")) << "they belonged to the earlier run";
  EXPECT_FALSE(fs::exists(folder_ / "run" / "kitti.txt"));
  EXPECT_TRUE(json::parse(read_file(folder_ / "run" / "run.json"))["mcap"].is_null());
}

TEST_F(McapOut, ALayoutThatIsThereStays) {
  write_file(folder_ / "foxglove_layout.json", "mine");
  ASSERT_EQ(run(option("--mcap", "drive.mcap")).status, kDone);
  EXPECT_EQ(read_file(folder_ / "foxglove_layout.json"), "mine");
}

TEST_F(McapOut, TheTrajectoryIsTheSameWithAndWithout) {
  ASSERT_EQ(run(option("--mcap", "drive.mcap")).status, kDone);
  const std::string with = read_file(folder_ / "run" / "trajectory.tum");
  ASSERT_EQ(run("--force").status, kDone);
  EXPECT_EQ(read_file(folder_ / "run" / "trajectory.tum"), with);
}

TEST_F(McapOut, NamesThatCannotBeAreWrongUse) {
  EXPECT_EQ(run(option("--mcap", "drive.bag")).status, kWrongUsage);
  EXPECT_EQ(run(option("--save-kitti", "run/trajectory.tum")).status, kWrongUsage);
  EXPECT_EQ(run(option("--mcap", "missing/drive.mcap")).status, kFailed);
  EXPECT_FALSE(fs::exists(folder_ / "run")) << "nothing is computed before";
}

TEST_F(McapOut, AnInputIsNotWrittenOver) {
  fs::create_directories(folder_ / "poses");
  fs::copy_file(street() / "ref_poses.txt", folder_ / "truth.txt");
  const std::string before = read_file(folder_ / "truth.txt");
  const Outcome outcome = run(option("--ground-truth", "truth.txt") + option("--save-kitti", "truth.txt"));
  EXPECT_EQ(outcome.status, kWrongUsage) << outcome.text;
  EXPECT_EQ(read_file(folder_ / "truth.txt"), before);
}

TEST_F(McapOut, ADiskThatIsFullBeforeTheFirstScanIsNamed) {
  fs::create_symlink("/dev/full", folder_ / "full.mcap");
  const std::string message = (folder_ / "full.mcap").string() + ": cannot write: No space left on device";
  for (const Outcome& outcome : {run(option("--mcap", "full.mcap")), convert(folder_ / "full.mcap")}) {
    EXPECT_EQ(outcome.status, kFailed);
    EXPECT_NE(outcome.text.find(message), std::string::npos) << outcome.text;
  }
  EXPECT_FALSE(fs::exists(folder_ / "run"));
}

// The machine's limit for the size of a file stands for a disk that fills up meanwhile.
TEST_F(McapOut, ADiskThatFillsUpCostsTheFileButNotTheRun) {
  write_file(folder_ / "drive.mcap", "\x89MCAP0\r\nof an earlier run");
  fs::create_symlink("/dev/full", folder_ / "full.txt");
  const Outcome outcome = run_shell("trap '' XFSZ; ulimit -f 512; '" DYNAMIC_ICP_PROGRAM "' run " + street().string() +
                                    " --quiet --output " + (folder_ / "run").string() + " " +
                                    option("--mcap", "drive.mcap") + option("--save-kitti", "full.txt"));
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_NE(outcome.text.find("the run is there, but no MCAP file: " + (folder_ / "drive.mcap").string() +
                              ": cannot write: File too large"),
            std::string::npos)
      << outcome.text;
  EXPECT_NE(outcome.text.find("no KITTI poses: " + (folder_ / "full.txt").string()), std::string::npos) << outcome.text;
  EXPECT_TRUE(fs::exists(folder_ / "run" / "trajectory.tum"));
  EXPECT_EQ(read_file(folder_ / "drive.mcap"), "\x89MCAP0\r\nof an earlier run");
  const json record = json::parse(read_file(folder_ / "run" / "run.json"));
  EXPECT_TRUE(record["mcap"].is_null());
  EXPECT_TRUE(record["kitti"].is_null());
  EXPECT_EQ(record["warnings"].size(), 2U) << record["warnings"];
  expect_no_leftovers();
}

TEST_F(McapOut, AFileOrAFolderOfAConversion) {
  ASSERT_EQ(convert(folder_ / "drive.mcap").status, kDone);
  ASSERT_EQ(convert(folder_ / "folder").status, kDone);
  EXPECT_TRUE(is_mcap(folder_ / "drive.mcap"));
  EXPECT_EQ(read_file(folder_ / "folder" / "recording.mcap"), read_file(folder_ / "drive.mcap"));
  EXPECT_EQ(json::parse(read_file(folder_ / "folder" / "conversion.json"))["format"], "mcap");

  const std::string before = read_file(folder_ / "drive.mcap");
  const Outcome again = convert(folder_ / "drive.mcap", "--start 1");
  EXPECT_EQ(again.status, kFailed);
  EXPECT_NE(again.text.find("drive.mcap: exists; use --force to replace it"), std::string::npos) << again.text;
  EXPECT_EQ(read_file(folder_ / "drive.mcap"), before);
  ASSERT_EQ(convert(folder_ / "drive.mcap", "--start 1 --force").status, kDone);
  EXPECT_NE(read_file(folder_ / "drive.mcap"), before);
  ASSERT_EQ(convert(folder_ / "folder", "--force").status, kDone);

  write_file(folder_ / "notes.mcap", "my notes");
  EXPECT_EQ(convert(folder_ / "notes.mcap", "--force").status, kFailed);
  EXPECT_EQ(read_file(folder_ / "notes.mcap"), "my notes");
  expect_no_leftovers();
}

TEST_F(McapOut, PosesOfBothForTheToolsOfKitti) {
  ASSERT_EQ(run("").status, kDone);
  const std::string estimate = (folder_ / "run" / "trajectory.tum").string();
  const Outcome outcome =
      run_program("evaluate " + estimate + " " + (street() / "ref_poses.txt").string() + " " +
                  option("--save-kitti", "estimate.txt") + option("--save-kitti-reference", "reference.txt"));
  ASSERT_EQ(outcome.status, kDone) << outcome.text;
  for (const char* name : {"estimate.txt", "reference.txt"}) {
    std::istringstream lines(read_file(folder_ / name));
    int rows = 0;
    for (std::string line; std::getline(lines, line); ++rows) {
      EXPECT_EQ(std::count(line.begin(), line.end(), ' '), 11) << line;
    }
    EXPECT_EQ(rows, 3) << name;
  }
  EXPECT_EQ(run_program("evaluate --objects " + estimate + " x " + option("--save-kitti", "a.txt")).status,
            kWrongUsage);
}

}  // namespace
}  // namespace dynamic_icp::tests
