// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/spherical_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/recording/datasets/unclear_input.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kRounding_rad = 1e-3;   // a turn may be written with few digits
constexpr double kClearlyWider = 1.5;    // the azimuth: sensors see further around than up and down
constexpr double kFarFromZ_share = 0.3;  // of half a turn; nothing looks so far up

/// The least and the greatest of one of the numbers of the points.
struct AngleSpan {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  [[nodiscard]] double width() const { return greatest - least; }
  [[nodiscard]] double largest() const { return std::max(std::abs(least), std::abs(greatest)); }
};

AngleSpan span_of(const std::vector<Eigen::Vector3d>& points, Eigen::Index column) {
  AngleSpan span;
  for (const Eigen::Vector3d& point : points) {
    if (std::isfinite(point[column])) {
      span.least = std::min(span.least, point[column]);
      span.greatest = std::max(span.greatest, point[column]);
    }
  }
  return span;
}

std::string_view ending_of(AngleUnit unit) { return unit == AngleUnit::kDegrees ? "deg" : "rad"; }

/// What says all of it: --field azimuth_deg=a --field elevation_deg=b
UnclearInput::Settings stating(const std::string& azimuth, const std::string& other, bool from_zenith, AngleUnit unit) {
  return {{fmt::format("field.azimuth_{}", ending_of(unit)), azimuth},
          {fmt::format("field.{}_{}", from_zenith ? "polar" : "elevation", ending_of(unit)), other}};
}

/// Whether an angle counts from z downwards; nothing where it may count up from the horizon as well.
std::optional<bool> counts_from_zenith(const AngleSpan& angle, AngleUnit unit) {
  const double half_turn = unit == AngleUnit::kDegrees ? 180.0 : std::numbers::pi;
  if (angle.least < 0.0) {
    return angle.least >= -0.5 * half_turn && angle.greatest <= 0.5 * half_turn ? std::optional(false) : std::nullopt;
  }
  return angle.least > kFarFromZ_share * half_turn && angle.greatest <= half_turn ? std::optional(true) : std::nullopt;
}

/// Tells which of theta and phi is the azimuth, and puts it first.
void settle_theta_phi(SphericalFields& fields, std::array<std::string, 3>& names,
                      const std::vector<Eigen::Vector3d>& points, AngleUnit unit, const std::string& origin) {
  const AngleSpan theta = span_of(points, 0);
  const AngleSpan phi = span_of(points, 1);
  const bool is_theta = theta.width() > kClearlyWider * phi.width();
  const bool is_phi = phi.width() > kClearlyWider * theta.width();
  const std::optional<bool> from_zenith = counts_from_zenith(is_theta ? phi : theta, unit);
  if (!(is_theta || is_phi) || !from_zenith) {
    throw UnclearInput(fmt::format("{}: has angles '{}' and '{}', which authors call by these names in either order",
                                   origin, names[0], names[1]),
                       stating(names[1], names[0], true, unit),
                       {stating(names[1], names[0], false, unit), stating(names[0], names[1], false, unit)});
  }
  fields.from_zenith = *from_zenith;
  fields.is_theta_phi = false;
  if (is_phi) {
    std::swap(names[0], names[1]);
  }
}

}  // namespace

Eigen::Vector3d from_spherical(double azimuth_rad, double elevation_rad, double range) {
  return {range * std::cos(elevation_rad) * std::cos(azimuth_rad),
          range * std::cos(elevation_rad) * std::sin(azimuth_rad), range * std::sin(elevation_rad)};
}

void make_cartesian(std::vector<Eigen::Vector3d>& points, const SphericalFields& fields) {
  const double unit_rad = fields.unit == AngleUnit::kDegrees ? std::numbers::pi / 180.0 : 1.0;
  for (Eigen::Vector3d& point : points) {
    const double second = unit_rad * point.y();
    point =
        from_spherical(unit_rad * point.x(), fields.from_zenith ? std::numbers::pi / 2.0 - second : second, point.z());
  }
}

std::string settle(SphericalFields& fields, std::array<std::string, 3>& names,
                   const std::vector<Eigen::Vector3d>& points, const std::string& origin) {
  const double largest = std::max(span_of(points, 0).largest(), span_of(points, 1).largest());
  const bool are_degrees = !points.empty() && std::isfinite(largest) && largest > kTurn_rad + kRounding_rad;
  const AngleUnit likely = fields.unit.value_or(are_degrees ? AngleUnit::kDegrees : AngleUnit::kRadians);
  if (fields.is_theta_phi) {
    settle_theta_phi(fields, names, points, likely, origin);
  }
  std::string sentence =
      fmt::format("columns '{}', '{}' and '{}' are taken as azimuth (from x ahead towards y on the left), {} and range",
                  names[0], names[1], names[2], fields.from_zenith ? "angle from z downwards" : "elevation");
  if (fields.unit) {
    return sentence;
  }
  if (!are_degrees) {
    throw UnclearInput(
        fmt::format("{}: columns '{}' and '{}' are angles of at most {:.2f}, and nothing says whether in "
                    "radians or degrees",
                    origin, names[0], names[1], std::isfinite(largest) ? largest : 0.0),
        stating(names[0], names[1], fields.from_zenith, AngleUnit::kRadians),
        {stating(names[0], names[1], fields.from_zenith, AngleUnit::kDegrees)});
  }
  fields.unit = AngleUnit::kDegrees;
  return sentence + fmt::format("; the angles, up to {:.0f}, are degrees", largest);
}

}  // namespace dynamic_icp::datasets
