// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <functional>

#include "dynamic_icp/recording/datasets/layouts.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

using BinFolder = RecordingByHand;

std::string many(const std::function<std::string(float)>& record) {
  std::string bytes;
  for (int i = 1; i <= 290; ++i) {
    bytes += record(static_cast<float>(i));
  }
  return bytes;
}

TEST_F(BinFolder, RecordsAreToldByTheirContent) {
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {"29 bytes", many([](float i) { return aeva_record(i, 2, 3, -4, static_cast<int>(1000 * i)); })},
      {"25 bytes", many([](float i) { return aeva_record(i, 2, 3, -4, static_cast<int>(1000 * i)).substr(0, 25); })},
      {"40 bytes", many([](float i) {
         return floats({i, 2, 3, -4, 11, 12, 13, 1000 * i, 256 * i, 0});
       })},
      {"28 bytes", many([](float i) {
         return floats({i, 2, 3, 11, -4, 0.0003F * i, 3});
       })},
      {"24 bytes", many([](float i) {
         return floats({i, 2, 3, 11, -4, 0.0003F * i});
       })},
      {"20 bytes", many([](float i) {
         return floats({i, 2, 3, -4, 0.0003F * i});
       })},
      {"16 bytes", many([](float i) {
         return floats({i, 2, 3, -4});
       })}};
  for (const auto& [size, bytes] : kinds) {
    write("00000.bin", "");
    write("00001.bin", bytes);
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    EXPECT_EQ(dataset->format(), "bin");
    const RawScan scan = dataset->scan(1);
    ASSERT_EQ(scan.points.size(), 290U) << size;
    EXPECT_EQ(scan.points[289], Eigen::Vector3d(290, 2, 3)) << size;
    EXPECT_EQ(scan.doppler[289], -4.0) << size;
    ASSERT_EQ(dataset->assumptions().size(), 2U);
    expect_within(dataset->assumptions()[0], "a scan period of 0.1 s is assumed");
    expect_within(dataset->assumptions()[1], size);
    expect_within(dataset->assumptions()[1], "00001.bin");
  }
}

TEST_F(BinFolder, KittiIsRefusedUnlessNamedDicp) {
  const auto reflectances = many([](float i) { return floats({i, 2, 3, 0.003F * i}); });
  write("000000.bin", reflectances);
  expect_within(fault(),
                "000000.bin: holds records of four numbers whose last lies between 0 and 1: the reflectance of KITTI");
  EXPECT_EQ(open_dataset(folder_, {.format = "dicp"})->scan(0).points.size(), 290U);
  std::filesystem::remove(folder_ / "000000.bin");
  write("sequences/00/velodyne/000000.bin", many([](float i) { return floats({i, 2, 3, -i}); }));
  expect_within(fault(), (folder_ / "sequences/00/velodyne").string() + ": looks like KITTI");
  EXPECT_EQ(open_dataset(folder_, {.format = "dicp"})->scan(0).points.size(), 290U);
}

TEST_F(BinFolder, RadarScansAreNamed) {
  write("1724479779384729506.bin", many([](float i) {
          return floats({3 * i / 2, 4 * i / 2, 0, -3, 5 * i / 2}) + std::string("\x10", 1) + floats({0.5F, 0.25F});
        }));
  expect_within(fault(), "1724479779384729506.bin: holds points of the Continental radar of HeRCULES");
}

TEST_F(BinFolder, WhatLooksLikeNothingIsRefusedWithWhatWasTried) {
  write("1.bin", "no points at all, but 41 bytes of some text");
  expect_within(
      fault(),
      "1.bin: 43 bytes that look like no records of points with Doppler. Tried:\n  aeva29, 29 bytes: does not divide");
  write("1.bin", std::string(16, '\x7f'));
  expect_within(fault(), "xyzd, 16 bytes");
  write("1.bin", "");
  expect_within(fault(), folder_.string() + ": all *.bin files are empty");
  write("1.bin", "PK\x03\x04");
  expect_within(fault(), "1.bin: is a zip archive");
}

}  // namespace
}  // namespace dynamic_icp::datasets
