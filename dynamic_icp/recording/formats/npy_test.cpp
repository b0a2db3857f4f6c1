// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npy.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

/// An NPY file put together by hand.
std::string npy(int version, const std::string& header, const std::string& data) {
  std::string file = std::string("\x93NUMPY") + static_cast<char>(version) + '\0';
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  for (std::size_t i = 0; i < length_bytes; ++i) {
    file += static_cast<char>(header.size() >> (8 * i) & 0xFFU);
  }
  return file + header + data;
}

std::string header(const std::string& descr, const std::string& shape, const std::string& fortran = "False") {
  return "{'descr': '" + descr + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }\n";
}

/// The message of the DataError that reading `content` throws.
std::string fault(const std::string& content) {
  try {
    const NpyArray array = parse_npy(content, "a.npy");
    column_as_doubles(array);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

void expect_fault(const std::string& content, const std::string& text) {
  const std::string message = fault(content);
  EXPECT_TRUE(message.starts_with("a.npy: ")) << message;
  EXPECT_NE(message.find(text), std::string::npos) << message;
}

TEST(Npy, ReadsEveryTypeInBothByteOrders) {
  // The number -2, or 2^n - 2 without sign.
  const std::string minus_two("\xfe\xff\xff\xff\xff\xff\xff\xff", 8);
  const std::string swapped("\xff\xff\xff\xff\xff\xff\xff\xfe", 8);
  for (const std::size_t size : {1U, 2U, 4U, 8U}) {
    const std::string code = std::to_string(size);
    const std::string little = minus_two.substr(0, size);
    const std::string big = swapped.substr(8 - size);
    const std::string prefix = size == 1 ? "|" : "<";
    EXPECT_EQ(column_as_integers(parse_npy(npy(1, header(prefix + "i" + code, "(1,)"), little), "a")).at(0), -2);
    EXPECT_EQ(column_as_integers(parse_npy(npy(1, header(">i" + code, "(1,)"), big), "a")).at(0), -2);
    const double largest = std::pow(2.0, 8.0 * static_cast<double>(size)) - 2.0;
    EXPECT_EQ(column_as_doubles(parse_npy(npy(1, header(prefix + "u" + code, "(1,)"), little), "a")).at(0), largest);
    EXPECT_EQ(column_as_doubles(parse_npy(npy(1, header(">u" + code, "(1,)"), big), "a")).at(0), largest);
  }
  const auto number = [](const std::string& descr, const std::string& data) {
    return column_as_doubles(parse_npy(npy(1, header(descr, "(1,)"), data), "a")).at(0);
  };
  EXPECT_EQ(number("<f4", std::string("\x00\x00\x50\xc0", 4)), -3.25);
  EXPECT_EQ(number(">f4", std::string("\xc0\x50\x00\x00", 4)), -3.25);
  EXPECT_EQ(number("<f8", std::string("\x00\x00\x00\x00\x00\x00\x0a\xc0", 8)), -3.25);
  EXPECT_EQ(number(">f8", std::string("\xc0\x0a\x00\x00\x00\x00\x00\x00", 8)), -3.25);
  EXPECT_EQ(number("|b1", "\x01"), 1.0);
  EXPECT_EQ(number("<f2", "\x80\xc2"), -3.25);
  EXPECT_EQ(number(">f2", "\xc2\x80"), -3.25);
}

TEST(Npy, ReadsEveryVersionAndStyleOfHeader) {
  const std::string data("\x05\x06", 2);
  for (const int version : {1, 2, 3}) {
    EXPECT_EQ(column_as_integers(parse_npy(npy(version, header("|u1", "(2,)"), data), "a")).at(1), 6) << version;
  }
  for (const char* text : {"{'shape': (2,), 'descr': '|u1', 'fortran_order': False}",
                           "{\"descr\":\"|u1\",\"fortran_order\":True,\"shape\":(2L,)}\n",
                           "  { 'fortran_order' : False , 'descr' : '|u1' , 'shape' : ( 2 , 1 ) , }          \n"}) {
    EXPECT_EQ(column_as_integers(parse_npy(npy(1, text, data), "a")), (std::vector<std::int64_t>{5, 6})) << text;
  }
}

TEST(Npy, BothOrdersOfIndicesGiveTheSameColumns) {
  // The matrix [1 2 3; 4 5 6].
  const NpyArray c = parse_npy(npy(1, header("|u1", "(2, 3)"), "\1\2\3\4\5\6"), "a");
  const NpyArray fortran = parse_npy(npy(1, header("|u1", "(2, 3)", "True"), "\1\4\2\5\3\6"), "a");
  EXPECT_EQ(fortran.bytes, c.bytes);
  EXPECT_EQ(rows_of(fortran), 2U);
  EXPECT_EQ(columns_of(fortran), 3U);
  EXPECT_EQ(column_as_integers(fortran, 2), (std::vector<std::int64_t>{3, 6}));
  // Three dimensions, items of two bytes: the element (i, j, k) of shape (2, 2, 2) is 4 i + 2 j + k.
  const std::string wide("\0\0\4\0\2\0\6\0\1\0\5\0\3\0\7\0", 16);
  EXPECT_EQ(parse_npy(npy(1, header("<u2", "(2, 2, 2)", "True"), wide), "a").bytes,
            std::string("\0\0\1\0\2\0\3\0\4\0\5\0\6\0\7\0", 16));
}

TEST(Npy, HalfFloatsBecomeFloats) {
  // The matrix [1 2; 3 4].
  const std::string numbers("\x00\x3c\x00\x40\x00\x42\x00\x44", 8);
  const std::string columns("\x00\x3c\x00\x42\x00\x40\x00\x44", 8);
  const NpyArray array = parse_npy(npy(1, header("<f2", "(2, 2)"), numbers), "a");
  EXPECT_EQ(array.type, NpyType::kFloat32);
  EXPECT_EQ(column_as_doubles(array, 1), (std::vector<double>{2.0, 4.0}));
  EXPECT_EQ(parse_npy(npy(1, header("<f2", "(2, 2)", "True"), columns), "a").bytes, array.bytes);
  EXPECT_EQ(column_as_doubles(parse_npy(npy_bytes(array), "a"), 0), (std::vector<double>{1.0, 3.0}));
  EXPECT_TRUE(parse_npy(npy(1, header("<f2", "(0, 3)"), ""), "a").bytes.empty());
  expect_fault(npy(1, header("<f2", "(2, 2)"), "1234567"), "expected 8 bytes of data for shape (2, 2) of f2, found 7");
  expect_fault(npy(1, header("<f2", "(9000000000000000000,)"), ""), "impossible shape");
  expect_fault(npy(1, header("|f2", "(1,)"), "12"), "has the type '|f2'");
}

TEST(Npy, EmptyArraysAreArrays) {
  EXPECT_TRUE(column_as_doubles(parse_npy(npy(1, header("<f4", "(0, 3)"), ""), "a"), 2).empty());
  EXPECT_TRUE(column_as_doubles(parse_npy(npy(1, header("<f4", "(0, 3)", "True"), ""), "a"), 2).empty());
  EXPECT_TRUE(column_as_doubles(parse_npy(npy(1, header("<f8", "(0,)"), ""), "a")).empty());
  EXPECT_EQ(parse_npy(npy(1, header("<f8", "()"), std::string(8, '\0')), "a").bytes.size(), 8U);
}

TEST(Npy, WhatIsNotAnArrayOfNumbersIsRefused) {
  expect_fault(npy(1, header("|O", "(2, 1)"), "pickled"), "holds Python objects");
  expect_fault(npy(1, "{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (1,)}", "12345678"),
               "table of records");
  expect_fault(npy(1, header("<U4", "(1,)"), std::string(16, 'x')), "has the type '<U4', expected one of f2 f4 f8");
  expect_fault(npy(1, header("|f4", "(1,)"), "1234"), "has the type '|f4'");
  expect_fault(npy(1, header("", "(1,)"), "1234"), "has the type ''");
  expect_fault("", "no NPY array");
  expect_fault("PK\x03\x04", "no NPY array");
}

TEST(Npy, LiesOfTheHeaderAreNoticed) {
  expect_fault(npy(1, header("<f4", "(3,)"), "12345678"), "expected 12 bytes of data for shape (3) of f4, found 8");
  expect_fault(npy(1, header("<f4", "(1,)"), "12345678"), "expected 4 bytes of data");
  expect_fault(npy(1, header("<f4", "(4611686018427387904, 2)"), "12345678"), "impossible shape");
  expect_fault(npy(1, header("<f8", "(2000000000000000000,)"), "12345678"), "expected 16000000000000000000 bytes");
  expect_fault(npy(1, header("<f4", "(99999999999999999999,)"), ""), "whole number");
  expect_fault(npy(1, header("<f4", "(-1,)"), ""), "expected a whole number that is not negative at byte");
  expect_fault(npy(4, header("<f4", "(1,)"), "1234"), "version 4, expected 1, 2 or 3");
  expect_fault(npy(1, "{'descr': '<f4', 'shape': (1,)}", "1234"), "has the keys descr shape, expected");
  expect_fault(npy(1, "{'descr': '<f4', 'shape': (1,), 'shape': (1,)}", "1234"), "has the keys");
  expect_fault(npy(1, "{'descr': '<f4', 'shape': (1,), 'order': 1}", "1234"), "expected descr");
  expect_fault(npy(1, header("<f4", "(1,)", "maybe"), "1234"), "True or False");
  expect_fault(npy(1, header("<f4", "(1,)") + "x", "1234"), "expected the end");
  expect_fault(npy(1, "{'descr': '<f4", ""), "the end of a string");
}

TEST(Npy, RowsWithoutColumnsTakeNoMemory) {
  const NpyArray array = parse_npy(npy(1, header("<f8", "(999999999999, 0)"), ""), "a.npy");
  EXPECT_THROW(column_as_doubles(array), DataError);
  EXPECT_THROW(column_as_integers(array), DataError);
}

TEST(Npy, EveryShortenedFileIsRefused) {
  for (const int version : {1, 2, 3}) {
    const std::string whole = npy(version, header("<f4", "(2, 1)"), "12345678");
    EXPECT_EQ(fault(whole), "no error");
    for (std::size_t size = 0; size < whole.size(); ++size) {
      expect_fault(whole.substr(0, size), "expected");
    }
  }
}

TEST(Npy, AccessIsChecked) {
  const NpyArray matrix = parse_npy(npy(1, header("<u8", "(1, 1)"), std::string(8, '\xff')), "a.npy");
  EXPECT_THROW(column_as_doubles(matrix, 1), DataError);
  EXPECT_THROW(column_as_integers(matrix), DataError) << "2^64 - 1 does not fit";
  EXPECT_THROW(column_as_integers(parse_npy(npy(1, header("<f4", "(1,)"), "1234"), "a")), DataError);
  EXPECT_THROW(column_as_integers(parse_npy(npy(1, header("<f4", "(0, 1)"), ""), "a"), 1), DataError);
  EXPECT_THROW(column_as_doubles(parse_npy(npy(1, header("|u1", "()"), "1"), "a")), DataError);
  EXPECT_THROW(column_as_doubles(parse_npy(npy(1, header("|u1", "(1, 1, 1)"), "1"), "a")), DataError);
  NpyArray torn = matrix;
  torn.bytes.pop_back();
  EXPECT_THROW(column_as_doubles(torn), std::invalid_argument);
  EXPECT_THROW(npy_bytes(torn), std::invalid_argument);
  EXPECT_THROW(npy_array<float>({2}, std::array{1.0F}), std::invalid_argument);
}

TEST(Npy, WritesTheDocumentedBytes) {
  const std::array<float, 6> values = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, -3.25F};
  const std::string bytes = npy_bytes(npy_array<float>({2, 3}, values));
  const std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
  ASSERT_EQ(bytes.size(), 128U + 24U);
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_EQ(bytes.substr(10, 118), text + std::string(118 - text.size() - 1, ' ') + "\n");
  EXPECT_EQ(bytes.substr(128 + 20), std::string("\x00\x00\x50\xc0", 4));
  EXPECT_NE(npy_bytes(npy_array<std::uint8_t>({1}, std::array<std::uint8_t, 1>{7}))
                .find("'|u1', 'fortran_order': "
                      "False, 'shape': (1,), }"),
            std::string::npos);
}

template <class Number>
void expect_return(const char* code) {
  const std::array<Number, 2> values = {std::numeric_limits<Number>::lowest(), Number{3}};
  const NpyArray array = parse_npy(npy_bytes(npy_array<Number>({2, 1}, values)), "a");
  EXPECT_EQ(code_of(array.type), code);
  EXPECT_EQ(column_as_doubles(array), (std::vector<double>{static_cast<double>(values[0]), 3.0})) << code;
}

TEST(Npy, EveryTypeComesBack) {
  expect_return<float>("f4");
  expect_return<double>("f8");
  expect_return<std::int8_t>("i1");
  expect_return<std::int16_t>("i2");
  expect_return<std::int32_t>("i4");
  expect_return<std::int64_t>("i8");
  expect_return<std::uint8_t>("u1");
  expect_return<std::uint16_t>("u2");
  expect_return<std::uint32_t>("u4");
  expect_return<std::uint64_t>("u8");
}

TEST(Npy, FilesAreNamedInFaults) {
  const fs::path path = fs::temp_directory_path() / ("npy_test-" + std::to_string(::getpid()) + ".npy");
  write_npy(path, npy_array<double>({1}, std::array{2.5}));
  EXPECT_EQ(column_as_doubles(read_npy(path)).at(0), 2.5);
  const auto message = [&](const std::string& content) -> std::string {
    write_whole_file(path, content);
    try {
      (void)read_npy(path);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_TRUE(message("nonsense").starts_with(path.string() + ": "));
  EXPECT_NE(message("version https://git-lfs.github.com/spec/v1\n").find("Git LFS pointer"), std::string::npos);
  fs::remove(path);
  EXPECT_THROW((void)read_npy(path), DataError);
}

}  // namespace
}  // namespace dynamic_icp::formats
