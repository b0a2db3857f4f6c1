// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/doppler_error_field.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string_view>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kLines = 8;

DopplerCell cell_at(double azimuth, double elevation) {
  DopplerCell cell;
  cell.u =
      Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  cell.weight = 100.0;
  cell.points = 5.0;
  return cell;
}

/// All over the field of view of `sensors` sensors, 2 rad x 0.4 rad.
std::vector<DopplerCell> some_cells(std::size_t sensors = 1) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<DopplerCell> cells;
  for (std::size_t k = 0; k < 600; ++k) {
    DopplerCell cell = cell_at(uniform(random), 0.2 * uniform(random));
    cell.range_m = 40.0 + 35.0 * uniform(random);
    cell.intensity = 10.0 + 5.0 * uniform(random);
    cell.line = static_cast<std::uint16_t>(k % kLines);
    cell.face = static_cast<std::uint8_t>(k % 4);
    cell.sensor = static_cast<std::uint8_t>(k % sensors);
    cells.push_back(cell);
  }
  return cells;
}

const DopplerErrorField::Group& group(const DopplerErrorField& field, std::string_view name) {
  return *std::find_if(field.groups().begin(), field.groups().end(),
                       [&](const DopplerErrorField::Group& g) { return g.name == name && g.size() != 1; });
}

/// Zero but for one group.
template <class Value>
VectorXd theta_of(const DopplerErrorField& field, std::string_view name, const Value& value) {
  VectorXd theta = VectorXd::Zero(static_cast<Index>(field.size()));
  const DopplerErrorField::Group& g = group(field, name);
  for (std::size_t k = 0; k < g.size(); ++k) {
    theta[static_cast<Index>(g.begin + k)] = value(static_cast<double>(k));
  }
  return theta;
}

VectorXd random_vector(unsigned seed, std::size_t size) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(static_cast<Index>(size), [&] { return normal(random); });
}

TEST(DopplerErrorField, GroupsFollowEachOther) {
  for (const std::size_t sensors : {1U, 4U}) {
    for (const std::size_t faces : {1U, 4U}) {
      const DopplerErrorField field(some_cells(sensors), faces);
      std::size_t next = 0;
      for (const DopplerErrorField::Group& g : field.groups()) {
        EXPECT_EQ(g.begin, next) << g.name;
        next += g.size();
      }
      EXPECT_EQ(field.size(), next);
    }
  }
}

TEST(DopplerErrorField, LinesWithoutPointsLieWhereTheirNumbersPutThem) {
  std::vector<DopplerCell> cells;
  for (const std::uint16_t line : std::vector<std::uint16_t>{2, 3, 6}) {
    DopplerCell cell;
    const double elevation = 0.02 * line - 0.1;
    cell.u << std::cos(elevation), 0.0, std::sin(elevation);
    cell.line = line;
    cells.push_back(cell);
  }
  const std::vector<double> elevations = DopplerErrorField::shape_of(cells, 1).line_elevations_rad;
  ASSERT_EQ(elevations.size(), 7U);
  for (std::size_t line = 0; line < elevations.size(); ++line) {
    EXPECT_NEAR(elevations[line], 0.02 * static_cast<double>(line) - 0.1, 1e-12) << line;
  }
}

TEST(DopplerErrorField, ColumnsReproduceTheError) {
  for (const std::size_t sensors : {1U, 4U}) {
    const std::vector<DopplerCell> cells = some_cells(sensors);
    const DopplerErrorField field(cells, 4);
    const VectorXd theta = random_vector(2, field.size());
    for (const DopplerCell& cell : cells) {
      const FieldColumns columns = field.columns(cell);
      ASSERT_LE(columns.size, FieldColumns::kCapacity);
      VectorXd row = VectorXd::Zero(theta.size());
      std::set<std::uint32_t> seen;
      for (std::size_t k = 0; k < columns.size; ++k) {
        ASSERT_LT(columns.index[k], field.size());
        EXPECT_TRUE(seen.insert(columns.index[k]).second) << "twice";
        row[columns.index[k]] += columns.value[k];
      }
      EXPECT_NEAR(field.at(cell, theta), row.dot(theta), 1e-12);
    }
  }
}

TEST(DopplerErrorField, ConstantsOfDirectionsLinesAndFacesAreConstants) {
  const std::vector<DopplerCell> cells = some_cells();
  const DopplerErrorField field(cells, 4);
  for (const std::string_view name : {"azimuth", "cross", "line", "face"}) {
    const VectorXd ones = theta_of(field, name, [](double) { return 1.0; });
    for (const DopplerCell& cell : cells) {
      EXPECT_NEAR(field.at(cell, ones), 1.0, 1e-12) << name;
    }
  }
}

TEST(DopplerErrorField, AzimuthIsPiecewiseConstant) {
  const DopplerErrorField field(some_cells(), 1);
  const VectorXd steps = theta_of(field, "azimuth", [](double k) { return k; });
  const auto bins = static_cast<double>(group(field, "azimuth").size());
  // Bins of equal width that cover the field of view with little beside it.
  const double width = 2.0 / bins;
  std::set<double> values;
  for (double azimuth = -0.99; azimuth < 0.99; azimuth += 1e-3) {
    const double value = field.at(cell_at(azimuth, 0.1), steps);
    EXPECT_EQ(value, std::round(value));
    EXPECT_NEAR(value + 0.5, (azimuth + 1.0) / width, 2.0);
    EXPECT_EQ(value, field.at(cell_at(azimuth, -0.1), steps)) << "whatever the elevation";
    values.insert(value);
  }
  EXPECT_GE(values.size(), group(field, "azimuth").size() - 2);
  EXPECT_EQ(field.at(cell_at(3.0, 0.0), steps), bins - 1.0) << "beyond the field of view";
  EXPECT_EQ(field.at(cell_at(-3.0, 0.0), steps), 0.0);
}

TEST(DopplerErrorField, CrossIsBilinear) {
  // Values on a grid that is linear in both of its axes are linear in azimuth and elevation.
  const DopplerErrorField field(some_cells(), 1);
  const VectorXd plane =
      theta_of(field, "cross", [](double k) { return std::floor(k / 4.0) - 0.7 * std::fmod(k, 4.0); });
  const auto at = [&](double azimuth, double elevation) { return field.at(cell_at(azimuth, elevation), plane); };
  const double by_azimuth = (at(0.9, 0.0) - at(-0.9, 0.0)) / 1.8;
  const double by_elevation = (at(0.0, 0.15) - at(0.0, -0.15)) / 0.3;
  EXPECT_GT(by_azimuth, 1.0);
  EXPECT_LT(by_elevation, -1.0);
  for (double azimuth = -0.95; azimuth < 0.95; azimuth += 0.13) {
    for (double elevation = -0.19; elevation < 0.19; elevation += 0.031) {
      EXPECT_NEAR(at(azimuth, elevation), at(0.0, 0.0) + by_azimuth * azimuth + by_elevation * elevation, 1e-10);
    }
  }
}

TEST(DopplerErrorField, LinesAndFacesHaveTheirOwnConstants) {
  const DopplerErrorField field(some_cells(), 4);
  const VectorXd lines = theta_of(field, "line", [](double k) { return 10.0 + k; });
  const VectorXd faces = theta_of(field, "face", [](double k) { return 20.0 + k; });
  EXPECT_EQ(group(field, "line").size(), kLines);
  EXPECT_EQ(group(field, "face").size(), 4U);
  DopplerCell cell = cell_at(0.3, 0.1);
  cell.line = 5;
  cell.face = 2;
  EXPECT_NEAR(field.at(cell, lines), 15.0, 1e-12);
  EXPECT_NEAR(field.at(cell, faces), 22.0, 1e-12);
}

TEST(DopplerErrorField, VelocityLooksLikeAMotionOfTheSensor) {
  for (const std::size_t faces : {1U, 4U}) {
    const DopplerErrorField field(some_cells(), faces);
    const Vector3d velocity(0.3, -0.2, 0.1);
    const VectorXd theta = theta_of(field, "velocity", [&](double k) { return velocity[static_cast<Index>(k)]; });
    for (const DopplerCell& cell : some_cells()) {
      EXPECT_NEAR(field.at(cell, theta), -cell.u.dot(velocity), 1e-12);
    }
  }
}

TEST(DopplerErrorField, IsLinearInRangeAndIntensity) {
  const DopplerErrorField field(some_cells(), 1);
  const auto error = [&](double range_m, double intensity, std::size_t column) {
    DopplerCell cell = cell_at(0.1, 0.0);
    cell.range_m = range_m;
    cell.intensity = intensity;
    return field.at(cell, theta_of(field, "range and intensity",
                                   [&](double k) { return k == static_cast<double>(column) ? 1.0 : 0.0; }));
  };
  EXPECT_NEAR(error(60.0, 8.0, 0) - error(40.0, 8.0, 0), error(40.0, 8.0, 0) - error(20.0, 8.0, 0), 1e-12);
  EXPECT_NEAR(error(12.0, 8.0, 1) / error(7.0, 8.0, 1), error(17.0, 8.0, 1) / error(12.0, 8.0, 1), 1e-12);
  EXPECT_GT(error(1.0, 8.0, 1), 5.0 * error(50.0, 8.0, 1)) << "near the sensor only";
  EXPECT_NEAR(error(30.0, 12.0, 2) - error(30.0, 10.0, 2), error(30.0, 10.0, 2) - error(30.0, 8.0, 2), 1e-12);
  EXPECT_GT(error(30.0, 12.0, 2), error(30.0, 10.0, 2));
}

TEST(DopplerErrorField, ShortRangesErrByALittle) {
  const DopplerErrorField field(some_cells(), 1);
  for (const double near_mps : {-2.0, -0.05, 0.05, 2.0}) {
    const Eigen::VectorXd theta =
        theta_of(field, "range and intensity", [&](double k) { return k == 1.0 ? near_mps : 0.0; });
    EXPECT_NEAR(field.own_error(0, Vector3d::UnitX(), 10.0, 0.0, theta),
                std::clamp(near_mps, -0.1, 0.1) * std::exp(-1.0), 1e-12)
        << "more is what creeps near by";
  }
}

TEST(DopplerErrorField, PriorIsTheInverseOfTheScaledCorrelation) {
  DopplerErrorField field(some_cells(), 4);
  const auto n = static_cast<Index>(field.size());
  const VectorXd theta = 0.1 * random_vector(3, field.size());
  field.learn_scales(theta, MatrixXd::Zero(n, n), {});  // now scales differ
  MatrixXd covariance = MatrixXd::Zero(n, n);
  std::set<double> scales;
  for (const DopplerErrorField::Group& g : field.groups()) {
    const auto begin = static_cast<Index>(g.begin);
    EXPECT_LT((g.K.diagonal().array() - 1.0).abs().maxCoeff(), 1e-14) << "a correlation";
    covariance.block(begin, begin, g.K.rows(), g.K.rows()) = g.tau * g.tau * g.K;
    scales.insert(g.tau);
  }
  EXPECT_GT(scales.size(), 3U);
  const MatrixXd H_before = MatrixXd::Constant(n, n, 0.5);
  const VectorXd g_before = VectorXd::Constant(n, -0.25);
  MatrixXd H = H_before;
  VectorXd g = g_before;
  field.add_prior_information(H);
  field.add_prior_gradient(theta, g);
  EXPECT_LT(((H - H_before) * covariance - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((covariance * (g - g_before) - theta).norm(), 1e-8);
}

TEST(DopplerErrorField, NeighboursInAzimuthErrAlike) {
  // An exponential kernel: who knows a neighbour learns nothing from those behind it, so the inverse is tridiagonal.
  const DopplerErrorField field(some_cells(), 1);
  const DopplerErrorField::Group& azimuth = group(field, "azimuth");
  EXPECT_GT(azimuth.K(0, 1), 0.5);
  EXPECT_LT(azimuth.K(0, azimuth.K.rows() - 1), 0.05);
  for (Index i = 0; i < azimuth.K.rows(); ++i) {
    for (Index j = i + 2; j < azimuth.K.rows(); ++j) {
      EXPECT_NEAR(azimuth.inverse(i, j), 0.0, 1e-9);
    }
  }
}

TEST(DopplerErrorField, LearnsTheScaleOfWhatIsWellKnown) {
  DopplerErrorField field(some_cells(), 1);
  const auto n = static_cast<Index>(field.size());
  const double scale = 0.12;
  for (const std::string_view name : {"azimuth", "cross", "line"}) {
    const DopplerErrorField::Group& g = group(field, name);
    VectorXd part = dense::cholesky_root(g.K) * random_vector(4, g.size());
    part *= scale * std::sqrt(static_cast<double>(g.size()) / part.dot(g.inverse * part));
    VectorXd theta = VectorXd::Zero(n);
    theta.segment(static_cast<Index>(g.begin), part.size()) = part;
    field.learn_scales(theta, 1e-6 * MatrixXd::Identity(n, n), {});
    // theta^T K^-1 theta / n = scale^2, but for the one column that the prior counts like.
    const auto size = static_cast<double>(g.size());
    EXPECT_NEAR(g.tau, scale * std::sqrt(size / (size + 1.0)), 0.01 * scale) << name;
  }
}

TEST(DopplerErrorField, ScaleOfTheVelocityFollowsThatOfDirections) {
  DopplerErrorField field(some_cells(), 1);
  const auto n = static_cast<Index>(field.size());
  const VectorXd theta = theta_of(field, "azimuth", [](double k) { return 0.01 * std::sin(k); });
  field.learn_scales(theta, MatrixXd::Zero(n, n), {});
  const double once = group(field, "velocity").tau;
  field.learn_scales(3.0 * theta, MatrixXd::Zero(n, n), {});
  EXPECT_NEAR(group(field, "velocity").tau, 3.0 * once, 0.02 * once);
  EXPECT_GT(once, group(field, "azimuth").tau / 3.0);
}

TEST(DopplerErrorField, AVelocityThatAHiddenViewCannotShowMayBeLarger) {
  DopplerErrorField field(some_cells(), 1);
  const auto n = static_cast<Index>(field.size());
  const VectorXd theta = theta_of(field, "azimuth", [](double k) { return 0.01 * std::sin(k); });
  const auto tau = [&](double hidden) {
    field.learn_scales(theta, MatrixXd::Zero(n, n), std::vector<double>{hidden});
    return group(field, "velocity").tau;
  };
  // Two parts that do not depend on each other: their variances add up.
  const double seen = tau(0.0);
  const double added = tau(1.0) * tau(1.0) - seen * seen;
  EXPECT_NEAR(tau(0.5) * tau(0.5) - seen * seen, 0.25 * added, 1e-12);
  EXPECT_GT(added, 0.17 * 0.17) << "what a sensor in use showed for each axis at rest";
}

TEST(DopplerErrorField, FindsTheScaleBehindNoisyEstimates) {
  // An error drawn from the prior with another scale, measured with noise: the fixed point is the likeliest scale, to
  // the square root of 1 / (2 n) that 48 numbers leave, about a tenth.
  for (const double truth : {0.02, 0.15}) {
    DopplerErrorField field(some_cells(), 1);
    const auto n = static_cast<Index>(field.size());
    const VectorXd z = random_vector(5, field.size());
    const VectorXd noise = random_vector(6, field.size());
    const double sigma = 0.5 * truth;
    const DopplerErrorField::Group& g = group(field, "azimuth");
    const auto begin = static_cast<Index>(g.begin);
    const Index size = g.K.rows();
    const MatrixXd root = dense::cholesky_root(g.K);
    const VectorXd seen = truth * root * z.segment(begin, size) + sigma * noise.segment(begin, size);
    for (int k = 0; k < 60; ++k) {
      const MatrixXd posterior =
          (g.inverse / (g.tau * g.tau) + MatrixXd::Identity(size, size) / (sigma * sigma)).inverse();
      VectorXd theta = VectorXd::Zero(n);
      MatrixXd root_of_all = MatrixXd::Zero(n, n);
      theta.segment(begin, size) = posterior * seen / (sigma * sigma);
      root_of_all.block(begin, begin, size, size) = dense::cholesky_root(posterior);
      field.learn_scales(theta, root_of_all, {});
    }
    EXPECT_NEAR(g.tau, truth, 0.4 * truth);
  }
}

TEST(DopplerErrorField, EverySensorOfARigHasItsOwnColumns) {
  const std::vector<DopplerCell> cells = some_cells(4);
  const DopplerErrorField field(cells, 1);
  for (const std::string_view name : {"azimuth", "range and intensity", "velocity"}) {
    EXPECT_EQ(std::count_if(field.groups().begin(), field.groups().end(),
                            [&](const DopplerErrorField::Group& g) { return g.name == name; }),
              4)
        << name;
  }
  std::vector<std::set<std::uint32_t>> columns_of(4);
  for (const DopplerCell& cell : cells) {
    const FieldColumns columns = field.columns(cell);
    columns_of[cell.sensor].insert(columns.index.begin(), columns.index.begin() + columns.size);
  }
  std::set<std::uint32_t> all;
  std::size_t sum = 0;
  for (const std::set<std::uint32_t>& columns : columns_of) {
    EXPECT_FALSE(columns.empty());
    sum += columns.size();
    all.insert(columns.begin(), columns.end());
  }
  EXPECT_EQ(all.size(), sum) << "no column of two sensors";
}

TEST(DopplerErrorField, OfNoCellsIsFiniteAllTheSame) {
  const DopplerErrorField field({}, 1);
  EXPECT_GT(field.size(), 0U);
  const VectorXd theta = random_vector(7, field.size());
  EXPECT_TRUE(std::isfinite(field.at(cell_at(0.3, 0.1), theta)));
}

}  // namespace
}  // namespace dynamic_icp::window
