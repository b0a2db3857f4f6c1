// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The map of a run against the truth of the drive.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <sstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class SavedMap : public ProgramTest {};

using Point = std::array<double, 3>;

/// A pose as TUM files and objects.jsonl state it.
struct Pose {
  Point t{};
  std::array<double, 4> q{};  ///< x y z w

  /// R p by p + 2 v x (v x p + w p).
  [[nodiscard]] Point turn(const Point& p, double w) const {
    const auto cross = [&](const Point& b) -> Point {
      return {q[1] * b[2] - q[2] * b[1], q[2] * b[0] - q[0] * b[2], q[0] * b[1] - q[1] * b[0]};
    };
    const Point c = cross(p);
    const Point outer = cross({c[0] + w * p[0], c[1] + w * p[1], c[2] + w * p[2]});
    return {p[0] + 2.0 * outer[0], p[1] + 2.0 * outer[1], p[2] + 2.0 * outer[2]};
  }
  [[nodiscard]] Point out(const Point& p) const {
    const Point r = turn(p, q[3]);
    return {r[0] + t[0], r[1] + t[1], r[2] + t[2]};
  }
  [[nodiscard]] Point in(const Point& p) const { return turn({p[0] - t[0], p[1] - t[1], p[2] - t[2]}, -q[3]); }
};

std::vector<Pose> read_poses(const fs::path& path) {
  std::vector<Pose> poses;
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream numbers(line);
    double stamp = 0.0;
    Pose pose;
    if (numbers >> stamp >> pose.t[0] >> pose.t[1] >> pose.t[2] >> pose.q[0] >> pose.q[1] >> pose.q[2] >> pose.q[3]) {
      poses.push_back(pose);
    }
  }
  return poses;
}

std::vector<float> floats_of(const std::string& bytes) {
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

std::array<int, 3> cell_of(const Point& p, double edge_m) {
  std::array<int, 3> cell{};
  for (std::size_t i = 0; i < 3; ++i) {
    cell[i] = static_cast<int>(std::floor(p[i] / edge_m));
  }
  return cell;
}

/// The truth of a simulated drive of instant scans in world axes.
struct TrueScene {
  static constexpr double kEdge_m = 0.2;
  static constexpr double kGround_m = 0.3;  // what a body drives on lies in the lowest part of its box

  explicit TrueScene(const fs::path& drive) {
    const std::vector<Pose> poses = read_poses(drive / "ref_poses.txt");
    std::istringstream bodies(read_file(drive / "objects.jsonl"));
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const std::string name = "000" + std::string(k < 9 ? "0" : "") + std::to_string(k + 1) + ".bin";
      const std::vector<float> points = floats_of(read_file(drive / "point_clouds" / name));
      const std::string labels = read_file(drive / "labels" / name);
      for (std::size_t i = 0; 4 * i + 3 < points.size(); ++i) {
        const Point p = poses[k].out({points[4 * i], points[4 * i + 1], points[4 * i + 2]});
        std::int32_t label = 0;
        std::memcpy(&label, labels.data() + 4 * i, 4);
        all.push_back(p);
        if (label == 0) {
          still.insert(cell_of(p, kEdge_m));
        }
      }
      std::string line;
      std::getline(bodies, line);
      const json row = json::parse(line);
      for (const json& body : row["objects"]) {
        const auto c = body["center_sensor"].get<Point>();
        boxes.push_back(
            {poses[k], {c, body["orientation_sensor_xyzw"].get<std::array<double, 4>>()}, body["size"].get<Point>()});
      }
    }
  }

  /// Whether a surface that stands still was seen within a voxel's reach.
  [[nodiscard]] bool is_near_still(const Point& p) const {
    const std::array<int, 3> cell = cell_of(p, kEdge_m);
    for (int step = 0; step < 27; ++step) {
      if (still.contains({cell[0] + step % 3 - 1, cell[1] + step / 3 % 3 - 1, cell[2] + step / 9 - 1})) {
        return true;
      }
    }
    return false;
  }

  /// Whether a moving body was there at the time of a scan.
  [[nodiscard]] bool is_in_a_moving_box(const Point& p) const {
    for (const Box& box : boxes) {
      const Point q = box.T_sensor_body.in(box.T_world_sensor.in(p));
      if (std::abs(q[0]) < 0.5 * box.size[0] && std::abs(q[1]) < 0.5 * box.size[1] &&
          q[2] > kGround_m - 0.5 * box.size[2] && q[2] < 0.5 * box.size[2]) {
        return true;
      }
    }
    return false;
  }

  struct Box {
    Pose T_world_sensor;
    Pose T_sensor_body;
    Point size;
  };
  std::vector<Point> all;  ///< every measured point, whatever it is of
  std::set<std::array<int, 3>> still;
  std::vector<Box> boxes;
};

TEST_F(SavedMap, TheMapHoldsWhatStandsStillAndNothingThatMoves) {
  const TrueScene scene(street());
  // Without removal: every point, thinned alike.
  std::set<std::array<int, 3>> voxels;
  std::size_t of_bodies = 0;
  for (const Point& p : scene.all) {
    of_bodies += voxels.insert(cell_of(p, 0.1)).second && scene.is_in_a_moving_box(p) ? 1 : 0;
  }
  ASSERT_GT(of_bodies, 1000u) << "else the drive shows nothing";
  for (const std::string preset : {"default", "paper"}) {
    const std::string path = (folder_ / (preset + ".ply")).string();
    run_and_summarise(street().string() + " --preset " + preset + " --save-map " + path);
    const std::string bytes = read_file(path);
    const std::vector<float> numbers = floats_of(bytes.substr(bytes.find("end_header\n") + 11));
    const json record = json::parse(read_file(folder_ / "out" / "run.json"))["map"];
    EXPECT_EQ(record["path"], path);
    EXPECT_EQ(record["points"], numbers.size() / 3);
    ASSERT_GT(numbers.size() / 3, 50'000u) << preset;
    std::size_t in_boxes = 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      const Point p = {numbers[i], numbers[i + 1], numbers[i + 2]};
      ASSERT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) << preset;
      in_boxes += scene.is_in_a_moving_box(p) ? 1 : 0;
      far += scene.is_near_still(p) ? 0 : 1;
    }
    EXPECT_LT(in_boxes, of_bodies / 50) << preset;
    EXPECT_LT(far, numbers.size() / 3 / 500) << preset;
  }
}

TEST_F(SavedMap, TheMapIsTheSameInBothFormatsAndMayLieInTheRun) {
  const std::string arguments = street().string() + " --max-frames 3 --map-voxel 0.5 --save-map ";
  run_and_summarise(arguments + (folder_ / "map.ply").string());
  const std::string ply = read_file(folder_ / "map.ply");
  const std::string points = ply.substr(ply.find("end_header\n") + 11);
  ASSERT_GT(points.size(), 12'000u);
  const fs::path inside = folder_ / "out" / "maps" / "map.pcd";
  for (int round = 0; round < 2; ++round) {  // the second one replaces the first
    run_and_summarise(arguments + inside.string() + (round == 1 ? " --threads 1" : " --threads 3"));
    const std::string pcd = read_file(inside);
    EXPECT_TRUE(pcd.ends_with("\nPOINTS " + std::to_string(points.size() / 12) + "\nDATA binary\n" + points));
    EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["map"]["path"], inside.string());
  }
  run_and_summarise(street().string() + " --max-frames 2");
  EXPECT_TRUE(json::parse(read_file(folder_ / "out" / "run.json")).at("map").is_null());
  EXPECT_FALSE(fs::exists(inside)) << "it was part of the earlier run";
  const Outcome relative = run_shell("cd '" + folder_.string() + "' && '" DYNAMIC_ICP_PROGRAM "' run " +
                                     street().string() + " --max-frames 2 --output here --save-map here.pcd");
  EXPECT_EQ(relative.status, 0) << relative.text;
  EXPECT_NE(relative.text.find("points in here.pcd"), std::string::npos) << relative.text;
  EXPECT_TRUE(fs::exists(folder_ / "here.pcd")) << "of the working directory";
}

}  // namespace
}  // namespace dynamic_icp::tests
