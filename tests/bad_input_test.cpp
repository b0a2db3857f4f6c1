// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Everything that can be wrong with input, output and the command line: a clear error with the right exit status or a
// reported status per frame, never a crash, a NaN in a file or the loss of an earlier result.
#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class BadInput : public ProgramTest {
 protected:
  /// A copy of the first scans of the street that the test may damage.
  fs::path copy_of_street(int scans = 4) {
    const fs::path copy = folder_ / "recording";
    fs::create_directories(copy / "point_clouds");
    std::istringstream poses(read_file(street() / "ref_poses.txt"));
    std::string kept;
    for (std::string line; scans > 0 && std::getline(poses, line);) {
      kept += line + "\n";
      if (!line.empty() && line[0] != '#') {
        const std::string name = "0000" + std::to_string(++copied_) + ".bin";
        fs::copy_file(street() / "point_clouds" / name, copy / "point_clouds" / name);
        --scans;
      }
    }
    write_file(copy / "ref_poses.txt", kept);
    return copy;
  }

  Outcome run(const fs::path& input, const std::string& more = "") {
    return run_program("run --quiet " + input.string() + " --output " + (folder_ / "out").string() + " " + more);
  }

  void expect_failure(const Outcome& outcome, int status, const std::string& words) {
    EXPECT_EQ(outcome.status, status) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << "nothing half-written";
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      EXPECT_EQ(entry.path().filename().string().find(".partial"), std::string::npos) << entry.path();
    }
  }

  /// The statuses of a run that must have gone through, with no NaN in any file of it.
  std::vector<std::string> statuses(const Outcome& outcome, int status = kDone) {
    EXPECT_EQ(outcome.status, status) << outcome.text;
    for (const char* name : {"trajectory.tum", "frames.jsonl", "objects.jsonl", "summary.json"}) {
      const std::string content = read_file(folder_ / "out" / name);
      EXPECT_FALSE(content.empty()) << name;
      EXPECT_EQ(content.find("nan"), std::string::npos) << name;
      EXPECT_EQ(content.find("inf,"), std::string::npos) << name;
    }
    std::vector<std::string> result;
    std::istringstream frames(read_file(folder_ / "out" / "frames.jsonl"));
    for (std::string line; std::getline(frames, line);) {
      result.push_back(json::parse(line)["reason"]);
    }
    return result;
  }

  static std::string record(float x, float y, float z, float doppler) {
    const float values[] = {x, y, z, doppler};
    return {reinterpret_cast<const char*>(values), sizeof(values)};
  }

 private:
  int copied_ = 0;
};

TEST_F(BadInput, MissingOrForeignInput) {
  expect_failure(run(folder_ / "nowhere"), kFailed, "nowhere");
  fs::create_directories(folder_ / "empty");
  expect_failure(run(folder_ / "empty"), kFailed, "not a recording of a known layout");
  write_file(folder_ / "file.txt", "hello");
  expect_failure(run(folder_ / "file.txt"), kFailed, "not a recording");
}

TEST_F(BadInput, ScansWithoutUse) {
  const fs::path recording = copy_of_street(6);
  const fs::path scans = recording / "point_clouds";
  write_file(scans / "00002.bin", "");
  write_file(scans / "00003.bin", record(5.0F, 1.0F, 0.0F, -3.0F));
  std::string one_voxel;
  for (int i = 0; i < 500; ++i) {
    one_voxel += record(5.05F, 1.05F, 0.05F, -3.0F);
  }
  write_file(scans / "00004.bin", one_voxel);
  std::string not_numbers;
  for (int i = 0; i < 500; ++i) {
    not_numbers += record(NAN, 1.0F, INFINITY, NAN);
  }
  write_file(scans / "00005.bin", not_numbers);
  const Outcome outcome = run(recording);
  const std::vector<std::string> result = statuses(outcome, kMostScansLost);
  ASSERT_EQ(result.size(), 6u) << outcome.text;
  EXPECT_TRUE(outcome.text.find("ODOMETRY FAILED on 4 of 6 scans: ") != std::string::npos) << outcome.text;
  EXPECT_EQ(result, (std::vector<std::string>{"first", "too_few_points", "too_few_points", "too_few_points",
                                              "too_few_points", result.back()}));
  EXPECT_TRUE(result.back() == "converged" || result.back() == "iteration_limit") << "recovers: " << result.back();
}

TEST_F(BadInput, AllMovingOrNoDoppler) {
  const fs::path recording = copy_of_street(4);
  for (const char* name : {"00002.bin", "00003.bin"}) {
    const fs::path file = recording / "point_clouds" / name;
    std::string bytes = read_file(file);
    for (std::size_t i = 0; i + 16 <= bytes.size(); i += 16) {
      const float doppler = name[4] == '3' ? 0.0F : (i / 16 % 2 == 0 ? 40.0F : -40.0F);
      std::memcpy(bytes.data() + i + 12, &doppler, 4);
    }
    write_file(file, bytes);
  }
  EXPECT_EQ(statuses(run(recording)).size(), 4u);
}

TEST_F(BadInput, ARunWithoutOneUsableScanIsAFailure) {
  const fs::path recording = copy_of_street(3);
  std::string at_origin;
  std::string not_numbers;
  for (int i = 0; i < 500; ++i) {
    at_origin += record(0.0F, 0.0F, 0.0F, -3.0F);
    not_numbers += record(NAN, 1.0F, INFINITY, NAN);
  }
  for (const auto& [scan, words] :
       {std::pair{at_origin, "0 have numbers that no sensor measures, 1500 are at the origin"},
        std::pair{not_numbers, "of 1500 points 1500 have numbers that are not finite"},
        std::pair{std::string(), "none of the 3 scans has enough points"}}) {
    for (const char* name : {"00001.bin", "00002.bin", "00003.bin"}) {
      write_file(recording / "point_clouds" / name, scan);
    }
    for (const char* method : {"--preset default", "--preset paper", "--method kiss-icp"}) {
      expect_failure(run(recording, method), kFailed, words);
    }
  }
}

TEST_F(BadInput, AColumnOfZerosIsNoDoppler) {
  const fs::path recording = copy_of_street(6);
  for (const fs::directory_entry& entry : fs::directory_iterator(recording / "point_clouds")) {
    std::string bytes = read_file(entry.path());
    for (std::size_t i = 0; i + 16 <= bytes.size(); i += 16) {
      std::memset(bytes.data() + i + 12, 0, 4);
    }
    write_file(entry.path(), bytes);
  }
  for (const char* method : {"", "--preset paper", "--method doppler-icp"}) {
    expect_failure(run(recording, method), kFailed, "are exactly zero");
    expect_failure(run(recording, method), kFailed, "--doppler-kind compensated");
  }
  EXPECT_EQ(run(recording, "--method kiss-icp").status, kDone) << "needs no Doppler";
  EXPECT_EQ(run(recording, "--force --doppler-kind compensated").status, kDone);
  // The same scan again and again: the sensor may stand still, and sees no noise.
  const std::string first = read_file(recording / "point_clouds" / "00001.bin");
  for (const fs::directory_entry& entry : fs::directory_iterator(recording / "point_clouds")) {
    write_file(entry.path(), first);
  }
  fs::remove(recording / "ref_poses.txt");
  const Outcome stationary = run(recording, "--force");
  EXPECT_EQ(stationary.status, kDone) << stationary.text;
}

TEST_F(BadInput, WhatIsNeitherFileNorFolderIsNamed) {
  const std::string pipe = (folder_ / "pipe.bin").string();
  ASSERT_EQ(run_shell("mkfifo '" + pipe + "'").status, 0);
  const auto expect = [&](const std::string& arguments, int status, const std::string& words) {
    const Outcome outcome = run_shell("timeout 20 '" DYNAMIC_ICP_PROGRAM "' " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << arguments << "\n" << outcome.text;
  };
  const std::string out = " --output " + (folder_ / "out").string();
  for (const char* format : {"auto", "dicp", "hercules", "boreas", "aevascenes", "npz", "pcd", "ply", "bin"}) {
    expect("info " + pipe + " --format " + format, kFailed, "pipe.bin: is a named pipe, expected a regular file");
  }
  expect("info /dev/zero", kFailed, "/dev/zero: is a device");
  expect("evaluate " + pipe + " " + pipe, kFailed, "is a named pipe");
  expect("register " + pipe + " " + pipe, kFailed, "is a named pipe");
  expect("run " + street().string() + out + " --config " + pipe, kFailed, "is a named pipe");
  const fs::path recording = copy_of_street(2);
  for (const char* name : {"ref_poses.txt", "point_clouds/00002.bin"}) {
    fs::rename(recording / name, folder_ / "aside");
    ASSERT_EQ(run_shell("mkfifo '" + (recording / name).string() + "'").status, 0);
    expect("run --quiet " + recording.string() + out, kFailed,
           fs::path(name).filename().string() + ": is a named pipe");
    fs::remove(recording / name);
    fs::rename(folder_ / "aside", recording / name);
  }
  fs::create_symlink(folder_ / "loop", folder_ / "loop");
  expect("info " + (folder_ / "loop").string(), kFailed, "loop: cannot be opened: ");
}

TEST_F(BadInput, AScanCutShortIsBlamedNotItsTimes) {
  const fs::path recording = folder_ / "swept";
  ASSERT_EQ(run_program("simulate street --frames 2 --quiet --set lidar.columns=100 --set lidar.rows=20 --output " +
                        recording.string())
                .status,
            kDone);
  const fs::path scan = recording / "point_clouds" / "00002.bin";
  const fs::path times = recording / "times" / "00002.bin";
  const std::string whole = read_file(scan);
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{16 * 50}, 16 * 50 + std::size_t{7}}) {
    write_file(scan, whole.substr(0, bytes));
    expect_failure(run(recording), kFailed, scan.string() + ": " + std::to_string(bytes / 16) + " points, expected ");
  }
  write_file(scan, whole);
  write_file(times, read_file(times).substr(0, 4 * 50));
  expect_failure(run(recording), kFailed, times.string() + ": 50 times for the ");
}

TEST_F(BadInput, TruncatedScanIsReadWithAWarning) {
  const fs::path recording = copy_of_street(2);
  const fs::path file = recording / "point_clouds" / "00002.bin";
  write_file(file, read_file(file).substr(0, 16 * 5000 + 7));
  const Outcome outcome = run_program("run " + recording.string() + " --output " + (folder_ / "out").string());
  EXPECT_EQ(outcome.status, kDone);
  EXPECT_NE(outcome.text.find("00002.bin: 7 bytes after record 5000"), std::string::npos) << outcome.text;
  EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["warnings"].size(), 1u);
}

TEST_F(BadInput, GitLfsPointerIsNamed) {
  const fs::path recording = copy_of_street(3);
  write_file(recording / "point_clouds" / "00003.bin",
             "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 1256624\n");
  expect_failure(run(recording), kFailed, "00003.bin: is a Git LFS pointer");
}

TEST_F(BadInput, PosesThatDoNotFit) {
  const fs::path recording = copy_of_street(3);
  write_file(recording / "ref_poses.txt", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n");
  expect_failure(run(recording), kFailed, "2 poses for 3 scans");
  write_file(recording / "ref_poses.txt", "0 0 0 0 0 0 0 1\n0.1 1 zero 0 0 0 0 1\n0.2 1 0 0 0 0 0 1\n");
  expect_failure(run(recording), kFailed, "ref_poses.txt");
  write_file(recording / "ref_poses.txt", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.1 2 0 0 0 0 0 1\n");
  expect_failure(run(recording), kFailed, "ref_poses.txt");
  fs::remove(recording / "ref_poses.txt");
  const Outcome outcome = run_program("run " + recording.string() + " --output " + (folder_ / "out").string());
  EXPECT_EQ(outcome.status, kDone) << "poses are optional";
  EXPECT_NE(outcome.text.find("scan period of 0.1 s is assumed"), std::string::npos) << outcome.text;
  EXPECT_TRUE(json::parse(read_file(folder_ / "out" / "summary.json"))["rte_rmse_m"].is_null());
}

TEST_F(BadInput, GroundTruthOfAnotherRecording) {
  write_file(folder_ / "other.tum", "1700000000.0 0 0 0 0 0 0 1\n1700000000.1 1 0 0 0 0 0 1\n");
  expect_failure(run(copy_of_street(2), "--ground-truth " + (folder_ / "other.tum").string()), kFailed, "1700000000");
  const Outcome loud = run_program("run " + copy_of_street(2).string() + " --ground-truth " +
                                   (folder_ / "other.tum").string() + " --output " + (folder_ / "out").string());
  EXPECT_EQ(loud.text.find("odometry:"), std::string::npos) << "before the first scan: " << loud.text;
}

TEST_F(BadInput, ARunThatLosesMostScansSaysSoAndWhy) {
  const fs::path recording = copy_of_street(6);
  for (int scan = 2; scan <= 6; ++scan) {
    const fs::path file = recording / "point_clouds" / ("0000" + std::to_string(scan) + ".bin");
    fs::resize_file(file, 3 * 16);
  }
  for (const std::string quiet : {" --quiet", ""}) {
    const fs::path out = folder_ / ("out" + quiet.substr(0, 2));
    const Outcome lost = run_shell("'" DYNAMIC_ICP_PROGRAM "' run " + recording.string() + quiet + " --output '" +
                                   out.string() + "' >/dev/null");
    EXPECT_EQ(lost.status, kMostScansLost) << lost.text;
    EXPECT_NE(lost.text.find("ODOMETRY FAILED on 5 of 6 scans: 3 points a scan are too few"), std::string::npos)
        << lost.text;
    const json summary = json::parse(read_file(out / "summary.json"));
    EXPECT_EQ(summary["statuses"], json({{"ok", 1}, {"degenerate", 0}, {"lost", 5}}));
    EXPECT_EQ(summary["reasons"], json({{"first", 1}, {"too_few_points", 5}}));
    EXPECT_TRUE(summary["failure"].get<std::string>().starts_with("ODOMETRY FAILED"));
  }
}

TEST_F(BadInput, GroundTruthOfTheRecordingThatDoesNotFitIsLeftOut) {
  const fs::path recording = folder_ / "scans";
  ASSERT_EQ(run_program("convert " + copy_of_street(3).string() + " --to npz --output " + recording.string()).status,
            kDone);
  write_file(recording / "ref_poses.txt", "1700000000.0 0 0 0 0 0 0 1\n1700000000.1 1 0 0 0 0 0 1\n");
  const Outcome outcome = run_program("run " + recording.string() + " --output " + (folder_ / "out").string());
  EXPECT_EQ(outcome.status, kDone) << outcome.text;
  EXPECT_NE(outcome.text.find("ground truth"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("is not used"), std::string::npos) << outcome.text;
  EXPECT_TRUE(json::parse(read_file(folder_ / "out" / "summary.json"))["rte_rmse_m"].is_null());
}

TEST_F(BadInput, AnEarlierRunIsNotOverwritten) {
  const fs::path recording = copy_of_street(2);
  ASSERT_EQ(run(recording).status, kDone);
  const std::string before = read_file(folder_ / "out" / "frames.jsonl");
  const Outcome refused = run(recording);
  EXPECT_EQ(refused.status, kFailed);
  EXPECT_NE(refused.text.find("--force"), std::string::npos) << refused.text;
  write_file(recording / "point_clouds" / "00002.bin", "PK\x03\x04 not a scan");
  EXPECT_EQ(run(recording, "--force").status, kFailed);
  EXPECT_EQ(read_file(folder_ / "out" / "frames.jsonl"), before) << "a failing run leaves the earlier one";
}

TEST_F(BadInput, OutputThatCannotBeWritten) {
  write_file(folder_ / "file", "x");
  const Outcome outcome =
      run_program("run --quiet " + street().string() + " --output " + (folder_ / "file" / "out").string());
  EXPECT_EQ(outcome.status, kFailed);
  EXPECT_NE(outcome.text.find("file/out"), std::string::npos) << outcome.text;
}

TEST_F(BadInput, AMapThatCannotBe) {
  const fs::path recording = copy_of_street(2);
  const auto map = [&](const fs::path& name) { return "--save-map " + name.string(); };
  for (const char* name : {"map", "map.las", "map.ply.gz", "map.PLY"}) {
    expect_failure(run(recording, map(folder_ / name)), kWrongUsage, "ends in .ply or .pcd");
    expect_failure(run(folder_ / "nowhere", map(folder_ / name)), kWrongUsage, "ends in .ply or .pcd");
  }
  for (const std::string method : {"doppler-icp", "point-to-point", "point-to-plane", "gicp", "kiss-icp"}) {
    const std::string more = map(folder_ / "map.ply") + " --method " + method;
    expect_failure(run(recording, more), kWrongUsage, "only dynamic-icp separates static from moving points");
    expect_failure(run(folder_ / "nowhere", more), kWrongUsage, method);
  }
  for (const char* voxel : {"0", "-0.1", "nan", "1e9"}) {
    expect_failure(run(recording, map(folder_ / "map.ply") + " --map-voxel " + voxel), kWrongUsage, "0.01 to 100 m");
  }
  expect_failure(run(recording, map(folder_ / "map.ply") + " --map-voxel wide"), kWrongUsage, "--map-voxel");
  expect_failure(run(recording, "--map-voxel 0.2"), kWrongUsage, "--save-map");
  expect_failure(run(recording, "--save-map ''"), kWrongUsage, ".ply or .pcd");
  EXPECT_FALSE(fs::exists(folder_ / "map.ply"));
  const fs::path both = folder_ / "both.ply";
  const Outcome same =
      run_program("run --quiet " + recording.string() + " --output " + both.string() + " " + map(both));
  EXPECT_EQ(same.status, kWrongUsage) << same.text;
  EXPECT_FALSE(fs::exists(both));
}

TEST_F(BadInput, AMapThatCannotBeWritten) {
  const fs::path recording = copy_of_street(2);
  write_file(folder_ / "file", "x");
  expect_failure(run(recording, "--save-map " + (folder_ / "file" / "map.ply").string()), kFailed, "file/map.ply");
  expect_failure(run(recording, "--save-map " + (folder_ / "no" / "map.pcd").string()), kFailed, "no/map.pcd");
  write_file(folder_ / "folder.ply" / "precious", "x");
  expect_failure(run(recording, "--save-map " + (folder_ / "folder.ply").string()), kFailed, "folder.ply");
  EXPECT_EQ(read_file(folder_ / "folder.ply" / "precious"), "x");
  // A run that fails leaves an earlier map as it was.
  write_file(folder_ / "map.ply", "earlier");
  write_file(recording / "point_clouds" / "00002.bin", "PK\x03\x04 not a scan");
  expect_failure(run(recording, "--save-map " + (folder_ / "map.ply").string()), kFailed, "00002.bin");
  EXPECT_EQ(read_file(folder_ / "map.ply"), "earlier");
}

TEST_F(BadInput, FullDisk) {
  const fs::path disk = folder_ / "disk";
  fs::create_directories(disk);
  if (run_shell("mount -t tmpfs -o size=48k tmpfs '" + disk.string() + "'").status != 0) {
    GTEST_SKIP() << "needs the right to mount a small file system";
  }
  const Outcome outcome =
      run_program("run --quiet --save-labels " + street().string() + " --output " + (disk / "out").string());
  const bool clean = fs::is_empty(disk);
  run_shell("umount '" + disk.string() + "'");
  EXPECT_EQ(outcome.status, kFailed) << outcome.text;
  EXPECT_NE(outcome.text.find("No space left on device"), std::string::npos) << outcome.text;
  EXPECT_TRUE(clean) << "a failed run leaves nothing behind";
}

TEST_F(BadInput, AKilledRunLeavesNoResultAndTheNextOneCleansUp) {
  const std::string out = (folder_ / "out").string();
  const Outcome killed =
      run_shell("timeout -s KILL 0.1 '" DYNAMIC_ICP_PROGRAM "' run --quiet --threads 1 --preset paper " +
                street().string() + " --output " + out);
  if (killed.status == kDone) {
    GTEST_SKIP() << "the run was faster than the kill";
  }
  EXPECT_FALSE(fs::exists(out));
  ASSERT_EQ(run_program("run --quiet --max-frames 2 " + street().string() + " --output " + out).status, kDone);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "only the result";
}

TEST_F(BadInput, WhatCannotBePrintedIsAFailure) {
  for (const std::string& arguments : {"info " + street().string() + " --json", std::string("simulate --list")}) {
    const Outcome outcome = run_shell("'" DYNAMIC_ICP_PROGRAM "' " + arguments + " > /dev/full");
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_NE(outcome.text.find("standard output"), std::string::npos) << outcome.text;
  }
}

TEST_F(BadInput, RegisterReportsWhatItCannotAlign) {
  write_file(folder_ / "empty.bin", "");
  const std::string scan = (street() / "point_clouds" / "00001.bin").string();
  for (const std::string& pair :
       {(folder_ / "empty.bin").string() + " " + scan, scan + " " + (folder_ / "empty.bin").string()}) {
    const Outcome outcome = run_program("register " + pair + " 2>/dev/null");
    EXPECT_EQ(outcome.status, kDone);
    EXPECT_EQ(json::parse(outcome.text)["reason"], "too_few_points") << pair;
  }
  EXPECT_EQ(run_program("register " + scan + " " + scan + " --dt 0").status, kWrongUsage);
  EXPECT_EQ(run_program("register " + scan + " " + scan + ".missing").status, kFailed);
}

}  // namespace
}  // namespace dynamic_icp::tests
