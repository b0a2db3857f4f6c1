// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/plain_rows.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/csv.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/formats/pcd_read.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"

namespace dynamic_icp::formats {
namespace {

/// The numbers of a row of three, and what is left of the text; no numbers where it is no plain row.
struct TakenRow {
  std::vector<double> numbers;
  std::string_view rest;
};

TakenRow take_three(std::string_view text, char delimiter) {
  TakenRow row{{0.0, 0.0, 0.0}, text};
  if (!take_plain_row(row.rest, delimiter, 3, [&](std::size_t k, const char* at, const char* end) {
        return take_number(at, end, row.numbers[k]);
      })) {
    row.numbers.clear();
  }
  return row;
}

TEST(PlainRows, NumbersBetweenDelimitersAndBlanks) {
  const std::array<std::pair<const char*, char>, 8> rows = {{{"1,-2.5,3e2\nrest", ','},
                                                             {" 1 ,\t-2.5 , 3e2 \r\nrest", ','},
                                                             {"1;-2.5;3e2\nrest", ';'},
                                                             {"1\t-2.5\t3e2\nrest", '\t'},
                                                             {" 1\t -2.5\t3e2\r\nrest", '\t'},
                                                             {"1 -2.5 3e2\nrest", ' '},
                                                             {"  1\t-2.5   3e2 \t\nrest", ' '},
                                                             {"1\f-2.5\v3e2\nrest", ' '}}};
  for (const auto& [text, delimiter] : rows) {
    SCOPED_TRACE(text);
    const TakenRow row = take_three(text, delimiter);
    EXPECT_EQ(row.numbers, (std::vector<double>{1.0, -2.5, 300.0}));
    EXPECT_EQ(row.rest, "rest");
  }
  EXPECT_EQ(take_three("1,2,3", ',').numbers.size(), 3U);  // the last line needs no end
  EXPECT_EQ(take_three("1,2,3", ',').rest, "");
}

TEST(PlainRows, WhatIsNoneIsLeft) {
  for (const char* text : {"", "\n1,2,3", "1,2\n3", "1,2,3,4\n", "1,2,3,\n", "1,,3\n", "1 2,3\n", "1,2,x\n", "1,2,3x\n",
                           "+1,2,3\n", "\"1\",2,3\n", "# 1,2,3\n", "1,2,1e999\n", "1,2,3 # far\n", "0x1,2,3\n"}) {
    SCOPED_TRACE(text);
    const TakenRow row = take_three(text, ',');
    EXPECT_TRUE(row.numbers.empty());
    EXPECT_EQ(row.rest, text);
  }
  for (const char* text : {"1 2\n3 4\n", "1 2 3 4\n", "1,2 3\n", "1 2 +3\n"}) {
    EXPECT_TRUE(take_three(text, ' ').numbers.empty()) << text;
  }
  EXPECT_TRUE(take_three("1\t\t3\n", '\t').numbers.empty());
}

const std::vector<std::string> kOddNumbers = {"0",
                                              "-0",
                                              "-0.0",
                                              "1.",
                                              ".5",
                                              "1e-40",
                                              "1e39",
                                              "4.9e-324",
                                              "nan",
                                              "-nan",
                                              "inf",
                                              "-INF",
                                              "infinity",
                                              "12345678901234567890",
                                              "0.1",
                                              "1E5",
                                              "2.2250738585072014e-308",
                                              "9007199254740993.0",
                                              "7.2057594037927933e16",
                                              "0.30000000000000004440892098500626161694526672363281"};

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }

/// Rows with a plus sign are no plain rows: both ways must read the same.
TEST(PlainRows, AreTheNumbersThatCellsAreInEveryFormat) {
  for (const std::string& number : kOddNumbers) {
    SCOPED_TRACE(number);
    const double expected = parse_number<double>(number).value();
    const std::string rows = fmt::format("{} 0.5\n{} +0.5\n", number, number);
    const CsvTable table = parse_csv("a b\n0.5 0.5\n" + rows, "a.csv");
    const PlyFile ply = parse_ply(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty double a\nproperty double b\nend_header\n" + rows, "a.ply");
    const PcdFile pcd("FIELDS a b\nSIZE 8 8\nTYPE F F\nPOINTS 2\nDATA ascii\n" + rows, "a.pcd");
    const std::vector<double> of_csv = column_as_doubles(table.columns.at(0));
    const std::vector<double> of_pcd = column_as_doubles(pcd.read("a"));
    for (std::size_t row = 0; row < 2; ++row) {
      EXPECT_EQ(bits_of(of_csv.at(row + 1)), bits_of(expected));
      EXPECT_EQ(bits_of(ply.elements.at(0).columns.at(0).values.at(row)), bits_of(expected));
      EXPECT_EQ(bits_of(of_pcd.at(row)), bits_of(expected));
    }
    const PcdFile narrow("FIELDS a b\nSIZE 4 4\nTYPE F F\nPOINTS 2\nDATA ascii\n" + rows, "a.pcd");
    const std::string bytes = narrow.read("a").bytes;
    EXPECT_EQ(bytes.substr(0, 4), bytes.substr(4));
  }
}

TEST(PlainRows, LinesAreCountedAcrossRowsOfAllKinds) {
  const std::string rows = "1 2\n+1 2\n\n3 4\n \n5 x\n";  // the sixth is wrong
  const auto fault = [](const auto& read) -> std::string {
    try {
      read();
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(fault([&] { (void)parse_csv(rows, "a.csv"); }), "a.csv: line 6: column 2 is 'x', expected a number");
  EXPECT_EQ(fault([&] { PcdFile("FIELDS a b\nSIZE 8 8\nTYPE F F\nPOINTS 4\nDATA ascii\n" + rows, "a.pcd"); }),
            "a.pcd: line 11: number 2 ('b') is no f8");
  EXPECT_EQ(fault([&] {
              (void)parse_ply(
                  "ply\nformat ascii 1.0\nelement vertex 4\nproperty double a\nproperty double b\nend_header\n" + rows,
                  "a.ply");
            }),
            "a.ply: line 12: value 2 ('b') is 'x', expected a number");
}

TEST(PlainRows, ColumnsOfATableHaveNoHalfRows) {
  // The first cell of the last rows is read before it shows that they are not plain.
  const CsvTable table = parse_csv("a,b\n1,2\n3,\n4,\"5\"\n6,+7\n8,9.5\n", "a.csv");
  EXPECT_EQ(column_as_integers(table.columns.at(0)), (std::vector<std::int64_t>{1, 3, 4, 6, 8}));
  const std::vector<double> b = column_as_doubles(table.columns.at(1));
  EXPECT_TRUE(b.at(1) != b.at(1));
  EXPECT_EQ(b.at(2) + b.at(3) + b.at(4), 21.5);
}

TEST(PlainRows, WholeNumbersOfATableStayWholeAsLongAsAllAre) {
  const CsvTable table = parse_csv("a,b,c\n1,1,9223372036854775807\n2,2.0,9223372036854775808\n", "a.csv");
  EXPECT_EQ(table.columns.at(0).type, NpyType::kInt64);
  EXPECT_EQ(table.columns.at(1).type, NpyType::kFloat64);
  EXPECT_EQ(table.columns.at(2).type, NpyType::kFloat64);
  EXPECT_EQ(column_as_doubles(table.columns.at(2)), (std::vector<double>{0x1p63, 0x1p63}));
}

TEST(PlainRows, TypesOfPropertiesAreChecked) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty uchar a\nend_header\n";
  EXPECT_EQ(parse_ply(head + "255\n0\n", "a.ply").elements.at(0).columns.at(0).values,
            (std::vector<double>{255.0, 0.0}));
  EXPECT_THROW((void)parse_ply(head + "255\n256\n", "a.ply"), DataError);
  EXPECT_THROW((void)parse_ply(head + "255\n0.5\n", "a.ply"), DataError);
  EXPECT_THROW((void)parse_ply(head + "255\nnan\n", "a.ply"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::formats
