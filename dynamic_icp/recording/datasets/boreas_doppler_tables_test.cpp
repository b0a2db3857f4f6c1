// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/boreas_doppler_tables.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<BoreasDopplerPart> kTwoParts = {{0.0, -0.5, 0.5, {0.1, 0.2, 0.3, 0.4}}, {0.5, -1, 1, {1, 2, 3, 4}}};

TEST(BoreasDopplerBias, IsThatOfThePartAndTheCell) {
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.2, -0.3), 0.1);  // 0.8 cells from the left
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.2, -0.2), 0.2);  // 1.2
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.2, 0.0), 0.3);   // 2: a limit is of the cell after it
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.8, -0.3), 2.0);  // 1.4, the cells are twice as wide
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.5, -0.3), 0.1) << "a limit is of the part before it";
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.5001, -0.3), 2.0);
}

TEST(BoreasDopplerBias, OuterPartsAndCellsReachOn) {
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.2, -3.0), 0.1);
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 0.2, 3.0), 0.4);
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, -1.0, 0.0), 0.3);
  EXPECT_EQ(boreas_doppler_bias_mps(kTwoParts, 2.0, 1.0), 4.0);
  EXPECT_EQ(boreas_doppler_bias_mps({{0.5, -1, 1, {7}}}, 0.0, 0.0), 7.0);
}

// Beam b: that of the two parts, and 10 b more.
BoreasDopplerTables tables_by_hand() {
  BoreasDopplerTables tables;
  for (std::size_t beam = 0; beam < kBoreasBeams; ++beam) {
    tables[beam] = kTwoParts;
    for (BoreasDopplerPart& part : tables[beam]) {
      for (double& bias : part.bias_mps) {
        bias += 10.0 * static_cast<double>(beam);
      }
    }
  }
  return tables;
}

TEST(BoreasDopplerBias, IsTakenOutOfAScan) {
  RawScan scan;
  scan.points = {{5, 0, 1}, {5, 0, 1}, {5, 5, 1}, {kNan, 0, 0}, {5, 0, 1}, {5, 0, 1}};
  scan.doppler = {1, 1, 1, 1, 1, 1};
  scan.times = {20.0, 20.1, 20.1, 20.1, kNan, 20.04};  // the span of the others is the duration
  scan.channels.line = {0, 3, 1, 0, 0, 2};
  subtract_boreas_doppler_bias(tables_by_hand(), "scan.bin", scan);
  EXPECT_DOUBLE_EQ(scan.doppler[0], 1 - 0.3);
  EXPECT_DOUBLE_EQ(scan.doppler[1], 1.0 - 33.0);
  EXPECT_DOUBLE_EQ(scan.doppler[2], 1.0 - 14.0) << "at 45 degrees";
  EXPECT_EQ(scan.doppler[3], 1.0) << "nowhere";
  EXPECT_EQ(scan.doppler[4], 1.0) << "at no time";
  EXPECT_DOUBLE_EQ(scan.doppler[5], 1.0 - 20.3);
  EXPECT_EQ(scan.warning, "");
}

TEST(BoreasDopplerBias, OfScansWithoutDurationIsThatOfTheFirstPart) {
  RawScan scan;
  scan.points = {{5, 0, 1}, {5, 0, 1}};
  scan.doppler = {1, 1};
  scan.times = {0.1, 0.1};
  scan.channels.line = {0, 1};
  subtract_boreas_doppler_bias(tables_by_hand(), "scan.bin", scan);
  EXPECT_DOUBLE_EQ(scan.doppler[0], 1 - 0.3);
  EXPECT_DOUBLE_EQ(scan.doppler[1], 1 - 10.3);
}

TEST(BoreasDopplerBias, WhatStaysIsSaid) {
  RawScan scan;
  subtract_boreas_doppler_bias(tables_by_hand(), "scan.bin", scan);
  EXPECT_EQ(scan.warning, "") << "empty";
  scan.points = {{5, 0, 1}, {5, 0, 1}};
  scan.doppler = {1, 1};
  scan.times = {0, 0.1};
  subtract_boreas_doppler_bias(tables_by_hand(), "scan.bin", scan);
  expect_within(scan.warning, "scan.bin: the Doppler keeps its bias: the tables go by beam and time");
  scan.channels.line = {4, 1};
  scan.warning = "before";
  subtract_boreas_doppler_bias(tables_by_hand(), "scan.bin", scan);
  EXPECT_EQ(scan.doppler, (std::vector<double>{1, 1 - 13.0}));
  expect_within(scan.warning, "before; scan.bin: the Doppler of 1 points keeps its bias: their beam is above 3");
}

class BoreasDopplerTablesByHand : public RecordingByHand {
 protected:
  void SetUp() override {
    RecordingByHand::SetUp();
    write_scan(28);
    write("applanix/readme.txt", "");
    write_tables("aeva_calib/");
  }

  // Those of tables_by_hand, as NumPy writes numbers; one file with the end of the last part in its lines.
  void write_tables(const std::string& folder, const std::string& end = "") const {
    for (int beam = 0; beam < 4; ++beam) {
      const std::string tens = beam == 0 ? "" : std::to_string(beam);
      const std::string ones = std::to_string(beam);
      write(folder + "azi_minmax_" + ones + ".csv", "-5.0e-01,5.0e-01\n-1,1\n");
      write(folder + "vel_mean_" + ones + ".csv", ones + "0.1," + ones + "0.2," + ones + "0.3," + ones + "0.4\n" +
                                                      tens + "1," + tens + "2," + tens + "3," + tens + "4\n");
    }
    const std::string row = "0.000000000000000000e+00,5.000000000000000000e-01" + end + "\n";
    write(folder + "rt_part.csv", row + row + row + row);
  }

  // 60 points at 0.1 rad to the left, of beam 0, 1, 2, 3, 0, ..., from 0.25 s to 0.3385 s after the stamp.
  void write_scan(int bytes) const {
    std::string content;
    for (int i = 0; i < 60; ++i) {
      const float time_s = 0.25F + 0.0015F * static_cast<float>(i);
      const float beam = static_cast<float>(i % 4);
      content += bytes == 40 ? floats({10, 1, 2, -4.25F, 11, 12, 13, time_s, beam * 65536, 0})
                             : floats({10, 1, 2, 11, -4.25F, time_s});
      content += bytes == 28 ? floats({beam}) : bytes == 32 ? floats({beam, 0}) : "";
    }
    write("aeva/1660000000000000.bin", content);
  }

  // What opening says once a line of a file is another.
  [[nodiscard]] std::string fault_with(const std::string& name, const std::string& content) const {
    write("aeva_calib/" + name, content);
    const std::string message = fault();
    write_tables("aeva_calib/");
    return message;
  }

  void expect_corrected() const {
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    const RawScan scan = dataset->scan(0);
    ASSERT_EQ(scan.doppler.size(), 60U);
    // The middle lies between 29 and 30. By then the cell is the third: 0.6 of 1 rad, then 1.1 of 2 rad.
    EXPECT_DOUBLE_EQ(scan.doppler[0], -4.25 - 0.3);
    EXPECT_DOUBLE_EQ(scan.doppler[29], -4.25 - 10.3);
    EXPECT_DOUBLE_EQ(scan.doppler[30], -4.25 - 23);
    EXPECT_DOUBLE_EQ(scan.doppler[59], -4.25 - 33);
    EXPECT_EQ(scan.warning, "");
  }

  void expect_uncorrected(const std::string& why) const {
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    EXPECT_EQ(dataset->scan(0).doppler, std::vector<double>(60, -4.25));
    EXPECT_TRUE(said(*dataset, why)) << dataset->assumptions().at(0);
  }
};

TEST_F(BoreasDopplerTablesByHand, CorrectTheDopplerOfTheRecordingBesideThem) {
  expect_corrected();
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  ASSERT_EQ(dataset->assumptions().size(), 1U);
  EXPECT_EQ(dataset->assumptions()[0],
            "the scans are read as records of 28 bytes (Boreas-Aeva); their Doppler is "
            "corrected by the tables of bias in " +
                (folder_ / "aeva_calib").string());
  write_tables("aeva_calib/", ",1.0");  // with the end of the last part
  expect_corrected();
}

TEST_F(BoreasDopplerTablesByHand, MayLieInSeveralPlaces) {
  fs::remove_all(folder_ / "aeva_calib");
  EXPECT_TRUE(find_boreas_doppler_tables(folder_).empty());
  expect_uncorrected("no tables of Doppler bias lie beside them (aeva_calib/), so their Doppler is not corrected");
  for (const std::string name : {"../aeva_calib/", "", "calib/", "Aeva_Calib/"}) {
    write_tables(name);  // each goes before the ones written so far
    EXPECT_TRUE(fs::equivalent(find_boreas_doppler_tables(folder_), folder_ / name)) << name;
    expect_corrected();
  }
}

TEST_F(BoreasDopplerTablesByHand, AreNotAppliedToScansTheyAreNotFor) {
  const std::string tables =
      "the tables of Doppler bias in " + (folder_ / "aeva_calib").string() + " are not applied: ";
  write_scan(24);
  expect_uncorrected(tables + "they go by beam");
  write_scan(32);
  expect_uncorrected(tables + "they are of one sensor");
  write_scan(40);
  expect_uncorrected(tables + "they are of the sensor of Boreas-Aeva");
  fs::remove_all(folder_ / "aeva_calib");
  EXPECT_TRUE(open_dataset(folder_)->assumptions().empty());
}

TEST_F(BoreasDopplerTablesByHand, ModelsOfTheOtherKindAreNamed) {
  EXPECT_TRUE(find_doppler_odom_model(folder_).empty());
  write("calib/sensor0_s1/lr_weights_row_0", "0,0\n");
  EXPECT_TRUE(said(*open_dataset(folder_), (folder_ / "calib" / "sensor0_s1").string() + " is of a model of Doppler"));
  expect_corrected();
}

TEST_F(BoreasDopplerTablesByHand, MissingFilesAreNamed) {
  for (const std::string name : {"rt_part.csv", "azi_minmax_2.csv", "vel_mean_3.csv"}) {
    fs::remove(folder_ / "aeva_calib" / name);
    expect_within(fault(), (folder_ / "aeva_calib" / name).string() + ": missing; tables of Doppler bias are rt_part");
    write_tables("aeva_calib/");
  }
}

TEST_F(BoreasDopplerTablesByHand, DamagedPartsNameTheLine) {
  const std::string place = (folder_ / "aeva_calib" / "rt_part.csv").string();
  expect_within(fault_with("rt_part.csv", "0,0.5\n0,0.5\n0,0.5\n"), place + ": 3 lines, expected 4: one per beam");
  expect_within(fault_with("rt_part.csv", "0,0.5\n0\n0,0.5\n0,0.5\n"),
                place + ": line 2: 1 numbers, expected the 2 begins of parts for the 2 lines of azi_minmax_1.csv");
  expect_within(fault_with("rt_part.csv", "0,0.5\n0,0.5\n0,0.5\n0,0.5,0.7,1\n"), place + ": line 4: 4 numbers");
  expect_within(fault_with("rt_part.csv", "0,0.5\n0,0.5\n0.5,0.5\n0,0.5\n"),
                place + ": line 3: 0.5 comes after 0.5, expected increasing shares of the scan's duration");
  expect_within(fault_with("rt_part.csv", "0,nan\n0,0.5\n0,0.5\n0,0.5\n"), place + ": line 1: a number is not finite");
  expect_within(fault_with("rt_part.csv", "0,0.5\n0,half\n"), place + ": line 2: 'half' is no number");
  expect_within(fault_with("rt_part.csv", "\n"), place + ": no numbers in this file");
}

TEST_F(BoreasDopplerTablesByHand, DamagedAzimuthsAndMeansNameTheLine) {
  const std::string azimuths = (folder_ / "aeva_calib" / "azi_minmax_1.csv").string();
  expect_within(fault_with("azi_minmax_1.csv", "-1,1\n-1,0,1\n"), azimuths + ": line 2: 3 numbers, expected 2: least");
  expect_within(fault_with("azi_minmax_1.csv", "1,-1\n-1,1\n"), azimuths + ": line 1: azimuths from 1 to -1, expected");
  expect_within(fault_with("azi_minmax_1.csv", "-1,1\n1,1\n"), azimuths + ": line 2: azimuths from 1 to 1");
  expect_within(fault_with("azi_minmax_1.csv", "-50,50\n-1,1\n"), "expected increasing ones from -pi to pi (rad)");
  expect_within(fault_with("azi_minmax_1.csv", "-1,inf\n-1,1\n"), azimuths + ": line 1: a number is not finite");
  const std::string means = (folder_ / "aeva_calib" / "vel_mean_2.csv").string();
  expect_within(fault_with("vel_mean_2.csv", "1,2,3,4\n1,2,3\n"), means + ": line 2: 3 numbers, expected 4 as in the");
  expect_within(fault_with("vel_mean_2.csv", "1,2\n"), means + ": 1 lines, expected 2 as in azi_minmax_2.csv");
  expect_within(fault_with("vel_mean_2.csv", "1,2\n1,nan\n"), means + ": line 2: a number is not finite");
  expect_corrected();
}

}  // namespace
}  // namespace dynamic_icp::datasets
