// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/conversion/conversion.hpp"

#include <bit>
#include <cstring>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::conversion {
namespace {

namespace fs = std::filesystem;
using datasets::Dataset;
using datasets::PointColumn;

/// A recording in memory.
struct Recording final : Dataset {
  std::vector<RawScan> scans;
  std::vector<std::vector<PointColumn>> others;
  formats::Trajectory truth;
  std::optional<Eigen::Isometry3d> mounting;
  DopplerKind kind = DopplerKind::kRelative;
  std::vector<std::string> nothing;

  [[nodiscard]] std::string_view format() const override { return "memory"; }
  [[nodiscard]] std::size_t size() const override { return scans.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return scans.at(index).stamp; }
  [[nodiscard]] fs::path scan_file(std::size_t /*index*/) const override { return "memory"; }
  [[nodiscard]] RawScan scan(std::size_t index) const override { return scans.at(index); }
  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override { return others.at(index); }
  [[nodiscard]] DopplerKind doppler_kind() const override { return kind; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth; }
  [[nodiscard]] fs::path ground_truth_file() const override { return ""; }
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override { return mounting; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return nothing; }
};

/// How numbers of a recording came about.
struct Kinds {
  bool float32 = true;
  bool times = false;
  bool nanoseconds = false;
  bool lines_of_sight = false;
};

Recording random_recording(std::uint64_t seed, const Kinds& kinds) {
  const RandomSource source(seed);
  std::uint64_t drawn = 0;
  const auto number = [&] {
    const double value = 200.0 * (source.uniform(drawn++) - 0.5);
    return kinds.float32 ? static_cast<double>(static_cast<float>(value)) : value;
  };
  Recording recording;
  for (int k = 0; k < 4; ++k) {
    RawScan scan;
    scan.stamp = Stamp{1'724'479'779'384'729'506 + 98'765'432 * k};
    const std::size_t points = k == 1 ? 0 : 1 + source.bits(drawn++) % 30;
    PointColumn line{"line_index", {}, true};
    PointColumn weird{"Some Colour", {}, false};
    for (std::size_t i = 0; i < points; ++i) {
      scan.points.emplace_back(number(), number(), number());
      scan.doppler.push_back(number());
      if (kinds.times) {
        const double s = source.uniform(drawn++) * 0.1;
        scan.times.push_back(kinds.nanoseconds ? 1e-9 * std::floor(1e9 * s)
                                               : static_cast<double>(static_cast<float>(s)));
      }
      if (kinds.lines_of_sight) {
        scan.directions.push_back(Eigen::Vector3d(number(), number(), number()).normalized());
      }
      line.values.push_back(static_cast<double>(source.bits(drawn++) % 64));
      weird.values.push_back(number());
    }
    if (points > 3) {
      scan.points[0].x() = std::numeric_limits<double>::quiet_NaN();
      scan.doppler[1] = -std::numeric_limits<double>::infinity();
      scan.points[2] = Eigen::Vector3d(-0.0, 0.0, 0.0);
    }
    recording.scans.push_back(scan);
    recording.others.push_back({line, weird});
    formats::StampedPose pose{scan.stamp, Eigen::Isometry3d::Identity()};
    pose.T_world_sensor = Eigen::Translation3d(number(), number(), number()) *
                          Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d(1, 2, 3).normalized());
    recording.truth.push_back(pose);
  }
  return recording;
}

std::vector<std::uint64_t> bits_of(const double* values, std::size_t count) {
  std::vector<std::uint64_t> bits;
  for (std::size_t i = 0; i < count; ++i) {
    bits.push_back(std::isnan(values[i]) ? 1 : std::bit_cast<std::uint64_t>(values[i]));
  }
  return bits;
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) { return bits_of(values.data(), values.size()); }
std::vector<std::uint64_t> bits_of(const std::vector<Eigen::Vector3d>& values) {
  return values.empty() ? std::vector<std::uint64_t>() : bits_of(values.front().data(), 3 * values.size());
}

class Conversion : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// Converts and opens the result.
  std::unique_ptr<Dataset> converted(const Recording& recording, Target target) {
    const fs::path out = folder_ / std::to_string(++made_);
    fs::create_directories(out);
    notes_ = convert(recording, {0, recording.size()}, target, out);
    return datasets::open_dataset(out);
  }
  [[nodiscard]] bool noted(const std::string& part) const {
    for (const std::string& note : notes_) {
      if (note.find(part) != std::string::npos) {
        return true;
      }
    }
    return false;
  }

  static void expect_same_scans(const Recording& recording, const Dataset& dataset) {
    ASSERT_EQ(dataset.size(), recording.size());
    for (std::size_t k = 0; k < recording.size(); ++k) {
      const RawScan& expected = recording.scans[k];
      const RawScan scan = dataset.scan(k);
      EXPECT_EQ(scan.stamp, expected.stamp);
      EXPECT_EQ(bits_of(scan.points), bits_of(expected.points)) << k;
      EXPECT_EQ(bits_of(scan.doppler), bits_of(expected.doppler)) << k;
      EXPECT_EQ(bits_of(scan.times), bits_of(expected.times)) << k;
      EXPECT_EQ(bits_of(scan.directions), bits_of(expected.directions)) << k;
    }
  }
  static void expect_same_truth(const Recording& recording, const Dataset& dataset, double tolerance) {
    ASSERT_EQ(dataset.ground_truth().size(), recording.truth.size());
    for (std::size_t k = 0; k < recording.truth.size(); ++k) {
      EXPECT_EQ(dataset.ground_truth()[k].stamp, recording.truth[k].stamp);
      EXPECT_TRUE(dataset.ground_truth()[k].T_world_sensor.isApprox(recording.truth[k].T_world_sensor, tolerance));
    }
  }

  std::vector<std::string> notes_;
  int made_ = 0;
  fs::path folder_ = fs::temp_directory_path() / ("conversion_test-" + std::to_string(::getpid()));
};

TEST_F(Conversion, WhatHasNamesComesBackBitByBit) {
  std::uint64_t seed = 0;
  for (const Target target : {Target::kNpz, Target::kPcd, Target::kPly, Target::kMcap}) {
    for (const Kinds kinds : {Kinds{}, Kinds{false, true, true, true}, Kinds{true, true, false, true},
                              Kinds{true, true, true, false}, Kinds{false, true, false, false}}) {
      const Recording recording = random_recording(++seed, kinds);
      const std::unique_ptr<Dataset> dataset = converted(recording, target);
      expect_same_scans(recording, *dataset);
      expect_same_truth(recording, *dataset, 1e-14);
      for (std::size_t k = 0; k < recording.size(); ++k) {
        const std::vector<PointColumn> columns = dataset->columns(k);
        ASSERT_EQ(columns.size(), 2u);
        EXPECT_EQ(columns[0].name, "line_index");
        EXPECT_TRUE(columns[0].is_integer);
        EXPECT_EQ(columns[0].values, recording.others[k][0].values);
        EXPECT_EQ(columns[1].name, "Some_Colour");
        EXPECT_EQ(bits_of(columns[1].values), bits_of(recording.others[k][1].values));
      }
      EXPECT_EQ(notes_, std::vector<std::string>{"column 'Some Colour' is called 'Some_Colour'"});
    }
  }
}

TEST_F(Conversion, McapKeepsMountingsAndTheKindOfDoppler) {
  Recording recording = random_recording(11, {true, true, false, false});
  recording.mounting = Eigen::Translation3d(1.5, 0, 2) * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized());
  recording.kind = DopplerKind::kCompensated;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    RawScan& scan = recording.scans[k];
    scan.mountings = {Eigen::Isometry3d::Identity(),
                      Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitY())};
    PointColumn sensor{"sensor", std::vector<double>(scan.points.size(), 1.0), true};
    recording.others[k].push_back(sensor);
  }
  const std::unique_ptr<Dataset> dataset = converted(recording, Target::kMcap);
  const std::unique_ptr<Dataset> by_npz = converted(recording, Target::kNpz);
  EXPECT_EQ(dataset->format(), "mcap");
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kCompensated);
  ASSERT_TRUE(dataset->T_vehicle_sensor());
  EXPECT_EQ(dataset->T_vehicle_sensor()->matrix(), by_npz->T_vehicle_sensor()->matrix()) << "bit by bit";
  const RawScan scan = dataset->scan(2);
  const RawScan expected = by_npz->scan(2);
  ASSERT_EQ(scan.mountings.size(), 2U);
  EXPECT_EQ(scan.mountings[1].matrix(), expected.mountings[1].matrix());
  EXPECT_TRUE(scan.mountings[1].isApprox(recording.scans[2].mountings[1], 1e-14));
  EXPECT_EQ(scan.channels.sensor, expected.channels.sensor);
  ASSERT_EQ(dataset->ground_truth().size(), by_npz->ground_truth().size());
  for (std::size_t k = 0; k < recording.truth.size(); ++k) {
    EXPECT_EQ(dataset->ground_truth()[k].stamp, by_npz->ground_truth()[k].stamp);
    EXPECT_TRUE(dataset->ground_truth()[k].T_world_sensor.isApprox(by_npz->ground_truth()[k].T_world_sensor, 1e-15));
  }
}

TEST_F(Conversion, McapHasNoTimesBefore1970) {
  Recording recording = random_recording(12, {});
  recording.truth.front().stamp.ns = -5;
  EXPECT_EQ(converted(recording, Target::kMcap)->ground_truth().size(), recording.truth.size() - 1);
  EXPECT_TRUE(noted("before 1970 are left out"));
  recording.scans.front().stamp.ns = -5;
  EXPECT_THROW(converted(recording, Target::kMcap), DataError);
}

TEST_F(Conversion, DicpHoldsFloat32) {
  Recording recording = random_recording(7, {true, true, false, false});
  recording.mounting = Eigen::Translation3d(1.5, 0, 2) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  const std::unique_ptr<Dataset> dataset = converted(recording, Target::kDicp);
  EXPECT_EQ(dataset->format(), "dicp");
  expect_same_scans(recording, *dataset);
  expect_same_truth(recording, *dataset, 1e-12);
  EXPECT_TRUE(dataset->T_vehicle_sensor()->isApprox(*recording.mounting, 1e-14));
  EXPECT_EQ(notes_, (std::vector<std::string>{"column 'line_index' is left out: dicp has no place for it",
                                              "column 'Some Colour' is left out: dicp has no place for it"}));
}

TEST_F(Conversion, WhatIsLostIsSaid) {
  Recording recording = random_recording(8, {false, true, true, true});
  recording.kind = DopplerKind::kCompensated;
  recording.mounting = Eigen::Isometry3d::Identity();
  recording.truth[2].stamp.ns += 5'000'000;
  recording.truth.pop_back();
  recording.truth.front().stamp.ns -= 1'000'000;
  converted(recording, Target::kDicp);
  EXPECT_TRUE(noted("rounded to float32: dicp"));
  EXPECT_TRUE(noted("rounded to float32 seconds"));
  EXPECT_TRUE(noted("lines of sight are left out"));
  EXPECT_TRUE(noted("ground truth is left out"));
  EXPECT_TRUE(noted("times of the scans are left out"));
  EXPECT_TRUE(noted("compensated is left out"));
  EXPECT_FALSE(converted(recording, Target::kPly)->T_vehicle_sensor()->matrix().hasNaN());
  EXPECT_FALSE(noted("mounting"));
  EXPECT_FALSE(noted("float32"));
  recording.scans[0].mountings = {Eigen::Isometry3d::Identity()};
  recording.scans[2].mountings = {Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0))};
  converted(recording, Target::kNpz);
  EXPECT_TRUE(noted("mountings of the sensors differ"));
}

TEST_F(Conversion, DicpGetsPosesAtTheTimesOfScans) {
  Recording recording = random_recording(9, {});
  for (formats::StampedPose& pose : recording.truth) {
    pose.T_world_sensor = Eigen::Isometry3d(
        Eigen::Translation3d(1e-6 * static_cast<double>((pose.stamp.ns - recording.scans[0].stamp.ns) / 1000), 0, 0));
  }
  formats::StampedPose late = recording.truth.back();
  for (formats::StampedPose& pose : recording.truth) {
    pose.stamp.ns -= 10'000'000;
  }
  late.stamp.ns += 10'000'000;
  recording.truth.push_back(late);
  const std::unique_ptr<Dataset> dataset = converted(recording, Target::kDicp);
  EXPECT_TRUE(noted("4 of 4 poses are interpolated"));
  ASSERT_EQ(dataset->size(), 4u);
  EXPECT_EQ(dataset->stamp(3), recording.scans[3].stamp);
  // Poses are 10 ms early, so that the scan is where the sensor is 10 ms on.
  EXPECT_NEAR(dataset->ground_truth()[1].T_world_sensor.translation().x(), 0.098765 + 0.01, 1e-5);
}

TEST_F(Conversion, StampsThatAreNoUnixTimesStayTimes) {
  Recording recording = random_recording(10, {});
  for (std::size_t k = 0; k < recording.size(); ++k) {
    recording.scans[k].stamp = Stamp{static_cast<std::int64_t>(k * k) * 83'333'333};
  }
  recording.truth.clear();
  const std::unique_ptr<Dataset> dataset = converted(recording, Target::kPcd);
  expect_same_scans(recording, *dataset);
  EXPECT_TRUE(fs::exists(folder_ / "1" / "0000000000083333333.pcd"));
  recording.scans[0].stamp.ns = -1;
  EXPECT_THROW(converted(recording, Target::kPcd), DataError);
}

TEST_F(Conversion, AColumnWithATakenNameGetsAnother) {
  Recording recording = random_recording(11, {});
  for (std::vector<PointColumn>& columns : recording.others) {
    columns[0].name = "doppler";
    columns[1].name = "x";
  }
  const std::unique_ptr<Dataset> dataset = converted(recording, Target::kPcd);
  expect_same_scans(recording, *dataset);
  EXPECT_EQ(dataset->columns(0)[0].name, "doppler_other");
  EXPECT_TRUE(noted("column 'x' is called 'x_other'"));
}

TEST_F(Conversion, AllFilesHaveTheSameTypes) {
  Recording recording = random_recording(12, {});
  recording.scans[0].points[0].y() = 0.1;  // one number that is no float32
  converted(recording, Target::kPcd);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "1")) {
    if (entry.path().extension() == ".pcd") {
      EXPECT_NE(formats::read_whole_file(entry.path()).find("SIZE 8 8 8 4 1 4\n"), std::string::npos) << entry.path();
    }
  }
}

TEST_F(Conversion, PlyKeepsLargeIntegersAsDoubles) {
  Recording recording = random_recording(13, {});
  recording.others[0][0].values[0] = 9007199254740991.0;
  recording.others[2][0].values[0] = -9007199254740991.0;
  const std::unique_ptr<Dataset> dataset = converted(recording, Target::kPly);
  EXPECT_TRUE(noted("PLY has no integers of 64 bits"));
  EXPECT_EQ(dataset->columns(0)[0].values, recording.others[0][0].values);
  EXPECT_EQ(converted(recording, Target::kNpz)->columns(2)[0].values, recording.others[2][0].values);
}

TEST(ConversionTarget, UnknownOnesAreWrongUse) {
  EXPECT_EQ(find_target("ply"), Target::kPly);
  EXPECT_EQ(find_target("mcap"), Target::kMcap);
  EXPECT_THROW(find_target("hercules"), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::conversion
