// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/named_rows.hpp"

#include <cmath>
#include <map>

#include "dynamic_icp/recording/datasets/unclear_input.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::size_t kPoints = 60;

class Arrays final : public NamedColumns {
 public:
  explicit Arrays(std::map<std::string, formats::NpyArray> arrays) : arrays_(std::move(arrays)) {
    for (const auto& [name, array] : arrays_) {
      names_.push_back(name);
    }
  }
  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] formats::NpyArray read(const std::string& name) const override {
    if (!arrays_.contains(name)) {
      throw DataError(name);
    }
    return arrays_.at(name);
  }

 private:
  std::map<std::string, formats::NpyArray> arrays_;
  std::vector<std::string> names_;
};

/// Numbers of point i: of a ring of points, a strength and the Doppler at 5 m/s along x.
std::vector<float> numbers_of(std::size_t i) {
  const double angle = 0.1 * static_cast<double>(i);
  const double range = 5.0 + static_cast<double>(i % 7);
  return {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)),
          static_cast<float>(0.1 * static_cast<double>(i % 5)),
          static_cast<float>(0.01 * static_cast<double>(i * i % 89)),
          static_cast<float>(-5.0 * range * std::cos(angle) / std::hypot(range, 0.1 * static_cast<double>(i % 5)))};
}

/// These of the five numbers, as an array; one of them is a column of its own.
formats::NpyArray array(const std::vector<std::size_t>& which) {
  std::vector<float> values;
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (const std::size_t k : which) {
      values.push_back(numbers_of(i).at(k));
    }
  }
  return formats::npy_array<float>(
      which.size() == 1 ? std::vector<std::size_t>{kPoints} : std::vector<std::size_t>{kPoints, which.size()}, values);
}

std::vector<double> column(std::size_t k) {
  std::vector<double> values;
  for (std::size_t i = 0; i < kPoints; ++i) {
    values.push_back(numbers_of(i).at(k));
  }
  return values;
}

UnclearInput::Settings proposal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UnclearInput& error) {
    return error.proposal();
  }
  return {};
}

TEST(NamedRows, FourColumnsAreXyzAndDoppler) {
  const Arrays scan({{"points", array({0, 1, 2, 4})}});
  const ArrayReading reading = read_arrays_as(scan, {}, "a.npz");
  EXPECT_EQ(reading.rows.array, "points");
  EXPECT_EQ(reading.rows.names, (std::vector<std::string>{"x", "y", "z", "doppler"}));
  ASSERT_EQ(reading.assumptions.size(), 1U);
  const auto rows = with_rows(std::make_unique<Arrays>(scan), reading.rows);
  EXPECT_EQ(rows->names(), reading.rows.names);
  EXPECT_EQ(formats::column_as_doubles(rows->read("doppler")), column(4));
  EXPECT_EQ(formats::column_as_doubles(rows->read("y")), column(1));
}

TEST(NamedRows, TheFourthIsNoneWhereAnArrayHasTheNameOfADoppler) {
  const Arrays scan({{"points", array({0, 1, 2, 3})}, {"velocity", array({4})}});
  const ArrayReading reading = read_arrays_as(scan, {}, "a.npz");
  EXPECT_EQ(reading.rows.names, (std::vector<std::string>{"x", "y", "z", "points[3]"}));
  EXPECT_TRUE(reading.assumptions.empty());
}

TEST(NamedRows, ArraysWithoutNamesArePointsAndDoppler) {
  const Arrays scan({{"arr_0", array({0, 1, 2})}, {"arr_1", array({4})}});
  const ArrayReading reading = read_arrays_as(scan, {}, "a.npz");
  EXPECT_EQ(reading.fields.at("doppler"), "arr_1");
  ASSERT_EQ(reading.assumptions.size(), 1U);
}

TEST(NamedRows, WideArraysAreAsStated) {
  const Arrays scan({{"points", array({0, 1, 2, 3, 4})}});
  const UnclearInput::Settings proposal = {{"columns", "x,y,z,_,doppler"}};
  EXPECT_EQ(proposal_of([&] { read_arrays_as(scan, {}, "a.npz"); }), proposal);
  EXPECT_EQ(proposal_of([&] {
              read_arrays_as(scan, {.columns = {"x", "y", "z", "doppler", "_", "_"}}, "a.npz");
            }),
            proposal);
  const ArrayReading reading = read_arrays_as(scan, {.columns = {"x", "y", "z", "_", "doppler"}}, "a.npz");
  const auto rows = with_rows(std::make_unique<Arrays>(scan), reading.rows);
  EXPECT_EQ(rows->names(), (std::vector<std::string>{"x", "y", "z", "doppler"}));
  EXPECT_EQ(formats::column_as_doubles(rows->read("doppler")), column(4));
}

TEST(NamedRows, ColumnsWithNamesAreNotStatedByTheirOrder) {
  const Arrays scan({{"x", array({0})}, {"y", array({1})}, {"z", array({2})}, {"foo", array({4})}});
  EXPECT_THROW(read_arrays_as(scan, {.columns = {"x", "y", "z", "_", "doppler"}}, "a.npz"), UsageError);
  EXPECT_NO_THROW(read_arrays_as(scan, {.columns = {"x", "y", "z", "doppler"}}, "a.npz"));
}

TEST(NamedRows, UnknownNamesAreProposed) {
  const auto proposed = [](std::map<std::string, formats::NpyArray> arrays) {
    const Arrays scan(std::move(arrays));
    return proposal_of([&] { map_columns(scan, {}, "a.npz", {}); });
  };
  EXPECT_EQ(proposed({{"x", array({0})}, {"y", array({1})}, {"z", array({2})}, {"a", array({3})}, {"foo", array({4})}}),
            (UnclearInput::Settings{{"field.doppler", "foo"}}));
  EXPECT_EQ(proposed({{"cloud", array({0, 1, 2})}, {"bar", array({3})}, {"foo", array({4})}}),
            (UnclearInput::Settings{{"field.points", "cloud"}, {"field.doppler", "foo"}}));
  EXPECT_EQ(proposed({{"cloud", array({0, 1, 2, 3, 4})}}),
            (UnclearInput::Settings{{"field.points", "cloud"}, {"columns", "x,y,z,_,doppler"}}));
  EXPECT_EQ(proposed({{"posX", array({0})}, {"posY", array({1})}, {"posZ", array({2})}, {"foo", array({4})}}),
            (UnclearInput::Settings{
                {"field.x", "posX"}, {"field.y", "posY"}, {"field.z", "posZ"}, {"field.doppler", "foo"}}));
  // Without a column that may be one there is nothing to propose.
  const Arrays points({{"x", array({0})}, {"y", array({1})}, {"z", array({2})}});
  try {
    map_columns(points, {}, "a.npz", {});
    FAIL();
  } catch (const UnclearInput&) {
    FAIL() << "proposes what is not there";
  } catch (const DataError& error) {
    expect_within(error.what(), "there are: x, y, z");
  }
}

TEST(NamedRows, AnArrayThatIsNotThereIsSaid) {
  const Arrays scan({{"cloud", array({0, 1, 2, 4})}});
  expect_within(fault_of([&] {
                  read_arrays_as(scan, {.fields = {{"points", "clod"}}}, "a.npz");
                }),
                "a.npz: no array 'clod' for the points; there are: cloud");
  EXPECT_EQ(read_arrays_as(scan, {.fields = {{"points", "Cloud"}}}, "a.npz").rows.array, "cloud");
}

}  // namespace
}  // namespace dynamic_icp::datasets
