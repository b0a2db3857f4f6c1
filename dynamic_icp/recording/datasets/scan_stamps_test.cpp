// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class ScanStamps : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  /// Makes the folder anew with files of these names.
  void make(const std::vector<std::string>& names) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const std::string& name : names) {
      std::ofstream(folder_ / name) << "x";
    }
  }
  StampedFiles read(const std::vector<std::string>& names) {
    make(names);
    return stamped_files(folder_, ".bin", 0.1);
  }
  std::vector<std::int64_t> stamps(const std::vector<std::string>& names) {
    std::vector<std::int64_t> ns;
    for (const Stamp stamp : read(names).stamps) {
      ns.push_back(stamp.ns);
    }
    return ns;
  }
  std::string fault(const std::vector<std::string>& names) {
    try {
      read(names);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_ = fs::temp_directory_path() / ("scan_stamps_test-" + std::to_string(::getpid()));
};

using Ns = std::vector<std::int64_t>;

TEST_F(ScanStamps, TheNumberOfDigitsTellsTheUnit) {
  EXPECT_EQ(stamps({"1724479779384729506.bin"}), Ns{1'724'479'779'384'729'506});
  EXPECT_EQ(stamps({"1724479779384729.bin"}), Ns{1'724'479'779'384'729'000});
  EXPECT_EQ(stamps({"1724479779384.bin"}), Ns{1'724'479'779'384'000'000});
  EXPECT_EQ(stamps({"1724479779.bin"}), Ns{1'724'479'779'000'000'000});
  EXPECT_EQ(stamps({"front_lidar_1724479779384729506.bin"}), Ns{1'724'479'779'384'729'506});
}

TEST_F(ScanStamps, ScansComeInTheOrderOfTheirStamps) {
  const StampedFiles scans =
      read({"b_1724479779384729506.bin", "a_1724479779484729506.bin", "c_1724479779284729506.bin"});
  ASSERT_EQ(scans.files.size(), 3U);
  EXPECT_EQ(scans.files[0], folder_ / "c_1724479779284729506.bin");
  EXPECT_EQ(scans.files[2], folder_ / "a_1724479779484729506.bin");
  EXPECT_EQ(scans.stamps[1].ns, 1'724'479'779'384'729'506);
  EXPECT_TRUE(scans.assumptions.empty());
}

TEST_F(ScanStamps, DecimalSecondsAreExact) {
  EXPECT_EQ(stamps({"1724479779.384729506.bin", "1724479779.484729506.bin"}),
            (Ns{1'724'479'779'384'729'506, 1'724'479'779'484'729'506}));
  EXPECT_EQ(stamps({"1724479779.38.bin", "1724479779.48.bin"}),
            (Ns{1'724'479'779'380'000'000, 1'724'479'779'480'000'000}));
}

// pcl_ros writes "<seconds>.<nanoseconds>"; a clock that is simulated begins near 0.
TEST_F(ScanStamps, SecondsAndNanosecondsAreOneNumber) {
  EXPECT_EQ(stamps({"1700000000.000000000.bin", "1700000001.000000000.bin", "1700000000.900000000.bin"}),
            (Ns{1'700'000'000'000'000'000, 1'700'000'000'900'000'000, 1'700'000'001'000'000'000}));
  EXPECT_EQ(stamps({"cloud_9.900000000.bin", "cloud_10.100000000.bin", "cloud_10.000000000.bin"}),
            (Ns{9'900'000'000, 10'000'000'000, 10'100'000'000}));
  EXPECT_EQ(stamps({"1700000000.100.bin", "1700000001.100.bin"}),
            (Ns{1'700'000'000'100'000'000, 1'700'000'001'100'000'000}));
}

TEST_F(ScanStamps, TheNumberThatDiffersCounts) {
  const StampedFiles scans = read({"cloud_10_run2.bin", "cloud_0_run2.bin", "cloud_1_run2.bin"});
  EXPECT_EQ(scans.stamps, (std::vector<Stamp>{{0}, {100'000'000}, {1'000'000'000}}));
  EXPECT_EQ(scans.files.back().filename(), "cloud_10_run2.bin");
  EXPECT_EQ(stamps({"1724479779384729506_lidar0.bin", "1724479779484729506_lidar0.bin"}),
            (Ns{1'724'479'779'384'729'506, 1'724'479'779'484'729'506}));
}

TEST_F(ScanStamps, SeveralNumbersTogetherOrNoneGiveAnOrderAndAPeriod) {
  const StampedFiles several = read({"2_0.bin", "10_0.bin", "2_1.bin"});
  EXPECT_EQ(several.files.back().filename(), "10_0.bin");
  EXPECT_EQ(several.stamps, (std::vector<Stamp>{{0}, {100'000'000}, {200'000'000}}));
  EXPECT_NE(several.assumptions.at(0).find("2_0.bin first: a scan period of 0.1 s"), std::string::npos);
  const StampedFiles none = read({"c_1.bin", "a_1.bin", "b_1.bin"});
  EXPECT_EQ(none.files.front().filename(), "a_1.bin");
  EXPECT_EQ(none.stamps.back().ns, 200'000'000);
  EXPECT_NE(none.assumptions.at(0).find("no number tells the scans apart"), std::string::npos);
  EXPECT_EQ(read({"last.bin", "first.bin"}).files.front().filename(), "first.bin");
}

TEST_F(ScanStamps, StepsOfSeveralAreSaidWithThePeriodThatMayBeMeant) {
  EXPECT_NE(read({"0.bin", "10.bin", "20.bin"}).assumptions.at(0).find("a period of 0.01 s"), std::string::npos);
  EXPECT_EQ(read({"0.bin", "10.bin", "15.bin", "16.bin"}).assumptions.at(0).find("--period"), std::string::npos);
}

TEST_F(ScanStamps, FractionsOfSeveralLengthsAreDecimalsOrNanosecondsAndItIsSaid) {
  const StampedFiles decimals = read({"1724479779.05.bin", "1724479779.15.bin", "1724479779.2.bin"});
  EXPECT_EQ(decimals.stamps.at(2).ns, 1'724'479'779'200'000'000);
  ASSERT_EQ(decimals.assumptions.size(), 1U);
  EXPECT_NE(decimals.assumptions[0].find("taken as decimals"), std::string::npos) << decimals.assumptions[0];
  const StampedFiles counts = read({"1724479779.5.bin", "1724479779.100000005.bin"});
  EXPECT_EQ(counts.stamps.at(0).ns, 1'724'479'779'000'000'005);
  EXPECT_EQ(counts.stamps.at(1).ns, 1'724'479'779'100'000'005);
  EXPECT_NE(counts.assumptions.at(0).find("taken as whole nanoseconds"), std::string::npos) << counts.assumptions[0];
}

TEST_F(ScanStamps, ShortNumbersAreIndicesAPeriodApartAndItIsSaid) {
  const StampedFiles scans = read({"frame_010.bin", "frame_002.bin", "frame_003.bin"});
  EXPECT_EQ(scans.files.at(2), folder_ / "frame_010.bin");
  EXPECT_EQ(scans.stamps.at(0).ns, 0);
  EXPECT_EQ(scans.stamps.at(1).ns, 100'000'000);
  EXPECT_EQ(scans.stamps.at(2).ns, 800'000'000) << "six scans are missing";
  ASSERT_EQ(scans.assumptions.size(), 1U);
  EXPECT_NE(scans.assumptions[0].find("a scan period of 0.1 s is assumed"), std::string::npos);
}

TEST_F(ScanStamps, ZerosInFrontMakeAnIndexOfAnyLength) {
  EXPECT_EQ(stamps({"0000000000.bin", "0000000002.bin"}), (Ns{0, 200'000'000}));
  EXPECT_EQ(stamps({"000000000000000007.bin"}), Ns{0});
  EXPECT_EQ(stamps({"00000000000000000007.bin"}), Ns{0});
}

TEST_F(ScanStamps, NineteenDigitsAreNanosecondsEvenSoonAfterZero) {
  EXPECT_EQ(stamps({"0000000000000000000.bin", "0000000000083333333.bin", "1724479779384729506.bin"}),
            (Ns{0, 83'333'333, 1'724'479'779'384'729'506}));
}

TEST_F(ScanStamps, OtherFilesAreLeftOut) {
  EXPECT_EQ(stamps({"1.bin", "2.txt", "._3.bin", "notes.bin", "4.bin.partial"}).size(), 1U);
}

TEST_F(ScanStamps, TheSameStampTwiceNamesBothFiles) {
  const std::string times = fault({"a_1724479779384729506.bin", "b_1724479779384729506.bin"});
  EXPECT_NE(times.find((folder_ / "b_1724479779384729506.bin").string() +
                       ": carries the same time stamp as a_1724479779384729506.bin"),
            std::string::npos)
      << times;
  const std::string indices = fault({"1.bin", "01.bin"});
  EXPECT_NE(indices.find("1.bin: carries the same number as 01.bin"), std::string::npos) << indices;
}

TEST_F(ScanStamps, WhatIsNoTimeNamesTheFile) {
  const std::string digits = fault({"20240824120000.bin"});
  EXPECT_NE(digits.find((folder_ / "20240824120000.bin").string() + ": the number in its name has 14 digits"),
            std::string::npos)
      << digits;
  EXPECT_NE(fault({"9999999999999999999.bin"}).find("has 19 digits"), std::string::npos) << "out of range";
  const std::string mixed = fault({"1724479779384729506.bin", "00001.bin"});
  EXPECT_NE(mixed.find("1724479779384729506.bin: its name is another kind of number than that of 00001.bin"),
            std::string::npos)
      << mixed;
  EXPECT_NE(fault({"1724479779384729506.bin", "1724479779384729.bin"}).find("another kind"), std::string::npos);
  EXPECT_NE(fault({}).find(folder_.string() + ": holds no scans"), std::string::npos);
  EXPECT_NE(fault({}).find("expected files *.bin"), std::string::npos);
  fs::remove_all(folder_);
  EXPECT_THROW(stamped_files(folder_, ".bin", 0.1), DataError);
}

}  // namespace
}  // namespace dynamic_icp::datasets
