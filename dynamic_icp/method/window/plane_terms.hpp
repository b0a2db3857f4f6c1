// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/window/doppler_terms.hpp"
#include "dynamic_icp/method/window/plane_sums.hpp"
#include "dynamic_icp/method/window/principal_motions.hpp"
#include "dynamic_icp/method/window/spline_trajectory.hpp"

namespace dynamic_icp::window {

/// How points on planes are believed.
struct PlaneNoise {
  double min_sigma_m = 0.005;    ///< smallest standard deviation of a point from its plane
  double model_sigma_m = 0.003;  ///< of a patch from a plane: common to all points on it
  double repeated = 2.5;         ///< the same error of a patch comes again in so many scans
  double kernel = 4.0;           ///< Tukey: points beyond so many standard deviations have no weight
  double max_noise_share = 0.2;  ///< of the information about a motion that is the noise of normals: none is left
  Eigen::Vector2d pointing_variance = Eigen::Vector2d::Zero();  ///< rad^2, of azimuth and elevation of a whole scan
};

/// How well the points of a scan fit the planes.
struct PlaneQuality {
  std::size_t on_planes = 0;         ///< points with a patch
  double matched = 0.0;              ///< sum of the kernel's weights
  double rms_m = 0.0;                ///< of those
  Vector6d held = Vector6d::Ones();  ///< how much the noise of normals leaves of each principal motion, descending
  double share = 0.0;                ///< of the scan in the patches it meets, once it is added to them
  std::optional<double> model_sigma_m;
};

/// The last sweep, which the map has taken in.
struct LastSweep {
  double map_age = 0.0;                      ///< scans, by which the map's mean sweep is older than the last one
  Vector6d displacement = Vector6d::Zero();  ///< [rotation; position] since then, about the reference, its axes
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, 0);  ///< of it by the coefficients
};

/// The point-to-plane terms of one scan in continuous time:
///   e = n . (p(t) + R(t) x - m) - n . (d_p + d_phi x X) ,
/// each point at its own time t, with d the error of the map, a rigid displacement that changes with the phase of the
/// sweep at which the patch was measured (Layout::kMapNodes). A patch that is younger than the map errs as the last
/// sweep, by the share of its age: d = (1 - r) d_map + r d_last, r = 1 - age / age of the map. Sums of w m m^T, m = [X
/// x n; n], over slices of time stand for the points in all steps of the solution. An error of the stamp moves all
/// points along the motion of the sensor.
class PlaneTerms {
 public:
  /// `points` static and thinned; scan and map must outlive it.
  PlaneTerms(const Scan& points, const mapping::PlaneMap& map, double stamp_s, double slice_s, const Workers& workers);

  /// When the scan was taken, as it is known by now.
  void set_stamp(double stamp_s);

  /// From the next `associate` on.
  void set_last_sweep(LastSweep sweep) { last_ = std::move(sweep); }

  /// What past scans showed of the motions, about the reference, its axes; from the next `associate` on.
  void set_past_motions(const MotionInformation& past) { past_motions_ = past; }

  /// With those of this scan, at the last `associate`.
  [[nodiscard]] const MotionInformation& shown_motions() const { return shown_motions_; }

  /// The middle of each slice, s.
  [[nodiscard]] std::vector<double> slice_times() const;

  /// Moves the points by the trajectory, looks up their patches and sums their terms. `adapt` widens the kernel to
  /// the scatter of the residuals. `displacements`: for each slice the covariance of the displacement [rotation;
  /// position] of what it sees against the map, about the origin of the reference, by which the kernel is widened, too;
  /// empty: none.
  void associate(const SplineTrajectory& trajectory, const Eigen::VectorXd& map_error, const PlaneNoise& noise,
                 bool adapt, const std::vector<Matrix6d>& displacements = {});

  /// Adds the terms at the trajectory of the last `associate`; to the lower triangle of H.
  void add(const Layout& layout, Eigen::MatrixXd& H, Eigen::VectorXd& g) const;

  /// By how much the whole scan points elsewhere, [azimuth; elevation] (rad), given the other unknowns as they are; its
  /// variances given them, and how it changes with each of them.
  struct ScanPointing {
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    Eigen::Vector2d variance = Eigen::Vector2d::Zero();
    Eigen::MatrixXd by_unknowns;  ///< unknowns x 2
  };
  [[nodiscard]] ScanPointing scan_pointing(const Layout& layout) const;

  /// Fit at the last `associate`, and how far patches are from planes after the best rigid motion of the whole scan:
  /// a false pose is not taken for roughness.
  [[nodiscard]] PlaneQuality quality() const;

 private:
  /// What the points of a scan have in common: a displacement of the map, one of its last sweep, and the pointing.
  static constexpr int kCommon = 14;
  using CommonVector = Eigen::Matrix<double, kCommon, 1>;
  using CommonMatrix = Eigen::Matrix<double, kCommon, kCommon>;
  struct Row : PlaneRow {
    double own = 0.0;                                 ///< m^2, of the point
    double in_common = 0.0;                           ///< m^2, of all points on its patch: one value for all of them
    double expected = 0.0;                            ///< m^2, of the residual: both of them, and by the displacement
    double all = 0.0;                                 ///< m^2, as one of these points
    Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< m, from the origin of the reference, map axes
    const mapping::Patch* patch = nullptr;
  };
  struct Slice {
    std::size_t begin = 0;
    std::size_t end = 0;
    double time_s = 0.0;  ///< its middle
    TrajectoryPoint at;
    PlaneSums sums;
    Matrix6d noise = Matrix6d::Zero();  ///< sum of w Sigma_m by the noise of normals, about the reference, map axes
    double matched = 0.0;
    double squares = 0.0;
    std::size_t on_planes = 0;
  };

  void place(const SplineTrajectory& trajectory, const Eigen::VectorXd& map_error, const PlaneNoise& noise,
             Slice& slice);
  void sum(Slice& slice) const;
  /// What the terms have in common with the displacement of the map in this scan and with the pointing of the scan.
  struct Common {
    Eigen::MatrixXd U;  ///< unknowns x kCommon
    CommonVector gradient = CommonVector::Zero();
  };
  [[nodiscard]] Common common(const Layout& layout) const;
  [[nodiscard]] Eigen::Matrix<double, 12, 12> by_displacements(const PlaneSums& sums) const;
  /// Of the two displacements, from sums over m and over r m.
  template <typename Sum>
  [[nodiscard]] auto along_displacements(const Sum& all, const Sum& recent) const {
    Eigen::Matrix<double, 12, Sum::ColsAtCompileTime> result;
    result << motions_.transpose() * all, motions_.transpose() * recent;
    return result;
  }
  static void add_slice(const Slice& slice, const Layout& layout, Eigen::MatrixXd& H, Eigen::VectorXd& g);
  void add_last_sweep(const Layout& layout, Eigen::MatrixXd& H, Eigen::VectorXd& g) const;
  [[nodiscard]] double recent_share(const mapping::Plane& plane) const;
  [[nodiscard]] double independent_patches();
  void hold_motions(double max_noise_share);

  const Scan& scan_;
  const mapping::PlaneMap& map_;
  const Workers& workers_;
  double stamp_s_;
  LastSweep last_;
  std::vector<std::uint32_t> order_;  ///< rows of the scan by slice
  std::vector<Slice> slices_;
  std::vector<Row> rows_;                ///< in that order
  std::vector<std::uint64_t> found_in_;  ///< finest cell of each row
  std::vector<std::uint32_t> members_;   ///< points per patch
  std::vector<double> precision_;        ///< 1/m^2, of what is common to the points of a patch: their sum
  std::vector<double> normal_noise_;     ///< of each patch, what the noise of its normal adds
  std::vector<double> squares_;          ///< e^2 over the variance of each row on a patch
  Eigen::Matrix3d R_map_reference_ = Eigen::Matrix3d::Identity();
  Matrix6d motions_ = Matrix6d::Identity();  ///< the principal ones, columns [phi; p], reference frame
  Eigen::Vector2d pointing_variance_ = Eigen::Vector2d::Zero();
  double model_variance_ = 0.0;  ///< m^2, of a patch from a plane
  CommonMatrix common_information_ = CommonMatrix::Identity();
  MotionInformation past_motions_;
  MotionInformation shown_motions_;
  Vector6d held_ = Vector6d::Ones();
};

}  // namespace dynamic_icp::window
