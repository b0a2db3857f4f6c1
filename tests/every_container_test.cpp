// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// A simulated drive through every container, written by programs of others: one sensor, and a rig of two.
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

#include "testing/bags_by_hand.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

bool can_run(const std::string& command) { return run_shell(command).status == 0; }

/// How a container is read.
struct Container {
  std::string name;
  std::string format;
  std::string options = {};
};

/// The two sensors of the rig, one ahead and one behind: poses on the vehicle as x, y, z (m) and quaternion x, y, z, w.
/// With these numbers a point is moved from one sensor to the other without any rounding.
constexpr const char* kFront = "front=1.5,0.25,2,0,0,0,1";
constexpr const char* kRear = "rear=-1.5,-0.25,2,0,0,1,0";

class EveryContainer : public ProgramTest {
 protected:
  [[nodiscard]] static fs::path scripts() { return source_folder() / "tests" / "interop"; }

  /// Simulated time begins at 0, which is no time that a recorder writes.
  static void shift_to_today(const fs::path& poses) {
    std::istringstream lines(read_file(poses));
    std::string shifted;
    for (std::string line; std::getline(lines, line);) {
      EXPECT_TRUE(line.starts_with("0.")) << line;
      shifted += "170000000" + line + "\n";
    }
    write_file(poses, shifted);
  }

  [[nodiscard]] fs::path simulate(const std::string& more) const {
    const fs::path path = folder_ / "drive";
    const Outcome made =
        run_program("simulate city --quiet --frames 5 --set lidar.columns=300 --set lidar.rows=40 --output " +
                    path.string() + " " + more);
    EXPECT_EQ(made.status, 0) << made.text;
    fs::create_directories(folder_ / "bags");
    return path;
  }

  [[nodiscard]] fs::path drive() const {
    const fs::path path = simulate("");
    shift_to_today(path / "ref_poses.txt");
    return path;
  }

  /// A drive of the rig, a folder for each sensor; the one behind is 31.25 ms late.
  [[nodiscard]] fs::path rig_drive() const {
    const std::string lidar =
        "{horizontal_fov_deg: 120.0, vertical_fov_deg: 19.2, columns: 300, rows: 40, rate_hz: 10.0, sweep_s: 0.1, "
        "max_range_m: 200.0, detection_range_m: 150.0, doppler_noise_mps: 0.1, range_noise_m: 0.02";
    write_file(folder_ / "rig.yaml",
               "description: one LiDAR ahead and one behind\nsensors:\n"
               "  - name: front\n    mount: {x_m: 1.5, y_m: 0.25, z_m: 2.0, roll_deg: 0.0, pitch_deg: 0.0, yaw_deg: "
               "0.0}\n    lidar: " +
                   lidar +
                   "}\n  - name: rear\n    mount: {x_m: -1.5, y_m: -0.25, z_m: 2.0, roll_deg: 0.0, pitch_deg: 0.0, "
                   "yaw_deg: 180.0}\n    lidar: " +
                   lidar + ", timing: {start_s: 0.03125}}\n");
    const fs::path path = simulate("--sensor " + (folder_ / "rig.yaml").string());
    shift_to_today(path / "front" / "ref_poses.txt");
    shift_to_today(path / "rear" / "ref_poses.txt");
    return path;
  }

  void write_with(const std::string& program, const char* script, const fs::path& from,
                  const std::string& more = "") const {
    const Outcome wrote = run_shell(program + " '" + (scripts() / script).string() + "' '" + from.string() + "' '" +
                                    (folder_ / "bags").string() + "' " + more + " 2>&1");
    ASSERT_EQ(wrote.status, 0) << wrote.text;
  }

  /// The databases of the recorder's own two compressions.
  void pack_db3() const {
    fs::create_directories(folder_ / "bags" / "drive-db3-zstd");
    write_file(folder_ / "bags/drive-db3-zstd/drive_0.db3.zstd",
               by_hand::packed("zstd", read_file(folder_ / "bags/drive-db3/drive_0.db3")));
    write_file(folder_ / "bags/drive-db3-zstd/metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
               "  relative_file_paths: [drive_0.db3.zstd]\n  compression_format: zstd\n  compression_mode: FILE\n");
  }

  [[nodiscard]] std::string trajectory(const fs::path& input, const Container& container) {
    const fs::path out = folder_ / fmt::format("run-{}", ++runs_);
    const Outcome ran =
        run_program("run --quiet " + input.string() + " --output " + out.string() + " " + container.options);
    EXPECT_EQ(ran.status, 0) << ran.text;
    const json run = json::parse(read_file(out / "run.json"));
    EXPECT_EQ(run["input"]["format"], container.format);
    return read_file(out / "trajectory.tum");
  }

  void expect_same(const std::string& expected, const std::vector<Container>& containers) {
    ASSERT_GT(expected.size(), 100U);
    for (const Container& container : containers) {
      EXPECT_EQ(trajectory(folder_ / "bags" / container.name, container), expected) << container.name;
    }
  }

  /// The scans of both sensors as one, in files of columns: the same numbers by other means.
  [[nodiscard]] fs::path merged(const fs::path& from) const {
    const fs::path folder = folder_ / "merged";
    fs::create_directories(folder);
    const auto front = datasets::open_dataset(from / "front");
    const auto rear = datasets::open_dataset(from / "rear");
    EXPECT_EQ(front->size(), rear->size());
    for (std::size_t i = 0; i < front->size(); ++i) {
      std::vector<double> points;
      std::vector<double> los;
      std::vector<double> doppler;
      std::vector<double> times;
      std::vector<std::uint8_t> sensor;
      for (const datasets::Dataset* dataset : {front.get(), rear.get()}) {
        const bool is_rear = dataset == rear.get();
        const RawScan scan = dataset->scan(i);
        for (std::size_t k = 0; k < scan.points.size(); ++k) {
          const Eigen::Vector3d& p = scan.points[k];
          const Eigen::Vector3d u = p.stableNormalized();
          const double sign = is_rear ? -1.0 : 1.0;
          points.insert(points.end(),
                        {sign * p.x() - (is_rear ? 3.0 : 0.0), sign * p.y() - (is_rear ? 0.5 : 0.0), p.z()});
          los.insert(los.end(), {sign * u.x(), sign * u.y(), u.z()});
          doppler.push_back(scan.doppler[k]);
          times.push_back(seconds_between(front->stamp(i), dataset->stamp(i)) + scan.times[k]);
          sensor.push_back(is_rear ? 1 : 0);
        }
      }
      const std::size_t rows = doppler.size();
      const auto table = [&](const char* name, const std::vector<double>& values) {
        return formats::NamedArray{name, formats::npy_array<double>({rows, 3}, values)};
      };
      const auto column = [&]<class Number>(const char* name, const std::vector<Number>& values) {
        return formats::NamedArray{name, formats::npy_array<Number>({rows}, values)};
      };
      const std::int64_t ns = front->stamp(i).ns;
      const std::vector<formats::NamedArray> members = {table("points", points), table("los", los),
                                                        column("doppler", doppler), column("time_offset_s", times),
                                                        column("sensor", sensor)};
      write_file(folder / fmt::format("{}.{:09d}.npz", ns / 1'000'000'000, ns % 1'000'000'000),
                 formats::npz_bytes(members));
    }
    write_file(
        folder / "calibration.json",
        R"({"T_V_to_S": {"translation": {"x": 1.5, "y": 0.25, "z": 2}, "quaternion": {"w": 1, "x": 0, "y": 0, "z": 0}},
 "sensors": [{"T_scan_sensor": {"translation": {"x": 0, "y": 0, "z": 0}, "quaternion": {"w": 1, "x": 0, "y": 0, "z": 0}}},
  {"T_scan_sensor": {"translation": {"x": -3, "y": -0.5, "z": 0}, "quaternion": {"w": 0, "x": 0, "y": 0, "z": 1}}}]})");
    return folder;
  }

  /// Of one drive, or of the sensor ahead alone.
  static std::vector<Container> python_bags(const std::string& options) {
    return {{"drive-none.bag", "rosbag", options},
            {"drive-bz2.bag", "rosbag", options},
            {"drive-lz4.bag", "rosbag", options},
            {"drive-db3", "rosbag2", options},
            {"drive-db3-zstd", "rosbag2", options}};
  }
  static std::vector<Container> mcap_files(const std::string& options) {
    return {{"drive-ros1.mcap", "mcap", options},
            {"drive-ros2.mcap", "mcap", options},
            {"drive-protobuf.mcap", "mcap", options},
            {"drive-json.mcap", "mcap", options},
            {"drive-mcap", "rosbag2", options}};
  }

  static bool has_rosbag() { return can_run("/usr/bin/python3 -c 'import rosbag, sqlite3'"); }
  static bool has_mcap() { return fs::exists(scripts() / "node_modules/@mcap/core") && can_run("node --version"); }

  int runs_ = 0;
};

constexpr const char* kBothTopics = "--topic /front/points --topic /rear/points";

TEST_F(EveryContainer, BagsOfPythonGiveTheTrajectoryOfThePlainLayoutBitForBit) {
  if (!has_rosbag()) {
    GTEST_SKIP() << "no rosbag: python3-rosbag of Debian";
  }
  const fs::path from = drive();
  write_with("/usr/bin/python3", "write_drive.py", from);
  pack_db3();
  expect_same(trajectory(from, {"", "dicp"}), python_bags(""));
}

TEST_F(EveryContainer, FilesOfMcapsAuthorsGiveTheTrajectoryOfThePlainLayoutBitForBit) {
  if (!has_mcap()) {
    GTEST_SKIP() << "no @mcap/core: scripts/install_viewer.sh tests";
  }
  const fs::path from = drive();
  write_with("node", "write_drive.mjs", from);
  expect_same(trajectory(from, {"", "dicp"}), mcap_files(""));
}

TEST_F(EveryContainer, FilesOfNumpyGiveTheTrajectoryOfThePlainLayoutBitForBit) {
  if (!can_run("/usr/bin/python3 -c 'import numpy'")) {
    GTEST_SKIP() << "no numpy: python3-numpy of Debian";
  }
  const fs::path from = drive();
  write_with("/usr/bin/python3", "write_drive_files.py", from);
  const std::string columns = "--columns x,y,z,doppler,time_offset_s";
  expect_same(trajectory(from, {"", "dicp"}), {{"npz", "npz"},
                                               {"npz-packed", "npz"},
                                               {"npy", "npz", columns},
                                               {"bin-float32", "bin", columns},
                                               {"bin-float64", "bin", columns + " --dtype float64"},
                                               {"csv", "csv"},
                                               {"txt", "csv"},
                                               {"pcd-ascii", "pcd"},
                                               {"pcd-binary", "pcd"},
                                               {"pcd-compressed", "pcd"},
                                               {"ply-ascii", "ply"},
                                               {"ply-little", "ply"},
                                               {"ply-big", "ply"}});
}

TEST_F(EveryContainer, ARigInBagsOfPythonIsTheRigOfItsSensors) {
  if (!has_rosbag()) {
    GTEST_SKIP() << "no rosbag: python3-rosbag of Debian";
  }
  const fs::path from = rig_drive();
  write_with("/usr/bin/python3", "write_drive.py", from, fmt::format("{} {}", kFront, kRear));
  pack_db3();
  expect_same(trajectory(merged(from), {"", "npz"}), python_bags(kBothTopics));
  expect_same(trajectory(from / "front", {"", "dicp"}), python_bags("--topic /front/points"));
}

TEST_F(EveryContainer, ARigInFilesOfMcapsAuthorsIsTheRigOfItsSensors) {
  if (!has_mcap()) {
    GTEST_SKIP() << "no @mcap/core: scripts/install_viewer.sh tests";
  }
  const fs::path from = rig_drive();
  write_with("node", "write_drive.mjs", from, fmt::format("{} {}", kFront, kRear));
  expect_same(trajectory(merged(from), {"", "npz"}), mcap_files(kBothTopics));
  expect_same(trajectory(from / "rear", {"", "dicp"}), mcap_files("--topic /rear/points"));
}

TEST_F(EveryContainer, ARigMayBeConvertedAndOneThatIsMountedOtherwiseIsSaidToBe) {
  if (!has_rosbag()) {
    GTEST_SKIP() << "no rosbag: python3-rosbag of Debian";
  }
  const fs::path from = rig_drive();
  write_with("/usr/bin/python3", "write_drive.py", from, fmt::format("{} {}", kFront, kRear));
  const fs::path bag = folder_ / "bags" / "drive-lz4.bag";
  const std::string expected = trajectory(bag, {"", "rosbag", kBothTopics});
  for (const std::string to : {"npz", "pcd", "mcap"}) {
    const fs::path converted = folder_ / "bags" / ("to-" + to);
    const Outcome outcome = run_program(
        fmt::format("convert {} {} --quiet --to {} --output {}", bag.string(), kBothTopics, to, converted.string()));
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(trajectory(converted, {"", to}), expected) << to;
  }
  // By the poses of the sensor ahead the rig is right; with the one behind turned by 60 degrees it is not.
  const std::string truth = fmt::format(" --ground-truth {}", (from / "front" / "ref_poses.txt").string());
  const json summary = run_and_summarise(bag.string() + " " + kBothTopics + truth);
  EXPECT_LT(summary.at("rte_rmse_m").get<double>(), 0.002);
  fs::remove_all(folder_ / "bags");
  fs::create_directories(folder_ / "bags");
  write_with("/usr/bin/python3", "write_drive.py", from,
             fmt::format("{} rear=-1.5,-0.25,2,0,0,{},0.5", kFront, std::sqrt(0.75)));
  const Outcome warned =
      run_program(fmt::format("run {} {} --output {}", bag.string(), kBothTopics, (folder_ / "wrong").string()));
  EXPECT_NE(warned.text.find("the mountings contradict the data: next to sensor 0, sensor 1 moves"), std::string::npos)
      << warned.text;
}

}  // namespace
}  // namespace dynamic_icp::tests
