// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/scenes/scene_file.hpp"

namespace dynamic_icp::scenes {
namespace {

class SceneFileErrors : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("scene_file_error_test-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void load(const std::string& text) const {
    formats::write_whole_file(folder_ / "my-scene.yaml", text);
    (void)load_scene_file(folder_ / "my-scene.yaml");
  }

  std::string message(const std::string& text) const {
    try {
      load(text);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "no UsageError";
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

TEST_F(SceneFileErrors, ErrorsNameFileLineKeyAndWhatIsAllowed) {
  // Line 8 is the first after kHead's 6 lines and the list's own.
  formats::write_whole_file(folder_ / "far.ply",
                            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "0 0 0\n2e5 0 0\n0 2 0\n3 0 1 2\n");
  const auto part = [](const char* text) { return kHead + "statics:\n- " + text + "\n"; };
  const auto body = [](const char* text) { return kHead + "bodies:\n- " + text + "\n"; };
  const auto lane = [](const char* text) { return kHead + "lanes:\n- " + text + "\n"; };
  const auto route = [](const char* text) { return std::string(kText) + "  r: {pieces: [" + text + "]}\n" + kVehicle; };
  const std::string top(kText);
  const std::vector<std::pair<std::string, std::vector<const char*>>> faults = {
      {"speed_mps: 1\n", {"line 1", "'description' is missing"}},
      {"description: x\nspeed_mps: 71\n", {"line 2", "'speed_mps' is '71'", "0 to 70"}},
      {top, {"'vehicle' is missing"}},
      {top + "vehicle: {route: man}\n", {"line 5", "'vehicle.route' is 'man'", "one of: main"}},
      {top + "vehicle: {route: main}\nstatic: []\n", {"line 6", "unknown key 'static'", "'statics'"}},
      {top + "vehicle: {route: main, lateral: 3}\n", {"line 5", "unknown key 'vehicle.lateral'", "'lateral_m'"}},
      {top + "vehicle: {route: main, speed: [[1, 2], [1, 3]]}\n", {"line 5", "'vehicle.speed'", "increasing times"}},
      {top + "vehicle: {route: main, speed: [[1, 200]]}\n", {"line 5", "'vehicle.speed'", "0 to 100 m/s"}},
      {top + "vehicle: {route: main, speed: [[-1, 2]]}\n", {"line 5", "row 1 of 'vehicle.speed'", "0 to 100000"}},
      {"description: x\nspeed_mps: 0\nroutes: {r: {}}\nvehicle: {route: r, speed: [[1, 2]]}\n",
       {"line 4", "'vehicle.speed' needs", "above 0"}},
      {route("straight: {length_m: 0}"), {"line 5", "'routes.r.pieces.straight.length_m' is '0'", "0.01 to 20000"}},
      {route("turn: {angle_deg: 10, radius_m: 10, ramp_m: 2}"), {"line 5", "turn.ramp_m' is 2", "at most", "1.74533"}},
      {route("turn: {angle_deg: 3600, radius_m: 10000, ramp_m: 2}"), {"turn.angle_deg'", "at most 20000 m"}},
      {route("bow: {length_m: 1}"), {"line 5", "'bow' is no piece", "straight, turn, curve"}},
      {route("curve: {length_m: 1, curvature_begin: 0}"), {"line 5", "'curvature_end' is missing", "-2 to 2"}},
      {part("bocks: {size_m: [1, 1, 1]}"), {"line 8", "'bocks' is no part of statics", "box, cylinder", "terrain"}},
      {part("box: {size_m: [1, 1], position_m: [0, 0, 0]}"), {"line 8", "'statics.box.size_m' is a list of 2", "3"}},
      {part("box: {size_m: [1, 1, 0], position_m: [0, 0, 0]}"), {"line 8", "number 3 of", "0.001 to 10000"}},
      {part("box: {size_m: [1, 1, 1]}"), {"line 8", "'position_m' is missing"}},
      {part("box: {size_m: [1, 1, 1], position_m: [0, 0, 0], route: main}"), {"line 8", "position_m' stands beside"}},
      {part("box: {size_m: [1, 1, 1], route: main, s_m: 1, count: 2}"), {"line 8", "'spacing_m' is missing"}},
      {part("box: {size_m: [1, 1, 1], position_m: [0, 0, nan]}"), {"line 8", "'nan'"}},
      {part("sphere: {radius_m: 1, position_m: [0, 0, 0], sides: 3}"), {"'statics.sphere.sides' is '3'", "4 to 256"}},
      {part("ground: {low_m: [0, 0], high_m: [1, 0]}"), {"line 8", "high_m' is [1, 0]", "more than low_m"}},
      {part("ground: {low_m: [0, 0], high_m: [1, 1], reflectivity: -1}"), {"reflectivity' is '-1'", "0 to 100"}},
      {part("ribbon: {route: main, begin_m: 1, end_m: 0, profile_m: [[0, 0], [1, 1]]}"), {"end_m' is 0", "begin_m"}},
      {part("ribbon: {route: main, begin_m: 0, end_m: 9, profile_m: [[0, 0]]}"), {"profile_m' has one", "two points"}},
      {part("ribbon: {route: bend, begin_m: 0, end_m: 9, lateral_m: -21, profile_m: [[0, 0], [1, 1]]}"),
       {"lateral_m' is -21", "less than the radius", "20"}},
      {part("trees: {route: main, begin_m: 0, end_m: 1e5, lateral_m: 1, spacing_m: 1}"),
       {"spacing_m' is 1", "at least 5"}},
      {part("houses: {route: main, begin_m: 0, end_m: 9, lateral_m: 1, spacing_m: 9, jitter_m: 1}"),
       {"line 8", "unknown key 'statics.houses.jitter_m'"}},
      {part("terrain: {low_m: [0, 0], high_m: [9e4, 9e4]}"), {"cell_m' is 1", "at least 45"}},
      {part("height_field: {corner_m: [0, 0], cell_m: 1, heights_m: [[1, 2], [3]]}"), {"row 2 of", "2 numbers"}},
      {part("height_field: {corner_m: [0, 0], cell_m: 1, heights_m: [[1], [3]]}"), {"has 2 rows of 1", "at least 2"}},
      {part("mesh: {file: '', position_m: [0, 0, 0]}"), {"'statics.mesh.file' is ''", "a text"}},
      {part("mesh: {file: far.ply, position_m: [0, 0, 0]}"), {"line 8", "scale' makes the mesh reach beyond 100000"}},
      {body("bus: {route: main, speed_mps: 1}"), {"line 8", "'bus' is no body", "car, van, truck, pedestrian, object"}},
      {body("car: {route: main}"), {"line 8", "'speed_mps' is missing in 'bodies.car'", "0 to 100"}},
      {body("car: {route: main, speed_mps: 1, speed: [[1, 2]]}"), {"'bodies.car.speed' stands beside 'speed_mps'"}},
      {body("car: {route: bend, speed_mps: 1, lateral_m: 40}"), {"'bodies.car.lateral_m' is 40", "33.3333"}},
      {body("car: {route: main, speed_mps: 1, against: 1}"), {"'bodies.car.against' is '1'", "true, false"}},
      {body("car: {route: main, speed_mps: 1, name: 'a b'}"), {"'bodies.car.name' is 'a b'", "letters"}},
      {body("car: {route: main, free: {position_m: [0, 0, 0], velocity_mps: [0, 0, 0]}}"), {"free' stands beside"}},
      {body("object: {route: main, speed_mps: 1, parts: [box: {size_m: [1, 1, 1]}]}"), {"'name' is missing"}},
      {body("object: {name: x, route: main, speed_mps: 1}"), {"'bodies.object.parts' is empty", "box, cylinder"}},
      {body("object: {name: x, route: main, speed_mps: 1, parts: [ground: {}]}"), {"'ground' is no part of a body"}},
      {body("object: {name: x, parts: [box: {size_m: [1, 1, 1]}], free: {position_m: [0, 0, 0]}}"),
       {"'velocity_mps' is missing in 'bodies.object.free'", "3 numbers"}},
      {lane("{route: main, spacing_m: 7, count: 2, speed_mps: 1}"), {"line 8", "'lanes.spacing_m' is '7'", "8 to"}},
      {lane("{route: main, spacing_m: 13, count: 2, speed_mps: 1, truck_share: 0.1}"), {"'13'", "14 to 10000"}},
      {lane("{route: main, spacing_m: 20, count: 0, speed_mps: 1}"), {"'lanes.count' is '0'", "1 to 1000"}},
      {lane("{route: main, spacing_m: 20, count: 2.5, speed_mps: 1}"), {"'2.5'", "whole number"}},
  };
  for (const auto& [text, parts] : faults) {
    const std::string error = message(text);
    EXPECT_EQ(error.rfind((folder_ / "my-scene.yaml").string() + ": line ", 0), 0u) << error;
    for (const char* piece : parts) {
      EXPECT_NE(error.find(piece), std::string::npos) << error << "\n lacks: " << piece;
    }
  }
}

TEST_F(SceneFileErrors, RefusesFilesThatAreNone) {
  EXPECT_THROW(load_scene_file(folder_ / "none.yaml"), DataError);
  EXPECT_THROW(load("description: [\n"), DataError);
  EXPECT_THROW(load(""), UsageError);
  EXPECT_THROW(load("- 1\n"), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::scenes
