// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/bird_view.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::simulation {
namespace {

using drawing::Rgb;

constexpr double kFullTone = 10.0;  // m above or below the road

/// The colour of a surface by its height and by how much it faces the light.
Rgb surface_colour(const world::RayHit& hit, double height_m, Rgb low, Rgb high) {
  static const Eigen::Vector3d light = Eigen::Vector3d(-0.5, 0.35, 0.8).normalized();
  const Rgb tone = drawing::mix(low, high, std::min(std::abs(height_m) / kFullTone, 1.0));
  const Eigen::Vector3d upward = hit.normal_world.z() < 0.0 ? Eigen::Vector3d(-hit.normal_world) : hit.normal_world;
  const double brightness = std::clamp(0.25 + 0.94 * upward.dot(light), 0.0, 1.0);
  return drawing::mix({0, 0, 0}, tone, brightness);
}

}  // namespace

drawing::Raster bird_view(const world::World& world, const world::RayCaster& caster, const Eigen::AlignedBox2d& region,
                          std::size_t width, std::size_t height, const drawing::Theme& theme, const Workers& workers) {
  drawing::Raster raster(width, height, drawing::rgb(theme.panel));
  const Eigen::AlignedBox3d all = bounds(world.statics);
  const double above = all.max().z() + 1.0;
  const Rgb low = drawing::mix(drawing::rgb(theme.panel), drawing::rgb(theme.ink), 0.08);
  const Rgb high = drawing::mix(drawing::rgb(theme.panel), drawing::rgb(theme.ink), 0.55);
  const auto place = [](std::size_t i, std::size_t n) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  };
  workers.for_blocks(height, 8, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t column = 0; column < width; ++column) {
        const double x = region.min().x() + place(column, width) * region.sizes().x();
        const double y = region.max().y() - place(row, height) * region.sizes().y();
        const world::Ray ray{{x, y, above}, -Eigen::Vector3d::UnitZ(), above - all.min().z() + 1.0};
        if (const auto hit = caster.cast(ray, {})) {
          raster.set(column, row, surface_colour(*hit, above - hit->range_m, low, high));
        }
      }
    }
  });
  return raster;
}

}  // namespace dynamic_icp::simulation
