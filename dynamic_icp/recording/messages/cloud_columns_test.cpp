// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

#include <array>
#include <cstring>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::messages {
namespace {

/// Puts a number at a place, in either byte order.
template <class Number>
void put(std::string& data, std::size_t at, Number value, bool is_bigendian) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &value, sizeof(Number));
  if (is_bigendian) {
    std::reverse(raw, raw + sizeof(Number));
  }
  std::memcpy(data.data() + at, raw, sizeof(Number));
}

/// 2 rows of 3 points of 40 bytes with gaps, rows of 128 bytes; z before x, a field of three numbers, every type.
PointCloud odd_cloud(bool is_bigendian) {
  PointCloud cloud;
  cloud.height = 2;
  cloud.width = 3;
  cloud.point_step = 40;
  cloud.row_step = 128;
  cloud.is_bigendian = is_bigendian;
  cloud.fields = {{"z", FieldType::kFloat64, 0, 1},       {"x", FieldType::kFloat32, 8, 1},
                  {"", FieldType::kUint8, 12, 4},         {"vector", FieldType::kInt16, 16, 3},
                  {"ring", FieldType::kUint16, 22, 1},    {"flag", FieldType::kInt8, 24, 1},
                  {"valid", FieldType::kUint8, 25, 1},    {"t", FieldType::kUint32, 28, 1},
                  {"offset_ns", FieldType::kInt32, 32, 1}};
  cloud.data.assign(128 + 3 * 40, '\x5A');
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t at = i / 3 * 128 + i % 3 * 40;
    const auto number = static_cast<int>(i);
    put(cloud.data, at, 0.5 + number, is_bigendian);
    put(cloud.data, at + 8, -1.25F * static_cast<float>(number), is_bigendian);
    for (int k = 0; k < 3; ++k) {
      put(cloud.data, at + 16 + 2 * static_cast<std::size_t>(k), static_cast<std::int16_t>(-100 * number - k),
          is_bigendian);
    }
    put(cloud.data, at + 22, static_cast<std::uint16_t>(65530 + number), is_bigendian);
    put(cloud.data, at + 24, static_cast<std::int8_t>(-number), is_bigendian);
    put(cloud.data, at + 25, static_cast<std::uint8_t>(250 + number), is_bigendian);
    put(cloud.data, at + 28, static_cast<std::uint32_t>(4'000'000'000U + i), is_bigendian);
    put(cloud.data, at + 32, -2'000'000'000 - number, is_bigendian);
  }
  return cloud;
}

std::string fault_of_columns(const PointCloud& cloud) {
  try {
    const CloudColumns columns(cloud, "bag: /points, message 4");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CloudColumns, AnyOrderTypeCountPaddingAndByteOrder) {
  for (const bool is_bigendian : {false, true}) {
    const CloudColumns columns(odd_cloud(is_bigendian), "bag");
    EXPECT_EQ(columns.points(), 6U);
    EXPECT_EQ(columns.names(),
              (std::vector<std::string>{"z", "x", "vector", "ring", "flag", "valid", "t", "offset_ns"}));
    EXPECT_EQ(columns.values("z"), (std::vector<double>{0.5, 1.5, 2.5, 3.5, 4.5, 5.5}));
    EXPECT_EQ(columns.values("x"), (std::vector<double>{-0.0, -1.25, -2.5, -3.75, -5.0, -6.25}));
    EXPECT_EQ(columns.values("vector", 2), (std::vector<double>{-2, -102, -202, -302, -402, -502}));
    EXPECT_EQ(columns.column("vector").shape, (std::vector<std::size_t>{6, 3}));
    EXPECT_EQ(columns.values("ring"), (std::vector<double>{65530, 65531, 65532, 65533, 65534, 65535}));
    EXPECT_EQ(columns.values("flag"), (std::vector<double>{0, -1, -2, -3, -4, -5}));
    EXPECT_EQ(columns.values("valid"), (std::vector<double>{250, 251, 252, 253, 254, 255}));
    EXPECT_EQ(columns.values("t").back(), 4'000'000'005.0);
    EXPECT_EQ(columns.values("offset_ns").back(), -2'000'000'005.0);
  }
}

TEST(CloudColumns, TheLastRowNeedNotBePaddedAndMoreDataPass) {
  PointCloud cloud = odd_cloud(false);
  EXPECT_EQ(fault_of_columns(cloud), "no error");
  cloud.data.pop_back();
  EXPECT_EQ(fault_of_columns(cloud),
            "bag: /points, message 4: 247 bytes of data for 2 x 3 points of 40 bytes (row_step 128)");
  cloud.data.append(500, '\0');
  EXPECT_EQ(fault_of_columns(cloud), "no error");
}

TEST(CloudColumns, SizesThatContradictEachOther) {
  const auto fault_with = [](auto change) {
    PointCloud cloud = odd_cloud(false);
    change(cloud);
    return fault_of_columns(cloud);
  };
  EXPECT_EQ(fault_with([](PointCloud& c) { c.fields[3].offset = 35; }),
            "bag: /points, message 4: field 'vector', 3 x int16 at byte 35, ends beyond a point of 40 bytes");
  EXPECT_NE(fault_with([](PointCloud& c) { c.fields[3].count = 0xFFFFFFFF; }).find("ends beyond"), std::string::npos);
  EXPECT_NE(fault_with([](PointCloud& c) { c.fields[3].offset = 0xFFFFFFFF; }).find("ends beyond"), std::string::npos);
  EXPECT_NE(fault_with([](PointCloud& c) { c.row_step = 119; }).find("row_step 119 bytes, expected 120 or more"),
            std::string::npos);
  EXPECT_NE(fault_with([](PointCloud& c) { c.row_step = 0xFFFFFFFFFFFFFFFF; }).find("248 bytes of data"),
            std::string::npos);
  EXPECT_NE(fault_with([](PointCloud& c) {
              c.width = 0xFFFFFFFF;
              c.height = 0xFFFFFFFF;
              c.row_step = std::uint64_t{0xFFFFFFFF} * 40;
            }).find("248 bytes of data for 4294967295 x 4294967295 points"),
            std::string::npos);
  EXPECT_NE(fault_with([](PointCloud& c) {
              c.fields.clear();
              c.point_step = 0;
            }).find("of point_step 0"),
            std::string::npos);
}

TEST(CloudColumns, AScanWithoutPoints) {
  PointCloud cloud = odd_cloud(false);
  cloud.width = 0;
  cloud.data.clear();
  const CloudColumns columns(cloud, "bag");
  EXPECT_EQ(columns.points(), 0U);
  EXPECT_TRUE(columns.values("x").empty());
  EXPECT_THROW((void)columns.column("doppler"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::messages
