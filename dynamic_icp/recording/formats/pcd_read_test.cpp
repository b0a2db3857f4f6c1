// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pcd_read.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"

namespace dynamic_icp::formats {
namespace {

using namespace std::string_literals;

template <class Number>
std::string bytes_of(Number value) {
  std::string bytes(sizeof(Number), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Number));
  return bytes;
}

PcdFile parse(const std::string& content) { return {content, "scan.pcd"}; }

std::string message(const std::string& content) {
  try {
    (void)parse(content);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const std::string& content, const std::string& part) {
  const std::string text = message(content);
  EXPECT_NE(text.find("scan.pcd: "), std::string::npos) << text;
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

/// What drivers write: x y z float32, padding, time int32, line uint8 twice, stamp uint64.
const std::string kMixedHeader =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z _ time line stamp\nSIZE 4 4 4 1 4 1 8\n"
    "TYPE F F F U I U U\nCOUNT 1 1 1 3 1 2 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

std::string mixed_record(float x, std::int32_t time, int line, std::uint64_t stamp) {
  return bytes_of(x) + bytes_of(2.0F) + bytes_of(-3.0F) + "pad" + bytes_of(time) +
         bytes_of(static_cast<std::uint8_t>(line)) + bytes_of(static_cast<std::uint8_t>(line + 1)) + bytes_of(stamp);
}

void expect_mixed(const PcdFile& file) {
  EXPECT_EQ(file.points(), 2u);
  EXPECT_EQ(file.names(), (std::vector<std::string>{"x", "y", "z", "time", "line", "stamp"}));
  EXPECT_EQ(column_as_doubles(file.read("x")), (std::vector<double>{1.5, -4.0}));
  EXPECT_EQ(column_as_doubles(file.read("z")), (std::vector<double>{-3.0, -3.0}));
  EXPECT_EQ(column_as_integers(file.read("time")), (std::vector<std::int64_t>{-7, 100'000'000}));
  EXPECT_EQ(file.read("line").shape, (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(column_as_integers(file.read("line"), 1), (std::vector<std::int64_t>{5, 201}));
  EXPECT_EQ(column_as_integers(file.read("stamp")),
            (std::vector<std::int64_t>{1'724'479'779'384'729'506, 1'724'479'779'384'729'507}));
}

TEST(PcdRead, BinaryRecordsOfAnyTypes) {
  expect_mixed(parse(kMixedHeader + "DATA binary\n" + mixed_record(1.5F, -7, 4, 1'724'479'779'384'729'506) +
                     mixed_record(-4.0F, 100'000'000, 200, 1'724'479'779'384'729'507)));
}

TEST(PcdRead, AsciiOfAnyTypes) {
  expect_mixed(parse(kMixedHeader + "DATA ascii\n1.5 2 -3 0 0 0 -7 4 5 1724479779384729506\r\n\n"
                                    "-4 2e0 -3.0 1 2 3 100000000 200 201 1724479779384729507\n"));
}

TEST(PcdRead, CompressedFieldByField) {
  const std::string columns =
      bytes_of(1.5F) + bytes_of(-4.0F) + bytes_of(2.0F) + bytes_of(2.0F) + bytes_of(-3.0F) + bytes_of(-3.0F) +
      "padpad" + bytes_of(std::int32_t{-7}) + bytes_of(std::int32_t{100'000'000}) + "\x04\x05\xc8\xc9" +
      bytes_of(std::uint64_t{1'724'479'779'384'729'506}) + bytes_of(std::uint64_t{1'724'479'779'384'729'507});
  std::string packed;
  for (std::size_t at = 0; at < columns.size(); at += 32) {
    const std::string part = columns.substr(at, 32);
    packed += static_cast<char>(part.size() - 1) + part;
  }
  const auto sizes = [&](std::uint32_t more) {
    return bytes_of(static_cast<std::uint32_t>(packed.size())) +
           bytes_of(static_cast<std::uint32_t>(columns.size()) + more);
  };
  const std::string header = kMixedHeader + "DATA binary_compressed\n";
  expect_mixed(parse(header + sizes(0) + packed));
  expect_message(header + "abc", "3 bytes after the header");
  expect_message(header + sizes(0) + packed.substr(1), "of compressed data, expected at most");
  expect_message(header + sizes(29) + packed, "expected 2 points of 29 bytes each");
  const std::string swapped = {0, 0, 0, static_cast<char>(packed.size())};  // as a big-endian machine writes it
  expect_message(header + swapped + swapped + packed, "of compressed data, expected at most");
  packed[0] = 0;
  expect_message(header + sizes(0) + packed, "damaged compressed data");
}

/// The content of a compressed file of one field of bytes.
std::string compressed(const std::string& packed, std::uint32_t points) {
  return fmt::format("FIELDS a\nSIZE 1\nTYPE U\nPOINTS {}\nDATA binary_compressed\n", points) +
         bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(points) + packed;
}

TEST(PcdRead, CompressedDataRepeatWhatWasBefore) {
  const auto unpacked = [](const std::string& packed, std::uint32_t points) {
    const std::vector<double> numbers = column_as_doubles(parse(compressed(packed, points)).read("a"));
    return std::string(numbers.begin(), numbers.end());
  };
  EXPECT_EQ(unpacked("", 0), "");
  // "abc", then 3 bytes (length field 1) from 3 bytes back (offset field 2).
  EXPECT_EQ(unpacked("\x02"s + "abc" + "\x20\x02", 6), "abcabc");
  // 8 bytes (length field 6) from 1 byte back, reaching into what is being written.
  EXPECT_EQ(unpacked("\x00"s + "a" + "\xc0\x00"s, 9), "aaaaaaaaa");
  // The long form: 7 + 250 + 2 bytes from 1 byte back.
  EXPECT_EQ(unpacked("\x00"s + "a" + "\xe0\xfa\x00"s, 260), std::string(260, 'a'));
}

TEST(PcdRead, DamagedCompressedDataAreErrors) {
  for (const std::string& packed : {"\x05"s + "ab", "\x20"s, "\xe0\x01"s, "\x20\x00"s, "\x00"s + "a" + "\x20\x01",
                                    "\x06"s + "abcdefg", "\x02"s + "abc"}) {
    expect_message(compressed(packed, 6), "damaged compressed data: they do not unpack to 6 bytes");
  }
  expect_message(compressed("\x00"s + "a", 1U << 30U), "cannot hold");
}

TEST(PcdRead, OldHeadersLackEntries) {
  const PcdFile file = parse(
      "FIELDS x y z v\nSIZE 4 4 4 8\nTYPE F F F F\nWIDTH 2\nHEIGHT 2\nDATA ascii\n"
      "1 2 3 4\nnan nan nan -1\n-inf 0 0 +1\n0 0 0 0");
  EXPECT_EQ(file.points(), 4u);
  const std::vector<double> x = column_as_doubles(file.read("x"));
  EXPECT_TRUE(std::isnan(x[1]));
  EXPECT_EQ(x[2], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(column_as_doubles(file.read("v")), (std::vector<double>{4, -1, 1, 0}));
  EXPECT_EQ(parse("FIELDS x\nSIZE 4\nTYPE F\nPOINTS 0\nDATA binary\n").points(), 0u);
}

TEST(PcdRead, WrongHeadersNameTheLine) {
  const auto with = [](const std::string& fields, const std::string& rest) {
    return "VERSION 0.7\nFIELDS " + fields + "\n" + rest + "DATA ascii\n";
  };
  expect_message("", "ends within the header");
  expect_message("hello\n", "line 1: 'hello'");
  expect_message("\x80\x81\x82"s + std::string(100, '\0') + "\n", "line 1: '???");
  expect_message(with("x y", "SIZE 4\nTYPE F F\nPOINTS 1\n"),
                 "line 3: SIZE has 1 words, expected one for each of the 2");
  expect_message(with("x", "SIZE 3\nTYPE F\nPOINTS 1\n"), "line 4: field 'x' has TYPE F and SIZE 3");
  expect_message(with("x", "SIZE 1\nTYPE F\nPOINTS 1\n"), "TYPE F and SIZE 1");
  expect_message(with("x", "SIZE 4\nPOINTS 1\n"), "no TYPE in the header");
  expect_message(with("x", "SIZE 4\nTYPE F\nCOUNT 0\nPOINTS 1\n"), "line 5: field 'x' has COUNT 0");
  expect_message(with("x", "SIZE 4\nTYPE F\nCOUNT 99999999\nPOINTS 1\n"), "line 5: more than");
  expect_message(with("x", "SIZE 4\nTYPE F\nPOINTS -1\n"), "line 5: POINTS is '-1'");
  expect_message(with("x", "SIZE 4\nTYPE F\nPOINTS 1\nPOINTS 1\n"), "line 6: POINTS for the second time");
  expect_message(with("x x", "SIZE 4 4\nTYPE F F\nPOINTS 1\n"), "line 2: field 'x' for the second time");
  expect_message(with("x", "SIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 3\nPOINTS 5\n"),
                 "line 5: WIDTH 2 and HEIGHT 3, expected 5");
  expect_message(with("x", "SIZE 4\nTYPE F\nWIDTH 9999999999\nHEIGHT 9999999999\n"), "expected fewer");
  expect_message(with("x", "SIZE 4\nTYPE F\n"), "no WIDTH in the header");
  expect_message("FIELDS x\nSIZE 4\nTYPE F\nPOINTS 1\nDATA rot13\n", "line 5: DATA is 'rot13'");
  expect_message("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n", "Git LFS pointer");
}

TEST(PcdRead, MoreFieldsThanAnyFileHasAreRefusedAtOnce) {
  const auto header = [](std::size_t fields) {
    std::string names = "FIELDS";
    std::string sizes = "\nSIZE";
    std::string types = "\nTYPE";
    for (std::size_t i = 0; i < fields; ++i) {
      names += fmt::format(" f{}", i);
      sizes += " 1";
      types += " U";
    }
    return names + sizes + types + "\nPOINTS 1\nDATA binary\n" + std::string(fields, 'x');
  };
  EXPECT_EQ(parse(header(1024)).names().size(), 1024U);
  expect_message(header(1025), "line 1: 1025 fields, expected at most 1024");
  expect_message(header(100'000), "line 1: 100000 fields");
}

TEST(PcdRead, CountsAreCheckedBeforeMemoryIsTaken) {
  const auto with = [](const std::string& points, const std::string& data) {
    return "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS " + points + "\nDATA " + data;
  };
  for (const std::string huge : {"3", "4000000000", "18446744073709551615"}) {
    expect_message(with(huge, "binary\n0123456701234567"), huge + " points of 8 bytes each after the header");
    expect_message(with(huge, "ascii\n1 2\n3 4\n"), huge + " points of 2 numbers each, expected at most 2");
    expect_message(with(huge, "binary_compressed\n\x02\0\0\0\x10\0\0\0\0a"s), "expected " + huge + " points");
  }
  expect_message(with("18446744073709551616", "binary\n"), "POINTS is");
}

TEST(PcdRead, WrongSizedDataAreErrors) {
  const auto with = [](const std::string& data) { return "FIELDS x y\nSIZE 4 4\nTYPE F U\nPOINTS 2\nDATA " + data; };
  expect_message(with("ascii\n1 2\n3\n   "), "line 7: 1 numbers, expected 2 for a point");
  expect_message(with("ascii\n1 2 4\n3 4\n"), "line 6: 3 numbers, expected 2");
  expect_message(with("ascii\n1 2\n       \n"), "ends after 1 points, expected 2");
  expect_message(with("ascii\n1 2\n3 4\n5 6\n"), "line 8: a point after the last one");
  expect_message(with("ascii\n1 2\n3 -4\n"), "line 7: number 2 ('y') is no u4");
  expect_message(with("ascii\n1 2\nx 4\n"), "line 7: number 1 ('x') is no f4");
  expect_message(with("binary\n" + std::string(24, 'a')), "8 bytes after the last of 2 points");
  EXPECT_NE(parse(with("binary\n" + std::string(19, 'a'))).warning().find("3 bytes after the last of 2 points"),
            std::string::npos);
  EXPECT_THROW((void)parse(with("binary\n" + std::string(16, 'a'))).read("z"), DataError);
}

/// An array of `rows` x `columns` random bytes of some type: any bits are numbers.
NamedArray random_array(const RandomSource& source, std::size_t rows, int number) {
  NamedArray column{fmt::format("field_{}", number), {}};
  column.array.type = static_cast<NpyType>(source.bits(0) % 10);
  column.array.shape = {rows};
  std::size_t columns = 1;
  if (source.uniform(1) < 0.3) {
    columns = 2 + source.bits(2) % 4;
    column.array.shape.push_back(columns);
  }
  for (std::size_t i = 0; i < rows * columns * size_of(column.array.type); ++i) {
    column.array.bytes.push_back(static_cast<char>(source.bits(10 + i)));
  }
  return column;
}

TEST(PcdRead, GivesBackWhatWasWrittenBitByBit) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const RandomSource source = RandomSource(7).fork(trial);
    const std::size_t rows = source.bits(0) % 20;
    std::vector<NamedArray> columns;
    const int fields = 1 + static_cast<int>(source.bits(1) % 6);
    for (int k = 0; k < fields; ++k) {
      columns.push_back(random_array(source.fork(static_cast<std::uint64_t>(k)), rows, k));
    }
    const PcdFile file = parse(pcd_bytes(columns));
    ASSERT_EQ(file.points(), rows);
    ASSERT_EQ(file.names().size(), columns.size());
    for (const NamedArray& column : columns) {
      const NpyArray read = file.read(column.name);
      EXPECT_EQ(read.type, column.array.type) << trial;
      EXPECT_EQ(read.shape, column.array.shape) << trial;
      EXPECT_EQ(read.bytes, column.array.bytes) << trial;
    }
  }
}

TEST(PcdRead, WrongTablesAreRefused) {
  const std::vector<float> two = {1, 2};
  const NamedArray x{"x", npy_array<float>({2}, two)};
  EXPECT_THROW(pcd_bytes({}), std::invalid_argument);
  EXPECT_THROW(pcd_bytes(std::vector<NamedArray>{x, x}), std::invalid_argument);
  EXPECT_THROW(pcd_bytes(std::vector<NamedArray>{x, {"y z", x.array}}), std::invalid_argument);
  EXPECT_THROW(pcd_bytes(std::vector<NamedArray>{x, {"y", npy_array<float>({1}, std::span(two).first(1))}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::formats
