// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_shape.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <tuple>

#include "dynamic_icp/recording/datasets/likely_doppler.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

using formats::NpyType;
using Row = std::vector<double>;
using Rows = std::vector<Row>;

constexpr double kQuiet_mps = 0.1;  // deviation of the Doppler

/// Points on the walls, floor and ceiling of a hall, ray by ray: rows from below to above, columns from right to left.
/// The sensor moves with velocity v.
Rows hall(const Eigen::Vector3d& v, int rows, int columns) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, kQuiet_mps);
  Rows all;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const double azimuth = -1.05 + 2.1 * column / (columns - 1);
      const double elevation = -0.15 + 0.3 * row / (rows - 1);
      const Eigen::Vector3d u(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                              std::sin(elevation));
      const Eigen::Vector3d to_wall(60.0, u.y() > 0 ? 7.0 : 12.0, u.z() > 0 ? 6.0 : 1.8);
      const double range = (to_wall.array() / u.array().abs()).minCoeff();
      all.push_back({range * u.x(), range * u.y(), range * u.z(), -u.dot(v) + noise(random)});
    }
  }
  return all;
}

template <class Number>
std::string records(const Rows& rows) {
  std::string bytes;
  for (const Row& row : rows) {
    for (const double value : row) {
      const auto number = static_cast<Number>(value);
      bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
    }
  }
  return bytes;
}

/// Rounded towards zero: normal numbers of IEEE 754 binary16.
std::string half_records(const Rows& rows) {
  Rows bits = rows;
  for (Row& row : bits) {
    for (double& value : row) {
      int exponent = 0;
      const double fraction = std::frexp(std::abs(value), &exponent);  // in [0.5, 1)
      value = (value < 0.0 ? 0x8000 : 0) +
              (value == 0.0 ? 0.0 : 1024.0 * (exponent + 14) + std::floor(2048.0 * fraction) - 1024.0);
    }
  }
  return records<std::uint16_t>(bits);
}

Rows each(Rows rows, const std::function<void(Row&, std::size_t)>& change) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    change(rows[i], i);
  }
  return rows;
}

/// Beams that see parts of the hall beside each other, and take turns.
Rows in_turns(const Rows& rows, std::size_t beams) {
  Rows result;
  const std::size_t of_each = rows.size() / beams;
  for (std::size_t i = 0; i < of_each; ++i) {
    for (std::size_t beam = 0; beam < beams; ++beam) {
      result.push_back(rows[beam * of_each + i]);
    }
  }
  return result;
}

class RecordShapes : public RecordingByHand {
 protected:
  [[nodiscard]] std::string doubt(const std::string& content) const {
    const auto other = other_shape({write("0.bin", content)}, 4, NpyType::kFloat32);
    return other ? other->what() : "";
  }

  void expect_trusted(const Rows& rows, const std::string& what) const {
    EXPECT_EQ(doubt(records<float>(rows)), "") << what;
  }

  void expect_proposed(const std::string& content, const UnclearInput::Settings& proposal) const {
    const auto other = other_shape({write("0.bin", content)}, 4, NpyType::kFloat32);
    ASSERT_TRUE(other.has_value());
    EXPECT_EQ(other->proposal(), proposal) << other->what();
  }
};

TEST_F(RecordShapes, SoundPointsAreTrusted) {
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(9, 0.5, 0), Eigen::Vector3d(0, 0, 0)}) {
    const Rows rows = hall(v, 20, 200);  // 64,000 bytes: records of 20, 32, 40 and 80 fit as well
    const std::string motion = v.isZero() ? "standing" : "moving";
    expect_trusted(rows, motion);
    for (const std::size_t count : {1U, 5U, 10U, 25U, 100U, 505U, 2000U}) {
      expect_trusted({rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count)}, motion + std::to_string(count));
    }
    for (const std::size_t beams : {2U, 3U, 4U, 5U, 8U}) {
      expect_trusted(in_turns(rows, beams), motion + " beams " + std::to_string(beams));
    }
    for (const double step : {0.05, 0.1, 0.5}) {
      expect_trusted(each(rows, [&](Row& row, std::size_t) { row[3] = step * std::round(row[3] / step); }),
                     motion + " quantised");
    }
    expect_trusted(each(rows,
                        [](Row& row, std::size_t) {
                          for (double& value : row) {
                            value = std::round(value);
                          }
                        }),
                   motion + " whole numbers");
    expect_trusted(each(rows, [](Row& row, std::size_t) { row[2] = 0.0; }), motion + " flat");
    expect_trusted(each(rows, [](Row& row, std::size_t) { row[3] = 0.0; }), motion + " without any Doppler");
    expect_trusted(each(rows, [](Row& row, std::size_t) { row[3] *= 1000.0; }), motion + " mm/s");
    expect_trusted(each(rows,
                        [](Row& row, std::size_t i) {
                          row = i % 5 == 0 ? Row{0, 0, 0, 0} : row;
                        }),
                   motion + " rays that met nothing");
    expect_trusted(
        each(rows, [](Row& row,
                      std::size_t i) { row = i % 2 == 0 ? Row(4, std::numeric_limits<double>::quiet_NaN()) : row; }),
        motion + " NaN");
    Rows shuffled = rows;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(2));
    expect_trusted(shuffled, motion + " in no order");
  }
}

TEST_F(RecordShapes, OtherRecordsAreProposed) {
  const Rows rows = hall({9, 0.5, 0}, 20, 200);
  const auto intensity = [](std::size_t i) { return 0.01 * static_cast<double>(i * i % 97); };
  const Rows five = each(rows, [&](Row& row, std::size_t i) { row.insert(row.begin() + 3, intensity(i)); });
  const Rows eight = each(rows, [&](Row& row, std::size_t i) {
    row = {row[0], row[1], row[2], 300.0 * intensity(i), 0.5, row[3], static_cast<double>(i % 4), 90.0};
  });
  expect_proposed(records<float>(five), {{"columns", "x,y,z,_,doppler"}});
  expect_proposed(records<float>(eight), {{"columns", "x,y,z,_,_,doppler,_,_"}});
  // As PCL pads its points: a one behind the coordinates, zeros behind the rest.
  for (const std::size_t numbers : {8U, 12U, 16U}) {
    const Rows padded = each(rows, [&](Row& row, std::size_t) {
      row = {row[0], row[1], row[2], 1.0, row[3]};
      row.resize(numbers, 0.0);
    });
    std::string columns = "x,y,z,_,doppler";
    for (std::size_t k = 5; k < numbers; ++k) {
      columns += ",_";
    }
    expect_proposed(records<float>(padded), {{"columns", columns}});
  }
  expect_proposed(records<double>(rows), {{"columns", "x,y,z,doppler"}, {"dtype", "float64"}});
  expect_proposed(records<double>(five), {{"columns", "x,y,z,_,doppler"}, {"dtype", "float64"}});
  EXPECT_EQ(other_shape({folder_ / "0.bin"}, 5, NpyType::kFloat64), std::nullopt);
}

TEST_F(RecordShapes, AFewFilesThatWereCutAreNoReasonToDoubt) {
  std::vector<std::filesystem::path> files;
  const std::string content = records<float>(hall({9, 0.5, 0}, 20, 200));
  for (std::size_t i = 0; i < 10; ++i) {
    files.push_back(write(std::to_string(i) + ".bin", content.substr(0, content.size() - (i == 3 ? 20 : 16 * i))));
  }
  EXPECT_EQ(other_shape(files, 4, NpyType::kFloat32), std::nullopt);
}

TEST(LikelyDoppler, IsTheColumnThatAVelocityExplains) {
  const Rows rows = hall({9, 0.5, 0}, 10, 100);
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<double>> columns(5);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d point(rows[i][0], rows[i][1], rows[i][2]);
    points.push_back(point);
    columns[0].push_back(std::atan2(point.y(), point.x()) * 57.29577951308232);
    columns[1].push_back(static_cast<double>(i % 10));
    columns[2].push_back(0.01 * static_cast<double>(i * i % 97));
    columns[3].push_back(i % 7 == 0 ? 12.5 : rows[i][3]);  // what moves by itself
    columns[4].push_back(1.5);
  }
  EXPECT_EQ(likely_doppler(points, columns), 3U);
  columns[3].assign(points.size(), 0.01);
  EXPECT_EQ(likely_doppler(points, columns), std::nullopt);
  EXPECT_EQ(likely_doppler({}, {}), std::nullopt);
}

TEST(LikelyDoppler, VelocityIsThatOfTheHall) {
  const Eigen::Vector3d v(9, 0.5, 0);
  std::vector<Eigen::Vector3d> points;
  std::vector<double> doppler;
  for (const Row& row : hall(v, 20, 200)) {
    points.emplace_back(row[0], row[1], row[2]);
    doppler.push_back(points.size() % 5 == 0 ? 20.0 : row[3]);
  }
  const auto found = likely_velocity(points, doppler);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((*found + v).norm(), 0.2) << found->transpose();
  EXPECT_EQ(likely_velocity({}, {}), std::nullopt);
}

TEST(LikelyDoppler, ProposesTheLastColumnWhereNoneIsLikely) {
  std::vector<std::vector<double>> columns(5, std::vector<double>(20, 1.5));
  EXPECT_EQ(proposed_columns(columns), "x,y,z,_,doppler");
  columns.resize(3);
  EXPECT_EQ(proposed_columns(columns), "x,y,z");
}

// Records of whole numbers, as embedded radars write them: each type holds these numbers exactly.
TEST_F(RecordShapes, TypesOfWholeNumbersAreReadAsStated) {
  const Rows rows = {{100, 20, 3, 7, 40}, {90, 120, 0, 8, 0}, {1, 2, 127, 9, 5}};
  const Rows negative = each(rows, [](Row& row, std::size_t) {
    row[1] = -row[1];
    row[4] = -row[4];
  });
  const std::tuple<const char*, std::string, const Rows*> types[] = {
      {"int8", records<std::int8_t>(negative), &negative},   {"uint8", records<std::uint8_t>(rows), &rows},
      {"int16", records<std::int16_t>(negative), &negative}, {"uint16", records<std::uint16_t>(rows), &rows},
      {"int32", records<std::int32_t>(negative), &negative}, {"uint32", records<std::uint32_t>(rows), &rows},
      {"float32", records<float>(negative), &negative},      {"float64", records<double>(negative), &negative}};
  for (const auto& [name, content, expected] : types) {
    write("0.bin", content);
    const auto dataset = open_dataset(folder_, {.columns = {"x", "y", "z", "_", "doppler"}, .dtype = name});
    const RawScan scan = dataset->scan(0);
    ASSERT_EQ(scan.points.size(), 3U) << name;
    for (std::size_t i = 0; i < 3; ++i) {
      const Row& row = (*expected)[i];
      EXPECT_EQ(scan.points[i], Eigen::Vector3d(row[0], row[1], row[2])) << name;
      EXPECT_EQ(scan.doppler[i], row[4]) << name;
    }
  }
}

// As a network on a graphics processor leaves them. Believed although the numbers repeat at the length of others.
TEST_F(RecordShapes, HalfFloatsAreReadAsStated) {
  const Rows points = hall({8.0, 0.5, 0.0}, 20, 60);
  const Rows rows = each(points, [](Row& row, std::size_t i) {
    row.insert(row.begin() + 3, {0.25 * static_cast<double>(i % 7), 1.0, 30.0, 2.0});
  });
  write("0.bin", half_records(rows));
  const std::vector<std::string> names = {"x", "y", "z", "intensity", "_", "_", "_", "doppler"};
  const auto dataset = open_dataset(folder_, {.columns = names, .dtype = "float16"});
  const RawScan scan = dataset->scan(0);
  ASSERT_EQ(scan.points.size(), points.size());
  const std::vector<PointColumn> columns = dataset->columns(0);
  ASSERT_EQ(columns.size(), 1U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double read[] = {scan.points[i].x(), scan.points[i].y(), scan.points[i].z(), scan.doppler[i]};
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(read[k], points[i][k], std::abs(points[i][k]) / 1024.0);
    }
    EXPECT_EQ(columns[0].values[i], 0.25 * static_cast<double>(i % 7));
  }
  EXPECT_EQ(scan.warning, "");
}

TEST_F(RecordShapes, FloatsAreNotReadAsHalfFloats) {
  write("0.bin", records<float>(each(hall({8.0, 0.5, 0.0}, 20, 60),
                                     [](Row& row, std::size_t) { row.insert(row.begin() + 3, 1.0); })));
  EXPECT_THROW(open_dataset(folder_, {.dtype = "float16"}), UnclearInput);
}

}  // namespace
}  // namespace dynamic_icp::datasets
