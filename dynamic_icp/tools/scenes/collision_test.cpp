// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/scenes/scene.hpp"
#include "dynamic_icp/tools/scenes/scene_file.hpp"
#include "dynamic_icp/tools/world/body_shapes.hpp"

// Bodies of the shipped scenes must not run through each other, through the vehicle or through what stands there.
namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector3d;

constexpr double kSight = 260.0;  // m; beyond the sensor's range scenes need not be finished

using Triangle = std::array<Vector3d, 3>;

/// A box in the world: middle, axes with half lengths as their lengths.
struct WorldBox {
  Vector3d center;
  std::array<Vector3d, 3> half_axes;

  [[nodiscard]] double reach(const Vector3d& axis) const {
    return std::abs(axis.dot(half_axes[0])) + std::abs(axis.dot(half_axes[1])) + std::abs(axis.dot(half_axes[2]));
  }
  [[nodiscard]] double radius() const {
    return std::sqrt(half_axes[0].squaredNorm() + half_axes[1].squaredNorm() + half_axes[2].squaredNorm());
  }
};

/// The box of a body without the lowest `ground_m`: it stands on the ground, which may be rough.
WorldBox world_box(const world::MotionState& motion, Eigen::AlignedBox3d box, double ground_m) {
  box.min().z() += ground_m;
  WorldBox result;
  result.center = motion.T_world_body * box.center();
  for (int i = 0; i < 3; ++i) {
    result.half_axes[static_cast<std::size_t>(i)] = 0.5 * box.sizes()[i] * motion.T_world_body.linear().col(i);
  }
  return result;
}

/// Convex sets are apart when some axis separates them; for boxes and triangles the normals of the faces and the
/// products of the edges are enough.
bool overlap(const WorldBox& a, const WorldBox& b) {
  const Vector3d between = b.center - a.center;
  const auto apart_along = [&](const Vector3d& axis) {
    return std::abs(axis.dot(between)) > a.reach(axis) + b.reach(axis);
  };
  if (between.norm() > a.radius() + b.radius()) {
    return false;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (apart_along(a.half_axes[i]) || apart_along(b.half_axes[i])) {
      return false;
    }
    for (std::size_t j = 0; j < 3; ++j) {
      if (apart_along(a.half_axes[i].cross(b.half_axes[j]))) {
        return false;
      }
    }
  }
  return true;
}

bool overlap(const WorldBox& box, const Triangle& triangle) {
  const auto apart_along = [&](const Vector3d& axis) {
    const auto [low, high] = std::minmax({axis.dot(triangle[0]), axis.dot(triangle[1]), axis.dot(triangle[2])});
    const double center = axis.dot(box.center);
    const double reach = box.reach(axis);
    return low > center + reach || high < center - reach;
  };
  const std::array<Vector3d, 3> edges = {triangle[1] - triangle[0], triangle[2] - triangle[1],
                                         triangle[0] - triangle[2]};
  if (std::any_of(box.half_axes.begin(), box.half_axes.end(), apart_along) || apart_along(edges[0].cross(edges[1]))) {
    return false;
  }
  for (const Vector3d& half_axis : box.half_axes) {
    for (const Vector3d& edge : edges) {
      if (apart_along(half_axis.cross(edge))) {
        return false;
      }
    }
  }
  return true;
}

TEST(Overlap, KnownCases) {
  const Eigen::AlignedBox3d cube(Vector3d(-1.0, -1.0, -1.0), Vector3d(1.0, 1.0, 1.0));
  const auto at = [&](double x, double yaw) {
    world::MotionState motion;
    motion.T_world_body.translation().x() = x;
    motion.T_world_body.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
    return world_box(motion, cube, 0.0);
  };
  EXPECT_TRUE(overlap(at(0.0, 0.0), at(1.99, 0.0)));
  EXPECT_FALSE(overlap(at(0.0, 0.0), at(2.01, 0.0)));
  EXPECT_TRUE(overlap(at(0.0, 0.0), at(2.40, std::numbers::pi / 4.0)));
  EXPECT_FALSE(overlap(at(0.0, 0.0), at(2.42, std::numbers::pi / 4.0)));
  EXPECT_TRUE(overlap(at(0.0, 0.0), Triangle{{{0.9, -9.0, -9.0}, {0.9, 9.0, -9.0}, {0.9, 0.0, 9.0}}}));
  EXPECT_FALSE(overlap(at(0.0, 0.0), Triangle{{{1.1, -9.0, -9.0}, {1.1, 9.0, -9.0}, {1.1, 0.0, 9.0}}}));
}

/// Static triangles by square cells of the ground plane.
class TriangleCells {
 public:
  explicit TriangleCells(const world::TriangleMesh& mesh) {
    for (const auto& corners : mesh.triangles) {
      const Triangle triangle = {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
      // Level ground reaches far and cannot be run into.
      if (triangle[0].z() == triangle[1].z() && triangle[1].z() == triangle[2].z() && triangle[0].z() <= 0.12) {
        continue;
      }
      Eigen::AlignedBox3d box(triangle[0]);
      box.extend(triangle[1]).extend(triangle[2]);
      for (int x = cell(box.min().x()); x <= cell(box.max().x()); ++x) {
        for (int y = cell(box.min().y()); y <= cell(box.max().y()); ++y) {
          cells_[{x, y}].push_back(triangle);
        }
      }
    }
  }

  [[nodiscard]] bool overlaps(const WorldBox& box) const {
    const double reach_x = box.reach(Vector3d::UnitX());
    const double reach_y = box.reach(Vector3d::UnitY());
    for (int x = cell(box.center.x() - reach_x); x <= cell(box.center.x() + reach_x); ++x) {
      for (int y = cell(box.center.y() - reach_y); y <= cell(box.center.y() + reach_y); ++y) {
        const auto found = cells_.find({x, y});
        if (found != cells_.end() &&
            std::any_of(found->second.begin(), found->second.end(), [&](const auto& t) { return overlap(box, t); })) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  static int cell(double x) { return static_cast<int>(std::floor(x / 5.0)); }

  std::map<std::pair<int, int>, std::vector<Triangle>> cells_;
};

/// A moving thing of a scene: the vehicle or a body.
struct Mover {
  std::string name;
  world::Trajectory trajectory;
  Eigen::AlignedBox3d box;
  std::int32_t id = 0;
  std::int32_t towed_by = 0;
};

std::vector<Mover> movers_of(const Scene& scene) {
  std::vector<Mover> movers = {{"vehicle", scene.vehicle, world::bounds(world::make_car()), -1}};
  for (const world::MovingBody& body : scene.world.bodies) {
    movers.push_back({body.name + " " + std::to_string(body.id), body.trajectory, scene.world.shapes[body.shape].box,
                      body.id, body.towed_by});
  }
  return movers;
}

void expect_no_collision(const Scene& scene, int frames, double ground_m) {
  const std::vector<Mover> movers = movers_of(scene);
  const TriangleCells statics(scene.world.statics);
  for (int i = 0; i < frames; ++i) {
    const double t = 0.1 * i;
    std::vector<WorldBox> boxes;
    for (const Mover& mover : movers) {
      boxes.push_back(world_box(mover.trajectory(t), mover.box, ground_m));
    }
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      const bool in_sight = (boxes[a].center - boxes[0].center).norm() < kSight;
      ASSERT_FALSE(in_sight && statics.overlaps(boxes[a]))
          << movers[a].name << " runs into something static at " << t << " s";
      for (std::size_t b = 0; b < a; ++b) {
        const bool is_coupled = movers[a].towed_by == movers[b].id;  // the boxes of both hold the place of the joint
        ASSERT_FALSE(!is_coupled && overlap(boxes[a], boxes[b]))
            << movers[a].name << " runs into " << movers[b].name << " at " << t << " s";
      }
    }
  }
}

class ShippedScene : public testing::TestWithParam<std::string> {
 protected:
  static void check(int frames, int seed, double traffic) {
    const SceneKind& kind = find_scene(GetParam());
    SCOPED_TRACE("seed " + std::to_string(seed) + ", traffic " + std::to_string(traffic));
    SceneKnobs knobs = default_knobs(kind);
    knobs.seed = seed;
    knobs.traffic = traffic;
    const double rough_m = GetParam() == "off-road" ? 0.45 : 0.15;
    expect_no_collision(build_scene(kind, knobs, 0.1 * frames), frames, rough_m);
  }
};

TEST_P(ShippedScene, NobodyRunsThroughAnybodyForAMinute) {
  for (int seed = 1; seed <= 5; ++seed) {
    check(600, seed, 1.0);
  }
}

TEST_P(ShippedScene, NobodyRunsThroughAnybodyInThinAndThickTraffic) {
  check(150, 6, 0.4);
  check(150, 7, 3.0);
}

TEST(ExampleScene, NobodyRunsThroughAnybodyForAMinute) {
  const SceneKind kind = load_scene_file(std::filesystem::path(DYNAMIC_ICP_EXAMPLE_SCENES) / "crossing.yaml");
  for (const double traffic : {0.4, 1.0, 3.0}) {
    SCOPED_TRACE(traffic);
    for (int seed = 1; seed <= 3; ++seed) {
      SceneKnobs knobs = default_knobs(kind);
      knobs.seed = seed;
      knobs.traffic = traffic;
      expect_no_collision(build_scene(kind, knobs, 60.0), 600, 0.15);
    }
  }
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const SceneKind& kind : scene_kinds()) {
    names.emplace_back(kind.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(, ShippedScene, testing::ValuesIn(scene_names()),
                         [](const testing::TestParamInfo<std::string>& scene) {
                           std::string name = scene.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace dynamic_icp::scenes
