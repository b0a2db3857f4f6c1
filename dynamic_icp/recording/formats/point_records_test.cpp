// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/point_records.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class PointRecords : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }

  RawScan read(const std::string& bytes, const RecordLayout& layout) {
    write_whole_file(path_, bytes);
    return read_points(path_, layout);
  }
  std::vector<double> column(const RecordLayout& layout, std::string_view name) {
    for (const RecordField& field : layout.fields) {
      if (field.name == name) {
        return read_field(path_, layout, field);
      }
    }
    ADD_FAILURE() << "no field " << name;
    return {};
  }

  fs::path path_ = fs::temp_directory_path() / ("point_records_test-" + std::to_string(::getpid()) + ".bin");
};

// x = 1, y = -2, z = 0.5, reflectivity 20.5, velocity -3.25, 6 700 000 ns, line 200, byte by byte; then -57 dB.
const std::string kShortRecord(
    "\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x00\x00\xa4\x41\x00\x00\x50\xc0\xe0\x3b\x66\x00\xc8", 25);
const std::string kRecord = kShortRecord + std::string("\x00\x00\x64\xc2", 4);
// x = 1, y = -2, z = 0.5, Doppler = -3.25.
const std::string kPlainRecord("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x00\x00\x50\xc0", 16);

std::string floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float value : values) {
    for (int k = 0; k < 4; ++k) {
      bytes.push_back(static_cast<char>(std::bit_cast<std::uint32_t>(value) >> (8 * k) & 0xff));
    }
  }
  return bytes;
}

void expect_record(const RawScan& scan, std::size_t i) {
  EXPECT_EQ(scan.points.at(i), Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_EQ(scan.doppler.at(i), -3.25);
}

TEST_F(PointRecords, OfAevaWithAndWithoutIntensity) {
  const RawScan scan = read(kRecord + kRecord, kAeva29);
  ASSERT_EQ(scan.points.size(), 2U);
  expect_record(scan, 1);
  EXPECT_DOUBLE_EQ(scan.times.at(1), 0.0067);
  EXPECT_EQ(column(kAeva29, "reflectivity"), (std::vector<double>{20.5, 20.5}));
  EXPECT_EQ(column(kAeva29, "line_index"), (std::vector<double>{200, 200}));
  EXPECT_EQ(column(kAeva29, "intensity"), (std::vector<double>{-57.0, -57.0}));
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{200, 200}));
  EXPECT_EQ(scan.channels.intensity, (std::vector<float>{-57, -57}));
  EXPECT_EQ(scan.warning, "");
  EXPECT_EQ(scan.stamp, Stamp{});

  const RawScan older = read(kShortRecord + kShortRecord + kShortRecord, kAeva25);
  ASSERT_EQ(older.points.size(), 3U);
  expect_record(older, 2);
  EXPECT_DOUBLE_EQ(older.times.at(2), 0.0067);
  EXPECT_EQ(column(kAeva25, "line_index"), (std::vector<double>{200, 200, 200}));
  EXPECT_EQ(kAeva25.fields.size(), 2U) << "no intensity";
  EXPECT_EQ(older.channels.line, (std::vector<std::uint16_t>{200, 200, 200}));
  EXPECT_EQ(older.channels.intensity, (std::vector<float>{20.5, 20.5, 20.5})) << "the reflectivity";
}

TEST_F(PointRecords, TimesMayLieBeforeTheStamp) {
  std::string record = kRecord;
  record.replace(20, 4, "\xff\xff\xff\xff");
  EXPECT_DOUBLE_EQ(read(record, kAeva29).times.at(0), -1e-9);
}

TEST_F(PointRecords, OfFourFloats) {
  const RawScan scan = read(kPlainRecord + kPlainRecord, kXyzd);
  ASSERT_EQ(scan.points.size(), 2U);
  expect_record(scan, 1);
  EXPECT_TRUE(scan.times.empty());
}

TEST_F(PointRecords, OfTheAevaSetHaveSeconds) {
  const RawScan scan = read(kPlainRecord + floats({0.0625F}) + kPlainRecord + floats({0.125F}), kXyzdTime);
  ASSERT_EQ(scan.points.size(), 2U);
  expect_record(scan, 1);
  EXPECT_EQ(scan.times, (std::vector<double>{0.0625, 0.125}));
}

// Flags: line 37, beam 5, face 2 above a lowest byte of 0x81.
TEST_F(PointRecords, OfBoreasRt) {
  const float flags = static_cast<float>(0x81 + (37 << 8) + (5 << 16) + (2 << 22));
  const std::string start = floats({1.0F, -2.0F, 0.5F, -3.25F, 11.0F, 12.0F, 13.0F});
  const RawScan scan =
      read(start + floats({50'000'000.0F, flags, 3.0F}) + start + floats({0.0F, flags, 3.0F}), kBoreas40);
  ASSERT_EQ(scan.points.size(), 2U);
  expect_record(scan, 1);
  EXPECT_EQ(scan.times, (std::vector<double>{50'000'000 * 1e-9, 0.0}));
  EXPECT_EQ(column(kBoreas40, "intensity"), (std::vector<double>{11, 11}));
  EXPECT_EQ(column(kBoreas40, "signal_quality"), (std::vector<double>{12, 12}));
  EXPECT_EQ(column(kBoreas40, "reflectivity"), (std::vector<double>{13, 13}));
  EXPECT_EQ(column(kBoreas40, "line_index"), (std::vector<double>{37, 37}));
  EXPECT_EQ(column(kBoreas40, "beam_id"), (std::vector<double>{5, 5}));
  EXPECT_EQ(column(kBoreas40, "face"), (std::vector<double>{2, 2}));
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{37, 37}));
  EXPECT_EQ(scan.channels.face, (std::vector<std::uint8_t>{2, 2}));
  EXPECT_EQ(scan.channels.intensity, (std::vector<float>{11, 11}));
  EXPECT_EQ(column(kBoreas40, "point_flags_lsb").at(0), flags);
  EXPECT_EQ(column(kBoreas40, "point_flags_msb"), (std::vector<double>{3, 3}));
  // None is above 10: seconds.
  EXPECT_EQ(read(start + floats({0.0625F, flags, 0.0F}), kBoreas40).times, std::vector<double>{0.0625});
}

TEST_F(PointRecords, PartsOfFlagsThatAreNoIntegersAreZero) {
  const std::string start = floats({1.0F, -2.0F, 0.5F, -3.25F, 0.0F, 0.0F, 0.0F, 0.0F});
  read(start + floats({std::numeric_limits<float>::quiet_NaN(), 0.0F}) + start + floats({-256.0F, 0.0F}) + start +
           floats({1e30F, 0.0F}),
       kBoreas40);
  EXPECT_EQ(column(kBoreas40, "line_index"), (std::vector<double>{0, 0, 0}));
}

TEST_F(PointRecords, OfBoreasWithBeams) {
  const std::string start = floats({1.0F, -2.0F, 0.5F, 11.0F, -3.25F});
  expect_record(read(start + floats({0.0625F}), kBoreas24), 0);
  EXPECT_EQ(column(kBoreas24, "intensity"), std::vector<double>{11});
  for (const RecordLayout* layout : {&kBoreas28, &kBoreas28BeamThenTime}) {
    const bool beam_first = layout == &kBoreas28BeamThenTime;
    const RawScan scan = read(start + (beam_first ? floats({3.0F, 0.0625F}) : floats({0.0625F, 3.0F})), *layout);
    expect_record(scan, 0);
    EXPECT_EQ(scan.times, std::vector<double>{0.0625});
    EXPECT_EQ(column(*layout, "beam_id"), std::vector<double>{3});
    EXPECT_EQ(scan.channels.line, std::vector<std::uint16_t>{3});
  }
  expect_record(read(start + floats({0.0625F, 3.0F, 7.0F}), kBoreas32), 0);
  EXPECT_EQ(column(kBoreas32, "beam_id"), std::vector<double>{3});
  EXPECT_EQ(column(kBoreas32, "sensor_id"), std::vector<double>{7});
  EXPECT_EQ(read_points(path_, kBoreas32).channels.sensor, std::vector<std::uint8_t>{7});
  const RawScan odd = read(start + floats({0.0625F, 0.5F, 7.0F}), kBoreas32);
  EXPECT_TRUE(odd.channels.line.empty());
  EXPECT_EQ(odd.channels.sensor, std::vector<std::uint8_t>{7});
  EXPECT_EQ(odd.warning, path_.string() +
                             ": column 'beam_id' is left out: it holds 0.5 at point 0, expected whole numbers from 0 "
                             "to 65535");
}

TEST_F(PointRecords, OfTheRadarOfViewOfDelft) {
  const std::string start = floats({1.0F, -2.0F, 0.5F, -17.5F, -3.25F, 0.75F});
  const RawScan scan = read(start + floats({-2.0F}) + start + floats({0.0F}), kVod28);
  expect_record(scan, 1);
  EXPECT_TRUE(scan.times.empty()) << "the last number is that of a scan";
  EXPECT_EQ(scan.is_unusable, (std::vector<std::uint8_t>{1, 0})) << "an earlier scan";
  EXPECT_EQ(scan.channels.intensity, (std::vector<float>{-17.5F, -17.5F}));
  EXPECT_EQ(column(kVod28, "v_r_compensated"), (std::vector<double>{0.75, 0.75}));
}

TEST_F(PointRecords, AreHandedOnFiniteOrNot) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const RawScan scan = read(floats({nan, 1.0F, -infinity, nan, nan}), kXyzdTime);
  EXPECT_TRUE(std::isnan(scan.points.at(0).x()) && std::isinf(scan.points[0].z()));
  EXPECT_TRUE(std::isnan(scan.doppler.at(0)) && std::isnan(scan.times.at(0)));
}

TEST_F(PointRecords, AnIncompleteOneIsLeftOutWithAWarning) {
  const RawScan scan = read(kRecord + kRecord.substr(0, 28), kAeva29);
  ASSERT_EQ(scan.points.size(), 1U);
  expect_record(scan, 0);
  EXPECT_NE(scan.warning.find(path_.string() + ": 28 bytes after record 1"), std::string::npos) << scan.warning;
  EXPECT_EQ(column(kAeva29, "intensity").size(), 1U);
}

TEST_F(PointRecords, NoneAreAnEmptyScanWithAWarning) {
  const RawScan scan = read("", kBoreas40);
  EXPECT_TRUE(scan.points.empty() && scan.times.empty());
  EXPECT_NE(scan.warning.find(path_.string() + ": empty file"), std::string::npos);
  EXPECT_TRUE(column(kBoreas40, "intensity").empty());
  EXPECT_THROW(read_points(path_.string() + ".missing", kAeva29), DataError);
}

// More records than one block holds.
TEST_F(PointRecords, ManyKeepTheirOrder) {
  for (const RecordLayout* layout : {&kXyzd, &kAeva29, &kBoreas40}) {
    std::string bytes;
    for (int i = 0; i < 10'000; ++i) {
      std::string record = floats({static_cast<float>(i), 0.0F, 0.0F});
      record.resize(layout->bytes);
      record.replace(layout->doppler, 4, floats({static_cast<float>(-i)}));
      bytes += record;
    }
    const RawScan scan = read(bytes, *layout);
    ASSERT_EQ(scan.points.size(), 10'000U);
    for (int i = 0; i < 10'000; ++i) {
      ASSERT_EQ(scan.points[static_cast<std::size_t>(i)], Eigen::Vector3d(i, 0, 0)) << layout->name;
      ASSERT_EQ(scan.doppler[static_cast<std::size_t>(i)], -i) << layout->name;
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
