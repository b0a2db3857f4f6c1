// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/state_archive.hpp"

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp {
namespace {

enum class Colour : std::uint8_t { kRed, kBlue };
constexpr Colour last_of(Colour /*any*/) { return Colour::kBlue; }

struct Part {
  double number = 0.0;
  bool flag = false;

  void state(StateArchive& archive) { archive(number, flag); }
};

struct Whole {
  bool flag = false;
  int count = 0;
  std::uint64_t large = 0;
  float small = 0.0F;
  Colour colour = Colour::kRed;
  std::string text;
  Stamp stamp;
  std::optional<double> maybe;
  std::optional<Part> part;
  std::pair<int, double> both;
  std::array<std::optional<int>, 2> some;
  std::vector<double> numbers;
  std::vector<std::vector<std::uint8_t>> lists;
  std::vector<Part> parts;
  std::map<Colour, std::vector<double>> by_colour;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Eigen::MatrixXd matrix;
  Eigen::VectorXd column;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();

  void state(StateArchive& archive) {
    archive(flag, count, large, small, colour, text, stamp, maybe, part, both, some, numbers, lists, parts, by_colour,
            vector, matrix, column, T);
  }
};

Whole example() {
  Whole whole;
  whole.flag = true;
  whole.count = -7;
  whole.large = 0xfedcba9876543210U;
  whole.small = 0.1F;
  whole.colour = Colour::kBlue;
  whole.text = std::string("a\0b", 3);
  whole.stamp = {1'724'479'779'384'729'506};
  whole.maybe = -0.0;
  whole.part = Part{1e-310, true};
  whole.both = {3, 0.25};
  whole.some = {std::nullopt, 5};
  whole.numbers = {1.0 / 3.0, 1e30, std::nextafter(1.0, 2.0)};
  whole.lists = {{1, 2, 3}, {}, {255}};
  whole.parts = {{1.0, true}, {2.0, false}};
  whole.by_colour = {{Colour::kBlue, {1.0}}, {Colour::kRed, {}}};
  whole.vector = {1.0, 2.0, 3.0};
  whole.matrix = Eigen::MatrixXd::Random(3, 5);
  whole.column = Eigen::VectorXd::Random(4);
  whole.T.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  whole.T.translation() = Eigen::Vector3d(1.0, -2.0, 3.0);
  return whole;
}

std::string written(Whole whole) {
  StateArchive archive;
  archive(whole);
  return archive.take();
}

Whole read(std::string_view bytes, Whole into = {}) {
  StateArchive archive(bytes);
  archive(into);
  archive.end();
  return into;
}

TEST(StateArchive, ReadsWhatItWrote) {
  const Whole whole = example();
  const Whole back = read(written(whole));
  EXPECT_EQ(back.flag, whole.flag);
  EXPECT_EQ(back.count, whole.count);
  EXPECT_EQ(back.large, whole.large);
  EXPECT_EQ(back.small, whole.small);
  EXPECT_EQ(back.colour, whole.colour);
  EXPECT_EQ(back.text, whole.text);
  EXPECT_EQ(back.stamp, whole.stamp);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(back.maybe.value()), std::bit_cast<std::uint64_t>(-0.0)) << "its sign, too";
  EXPECT_EQ(back.part.value().number, 1e-310);
  EXPECT_TRUE(back.part.value().flag);
  EXPECT_EQ(back.both, whole.both);
  EXPECT_EQ(back.some, whole.some);
  EXPECT_EQ(back.numbers, whole.numbers);
  EXPECT_EQ(back.lists, whole.lists);
  ASSERT_EQ(back.parts.size(), 2u);
  EXPECT_EQ(back.parts[1].number, 2.0);
  EXPECT_EQ(back.by_colour, whole.by_colour);
  EXPECT_EQ(back.vector, whole.vector);
  EXPECT_EQ(back.matrix, whole.matrix);
  EXPECT_EQ(back.column, whole.column);
  EXPECT_EQ(back.T.matrix(), whole.T.matrix());
}

TEST(StateArchive, RefusesWhatCannotBe) {
  const auto refusal = [](const auto& change) -> std::string {
    Whole whole = example();
    change(whole);
    try {
      (void)read(written(whole));
    } catch (const DataError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal([](Whole&) {}), "none");
  for (const double number : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(), 1e31}) {
    for (const auto& change : std::vector<std::function<void(Whole&)>>{
             [&](Whole& whole) { whole.maybe = number; }, [&](Whole& whole) { whole.numbers[1] = number; },
             [&](Whole& whole) { whole.matrix(2, 4) = number; }, [&](Whole& whole) { whole.both.second = number; }}) {
      EXPECT_NE(refusal(change).find("a number of it cannot be"), std::string::npos) << number;
    }
  }
  EXPECT_NE(refusal([](Whole& whole) { whole.small = std::numeric_limits<float>::infinity(); }).find("a number"),
            std::string::npos);
  EXPECT_NE(refusal([](Whole& whole) { whole.colour = static_cast<Colour>(2); }).find("a choice"), std::string::npos);
  EXPECT_NE(refusal([](Whole& whole) { whole.T.linear() *= 1.01; }).find("a pose"), std::string::npos);
  EXPECT_NE(refusal([](Whole& whole) { whole.T.matrix()(3, 3) = 2.0; }).find("a pose"), std::string::npos);
  EXPECT_NE(refusal([](Whole& whole) { whole.T.linear().col(0) *= -1.0; }).find("a pose"), std::string::npos)
      << "a reflection";
}

TEST(StateArchive, NumbersThatMayBeAnythingComeBack) {
  std::vector<float> numbers = {std::numeric_limits<float>::quiet_NaN(), -1.0F};
  StateArchive writing;
  writing.any_numbers(numbers);
  const std::string bytes = writing.take();
  std::vector<float> back;
  StateArchive reading(bytes);
  reading.any_numbers(back);
  reading.end();
  ASSERT_EQ(back.size(), 2U);
  EXPECT_TRUE(std::isnan(back[0]));
  EXPECT_EQ(back[1], -1.0F);
}

TEST(StateArchive, WhatIsRequiredIsAskedOfWhatIsRead) {
  StateArchive writing;
  EXPECT_NO_THROW(writing.require(false, "a test"));
  const std::string bytes = writing.take();
  StateArchive reading(bytes);
  EXPECT_NO_THROW(reading.require(true, "a test"));
  EXPECT_THROW(reading.require(false, "a test"), DataError);
}

TEST(StateArchive, ReplacesWhatWasThereBefore) {
  const Whole back = read(written(Whole{}), example());
  EXPECT_FALSE(back.flag);
  EXPECT_TRUE(back.text.empty());
  EXPECT_FALSE(back.maybe.has_value());
  EXPECT_FALSE(back.part.has_value());
  EXPECT_TRUE(back.lists.empty());
  EXPECT_TRUE(back.parts.empty());
  EXPECT_TRUE(back.by_colour.empty());
  EXPECT_EQ(back.matrix.size(), 0);
  EXPECT_EQ(written(back), written(Whole{}));
}

TEST(StateArchive, ElementsMayHaveNoDefault) {
  struct Named {
    explicit Named(int number) : id(number) {}
    int id;
    double value = 0.0;
  };
  std::vector<Named> named = {Named(1), Named(2)};
  named[1].value = 0.5;
  StateArchive writing;
  writing.each(named, Named(0), [&](Named& one) { writing(one.id, one.value); });
  const std::string bytes = writing.take();
  std::vector<Named> back = {Named(9)};
  StateArchive reading(bytes);
  reading.each(back, Named(0), [&](Named& one) { reading(one.id, one.value); });
  reading.end();
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[1].id, 2);
  EXPECT_EQ(back[1].value, 0.5);
}

TEST(StateArchive, EachDamagedByteAndEachCutIsFound) {
  const std::string bytes = written(example());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 1 << (at % 8));
    EXPECT_THROW(read(damaged), DataError) << at;
    EXPECT_THROW(read(bytes.substr(0, at)), DataError) << at;
  }
  EXPECT_THROW(read(bytes + '\0'), DataError);
}

int parts_made = 0;

struct CountedPart : Part {
  CountedPart() { ++parts_made; }
};

// The checksum of such bytes is right: 800 elements of nine bytes are said to be in 800 bytes.
TEST(StateArchive, MakesNoMoreElementsThanThereAreBytesFor) {
  StateArchive lying;
  std::string text(800, '\0');
  lying(text);
  const std::string bytes = lying.take();
  std::vector<CountedPart> parts;
  EXPECT_THROW(StateArchive{bytes}(parts), DataError);
  EXPECT_LE(parts_made, 800 / 9 + 1);
  Eigen::MatrixXd matrix;
  std::uint64_t rows = 100;
  lying(rows, text);
  const std::string wide = lying.take();
  EXPECT_THROW(StateArchive{wide}(matrix), DataError) << "100 x 800 numbers in 808 bytes";
  EXPECT_EQ(matrix.size(), 0);
}

// The checksum of such bytes is right.
TEST(StateArchive, ReadsNoMoreThanIsThereAndLeavesNothing) {
  StateArchive lying;
  std::uint64_t size = 1'000'000'000'000;
  lying(size);
  const std::string bytes = lying.take();
  std::vector<double> numbers;
  std::string text;
  Eigen::VectorXd column;
  EXPECT_THROW(StateArchive{bytes}(numbers), DataError);
  EXPECT_THROW(StateArchive{bytes}(text), DataError);
  EXPECT_THROW(StateArchive{bytes}(column), DataError);
  std::array<double, 2> two{};
  EXPECT_THROW(StateArchive{bytes}(two), DataError);
  StateArchive unread(bytes);
  EXPECT_THROW(unread.end(), DataError);
}

}  // namespace
}  // namespace dynamic_icp
