// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::NamedArray;

class ColumnFolder : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& content) const {
    formats::write_whole_file(folder_ / name, content);
  }
  /// Two points, the first at (x, 2, 3).
  void write_pcd(const std::string& name, double x) const {
    write(name,
          "VERSION 0.7\nFIELDS x y z velocity ring time\nSIZE 4 4 4 4 1 4\nTYPE F F F F U F\nWIDTH 2\nHEIGHT 1\n"
          "POINTS 2\nDATA ascii\n" +
              std::to_string(x) + " 2 3 -4.5 7 0.25\nnan 5 6 1.5 8 0.5\n");
  }
  template <class Number>
  static NamedArray array(const std::string& name, std::vector<std::size_t> shape, const std::vector<Number>& values) {
    return {name, formats::npy_array<Number>(std::move(shape), values)};
  }
  void write_npz(const std::string& name, const std::vector<NamedArray>& members) const {
    formats::write_npz(folder_ / name, members);
  }
  [[nodiscard]] std::string message(const OpenOptions& options = {}) const {
    return fault_of_reading(folder_, options);
  }
  void expect_message(const std::string& part) const { expect_within(message(), part); }

  const std::vector<double> kXyz = {1, 2, 3, 4, 5, 6};
  fs::path folder_ = fs::temp_directory_path() / ("column_folder_test-" + std::to_string(::getpid()));
};

TEST_F(ColumnFolder, PcdByNamesOfColumnsAndStampsOfFiles) {
  write_pcd("1724479779484729506.pcd", 20);
  write_pcd("1724479779384729506.pcd", 10);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "pcd");
  ASSERT_EQ(dataset->size(), 2u);
  EXPECT_EQ(dataset->stamp(0).ns, 1'724'479'779'384'729'506);
  const RawScan scan = dataset->scan(0);
  EXPECT_EQ(scan.stamp, dataset->stamp(0));
  EXPECT_EQ(scan.points.at(0), Eigen::Vector3d(10, 2, 3));
  EXPECT_TRUE(std::isnan(scan.points.at(1).x()));
  EXPECT_EQ(scan.doppler, (std::vector<double>{-4.5, 1.5}));
  EXPECT_EQ(scan.times, (std::vector<double>{0.25, 0.5}));
  EXPECT_TRUE(scan.directions.empty());
  EXPECT_EQ(scan.doppler_kind, DopplerKind::kRelative);
  EXPECT_TRUE(said(*dataset, "'velocity' as doppler"));
  EXPECT_TRUE(said(*dataset, "'time' are taken as seconds"));
  const std::vector<PointColumn> columns = dataset->columns(1);
  ASSERT_EQ(columns.size(), 1u);
  EXPECT_EQ(columns[0].name, "ring");
  EXPECT_TRUE(columns[0].is_integer);
  EXPECT_EQ(columns[0].values, (std::vector<double>{7, 8}));
}

TEST_F(ColumnFolder, NpzWithLinesOfSightAndObjectsThatStayUnread) {
  write_npz("00001.npz",
            {array<double>("points", {2, 3}, kXyz), array<float>("doppler", {2, 1}, {0.5F, -0.25F}),
             array<float>("los", {2, 3}, {1, 0, 0, 0, 1, 0}), array<double>("time_offsets", {2}, {0, 0.1}),
             array<float>("pose", {4, 4}, std::vector<float>(16)), array<float>("colour", {2, 2}, {1, 2, 3, 4})});
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_ / "00001.npz");
  EXPECT_EQ(dataset->format(), "npz");
  const RawScan scan = dataset->scan(0);
  EXPECT_EQ(scan.points.at(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scan.doppler, (std::vector<double>{0.5, -0.25}));
  EXPECT_EQ(scan.directions.at(1), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(scan.times, (std::vector<double>{0, 0.1}));
  const std::vector<PointColumn> columns = dataset->columns(0);
  ASSERT_EQ(columns.size(), 2u) << "a matrix is no column of the points";
  EXPECT_EQ(columns[1].name, "colour[1]");
  EXPECT_EQ(columns[1].values, (std::vector<double>{2, 4}));
}

TEST_F(ColumnFolder, PlyOfAnyTypesInAFolderBelow) {
  fs::create_directories(folder_ / "unpacked" / "scans");
  write("unpacked/scans/scan_1.ply",
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int corners\nelement vertex 2\nproperty double x\n"
        "property double y\nproperty double z\nproperty float Doppler\nproperty int t\nend_header\n"
        "3 0 1 2\n1 2 3 -4 100000000\n0.1 0 0 5 -7\n");
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "ply");
  const RawScan scan = dataset->scan(0);
  EXPECT_EQ(scan.points.at(1), Eigen::Vector3d(0.1, 0, 0));
  EXPECT_EQ(scan.doppler, (std::vector<double>{-4, 5}));
  EXPECT_EQ(scan.times, (std::vector<double>{1e-9 * 1e8, 1e-9 * -7}));
}

TEST_F(ColumnFolder, PairsOfNpy) {
  for (int i = 1; i <= 2; ++i) {
    formats::write_npy(folder_ / ("frame_00" + std::to_string(i) + ".npy"), array<double>("", {2, 3}, kXyz).array);
    formats::write_npy(folder_ / ("frame_00" + std::to_string(i) + "_dop.npy"),
                       array<double>("", {2}, {-1.5, 0.5 * i}).array);
  }
  write("example_gt.txt", "7.0 0 0 0 0 0 0 1\n7.0833 1 0 0 0 0 0 1\n");
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "npz");
  ASSERT_EQ(dataset->size(), 2u);
  EXPECT_EQ(dataset->stamp(1).ns, 7'083'300'000) << "the stamps of the poses, one for one";
  EXPECT_EQ(dataset->ground_truth().size(), 2u);
  EXPECT_EQ(dataset->scan(1).doppler, (std::vector<double>{-1.5, 1.0}));
  EXPECT_EQ(dataset->scan(1).points.at(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(open_dataset(folder_ / "frame_002.npy")->size(), 1u);
}

TEST_F(ColumnFolder, IndicesAreAPeriodApart) {
  write_pcd("scan_8.pcd", 1);
  write_pcd("scan_10.pcd", 1);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_, {.period_s = 0.25});
  EXPECT_EQ(dataset->scan_file(0).filename(), "scan_8.pcd");
  EXPECT_EQ(dataset->stamp(0).ns, 0);
  EXPECT_TRUE(said(*dataset, "period of 0.25 s"));
  EXPECT_TRUE(dataset->ground_truth().empty());
  EXPECT_TRUE(dataset->ground_truth_file().empty());
}

TEST_F(ColumnFolder, FieldsOfTheUserGoFirst) {
  write_pcd("1.pcd", 10);
  const RawScan scan = open_dataset(folder_, {.fields = {{"doppler", "time"}, {"time", "velocity"}}})->scan(0);
  EXPECT_EQ(scan.doppler, (std::vector<double>{0.25, 0.5}));
  EXPECT_THROW(open_dataset(folder_, {.fields = {{"speed", "velocity"}}}), UsageError);
  EXPECT_NE(message({.fields = {{"doppler", "nope"}}}).find("there are: x, y, z, velocity, ring, time"),
            std::string::npos);
  EXPECT_THROW(open_dataset(folder_, {.sensors = {"front"}}), UsageError);
}

TEST_F(ColumnFolder, CompensatedByTheNameOfTheFolder) {
  fs::create_directories(folder_ / "points_compensated");
  write_pcd("points_compensated/1.pcd", 10);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kCompensated);
  EXPECT_EQ(dataset->scan(0).doppler_kind, DopplerKind::kCompensated);
  EXPECT_TRUE(said(*dataset, "compensated"));
}

TEST_F(ColumnFolder, ColumnsMustBelongTogether) {
  write_npz("1.npz", {array<double>("points", {2, 3}, kXyz), array<float>("doppler", {3}, {1, 2, 3})});
  expect_message("1.npz: array 'doppler' of shape (3) has 3 rows, expected 2");
  write_npz("1.npz", {array<double>("points", {2, 3}, kXyz), array<double>("velocity", {2, 3}, kXyz)});
  expect_message("array 'velocity': has 3 columns, expected one");
  write_npz("1.npz", {array<double>("points", {3, 2}, kXyz), array<float>("doppler", {3}, {1, 2, 3})});
  expect_message("array 'points': has 2 columns, expected at least 3");
  write_npz("1.npz", {array<double>("points", {6}, kXyz)});
  expect_message("no column of Doppler velocities");
}

TEST_F(ColumnFolder, ArraysThatHoldNoNumbersAreNamedWithWhatTheyAre) {
  const auto npz_of = [&](const std::string& type, const std::string& shape) {
    std::string bytes = formats::npz_bytes(
        std::vector<NamedArray>{array<double>("points", {2, 3}, kXyz), array<float>("doppler", {2}, {1, 2})});
    bytes.replace(bytes.find("<f8"), 3, type);
    bytes.replace(bytes.find("(2, 3)"), 6, shape);
    write("1.npz", bytes);
  };
  npz_of("<c8", "(2, 3)");
  expect_message("1.npz: no column for x");
  expect_message("there are: doppler; array 'points': has the type '<c8', expected one of f2 f4 f8");
  npz_of("<f8", "(2,-3)");
  expect_message("array 'points': expected a whole number that is not negative at byte ");
}

TEST_F(ColumnFolder, DamagedFilesAreNamed) {
  const auto expect_file_named = [&](const std::string& name) {
    expect_message((folder_ / name).string());
    EXPECT_NE(message(), "no error");
    fs::remove(folder_ / name);
  };
  for (const std::string content : {"", "ply", "VERSION", "\x89PNG", "version https://git-lfs.github.com/spec/v1\n"}) {
    for (const char* name : {"1.npz", "1.pcd", "1.ply"}) {
      write(name, content);
      expect_file_named(name);
    }
  }
  write_npz("1.npz", {array<double>("points", {2, 3}, kXyz), array<float>("doppler", {2}, {1, 2})});
  const std::string whole = formats::read_whole_file(folder_ / "1.npz");
  write("1.npz", whole.substr(0, whole.size() - 30));
  expect_file_named("1.npz");
  std::string flipped = whole;
  flipped[flipped.find("NUMPY") + 140] ^= 1;
  write("1.npz", flipped);
  expect_file_named("1.npz");
}

TEST_F(ColumnFolder, AScanMayBeEmpty) {
  write("1.pcd", "FIELDS x y z doppler t\nSIZE 4 4 4 4 4\nTYPE F F F F F\nPOINTS 0\nDATA ascii\n");
  write_npz("1.npz", {array<float>("points", {0, 3}, {}), array<float>("doppler", {0}, {})});
  EXPECT_TRUE(open_dataset(folder_, {.format = "pcd"})->scan(0).points.empty());
  EXPECT_TRUE(open_dataset(folder_, {.format = "npz"})->scan(0).doppler.empty());
}

TEST_F(ColumnFolder, TheSameStampTwiceAndMixedUnitsAreErrors) {
  write_pcd("a_1.pcd", 1);
  write_pcd("b_1.pcd", 1);
  write_pcd("b_2.pcd", 1);
  expect_message("carries the same number");
  fs::remove(folder_ / "b_1.pcd");
  fs::remove(folder_ / "b_2.pcd");
  write_pcd("1724479779384.pcd", 1);
  write_pcd("1724479779384000000.pcd", 1);
  fs::remove(folder_ / "a_1.pcd");
  expect_message("another kind of number");
}

TEST_F(ColumnFolder, FilesWithoutNumbersComeInTheOrderOfTheirNames) {
  write_pcd("second.pcd", 2);
  write_pcd("first.pcd", 1);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  ASSERT_EQ(dataset->size(), 2U);
  EXPECT_EQ(dataset->scan(0).points.at(0).x(), 1.0);
  EXPECT_TRUE(said(*dataset, "no number tells the scans apart"));
  EXPECT_EQ(open_dataset(folder_ / "first.pcd")->stamp(0).ns, 0);
}

/// A table in which the points of a line have one time.
std::string table_of_lines(const std::string& name, int lines, int points_of_each, double begin, double step) {
  std::string text = name + ",x,y,z,doppler\n";
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < points_of_each; ++i) {
      text += fmt::format("{:.6f},{},{},1,2\n", begin + step * line, i, line);
    }
  }
  return text;
}

TEST_F(ColumnFolder, ATableWithTheTimesOfScansIsSeveral) {
  const std::string said = "holds several scans, told apart by its column";
  write("all.csv", table_of_lines("timestamp", 4, 40, 1.7e9, 0.1));
  expect_message(said);
  write("all.csv", table_of_lines("time", 30, 400, 0.0, 0.5));
  expect_message(said);
  write("all.csv", table_of_lines("time", 5, 40, 0.0, 0.1));
  expect_message(said);
  // Lines and packets of one scan.
  write("all.csv", table_of_lines("timestamp", 100, 64, 1.7e9, 0.001));
  EXPECT_EQ(open_dataset(folder_)->scan(0).points.size(), 6400U);
  write("all.csv", table_of_lines("time", 64, 400, 0.0, 1.5));  // milliseconds
  EXPECT_NEAR(open_dataset(folder_)->scan(0).times.back(), 0.0945, 1e-9);
}

TEST_F(ColumnFolder, WhatIsNoTableOrArrayOfPointsSaysWhy) {
  write("0.csv", "x;y;z;doppler\n1,5;2,5;3,5;4,5\n");
  expect_message("line 2: column 1 is '1,5', expected a number with a decimal point");
  fs::remove(folder_ / "0.csv");
  write("all.npy", formats::npy_bytes(formats::npy_array<float>({2, 3, 4}, std::vector<float>(24))));
  expect_message("all.npy: has the shape (2, 3, 4), expected (N, 4) or wider");
  fs::remove(folder_ / "all.npy");
  write("0.npy", formats::npy_bytes(formats::npy_array<float>({4, 100}, std::vector<float>(400))));
  expect_message("0.npy: has the shape (4, 100), expected a row for each point");
  fs::remove(folder_ / "0.npy");
  for (const char* name : {"0.dat", "1.dat", "notes.md"}) {
    write(name, std::string(160, '\1'));
  }
  expect_message(": it holds 2 *.dat, 1 *.md; records of numbers are read where their names end in .bin");
  write("run.json", "{}");
  expect_message("it holds the results of a run; name the recording");
}

TEST_F(ColumnFolder, TextsOfOtherEndingsAndNamesWithBlanks) {
  write("0.xyz", "1 2 3 4\n5 6 7 8\n");
  EXPECT_EQ(open_dataset(folder_)->scan(0).doppler, (std::vector<double>{4, 8}));
  fs::remove(folder_ / "0.xyz");
  write("0.csv", "X [m],Y [m],Z [m],Radial Velocity (m/s),time_ms\n1,2,3,4,50\n");
  const RawScan scan = open_dataset(folder_)->scan(0);
  EXPECT_EQ(scan.doppler, std::vector<double>{4});
  EXPECT_NEAR(scan.times.at(0), 0.05, 1e-12);
}

TEST_F(ColumnFolder, AVelocityInSpaceIsNotProposedAsDoppler) {
  write("0.csv", "x,y,z,vx,vy,vz\n1,2,3,4,5,6\n");
  EXPECT_NE(message(), "no error");
  EXPECT_THROW(open_dataset(folder_), DataError);
  try {
    open_dataset(folder_);
  } catch (const UnclearInput& error) {
    ADD_FAILURE() << "proposes " << error.proposal().at(0).second;
  } catch (const DataError&) {
  }
}

TEST_F(ColumnFolder, SeveralRecordingsMustBeNamed) {
  for (const char* name : {"a", "b"}) {
    fs::create_directories(folder_ / name);
    write_pcd(std::string(name) + "/1.pcd", 1);
  }
  expect_message((folder_ / "b").string());
}

}  // namespace
}  // namespace dynamic_icp::datasets
