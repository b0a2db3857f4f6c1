// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/ply.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

PlyFile ply_of(const std::string& content) { return parse_ply(content, "file.ply"); }

std::string ply_message(const std::string& content) {
  try {
    ply_of(content);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no DataError";
}

/// Bytes of a number as they stand in a file.
template <class Number>
std::string bytes(Number number, bool big_endian) {
  std::string text(sizeof(number), '\0');
  std::memcpy(text.data(), &number, sizeof(number));
  if (big_endian) {
    std::reverse(text.begin(), text.end());
  }
  return text;
}

constexpr const char* kAsciiHead =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty float x\nproperty uchar red\n";

TEST(Ply, ReadsAscii) {
  const PlyFile file =
      ply_of(std::string(kAsciiHead) +
             "element face 2\nproperty list uchar int vertex_indices\nproperty double area\nend_header\n"
             "1.5 255\n-2e3 0\n3 0 1 -7 0.25\n\n0 1\n");
  ASSERT_EQ(file.elements.size(), 2u);
  const PlyElement& vertex = *file.find("vertex");
  EXPECT_EQ(vertex.count, 2u);
  EXPECT_EQ(vertex.find("x")->values, (std::vector<double>{1.5, -2000.0}));
  EXPECT_EQ(vertex.find("red")->values, (std::vector<double>{255.0, 0.0}));
  EXPECT_EQ(vertex.find("red")->type, NpyType::kUint8);
  const PlyColumn& indices = *file.find("face")->find("vertex_indices");
  EXPECT_TRUE(indices.is_list);
  EXPECT_EQ(std::vector<double>(indices.list(0).begin(), indices.list(0).end()), (std::vector<double>{0.0, 1.0, -7.0}));
  EXPECT_TRUE(indices.list(1).empty());
  EXPECT_EQ(file.find("face")->find("area")->values, (std::vector<double>{0.25, 1.0}));
  EXPECT_EQ(file.find("edge"), nullptr);
  EXPECT_EQ(vertex.find("y"), nullptr);
}

TEST(Ply, ReadsEveryTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string content = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
                          "_endian 1.0\r\nelement e 1\r\nproperty char a\r\nproperty uint8 b\r\nproperty short c\r\n"
                          "property uint16 d\r\nproperty int e\r\nproperty uint32 f\r\nproperty float32 g\r\n"
                          "property double h\r\nproperty list ushort float64 i\r\nend_header\r\n";
    content += bytes<std::int8_t>(-100, big) + bytes<std::uint8_t>(200, big) + bytes<std::int16_t>(-30000, big) +
               bytes<std::uint16_t>(60000, big) + bytes<std::int32_t>(-2000000000, big) +
               bytes<std::uint32_t>(4000000000u, big) + bytes(1.25f, big) + bytes(0.1, big) +
               bytes<std::uint16_t>(2, big) + bytes(-0.3, big) + bytes(1e300, big);
    const PlyFile file = ply_of(content);
    const std::vector<double> expected = {-100.0, 200.0, -30000.0, 60000.0, -2e9, 4e9, 1.25, 0.1};
    const PlyElement& element = *file.find("e");
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(element.columns[i].values, std::vector<double>{expected[i]}) << element.columns[i].name;
    }
    EXPECT_EQ(element.find("i")->values, (std::vector<double>{-0.3, 1e300}));
    // Every truncation is found, and so is a byte too many.
    const std::size_t header = content.find("end_header") + 10;  // its line needs no end
    for (std::size_t size = 0; size < content.size(); ++size) {
      const std::string error = ply_message(content.substr(0, size));
      EXPECT_EQ(error.rfind("file.ply: ", 0), 0u) << size << ": " << error;
      EXPECT_EQ(error.find("line") == std::string::npos, size >= header) << size << ": " << error;
    }
    EXPECT_NE(ply_message(content + "x").find("1 bytes after the last record"), std::string::npos);
  }
}

TEST(Ply, ReadsEmptyElements) {
  const PlyFile file = ply_of("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n");
  EXPECT_EQ(file.find("vertex")->count, 0u);
  EXPECT_TRUE(file.find("vertex")->find("x")->values.empty());
}

TEST(Ply, ReadsFiles) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("ply_test-" + std::to_string(::getpid()) + ".ply");
  write_whole_file(path, std::string(kAsciiHead) + "end_header\n1 2\n3 4");
  EXPECT_EQ(read_ply(path).find("vertex")->find("x")->values, (std::vector<double>{1.0, 3.0}));
  std::filesystem::remove(path);
  EXPECT_THROW(read_ply(path), DataError);
}

TEST(Ply, ErrorsNameLineAndExpectation) {
  const std::string head(kAsciiHead);
  const std::vector<std::pair<std::string, std::vector<std::string>>> faults = {
      {"", {"line 1", "is no PLY"}},
      {"obj\n", {"line 1", "is no PLY"}},
      {"ply\nformat ascii 2.0\n", {"line 2", "is no PLY"}},
      {"ply\nformat text 1.0\n", {"line 2", "is no PLY"}},
      {"ply\nformat ascii 1.0\n", {"line 2", "end_header"}},
      {"ply\nformat ascii 1.0\nproperty float x\n", {"line 3", "before the first element"}},
      {head + "property float x\n", {"line 7", "'x'", "second time"}},
      {head + "element vertex 3\n", {"line 7", "'vertex'", "second time"}},
      {head + "element face many\n", {"line 7", "'many'", "whole number"}},
      {head + "element face -1\n", {"line 7", "'-1'"}},
      {head + "property real y\n", {"line 7", "'real'", "float32"}},
      {head + "property list float int y\n", {"line 7", "'float'", "whole-number type"}},
      {head + "vertex 3\n", {"line 7", "'vertex 3'", "element <name>"}},
      {head + "end_header\n1 2\n", {"2 records of element 'vertex'", "at most 1"}},
      {head + "end_header\n1 2   \n\n", {"line 9", "the file ends", "2 records"}},
      {head + "end_header\n1 2\n333\n", {"line 9", "'red' is missing"}},
      {head + "end_header\n1 2\n3 4 5\n", {"line 9", "3 values, expected 2"}},
      {head + "end_header\n1 2\n3 4\n5 6\n", {"4 bytes after the last record"}},
      {head + "end_header\n1 256\n3 4\n", {"line 8", "value 2 ('red') is '256'", "from 0 to 255"}},
      {head + "end_header\n1 0.5\n3 4\n", {"line 8", "'0.5'"}},
      {head + "end_header\n1 nan\n3 4\n", {"line 8", "'nan'"}},
      {head + "end_header\none 2\n3 4\n", {"line 8", "('x') is 'one'", "a number"}},
  };
  for (const auto& [content, parts] : faults) {
    const std::string error = ply_message(content);
    for (const std::string& part : parts) {
      EXPECT_NE(error.find(part), std::string::npos) << error << "\n lacks: " << part << "\n" << content;
    }
  }
}

TEST(Ply, MoreColumnsOrElementsThanAnyFileHasAreRefusedAtOnce) {
  const auto header = [](std::size_t elements, std::size_t columns) {
    std::string text = "ply\nformat ascii 1.0\n";
    for (std::size_t i = 0; i < elements; ++i) {
      text += "element e" + std::to_string(i) + " 0\n";
    }
    for (std::size_t i = 0; i < columns; ++i) {
      text += "property uchar p" + std::to_string(i) + "\n";
    }
    return text + "end_header\n";
  };
  EXPECT_EQ(ply_of(header(1024, 1024)).elements.back().columns.size(), 1024U);
  EXPECT_NE(ply_message(header(1025, 1)).find("line 1027: more than 1024 elements"), std::string::npos);
  EXPECT_NE(ply_message(header(1, 1025)).find("line 1028: element 'e0' has more than 1024 properties"),
            std::string::npos);
  EXPECT_NE(ply_message(header(100'000, 1)).find("more than 1024 elements"), std::string::npos);
}

TEST(Ply, LyingCountsTakeNoMemory) {
  for (const char* format : {"ascii", "binary_little_endian"}) {
    const std::string head = std::string("ply\nformat ") + format + " 1.0\nelement vertex ";
    const std::string tail = "\nproperty float x\nend_header\n1 2 3 4\n";
    EXPECT_NE(ply_message(head + "1000000000000000000" + tail).find("expected at most"), std::string::npos);
    EXPECT_NE(ply_message(head + "18446744073709551615" + tail).find("expected at most"), std::string::npos);
    EXPECT_NE(ply_message(head + "18446744073709551616" + tail).find("whole number"), std::string::npos);
    EXPECT_NE(ply_message(head + "5\nend_header\n").find("expected at most 0"), std::string::npos);
  }
  const std::string list =
      "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list int double i\nend_header\n";
  EXPECT_NE(ply_message(list + bytes<std::int32_t>(2000000000, false)).find("record 1 of element 'face'"),
            std::string::npos);
  EXPECT_NE(ply_message(list + bytes<std::int32_t>(-1, false)).find("'i' has -1 values"), std::string::npos);
  EXPECT_NE(ply_message("ply\nformat ascii 1.0\nelement face 1\nproperty list int int i\nend_header\n4294967295 0\n")
                .find("'i' is missing"),
            std::string::npos);
}

constexpr const char* kPointsEnd = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";

TEST(PlyPoints, AnEmptyCloudIsAFileWithoutRecords) {
  const std::string content = ply_bytes(point_table({}));
  EXPECT_EQ(content, std::string("ply\nformat binary_little_endian 1.0\nelement vertex 0") + kPointsEnd);
  EXPECT_EQ(ply_of(content).find("vertex")->count, 0u);
}

// x = 1, y = -2, z = 0.5 as IEEE 754 has them, lowest byte first.
TEST(PlyPoints, TheBytesAreThoseOfTheFormat) {
  const std::string record("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 12);
  EXPECT_EQ(ply_bytes(point_table(std::vector<Eigen::Vector3d>{{1.0, -2.0, 0.5}})),
            std::string("ply\nformat binary_little_endian 1.0\nelement vertex 1") + kPointsEnd + record);
}

TEST(PlyPoints, TheReaderFindsEveryPoint) {
  const PlyFile file =
      ply_of(ply_bytes(point_table(std::vector<Eigen::Vector3d>{{1.25, -2.0, 0.5}, {1e-3, 4e4, -0.1}})));
  ASSERT_EQ(file.elements.size(), 1u);
  const PlyElement& vertex = *file.find("vertex");
  const auto rounded = [](float a, float b) { return std::vector<double>{a, b}; };
  EXPECT_EQ(vertex.columns.size(), 3u);
  EXPECT_EQ(vertex.find("x")->values, rounded(1.25f, 1e-3f));
  EXPECT_EQ(vertex.find("y")->values, rounded(-2.0f, 4e4f));
  EXPECT_EQ(vertex.find("z")->values, rounded(0.5f, -0.1f));
  EXPECT_EQ(vertex.find("z")->type, NpyType::kFloat32);
}

TEST(PlyPoints, RefusesNumbersThatAreNotFinite) {
  constexpr double kHuge = 1e39;  // a double, but no float32
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), kHuge}) {
    EXPECT_THROW(ply_bytes(point_table(std::vector<Eigen::Vector3d>{{0.0, bad, 0.0}})), std::invalid_argument) << bad;
  }
}

TEST(PlyTable, KeepsTypesAndBits) {
  const std::vector<float> x = {1.5F, std::numeric_limits<float>::quiet_NaN()};
  const std::vector<double> y = {0.1, -2e300};
  const std::vector<std::uint8_t> line = {7, 255};
  const std::vector<std::int32_t> time = {-1, 100'000'000};
  const std::vector<NamedArray> columns = {{"x", npy_array<float>({2}, x)},
                                           {"y", npy_array<double>({2}, y)},
                                           {"line", npy_array<std::uint8_t>({2}, line)},
                                           {"time", npy_array<std::int32_t>({2}, time)}};
  std::string expected =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty double y\n"
      "property uchar line\nproperty int time\nend_header\n";
  for (std::size_t i = 0; i < 2; ++i) {
    expected.append(reinterpret_cast<const char*>(&x[i]), 4).append(reinterpret_cast<const char*>(&y[i]), 8);
    expected.append(reinterpret_cast<const char*>(&line[i]), 1).append(reinterpret_cast<const char*>(&time[i]), 4);
  }
  EXPECT_EQ(ply_bytes(columns), expected);
  const PlyFile file = parse_ply(expected, "scan.ply");
  EXPECT_EQ(file.find("vertex")->find("y")->values, y);
  EXPECT_EQ(file.find("vertex")->find("line")->type, NpyType::kUint8);
  EXPECT_TRUE(std::isnan(file.find("vertex")->find("x")->values[1]));
}

TEST(PlyTable, RefusesWhatPlyCannotHold) {
  const std::vector<std::int64_t> big = {1};
  const NamedArray wide{"t", npy_array<std::int64_t>({1}, big)};
  EXPECT_THROW(ply_bytes(std::vector<NamedArray>{wide}), std::invalid_argument);
  EXPECT_THROW(ply_bytes({}), std::invalid_argument);
  const std::vector<float> two = {1, 2};
  const NamedArray x{"x", npy_array<float>({2}, two)};
  EXPECT_THROW(ply_bytes(std::vector<NamedArray>{x, x}), std::invalid_argument);
  EXPECT_THROW(ply_bytes(std::vector<NamedArray>{{"x", npy_array<float>({1, 2}, two)}}), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::formats
