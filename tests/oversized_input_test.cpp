// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Files that are small on the disk and would cost hours or all memory to read: each is refused by its name.
#include <cstdint>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

class OversizedInput : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy(street(), folder_ / "rec", fs::copy_options::recursive);
  }

  /// A file of zero bytes that takes no room on the disk.
  void make_sparse(const fs::path& path) const { fs::resize_file(path, std::uintmax_t{6} << 30U); }

  static void expect_named(const Outcome& outcome, int status, const std::string& words) {
    EXPECT_EQ(outcome.status, status) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
  }
};

TEST_F(OversizedInput, SparseFiles) {
  const std::string info = "info " + (folder_ / "rec").string();
  for (const char* name : {"point_clouds/00001.bin", "ref_poses.txt", "calibration.json"}) {
    const fs::path path = folder_ / "rec" / name;
    const std::string content = fs::exists(path) ? read_file(path) : "";
    write_file(path, content.empty() ? "{}" : content);
    make_sparse(path);
    expect_named(run_program(info), kFailed, path.string() + ": has 6442450944 bytes, expected at most 1073741824");
    content.empty() ? static_cast<void>(fs::remove(path)) : write_file(path, content);
  }
  EXPECT_EQ(run_program(info).status, 0);
}

TEST_F(OversizedInput, HeadersOfAHundredThousandFields) {
  std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\n";
  std::string names = "FIELDS x y z doppler";
  std::string sizes = "SIZE 4 4 4 4";
  std::string types = "TYPE F F F F";
  for (int i = 0; i < 100'000; ++i) {
    ply += "property float f" + std::to_string(i) + "\n";
    names += " f" + std::to_string(i);
    sizes += " 4";
    types += " F";
  }
  fs::create_directories(folder_ / "ply");
  fs::create_directories(folder_ / "pcd");
  write_file(folder_ / "ply" / "1.ply", ply + "end_header\n");
  write_file(folder_ / "pcd" / "1.pcd", names + "\n" + sizes + "\n" + types + "\nPOINTS 1\nDATA ascii\n");
  expect_named(run_program("info " + (folder_ / "ply").string()), kFailed, "1.ply: line 1028: element 'vertex' has");
  expect_named(run_program("info " + (folder_ / "pcd").string()), kFailed, "1.pcd: line 1: 100004 fields");
}

TEST_F(OversizedInput, AliasesThatDoubleWithEveryLine) {
  std::string yaml = "a0: &a0 {}\n";
  for (int i = 1; i <= 30; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    yaml += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " {x: " + before + ", y: " + before + "}\n";
  }
  write_file(folder_ / "c.yaml", yaml);
  const std::string run = "run " + (folder_ / "rec").string() + " --output " + (folder_ / "out").string();
  expect_named(run_program(run + " --config " + (folder_ / "c.yaml").string()), kWrongUsage, "c.yaml: line 1: unknown");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(OversizedInput, TimeScaledBeyondAnyStamp) {
  const fs::path scans = folder_ / "rec" / "point_clouds";
  fs::remove(folder_ / "rec" / "ref_poses.txt");
  expect_named(run_program("info " + (folder_ / "rec").string() + " --period 3600 --time-scale 1e9"), kFailed,
               (scans / "00002.bin").string() + ": scan 1 is 3600 s after the first one");
}

}  // namespace
}  // namespace dynamic_icp::tests
