// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/body_terms.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

// A body is compared with where it was so many scans ago: the longer, the less the error of its surfaces counts. Fewer
// than the least say little, and how it is believed to move may still be far off.
constexpr std::size_t kScans = 8;
constexpr std::size_t kMinScans = 3;

// Its points, and the share of them that lie on surfaces of before: fewer, and these are others.
constexpr std::size_t kMinPoints = 30;
constexpr double kMinMatch = 0.75;

// What is seen of a body changes. Its surfaces are off by so much, all alike.
constexpr double kSurface_m = 0.03;
constexpr double kSurface_rad = 0.015;

// What all Doppler values of a body have in common.
constexpr double kCommonDoppler_mps = 0.02;

// No sensor errs by more: surfaces that say so are not those that were seen before.
constexpr double kMaxError_mps = 1.0;

constexpr double kBodyOmega_rad_s = 0.2;
constexpr double kBodyVelocity_mps = 3.0;

/// Of one body: sum of w phi phi^T over its Doppler, less C^T C, which its unknown motion takes away.
struct Comparison {
  BodyPath path;
  double w = 0.0;     ///< s^2/m^2
  Eigen::MatrixXd C;  ///< 6 x size of the field
  Eigen::VectorXd g;

  /// Of each scan in between are so many comparisons.
  [[nodiscard]] double share() const { return 1.0 / static_cast<double>(path.size() - 1); }

  /// Calls `use` with the Doppler since the first scan, and how the body was believed to move.
  template <typename Use>
  void each(const Use& use) const {
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      for (const BodyDoppler& one : path[k]->doppler) {
        use(*path[k], one);
      }
    }
  }
};

Matrix6d diagonal(double rotation, double translation) {
  Vector6d values;
  values << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(translation);
  return values.asDiagonal();
}

/// What surfaces say, known no better than they are seen, and what is known of any body.
BodyMotion with_limits(const BodyMotion& by_surfaces, double dt_s) {
  const Matrix6d A = by_surfaces.A + diagonal(std::pow(kBodyOmega_rad_s, -2.0), std::pow(kBodyVelocity_mps, -2.0));
  const Eigen::LDLT<Matrix6d> solver(A);
  const Matrix6d covariance = solver.solve(Matrix6d::Identity()) +
                              diagonal(std::pow(kSurface_rad / dt_s, 2.0), std::pow(kSurface_m / dt_s, 2.0));
  BodyMotion result;
  result.A = covariance.ldlt().solve(Matrix6d::Identity());
  result.b = result.A * solver.solve(by_surfaces.b);
  result.points = by_surfaces.points;
  return result;
}

std::optional<Comparison> compared(BodyPath path, const Eigen::VectorXd& theta, double point_sigma_mps,
                                   double max_noise_share, const Workers& workers) {
  const double dt_s = path.front()->time_s - path.back()->time_s;
  if (path.size() <= kMinScans || !(dt_s > 0.0)) {
    return std::nullopt;
  }
  const BodyMotion by_surfaces = motion_by_surfaces(path, max_noise_share, workers);
  const auto points = static_cast<double>(path.front()->points.size());
  if (path.front()->points.size() < kMinPoints || static_cast<double>(by_surfaces.points) < kMinMatch * points) {
    return std::nullopt;
  }
  const BodyMotion limited = with_limits(by_surfaces, dt_s);
  const Vector6d d = limited.A.ldlt().solve(limited.b);
  Comparison result;
  result.path = std::move(path);
  double count = 0.0;
  result.each([&](const SeenBody&, const BodyDoppler&) { count += 1.0; });
  result.w = 1.0 / (point_sigma_mps * point_sigma_mps + count * kCommonDoppler_mps * kCommonDoppler_mps);
  result.C = Eigen::MatrixXd::Zero(6, theta.size());
  result.g = Eigen::VectorXd::Zero(theta.size());
  Matrix6d A = limited.A;
  Vector6d b = limited.b;
  double error = 0.0;
  result.each([&](const SeenBody& body, const BodyDoppler& one) {
    Vector6d r;
    r << one.lever.cross(one.u), one.u;
    const double e = one.s - one.u.dot(body.velocity + body.omega.cross(one.lever)) - one.columns.dot(theta);
    error += (e - r.dot(d)) / count;
    A += result.w * r * r.transpose();
    b += (result.w * e) * r;
    for (std::size_t k = 0; k < one.columns.size; ++k) {
      const auto column = static_cast<Eigen::Index>(one.columns.index[k]);
      result.C.col(column) += (result.w * one.columns.value[k]) * r;
      result.g[column] -= result.w * e * one.columns.value[k];
    }
  });
  if (!(std::abs(error) < kMaxError_mps)) {
    return std::nullopt;
  }
  const Eigen::LLT<Matrix6d> root(A);
  result.g += result.C.transpose() * root.solve(b);
  root.matrixL().solveInPlace(result.C);
  return result;
}

void add(const Comparison& one, FieldInformation& sum) {
  const double w = one.share() * one.w;
  one.each([&](const SeenBody&, const BodyDoppler& doppler) {
    const FieldColumns& columns = doppler.columns;
    for (std::size_t i = 0; i < columns.size; ++i) {
      for (std::size_t j = 0; j < columns.size; ++j) {
        sum.H(static_cast<Eigen::Index>(columns.index[i]), static_cast<Eigen::Index>(columns.index[j])) +=
            w * columns.value[i] * columns.value[j];
      }
    }
  });
  sum.H.selfadjointView<Eigen::Lower>().rankUpdate(one.C.transpose(), -one.share());
  sum.g += one.share() * one.g;
}

}  // namespace

/// The body in the scans before, as long as each has it.
BodyPath BodyTerms::path_of(const SeenBody& now) const {
  BodyPath path = {&now};
  for (const std::vector<SeenBody>& scan : scans_) {
    const auto before = std::ranges::find(scan, now.id, &SeenBody::id);
    if (before == scan.end()) {
      break;
    }
    path.push_back(&*before);
  }
  return path;
}

std::optional<FieldInformation> BodyTerms::compare(std::vector<SeenBody> bodies, const Eigen::VectorXd& theta,
                                                   double point_sigma_mps, double max_noise_share,
                                                   const Workers& workers) {
  std::vector<std::optional<Comparison>> comparisons(bodies.size());
  workers.for_each(bodies.size(), 1, [&](std::size_t k) {
    comparisons[k] = compared(path_of(bodies[k]), theta, point_sigma_mps, max_noise_share, workers);
  });
  std::optional<FieldInformation> sum;
  for (const std::optional<Comparison>& one : comparisons) {
    if (one) {
      if (!sum) {
        sum = FieldInformation{Eigen::MatrixXd::Zero(theta.size(), theta.size()), Eigen::VectorXd::Zero(theta.size())};
      }
      add(*one, *sum);
    }
  }
  remember(std::move(bodies));
  return sum;
}

void BodyTerms::remember(std::vector<SeenBody> bodies) {
  std::erase_if(bodies, [](const SeenBody& body) { return body.points.size() < kMinPoints; });
  scans_.insert(scans_.begin(), std::move(bodies));
  scans_.resize(std::min(scans_.size(), kScans));
}

void BodyTerms::state(StateArchive& archive, std::size_t field_size) {
  archive.each(scans_, [&](std::vector<SeenBody>& scan) { archive(scan); });
  archive.require(scans_.size() <= kScans, "the moving bodies");
  for (const std::vector<SeenBody>& scan : scans_) {
    for (const SeenBody& body : scan) {
      for (const BodyDoppler& one : body.doppler) {
        const auto used = std::span(one.columns.index).first(one.columns.size);
        archive.require(std::ranges::all_of(used, [&](std::uint32_t column) { return column < field_size; }),
                        "the Doppler of a moving body");
      }
    }
  }
}

}  // namespace dynamic_icp::window
