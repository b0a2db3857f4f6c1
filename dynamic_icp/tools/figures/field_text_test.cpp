// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_text.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::figures {
namespace {

/// How many places a terminal needs for a text in UTF-8.
std::size_t places(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Between the bars of a line of the picture.
std::string row_of(const std::vector<std::string>& lines, std::size_t row) {
  const std::string& line = lines.at(row + 1);
  const std::size_t begin = line.find('|') + 1;
  return line.substr(begin, line.rfind('|') - begin);
}

std::string repeated(const std::string& glyph, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    text += glyph;
  }
  return text;
}

/// No error, known to 5 mm/s, but 0.1 m/s in all as a rule.
FieldSummary nothing_wrong() {
  FieldSummary learned;
  learned.view = {-60.0, 40.0, -8.0, 16.0};
  learned.sizes = {0.1, 0.2, 0.005};
  learned.cells.error_mps = Eigen::MatrixXd::Zero(8, 48);
  learned.cells.sigma_mps = Eigen::MatrixXd::Constant(8, 48, 0.005);
  return learned;
}

TEST(FieldText, ShowsTheErrorAsTheSensorLooksOut) {
  FieldSummary learned = nothing_wrong();
  learned.cells.error_mps.topLeftCorner(2, 3).setConstant(0.14);       // the lowest elevations, to the right
  learned.cells.error_mps.bottomRightCorner(1, 5).setConstant(-0.14);  // the highest one, to the left
  learned.cells.error_mps(4, 24) = 0.05;
  learned.cells.error_mps(4, 23) = -0.09;
  const std::vector<std::string> lines = lines_of(field_text(learned));
  EXPECT_EQ(row_of(lines, 0), repeated("≡", 5) + repeated("·", 43));
  EXPECT_EQ(row_of(lines, 1), repeated("·", 48));
  EXPECT_EQ(row_of(lines, 3), repeated("·", 23) + "░=" + repeated("·", 23));
  EXPECT_EQ(row_of(lines, 6), repeated("·", 45) + repeated("█", 3));
  EXPECT_EQ(row_of(lines, 7), row_of(lines, 6));
}

TEST(FieldText, NamesDirectionsAndSizes) {
  FieldSummary learned = nothing_wrong();
  learned.cells.error_mps(0, 0) = -0.14;
  const std::string text = field_text(learned);
  const std::vector<std::string> lines = lines_of(text);
  ASSERT_EQ(lines.size(), 13U);
  EXPECT_NE(lines[1].find(" 14.5 |"), std::string::npos) << lines[1];
  EXPECT_NE(lines[8].find(" -6.5 |"), std::string::npos) << lines[8];
  EXPECT_EQ(lines[9].find("-60.0"), lines[8].find('|')) << text;
  EXPECT_EQ(lines[9].find("40.0") + 4, places(lines[8])) << text;
  EXPECT_NEAR(static_cast<double>(lines[9].find("-10.0")) + 2.5, 8.0 + 1.0 + 24.0, 0.5) << text;
  EXPECT_NE(lines[10].find("░ 2.0 to 6.0 "), std::string::npos) << text;
  EXPECT_NE(lines[10].find("█ 10.0 to 14.0"), std::string::npos) << text;
  EXPECT_NE(lines[11].find("≡ -10.0 to -14.0"), std::string::npos) << text;
  EXPECT_NE(lines[12].find("· below 2.0 "), std::string::npos) << text;
  EXPECT_NE(lines[12].find("? unknown: standard deviation above 10.0"), std::string::npos) << text;
  for (const std::string& line : lines) {
    EXPECT_LE(places(line), 78U) << line;
    EXPECT_NE(line.back(), ' ') << line;
  }
}

TEST(FieldText, KnowsNoNegativeZero) {
  FieldSummary learned = nothing_wrong();
  learned.view = {-60.02, 60.0, -8.0, 16.0};
  const std::string axis = lines_of(field_text(learned)).at(9);
  EXPECT_EQ(axis.find("-0.0"), std::string::npos) << axis;
  EXPECT_NE(axis.find(" 0.0 "), std::string::npos) << axis;
}

TEST(FieldText, LeavesOpenWhatIsNotKnown) {
  FieldSummary learned = nothing_wrong();
  learned.cells.error_mps(0, 0) = 0.07;
  learned.cells.error_mps(0, 47) = 5.0;
  learned.cells.sigma_mps(0, 47) = 0.11;  // more than the error is as a rule
  const std::string text = field_text(learned);
  EXPECT_EQ(row_of(lines_of(text), 7), "?" + repeated("·", 46) + "█") << "what is unknown does not stretch the scale";
  learned.sizes.rms_mps = 0.2;
  EXPECT_EQ(row_of(lines_of(field_text(learned)), 7), "█" + repeated("·", 47));
}

TEST(FieldText, SaysWhereNothingIsBeyondItsUncertainty) {
  FieldSummary learned = nothing_wrong();
  EXPECT_EQ(field_text(learned).find("everywhere"), std::string::npos);
  learned.sizes.rms_mps = 2e-4;
  const std::string text = field_text(learned);
  EXPECT_EQ(row_of(lines_of(text), 0), repeated("?", 48));
  EXPECT_NE(text.find("smaller than its standard deviation everywhere"), std::string::npos) << text;
}

TEST(FieldText, DoesNotBlowUpWhatIsNoError) {
  FieldSummary learned = nothing_wrong();
  learned.sizes.rms_mps = 1e-5;
  learned.cells.error_mps(0, 0) = 1e-4;
  learned.cells.sigma_mps.setConstant(9e-4);
  const std::string text = field_text(learned);
  EXPECT_EQ(row_of(lines_of(text), 7), repeated("·", 48));
  EXPECT_NE(text.find("█ 0.07 to 0.10"), std::string::npos) << text;
}

}  // namespace
}  // namespace dynamic_icp::figures
