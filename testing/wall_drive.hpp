// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "testing/sample_run.hpp"

// For tests of reports: a drive in a world of planes, as a recording and as the run that a perfect method leaves.
namespace dynamic_icp::report {

/// A sensor that drives along x at 10 m/s, a scan each 0.1 s, over the ground z = -1.7 between a wall y = 8 and, ahead,
/// one at x = 120. A car of four walls, 4 m x 2 m, drives at 15 m/s ahead of it. Points are exact.
struct WallDrive {
  std::size_t frames = 6;
  std::size_t points = 3000;
  bool save_labels = true;
  double sweep_s = 0.0;  ///< how long a scan takes; its points are measured one after the other

  static constexpr double kGround_m = -1.7;
  static constexpr double kSide_m = 8.0;
  static constexpr double kAhead_m = 120.0;
  static constexpr double kEgo_mps = 10.0;
  static constexpr double kCar_mps = 15.0;

  /// At a time after the first scan, s.
  [[nodiscard]] static Eigen::Vector3d sensor(double t) { return {kEgo_mps * t, 0.0, 0.0}; }
  [[nodiscard]] static double car_x(double t) { return 20.0 + kCar_mps * t; }
  [[nodiscard]] static double seconds(std::size_t frame) { return 0.1 * static_cast<double>(frame); }

  struct Point {
    double time = 0.0;  ///< s after the stamp
    Eigen::Vector3d world;
    bool on_car = false;
  };

  [[nodiscard]] std::vector<Point> scene(std::size_t frame) const {
    std::mt19937 random(static_cast<std::uint32_t>(frame + 1));
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    std::vector<Point> all;
    for (std::size_t k = 0; k < points; ++k) {
      const double time = sweep_s * static_cast<double>(k) / static_cast<double>(points);
      const double x = sensor(seconds(frame) + time).x();
      if (k % 10 == 0) {
        all.push_back({time, {car_x(seconds(frame) + time), uniform(-1.0, 1.0), uniform(-1.5, 0.0)}, true});
      } else if (k % 10 < 5) {
        const double range = 5.0 + 60.0 * std::pow(uniform(0.0, 1.0), 2.0);  // dense near, thin far
        all.push_back({time, {x + range, uniform(-6.0, 6.0), kGround_m}, false});
      } else if (k % 10 < 9) {
        all.push_back({time, {x + uniform(2.0, 70.0), kSide_m, uniform(-1.5, 3.0)}, false});
      } else {
        all.push_back({time, {kAhead_m, uniform(-6.0, 6.0), uniform(-1.5, 4.0)}, false});
      }
    }
    return all;
  }

  void write(const runs::TestFolder& folder) const {
    std::string truth;
    std::string trajectory;
    std::string rows;
    std::string objects;
    for (std::size_t k = 0; k < frames; ++k) {
      const std::string stamp = fmt::format("{}.{}00000000", 100 + k / 10, k % 10);
      const std::string pose = fmt::format("{} {} 0 0 0 0 0 1\n", stamp, sensor(seconds(k)).x());
      truth += pose;
      trajectory += pose;
      std::string bytes;
      std::string labels;
      std::string times;
      for (const Point& point : scene(k)) {
        const Eigen::Vector3d p = point.world - sensor(seconds(k) + point.time);
        const double doppler = p.x() / p.norm() * ((point.on_car ? kCar_mps : 0.0) - kEgo_mps);
        for (const double value : {p.x(), p.y(), p.z(), doppler}) {
          append(bytes, static_cast<float>(value));
        }
        append(times, static_cast<float>(point.time));
        append(labels, std::int32_t{point.on_car ? 7 : 0});
      }
      folder.write(fmt::format("drive/point_clouds/{:05}.bin", k + 1), bytes);
      if (sweep_s > 0.0) {
        folder.write(fmt::format("drive/times/{:05}.bin", k + 1), times);
      }
      if (save_labels) {
        folder.write(fmt::format("run/labels/{:05}.bin", k + 1), labels);
      }
      rows += fmt::format(
          R"({{"index":{0},"timestamp":{1},"points":{2},"points_used":{2},"ego_velocity":[10,0,0],)"
          R"("dynamic_candidates":{3},"dynamic_clustered":{3},"dynamic_refined":{3},"iterations":5,"converged":true,)"
          R"("status":"ok","reason":"{4}","fitness":1,"inlier_rmse":0.01,"information_ratio":0.5,"degenerate":[],)"
          R"("twist":{{"angular":[0,0,0],"linear":[10,0,0]}},"ms":{{"preprocess":1.5,"total":4}}}})"
          "\n",
          k, stamp, points, (points + 9) / 10, k == 0 ? "first" : "converged");
      objects +=
          fmt::format(R"({{"index":{},"timestamp":{},"objects":[{{"id":7,"velocity":[15,0,0],"centroid":[{},0,-0.75],)"
                      R"("extent":[4,2,1.5],"points":{}}}]}})"
                      "\n",
                      k, stamp, car_x(seconds(k)) - sensor(seconds(k)).x(), (points + 9) / 10);
    }
    folder.write("drive/ref_poses.txt", truth);
    folder.write("run/trajectory.tum", trajectory);
    folder.write("run/frames.jsonl", rows);
    folder.write("run/objects.jsonl", objects);
    folder.write("run/summary.json", fmt::format(R"({{"method":"dynamic-icp","frames":{},"rte_rmse_m":0.0}})", frames));
    folder.write("run/run.json",
                 fmt::format(R"({{"version":"0.1.0","command":"dynamic-icp run drive","input":{{"path":"{}",)"
                             R"("format":"dicp"}},"method":"dynamic-icp","preset":"default","configuration":{{}},)"
                             R"("sweep":{{"deskewed":{}}},"ground_truth":"{}"}})",
                             (folder.path() / "drive").string(), sweep_s > 0.0,
                             (folder.path() / "drive/ref_poses.txt").string()));
  }

 private:
  template <class Value>
  static void append(std::string& bytes, Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }
};

}  // namespace dynamic_icp::report
