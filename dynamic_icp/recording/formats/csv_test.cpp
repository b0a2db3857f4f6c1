// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/csv.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

using Numbers = std::vector<double>;
using Names = std::vector<std::string>;

std::string csv_fault(const std::string& text) {
  try {
    (void)parse_csv(text, "a.csv");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Csv, DelimitersHeadersQuotesAndUnits) {
  const char* const texts[] = {"x,y,v [m/s]\n1,2.5,-3\n4,5,6\n", "\"x\";\"y\";\"v\"\r\n1;2.5;-3\r\n4;5;6\r\n",
                               "#x\ty\tv\n1\t2.5\t-3\n\n4\t5\t6",
                               "# any words that stand here\n# x y v\n 1  2.5 -3 \n4 5 6\n",
                               "\xEF\xBB\xBFx, y, v (m/s)\n1, 2.5, -3\n# a comment\n4, 5, 6\n"};
  for (const char* text : texts) {
    SCOPED_TRACE(text);
    const CsvTable table = parse_csv(text, "a.csv");
    EXPECT_EQ(table.names, (Names{"x", "y", "v"}));
    ASSERT_EQ(table.columns.size(), 3U);
    EXPECT_EQ(column_as_doubles(table.columns[1]), (Numbers{2.5, 5}));
    EXPECT_EQ(column_as_doubles(table.columns[2]), (Numbers{-3, 6}));
  }
}

TEST(Csv, WithoutHeader) {
  const CsvTable table = parse_csv("1 2\n3 nan\n", "a.csv");
  EXPECT_TRUE(table.names.empty());
  EXPECT_TRUE(std::isnan(column_as_doubles(table.columns.at(1)).at(1)));
  EXPECT_TRUE(parse_csv("# four words and more\n1 2\n", "a.csv").names.empty());
  EXPECT_TRUE(parse_csv("", "a.csv").columns.empty());
}

TEST(Csv, WholeNumbersStayExact) {
  const CsvTable table = parse_csv("t,v\n1724479779384729506,1\n1724479779384729507,1.5\n", "a.csv");
  EXPECT_EQ(column_as_integers(table.columns.at(0)),
            (std::vector<std::int64_t>{1724479779384729506, 1724479779384729507}));
  EXPECT_EQ(column_as_doubles(table.columns.at(1)), (Numbers{1, 1.5}));
}

TEST(Csv, EmptyCellsAreNoNumbers) {
  EXPECT_TRUE(std::isnan(column_as_doubles(parse_csv("x,y\n1,\n", "a.csv").columns.at(1)).at(0)));
}

TEST(Csv, WhatIsNoTableIsNamedWithItsLine) {
  EXPECT_EQ(csv_fault("x,y\n1,2,3\n"), "a.csv: line 1: 2 names, but the row after it has 3 numbers");
  EXPECT_EQ(csv_fault("1,2\n\n1\n"), "a.csv: line 3: 1 columns, expected 2 as in the first row");
  EXPECT_EQ(csv_fault("x,y\n1,2\n1,two\n"), "a.csv: line 3: column 2 is 'two', expected a number");
  EXPECT_EQ(csv_fault("x;y\n1,5;2\n"),
            "a.csv: line 2: column 1 is '1,5', expected a number with a decimal point (sed 's/,/./g')");
}

}  // namespace
}  // namespace dynamic_icp::formats
