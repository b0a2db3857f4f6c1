// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::mapping {

/// Sums over points relative to an origin near them, so that nothing is lost to rounding. The moments of two sets add
/// up to those of both.
struct Moments {
  double weight = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();                           ///< sum of p, m
  Eigen::Matrix<double, 6, 1> second = Eigen::Matrix<double, 6, 1>::Zero();  ///< sum of xx, xy, xz, yy, yz, zz, m^2
  double phase = 0.0;  ///< sum of the phase of the sweep, 0 to 1, at which they were measured
  double scan = 0.0;   ///< sum of the numbers of their scans

  void add(const Eigen::Vector3d& point, double point_phase = 0.0, double point_scan = 0.0) {
    weight += 1.0;
    phase += point_phase;
    scan += point_scan;
    first += point;
    second[0] += point.x() * point.x();
    second[1] += point.x() * point.y();
    second[2] += point.x() * point.z();
    second[3] += point.y() * point.y();
    second[4] += point.y() * point.z();
    second[5] += point.z() * point.z();
  }

  /// Makes all points count `factor` times as much.
  void scale(double factor) {
    weight *= factor;
    phase *= factor;
    scan *= factor;
    first *= factor;
    second *= factor;
  }
};

/// How points err along the line of sight. A plane that is seen at a grazing angle tilts towards the beam: on the
/// ground the scatter of ranges looks like a slope.
struct RangeNoise {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, where the sensor is, in map axes
  double variance = 0.0;                               ///< m^2, of the range of a point
};

/// What counts as a plane.
struct PlaneRule {
  double min_points = 6.0;     ///< fewer (with forgetting: their weight) make no plane
  double max_flatness = 0.05;  ///< of smallest over middle eigenvalue of the scatter: more is no plane but a heap
  double min_width = 0.1;      ///< root of the middle eigenvalue over the edge of the cell: less is no plane but a line
};

ConfigFields fields(PlaneRule& rule);

/// A patch of surface: the plane fitted to points, with its uncertainty.
struct Plane {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();        ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();      ///< unit; the sign is arbitrary
  Eigen::Matrix3d tangential = Eigen::Matrix3d::Zero();  ///< 1/m^2: pseudo-inverse of the scatter within the plane
  double variance = 0.0;                                 ///< m^2, of one point across the plane: noise and roughness
  double points = 0.0;                                   ///< the weight of the points it was fitted to
  double bend = 0.0;                                     ///< m^2, of the surface across the plane, without noise
  double phase = 0.0;                                    ///< of the sweep, 0 to 1: the mean of the points
  double scan = 0.0;                                     ///< the number of their scan, the mean of the points

  /// Signed distance of a point, m.
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const { return normal.dot(point - mean); }

  /// Variance (m^2) of the height of the plane under a point, as of every least squares fit: it grows with the distance
  /// d from the mean, variance / points * (1 + d^T tangential d).
  [[nodiscard]] double height_variance(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d d = point - mean;
    return variance / points * (1.0 + d.dot(tangential * d));
  }
};

/// The plane through points with the given moments, relative to `origin`, in a cell with the edge `edge_m`: the scatter
/// without what the noise of ranges adds to it, S - variance b b^T with b the line of sight, has the normal as its
/// smallest axis. Nothing where the points make no plane.
std::optional<Plane> fit_plane(const Moments& moments, const Eigen::Vector3d& origin, double edge_m,
                               const PlaneRule& rule, const RangeNoise& noise = {});

}  // namespace dynamic_icp::mapping
