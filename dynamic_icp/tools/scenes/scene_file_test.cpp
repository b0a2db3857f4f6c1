// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene_file.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/world/ray_caster.hpp"

namespace dynamic_icp::scenes {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// A folder of its own for the files of a test.
class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("scene_file_test-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  SceneKind load(const std::string& text) const {
    formats::write_whole_file(folder_ / "my-scene.yaml", text);
    return load_scene_file(folder_ / "my-scene.yaml");
  }

  /// The scene of a file with these lines after a plain beginning of kHead lines.
  Scene build(const std::string& lines, double traffic = 1.0, double speed_mps = 10.0, int seed = 1) const {
    return build_scene(load(kHead + lines), {seed, speed_mps, traffic}, 10.0);
  }

  static constexpr const char* kText = "description: a test\nspeed_mps: 10\nroutes:\n  main: {start_m: [1, 2]}\n";
  inline static const std::string kHead =
      std::string(kText) +
      "  bend: {start_m: [5, 0], heading_deg: 90, pieces: [straight: {length_m: 10}, turn: {angle_deg: -90, radius_m: "
      "20, "
      "ramp_m: 8}, curve: {length_m: 12, curvature_begin: 0, curvature_end: 0.03}]}\nvehicle: {route: main}\n";

  std::filesystem::path folder_;
};

constexpr const char* kVehicle = "vehicle: {route: main}\n";

/// What rays meet in a scene.
class Probe {
 public:
  explicit Probe(const Scene& scene) : world_(scene.world), caster_(world_) {}

  /// The height of the surface above a point of the ground; nothing where there is none.
  std::optional<double> height(double x, double y) const {
    const std::optional<world::RayHit> hit = down(x, y);
    return hit ? std::optional(kAbove - hit->range_m) : std::nullopt;
  }
  double reflectivity(double x, double y) const { return down(x, y).value().reflectivity; }
  Vector3d normal(double x, double y) const { return down(x, y).value().normal_world; }

 private:
  static constexpr double kAbove = 50.0;

  std::optional<world::RayHit> down(double x, double y) const {
    return caster_.cast({{x, y, kAbove}, -Vector3d::UnitZ(), 100.0}, {});
  }

  world::World world_;
  world::RayCaster caster_;
};

TEST_F(SceneFile, HasNameDescriptionAndSpeed) {
  const SceneKind kind = load(std::string(kText) + kVehicle);
  EXPECT_EQ(kind.name, "my-scene");
  EXPECT_EQ(kind.description, "a test");
  EXPECT_EQ(kind.speed_mps, 10.0);
  const Scene scene = build_scene(kind, default_knobs(kind), 5.0);
  EXPECT_TRUE(scene.world.statics.triangles.empty());
  EXPECT_TRUE(scene.world.bodies.empty());
  EXPECT_TRUE(scene.vehicle(2.0).T_world_body.translation().isApprox(Vector3d(21.0, 2.0, 0.0)));
}

TEST_F(SceneFile, SolidsAreWhereTheFileSays) {
  const Probe probe(build(R"(statics:
- box: {size_m: [4, 2, 1.5], position_m: [10, 0, 0.25], yaw_deg: 90, reflectivity: 0.75}
- cylinder: {radius_m: 1, height_m: 3, sides: 64, position_m: [20, 0, 0]}
- cylinder: {radius_m: 0.5, height_m: 4, sides: 128, position_m: [28, 0, 2], pitch_deg: 90}
- sphere: {radius_m: 2, sides: 128, position_m: [40, 0, 1]}
- ellipsoid: {radii_m: [1, 3, 2], sides: 128, position_m: [50, 0, 1]}
)"));
  EXPECT_NEAR(*probe.height(10.0, 0.0), 1.75, 1e-9);
  EXPECT_NEAR(*probe.height(10.9, 1.9), 1.75, 1e-9);
  EXPECT_FALSE(probe.height(11.1, 0.0));
  EXPECT_FALSE(probe.height(10.0, 2.1));
  EXPECT_FLOAT_EQ(static_cast<float>(probe.reflectivity(10.0, 0.0)), 0.75f);
  EXPECT_NEAR(*probe.height(20.9, 0.0), 3.0, 1e-9);
  EXPECT_FALSE(probe.height(21.1, 0.0));
  // Lies along x from 28 to 32, half a metre about the height 2.
  EXPECT_NEAR(*probe.height(31.9, 0.0), 2.5, 1e-3);
  EXPECT_FALSE(probe.height(27.9, 0.0));
  EXPECT_FALSE(probe.height(30.0, 0.6));
  EXPECT_NEAR(*probe.height(40.0, 1.2), 1.0 + 1.6, 2e-3);
  EXPECT_NEAR(*probe.height(50.0, 1.8), 1.0 + 2.0 * 0.8, 2e-3);
  EXPECT_FALSE(probe.height(51.05, 0.0));
}

TEST_F(SceneFile, SolidsStandInRowsAlongRoutes) {
  const Probe probe(build(
      "statics:\n- box: {size_m: [1, 1, 2], route: bend, s_m: 2, lateral_m: 3, z_m: 1, count: 3, spacing_m: 4}\n"));
  // The route begins at (5, 0) towards y; left of it is smaller x.
  for (const double y : {2.0, 6.0, 10.0}) {
    EXPECT_NEAR(*probe.height(2.0, y), 3.0, 1e-9) << y;
    EXPECT_FALSE(probe.height(2.0, y + 2.0)) << y;
  }
  EXPECT_FALSE(probe.height(2.0, 14.0));
}

TEST_F(SceneFile, SurfacesAreWhereTheFileSays) {
  const Probe probe(build(R"(statics:
- ground: {low_m: [-10, -10], high_m: [0, 10], z_m: -0.5, reflectivity: 0.125}
- pavement: {low_m: [0, -10], high_m: [10, 10]}
- ribbon: {route: main, begin_m: 19, end_m: 39, lateral_m: 10, profile_m: [[-2, 0], [0, 1], [2, 0]]}
- height_field: {corner_m: [50, 0], cell_m: 2, heights_m: [[1, 2, 3], [1, 2, 3], [5, 6, 7]]}
)"));
  EXPECT_NEAR(*probe.height(-5.0, 0.0), -0.5, 1e-9);
  EXPECT_FLOAT_EQ(static_cast<float>(probe.reflectivity(-5.0, 0.0)), 0.125f);
  EXPECT_NEAR(*probe.height(5.0, 0.0), 0.12, 1e-9);
  // The route runs at y = 2, so the crest is at y = 12.
  EXPECT_NEAR(*probe.height(30.0, 12.0), 1.0, 1e-6);
  EXPECT_NEAR(*probe.height(30.0, 13.0), 0.5, 1e-6);
  EXPECT_NEAR(*probe.height(39.5, 11.0), 0.5, 1e-6);
  EXPECT_TRUE(probe.normal(30.0, 13.0).isApprox(Vector3d(0.0, 1.0, 2.0).normalized()));
  EXPECT_FALSE(probe.height(30.0, 14.5));
  EXPECT_FALSE(probe.height(19.5, 12.0));
  EXPECT_NEAR(*probe.height(51.0, 1.0), 1.5, 1e-6);
  EXPECT_NEAR(*probe.height(53.0, 1.0), 2.5, 1e-6);
  EXPECT_NEAR(*probe.height(50.5, 3.0), 3.25, 1e-6);
  EXPECT_TRUE(probe.normal(51.0, 1.0).isApprox(Vector3d(-1.0, 0.0, 2.0).normalized()));
  EXPECT_FALSE(probe.height(54.5, 1.0));
}

TEST_F(SceneFile, TerrainRollsAboutItsHeightAndDependsOnTheSeed) {
  const std::string text =
      "statics:\n- terrain: {low_m: [0, 0], high_m: [60, 60], cell_m: 2, roughness: 0.5, z_m: 7}\n";
  const Probe first(build(text));
  const Probe again(build(text));
  const Probe other(build(text, 1.0, 10.0, 2));
  double least = 1e9;
  double most = -1e9;
  double difference = 0.0;
  for (double x = 1.0; x < 60.0; x += 2.5) {
    for (double y = 1.0; y < 60.0; y += 2.5) {
      const double height = first.height(x, y).value();
      EXPECT_EQ(height, again.height(x, y).value());
      least = std::min(least, height);
      most = std::max(most, height);
      difference = std::max(difference, std::abs(height - other.height(x, y).value()));
    }
  }
  EXPECT_GT(most - least, 0.2);
  EXPECT_LT(std::max(most - 7.0, 7.0 - least), 1.0);
  EXPECT_GT(difference, 0.1);
  EXPECT_FALSE(first.height(65.0, 30.0));
}

TEST_F(SceneFile, RowsStandBesideTheRoute) {
  struct Case {
    const char* line;
    double min_lateral;
    double max_lateral;
    double min_height;
  };
  for (const Case& row : {Case{"houses: {spacing_m: 12, lateral_m: 9", 7.5, 23.0, 8.0},
                          Case{"trees: {spacing_m: 9, jitter_m: 1, lateral_m: 9", 7.0, 11.0, 4.0},
                          Case{"lamp_posts: {spacing_m: 20, lateral_m: 9", 8.0, 10.0, 6.0},
                          Case{"parked_cars: {spacing_m: 8, jitter_m: 0.3, lateral_m: 9", 7.8, 10.2, 1.4},
                          Case{"parked_cars: {spacing_m: 3, yaw_deg: 90, lateral_m: 9", 5.9, 12.1, 1.4}}) {
    const Scene scene =
        build(std::string("statics:\n- ") + row.line + ", route: main, begin_m: 20, end_m: 100, reflectivity: 0.5}\n");
    ASSERT_FALSE(scene.world.statics.triangles.empty()) << row.line;
    const Eigen::AlignedBox3d box = world::bounds(scene.world.statics);
    EXPECT_GT(box.min().x(), 21.0 - 5.0) << row.line;
    EXPECT_LT(box.max().x(), 101.0 + 5.0) << row.line;
    EXPECT_GT(box.sizes().x(), 40.0) << row.line;
    EXPECT_GT(box.min().y(), 2.0 + row.min_lateral) << row.line;
    EXPECT_LT(box.max().y(), 2.0 + row.max_lateral) << row.line;
    EXPECT_GT(box.max().z(), row.min_height) << row.line;
    EXPECT_EQ(scene.world.statics.reflectivity, std::vector<float>(scene.world.statics.triangles.size(), 0.5f));
  }
}

TEST_F(SceneFile, MeshesComeFromFilesBesideTheScene) {
  std::filesystem::create_directories(folder_ / "meshes");
  formats::write_whole_file(folder_ / "meshes" / "roof.ply",
                            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "0 0 1\n2 0 1\n2 2 1\n0 2 1\n4 0 1 2 3\n");
  const Probe probe(
      build("statics:\n- mesh: {file: meshes/roof.ply, scale: 3, position_m: [10, 0, 1], yaw_deg: 180}\n"));
  EXPECT_NEAR(*probe.height(5.0, -5.0), 4.0, 1e-9);
  EXPECT_FALSE(probe.height(11.0, 1.0));
  EXPECT_THROW(build("statics:\n- mesh: {file: meshes/none.ply, position_m: [0, 0, 0]}\n"), DataError);
}

/// The twist must be the time derivative of the pose: central differences of position and rotation.
void expect_exact_twist(const world::Trajectory& trajectory) {
  const double h = 1e-4;
  for (double t = 0.013; t < 9.0; t += 0.217) {
    const world::MotionState before = trajectory(t - h);
    const world::MotionState after = trajectory(t + h);
    const world::MotionState now = trajectory(t);
    const Vector3d velocity = (after.T_world_body.translation() - before.T_world_body.translation()) / (2.0 * h);
    const Vector3d omega = log_so3(after.T_world_body.linear() * before.T_world_body.linear().transpose()) / (2.0 * h);
    EXPECT_LT((velocity - now.velocity_world).norm(), 2e-6) << t;
    EXPECT_LT((omega - now.angular_velocity_world).norm(), 2e-6) << t;
  }
}

TEST_F(SceneFile, TwistsAreTheDerivativesOfPoses) {
  const Scene scene = build(R"(bodies:
- car: {route: bend, lateral_m: 3, start_m: -5, speed: [[1, 8], [4, 2], [6, 9]]}
- van: {route: bend, lateral_m: -4, start_m: 70, against: true, speed_mps: 7}
- object:
    name: ball
    parts: [sphere: {radius_m: 1}]
    free: {position_m: [1, 2, 3], yaw_deg: 30, velocity_mps: [1, -2, 0.5], spin_dps: [200, -100, 50]}
lanes:
- {route: bend, lateral_m: 3.5, count: 3, spacing_m: 20, speed: [[0, 5], [5, 10]]}
)");
  ASSERT_EQ(scene.world.bodies.size(), 6u);
  for (const world::MovingBody& body : scene.world.bodies) {
    SCOPED_TRACE(body.name);
    expect_exact_twist(body.trajectory);
  }
  const Scene swaying = build_scene(
      load(std::string(kText) + "vehicle: {route: main, sway: 3, speed: [[1, 8], [4, 2]]}\n"), {1, 15.0, 1.0}, 10.0);
  expect_exact_twist(swaying.vehicle);
  EXPECT_GT(std::abs(swaying.vehicle(1.0).T_world_body.translation().z()), 1e-4);
}

TEST_F(SceneFile, FreeBodiesSpinAboutAxesOfTheWorld) {
  const Scene scene = build(
      "bodies:\n- object: {name: ball, parts: [box: {size_m: [1, 2, 3], position_m: [0, 0, -1.5]}], free: {position_m: "
      "[1, 2, 3], yaw_deg: 90, velocity_mps: [1, 0, -1], spin_dps: [0, 45, 0]}}\n");
  const world::MotionState state = scene.world.bodies[0].trajectory(2.0);
  EXPECT_TRUE(state.T_world_body.translation().isApprox(Vector3d(3.0, 2.0, 1.0)));
  // After 2 s: a quarter rotation about y, on top of a quarter rotation about z.
  EXPECT_LT((state.T_world_body.linear().col(0) - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((state.T_world_body.linear().col(2) - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_EQ(state.angular_velocity_world, Vector3d(0.0, 45.0 * pi / 180.0, 0.0));
  const Eigen::AlignedBox3d& box = scene.world.shapes[scene.world.bodies[0].shape].box;
  EXPECT_TRUE(box.max().isApprox(Vector3d(0.5, 1.0, 1.5)));
}

TEST_F(SceneFile, BodiesFollowTheirRoutes) {
  const Scene scene = build(
      "bodies:\n- truck: {route: main, start_m: 50, lateral_m: 3, against: true, speed_mps: 6}\n"
      "- pedestrian: {name: child, route: main, speed: [[0, 0], [4, 0], [6, 2]]}\n");
  EXPECT_EQ(scene.world.bodies[0].name, "truck");
  EXPECT_EQ(scene.world.bodies[1].name, "child");
  const world::MotionState truck = scene.world.bodies[0].trajectory(4.0);
  EXPECT_LT((truck.T_world_body.translation() - Vector3d(27.0, 5.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((truck.velocity_world - Vector3d(-6.0, 0.0, 0.0)).norm(), 1e-9);
  // Speeds up from 0 to 2 m/s within 2 s: 2 m.
  EXPECT_LT((scene.world.bodies[1].trajectory(7.0).T_world_body.translation() - Vector3d(5.0, 2.0, 0.0)).norm(), 1e-9);
}

TEST_F(SceneFile, RoutesAreComposedOfTheirPieces) {
  const Scene scene = build_scene(
      load(kHead.substr(0, kHead.find("vehicle")) + "vehicle: {route: bend, start_m: 10}\n"), {1, 1.0, 1.0}, 10.0);
  EXPECT_LT((scene.vehicle(0.0).T_world_body.translation() - Vector3d(5.0, 10.0, 0.0)).norm(), 1e-9);
  // A turn by a quarter is radius x angle + ramp long, and its middle has the curvature of the radius.
  const double turn_m = 0.5 * pi * 20.0 + 8.0;
  EXPECT_NEAR(scene.vehicle(0.5 * turn_m).angular_velocity_world.z(), -1.0 / 20.0, 1e-12);
  EXPECT_LT((scene.vehicle(turn_m).velocity_world - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_NEAR(scene.vehicle(turn_m + 6.0).angular_velocity_world.z(), 0.015, 1e-12);
}

TEST_F(SceneFile, TheSpeedKnobScalesTheVehicle) {
  const SceneKind kind = load(std::string(kText) + "vehicle: {route: main, speed: [[2, 10], [4, 0]]}\n");
  const Scene usual = build_scene(kind, default_knobs(kind), 10.0);
  const Scene slow = build_scene(kind, {1, 5.0, 1.0}, 10.0);
  EXPECT_NEAR(usual.vehicle(9.0).T_world_body.translation().x(), 1.0 + 30.0, 1e-9);
  EXPECT_NEAR(slow.vehicle(9.0).T_world_body.translation().x(), 1.0 + 15.0, 1e-9);
  EXPECT_NEAR(slow.vehicle(1.0).velocity_world.x(), 5.0, 1e-12);
}

TEST_F(SceneFile, TheTrafficKnobScalesLanesAndRemovesBodies) {
  const std::string text =
      "bodies:\n- car: {route: main, speed_mps: 6}\n"
      "lanes:\n- {route: main, lateral_m: 4, first_m: 100, spacing_m: 40, count: 6, truck_share: 1, speed_mps: 6}\n";
  EXPECT_TRUE(build(text, 0.0).world.bodies.empty());
  EXPECT_EQ(build(text, 0.5).world.bodies.size(), 1u + 3u);
  EXPECT_EQ(build(text, 1.0).world.bodies.size(), 1u + 6u);
  EXPECT_EQ(build(text, 2.0).world.bodies.size(), 1u + 12u);
  for (const double traffic : {0.5, 1.0, 2.0, 3.0}) {
    const Scene scene = build(text, traffic);
    double last = 0.0;
    for (std::size_t i = 1; i < scene.world.bodies.size(); ++i) {
      EXPECT_EQ(scene.world.bodies[i].name, "truck");
      const double x = scene.world.bodies[i].trajectory(0.0).T_world_body.translation().x();
      EXPECT_GT(x - last, 10.5);
      last = x;
    }
    EXPECT_GT(last, 100.0 + 130.0);
    EXPECT_LT(last, 101.0 + 240.0 + 8.0);
  }
}

TEST_F(SceneFile, TheSameRequestGivesTheSameScene) {
  const std::string text =
      "statics:\n- trees: {route: main, begin_m: 0, end_m: 90, lateral_m: 6, spacing_m: 9, jitter_m: 3}\n"
      "lanes:\n- {route: main, lateral_m: 4, spacing_m: 40, count: 6, speed_mps: 6}\n";
  const auto positions = [&](int seed) {
    const Scene scene = build(text, 1.0, 10.0, seed);
    std::vector<Vector3d> all = scene.world.statics.vertices;
    for (const world::MovingBody& body : scene.world.bodies) {
      all.push_back(body.trajectory(3.0).T_world_body.translation());
    }
    return all;
  };
  EXPECT_EQ(positions(1), positions(1));
  EXPECT_NE(positions(1), positions(2));
}

TEST(ExampleScene, CrossingStopsAndDrivesOn) {
  const SceneKind kind = load_scene_file(std::filesystem::path(DYNAMIC_ICP_EXAMPLE_SCENES) / "crossing.yaml");
  EXPECT_EQ(kind.name, "crossing");
  const Scene scene = build_scene(kind, default_knobs(kind), 60.0);
  EXPECT_GT(scene.world.statics.triangles.size(), 5000u);
  EXPECT_EQ(scene.world.bodies.size(), 8u + 17u);
  EXPECT_NEAR(scene.vehicle(10.0).T_world_body.translation().x(), 47.5, 1e-9);
  EXPECT_LT(scene.vehicle(10.0).velocity_world.norm(), 0.2);
  EXPECT_NEAR(scene.vehicle(24.0).velocity_world.x(), 10.0, 1e-9);
  const Probe probe(scene);
  EXPECT_NEAR(*probe.height(20.0, 0.0), 0.0, 1e-6);
  EXPECT_NEAR(*probe.height(20.0, -5.8), 0.12, 1e-6);
  EXPECT_NEAR(*probe.height(61.75, -3.0), 0.0, 1e-6);
  EXPECT_NEAR(*probe.height(250.0, 12.0), 0.8, 1e-6);
}

TEST_F(SceneFile, TheSmallestFileOfTheDocumentationIsOne) {
  const std::string page =
      formats::read_whole_file(std::filesystem::path(DYNAMIC_ICP_EXAMPLE_SCENES) / "../../docs/scenes.md");
  const std::size_t begin = page.find("```yaml\n") + 8;
  const SceneKind kind = load(page.substr(begin, page.find("```", begin) - begin));
  const Probe probe(build_scene(kind, default_knobs(kind), 1.0));
  EXPECT_NEAR(*probe.height(300.0, 6.1), 3.0, 1e-9);
  EXPECT_NEAR(*probe.height(300.0, 5.8), 0.0, 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::scenes
