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

// Seen from 20 m/s, beside something that comes towards it.
std::string vod_record(float i, float scan_offset) {
  return floats({i, 0.1F * i, 0.5F, -10, -20, i < 20 ? -3.0F : 0.25F, scan_offset});
}

TEST_F(BinFolder, TheRadarOfViewOfDelftIsNoKitti) {
  write("radar/training/velodyne/00549.bin", many([](float i) { return vod_record(i, 0); }));
  write("radar/training/velodyne/00544.bin", many([](float i) { return vod_record(i, i < 100 ? 0.0F : -1.0F); }));
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "bin");
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kRelative);
  EXPECT_EQ(dataset->stamp(0).ns, 0) << "names that count are no times";
  EXPECT_EQ(dataset->stamp(1).ns, 500'000'000);
  EXPECT_EQ(dataset->scan(1).doppler.at(0), -20.0);
  EXPECT_EQ(dataset->scan(0).is_unusable.at(290 - 1), 1);
  EXPECT_TRUE(said(*dataset, "a scan period of 0.1 s is assumed"));
  EXPECT_TRUE(said(*dataset, "the time between scans is uncertain"));
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
  expect_within(fault(),
                "1.bin: 43 bytes that look like no records of points with Doppler. Tried:\n  radar of View-of-Delft, "
                "28 bytes: does not divide");
  expect_within(fault(), "`columns` and `dtype` state what they are");
  write("1.bin", std::string(16, '\x7f'));
  expect_within(fault(), "xyzd, 16 bytes");
  write("1.bin", "");
  expect_within(fault(), folder_.string() + ": all *.bin files are empty");
  write("1.bin", "PK\x03\x04");
  expect_within(fault(), "1.bin: is a zip archive");
}

}  // namespace
}  // namespace dynamic_icp::datasets
