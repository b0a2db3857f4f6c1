// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/simulation/detection.hpp"
#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/tools/world/ray_caster.hpp"
#include "dynamic_icp/tools/world/world.hpp"

namespace dynamic_icp::simulation {

/// What gave a return.
enum class ReturnKind : std::uint8_t {
  kSurface,  ///< one surface
  kMixed,    ///< two surfaces in one beam; the point lies between them
  kRain,     ///< a drop
  kSpray,    ///< a drop behind a moving body
  kWindow,   ///< the window before the sensor
  kGhost     ///< the mirror image of a surface behind another
};

/// Label of returns that belong to no body and to no static surface: drops, the window, ghosts.
constexpr std::int32_t kNoBody = -1;

/// The true range rate (m/s, positive away) of a surface point seen along `direction_world`:
/// s = u . (v_point - v_sensor), where v_sensor has the lever arm of the mounting (`world::mounted`) and v_point the
/// rotation of the body the point belongs to.
double range_rate(const Eigen::Vector3d& direction_world, const Eigen::Vector3d& velocity_point_world,
                  const world::MotionState& sensor);

/// What scanning needs to know besides the sensor.
struct Surroundings {
  const world::World& world;
  const world::RayCaster& caster;
  const world::Trajectory& sensor;  ///< of the sensor frame
};

/// Sensor and bodies at the time of a firing.
struct Moment {
  double time_s = 0.0;
  world::MotionState sensor;
  std::vector<world::BodyAt> bodies;
};

/// Throws std::invalid_argument when a trajectory gives a pose that is not finite.
Moment moment_at(const Surroundings& surroundings, double time_s);

/// What comes back along one ray, before the sensor measures it.
struct Return {
  Echo echo;
  double doppler = 0.0;     ///< m/s
  double true_range = 0.0;  ///< m; differs from the echo's where returns are mixed
  double true_doppler = 0.0;
  std::int32_t body = 0;
  ReturnKind kind = ReturnKind::kSurface;
};

/// Finds what the rays of a sensor meet.
class RayReturns {
 public:
  /// Keeps references to both.
  RayReturns(const Surroundings& surroundings, const FmcwLidarConfig& config)
      : surroundings_(surroundings), config_(config) {}

  /// The return of the ray in this direction (rad, sensor frame); `random` has the random numbers of the ray. Nothing
  /// where no surface is met between the smallest and the largest range.
  [[nodiscard]] std::optional<Return> find(const Moment& moment, double azimuth, double elevation,
                                           const RandomSource& random) const;

 private:
  struct Hit {
    Eigen::Vector3d point_world;
    Eigen::Vector3d normal_world;
    Eigen::Vector3d velocity_world;
    Return result;
  };

  [[nodiscard]] std::optional<Hit> cast(const Moment& moment, const world::Ray& ray) const;
  [[nodiscard]] std::optional<Hit> cast(const Moment& moment, const Eigen::Vector3d& direction_sensor) const;
  [[nodiscard]] double roughness(const Moment& moment, const world::RayHit& surface,
                                 const Eigen::Vector3d& point_world) const;
  [[nodiscard]] std::optional<Return> mirrored(const Moment& moment, const Hit& mirror) const;
  [[nodiscard]] std::optional<Return> over_the_beam(const Moment& moment, const std::optional<Hit>& on_axis,
                                                    double azimuth, double elevation, const RandomSource& random) const;
  [[nodiscard]] static bool is_edge(const Hit& on_axis, const Hit& aside);
  [[nodiscard]] Return at_edge(Return on_axis, Return aside, double share_aside) const;

  const Surroundings& surroundings_;
  const FmcwLidarConfig& config_;
};

}  // namespace dynamic_icp::simulation
