// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/step_equations.hpp"

#include <array>
#include <cmath>

namespace dynamic_icp::registration {
namespace {

using simd::LaneMask;
using simd::Lanes;

// No arrays and loops here: lanes in an array go through memory.
struct Vector {
  Lanes x;
  Lanes y;
  Lanes z;
};

DYNAMIC_ICP_INLINE void load(Vector& v, const SourceRows::Vectors& from) {
  simd::load(v.x, from[0].data());
  simd::load(v.y, from[1].data());
  simd::load(v.z, from[2].data());
}

DYNAMIC_ICP_INLINE void dot(Lanes& result, const Vector& a, const Vector& b) {
  result = (a.x * b.x + a.y * b.y) + a.z * b.z;
}

DYNAMIC_ICP_INLINE void cross(Vector& result, const Vector& a, const Vector& b) {
  result.x = a.y * b.z - a.z * b.y;
  result.y = a.z * b.x - a.x * b.z;
  result.z = a.x * b.y - a.y * b.x;
}

/// Tukey's weight, zero where the mask is 0. Of an infinite scale it is 1.
DYNAMIC_ICP_INLINE void tukey(Lanes& weight, const Lanes& e, double scale, const LaneMask& mask) {
  const Lanes ratio = e / scale;
  const Lanes inside = 1.0 - ratio * ratio;
  weight = inside * inside;
  simd::keep_where(weight, mask & (inside > 0.0));
}

/// The sums of one block, a lane each.
struct LaneSums {
  std::array<Lanes, 6> rotation{};     // lower triangle of H, column by column
  std::array<Lanes, 9> mixed{};        // its lower left block, row by row
  std::array<Lanes, 6> translation{};  // lower triangle
  std::array<Lanes, 3> rotation_b{};
  std::array<Lanes, 3> translation_b{};
  Lanes squared{};
  LaneMask pairs{};

  /// Jacobian [c; 0].
  DYNAMIC_ICP_INLINE void add_rotation(const Vector& c, const Lanes& e, const Lanes& weight) {
    const Vector weighted{weight * c.x, weight * c.y, weight * c.z};
    add(rotation_b, weighted, e);
    add_triangle(rotation, weighted, c);
  }

  /// The rest of Jacobian [c; n].
  DYNAMIC_ICP_INLINE void add_translation(const Vector& c, const Vector& n, const Lanes& e, const Lanes& weight) {
    const Vector weighted{weight * n.x, weight * n.y, weight * n.z};
    add(translation_b, weighted, e);
    add_triangle(translation, weighted, n);
    mixed[0] += weighted.x * c.x;
    mixed[1] += weighted.x * c.y;
    mixed[2] += weighted.x * c.z;
    mixed[3] += weighted.y * c.x;
    mixed[4] += weighted.y * c.y;
    mixed[5] += weighted.y * c.z;
    mixed[6] += weighted.z * c.x;
    mixed[7] += weighted.z * c.y;
    mixed[8] += weighted.z * c.z;
  }

  static DYNAMIC_ICP_INLINE void add(std::array<Lanes, 3>& sums, const Vector& a, const Lanes& b) {
    sums[0] += a.x * b;
    sums[1] += a.y * b;
    sums[2] += a.z * b;
  }

  static DYNAMIC_ICP_INLINE void add_triangle(std::array<Lanes, 6>& sums, const Vector& a, const Vector& b) {
    sums[0] += a.x * b.x;
    sums[1] += a.x * b.y;
    sums[2] += a.x * b.z;
    sums[3] += a.y * b.y;
    sums[4] += a.y * b.z;
    sums[5] += a.z * b.z;
  }

  [[nodiscard]] StepEquations finish() const {
    StepEquations sums;
    estimation::NormalEquations& equations = sums.equations;
    Eigen::Index k = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      equations.b[i] = simd::sum(rotation_b[static_cast<std::size_t>(i)]);
      equations.b[3 + i] = simd::sum(translation_b[static_cast<std::size_t>(i)]);
      for (Eigen::Index j = i; j < 3; ++j, ++k) {
        equations.H(j, i) = simd::sum(rotation[static_cast<std::size_t>(k)]);
        equations.H(3 + j, 3 + i) = simd::sum(translation[static_cast<std::size_t>(k)]);
      }
      for (Eigen::Index j = 0; j < 3; ++j) {
        equations.H(3 + i, j) = simd::sum(mixed[static_cast<std::size_t>(3 * i + j)]);
      }
    }
    sums.squared_distances = simd::sum(squared);
    sums.pairs = static_cast<std::size_t>((pairs[0] + pairs[1]) + (pairs[2] + pairs[3]));
    return sums;
  }
};

DYNAMIC_ICP_INLINE void add_plane(LaneSums& sums, const SourceRows& group, const Objective& objective, double share,
                                  const LaneMask& pairs) {
  Vector p;
  Vector q;
  Vector n;
  load(p, group.moved);
  load(q, group.target);
  load(n, group.normal);
  const Vector d{p.x - q.x, p.y - q.y, p.z - q.z};
  Lanes e;
  dot(e, n, d);
  Vector c;
  cross(c, p, n);
  Lanes weight;
  tukey(weight, e, objective.tukey_geometry_m, pairs);
  weight = share * weight;
  sums.add_rotation(c, e, weight);
  sums.add_translation(c, n, e, weight);
}

DYNAMIC_ICP_INLINE void add_doppler(LaneSums& sums, const SourceRows& group, const std::array<double, 9>& R,
                                    const Objective& objective, const LaneMask& pairs) {
  Vector ray;
  Vector u;
  load(ray, group.ray);
  load(u, group.direction);
  const Vector rotated{(R[0] * ray.x + R[1] * ray.y) + R[2] * ray.z, (R[3] * ray.x + R[4] * ray.y) + R[5] * ray.z,
                       (R[6] * ray.x + R[7] * ray.y) + R[8] * ray.z};
  Lanes doppler;
  simd::load(doppler, group.doppler.data());
  Lanes e;
  dot(e, u, rotated);
  e -= doppler;
  Vector c;
  cross(c, rotated, u);
  Lanes weight;
  tukey(weight, e, objective.tukey_doppler_mps, pairs);
  weight = objective.doppler_weight * weight;
  sums.add_rotation(c, e, weight);
}

}  // namespace

StepEquations& StepEquations::operator+=(const StepEquations& other) {
  equations += other.equations;
  pairs += other.pairs;
  squared_distances += other.squared_distances;
  return *this;
}

bool has_step_equations(const Objective& objective) {
  return objective.geometry == GeometryTerm::kPointToPlane && std::isinf(objective.reject_doppler_mps) &&
         (!has_doppler(objective) ||
          (objective.doppler == DopplerTerm::kRotation && objective.tukey_doppler_from_iteration <= 0));
}

StepEquations step_equations(std::span<const SourceRows> groups, const Eigen::Matrix3d& R, const Objective& objective) {
  const bool with_doppler = has_doppler(objective);
  const double share = with_doppler ? 1.0 - objective.doppler_weight : 1.0;
  std::array<double, 9> rotation;
  for (Eigen::Index i = 0; i < 9; ++i) {
    rotation[static_cast<std::size_t>(i)] = R(i / 3, i % 3);
  }
  LaneSums sums;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    for (const SourceRows& group : groups) {
      Lanes squared;
      Lanes gate;
      simd::load(squared, group.squared_distance.data());
      simd::load(gate, group.squared_gate.data());
      const LaneMask pairs = squared <= gate;
      sums.pairs -= pairs;
      simd::keep_where(squared, pairs);
      sums.squared += squared;
      add_plane(sums, group, objective, share, pairs);
      if (with_doppler) {
        add_doppler(sums, group, rotation, objective, pairs);
      }
    }
  });
  return sums.finish();
}

}  // namespace dynamic_icp::registration
