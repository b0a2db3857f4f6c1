// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/point_table.hpp"

#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// A file taken apart line by line and byte by byte, with nothing from the library.
struct ReadBack {
  std::map<std::string, std::string> header;  ///< key: the rest of its line
  std::vector<std::vector<float>> records;
  std::size_t bytes_left = 0;
};

ReadBack read_back(const std::string& bytes, std::size_t fields) {
  ReadBack file;
  std::istringstream stream(bytes);
  std::string line;
  while (file.header.count("DATA") == 0 && std::getline(stream, line)) {
    const std::size_t blank = line.find(' ');
    file.header[line.substr(0, blank)] = line.substr(blank + 1);
  }
  std::size_t at = static_cast<std::size_t>(stream.tellg());
  for (; at + 4 * fields <= bytes.size(); at += 4 * fields) {
    std::vector<float> record;
    for (std::size_t i = 0; i < fields; ++i) {
      std::uint32_t bits = 0;
      for (std::size_t k = 4; k-- > 0;) {
        bits = bits << 8 | static_cast<unsigned char>(bytes[at + 4 * i + k]);
      }
      record.emplace_back();
      std::memcpy(&record.back(), &bits, 4);
    }
    file.records.push_back(record);
  }
  file.bytes_left = bytes.size() - at;
  return file;
}

TEST(Pcd, AnEmptyCloudIsAFileOfWidthZero) {
  const ReadBack file = read_back(pcd_bytes(point_table({})), 3);
  EXPECT_EQ(file.header.at("WIDTH"), "0");
  EXPECT_EQ(file.header.at("POINTS"), "0");
  EXPECT_TRUE(file.records.empty());
  EXPECT_EQ(file.bytes_left, 0u);
}

TEST(Pcd, HeaderSaysWhatTheBytesAre) {
  const std::vector<Vector3d> points = {{1.0, -2.0, 0.5}, {1e-3, 4e4, -0.1}};
  const std::vector<float> doppler = {-3.25f, 0.0f};
  const std::vector<float> label = {0.0f, 7.0f};
  std::vector<NamedArray> table = point_table(points);
  table.push_back({"doppler", npy_array<float>({2}, doppler)});
  table.push_back({"label", npy_array<float>({2}, label)});
  const ReadBack file = read_back(pcd_bytes(table), 5);
  const std::map<std::string, std::string> expected = {{"#", ".PCD v0.7 - Point Cloud Data file format"},
                                                       {"VERSION", "0.7"},
                                                       {"FIELDS", "x y z doppler label"},
                                                       {"SIZE", "4 4 4 4 4"},
                                                       {"TYPE", "F F F F F"},
                                                       {"COUNT", "1 1 1 1 1"},
                                                       {"WIDTH", "2"},
                                                       {"HEIGHT", "1"},
                                                       {"VIEWPOINT", "0 0 0 1 0 0 0"},
                                                       {"POINTS", "2"},
                                                       {"DATA", "binary"}};
  EXPECT_EQ(file.header, expected);
  EXPECT_EQ(file.records,
            (std::vector<std::vector<float>>{{1.0f, -2.0f, 0.5f, -3.25f, 0.0f}, {1e-3f, 4e4f, -0.1f, 0.0f, 7.0f}}));
  EXPECT_EQ(file.bytes_left, 0u);
}

// x = 1, y = -2, z = 0.5 as IEEE 754 has them, lowest byte first.
TEST(Pcd, DataBeginRightAfterTheHeader) {
  const std::vector<Vector3d> points = {{1.0, -2.0, 0.5}};
  const std::string record("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 12);
  EXPECT_TRUE(pcd_bytes(point_table(points)).ends_with("\nDATA binary\n" + record));
}

TEST(Pcd, RefusesColumnsThatDoNotBelong) {
  const auto write = [](const std::vector<std::pair<std::string, std::size_t>>& columns) {
    std::vector<NamedArray> table;
    for (const auto& [name, count] : columns) {
      table.push_back({name, npy_array<float>({count}, std::vector<float>(count, 1.0F))});
    }
    return pcd_bytes(table);
  };
  EXPECT_NO_THROW(write({{"a", 2}, {"b", 2}}));
  EXPECT_THROW(write({{"a", 2}, {"b", 3}}), std::invalid_argument);
  EXPECT_THROW(write({{"", 2}}), std::invalid_argument);
  EXPECT_THROW(write({{"a b", 2}}), std::invalid_argument);
  EXPECT_THROW(write({{"a\nDATA", 2}}), std::invalid_argument);
  EXPECT_THROW(write({{"a", 2}, {"a", 2}}), std::invalid_argument);
}

TEST(Pcd, RefusesNumbersThatAreNotFinite) {
  constexpr double kHuge = 1e39;  // a double, but no float32
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), kHuge}) {
    EXPECT_THROW(pcd_bytes(point_table(std::vector<Vector3d>{{0.0, bad, 0.0}})), std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
