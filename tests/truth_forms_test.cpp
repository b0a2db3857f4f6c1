// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The forms of ground truth that lies beside a recording.
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tests/forms.hpp"

namespace dynamic_icp::tests::forms {
namespace {

std::string kitti_of(const formats::Trajectory& poses) {
  std::string text;
  for (const formats::StampedPose& pose : poses) {
    const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows = pose.T_world_sensor.matrix().topRows<3>();
    std::vector<double> numbers(rows.data(), rows.data() + rows.size());
    text += fmt::format("{}\n", fmt::join(numbers, " "));
  }
  return text;
}

TEST_F(OpenDoor, GroundTruthOfKittiAndTablesIsFoundAndTaken) {
  const fs::path plain = counted("point_clouds/{:05d}.bin", records<float>(xyzd))(drive(), folder_ / "plain");
  write(plain / "ref_poses.txt", drive().poses);
  const auto reference = datasets::open_dataset(plain);
  const formats::Trajectory& truth = reference->ground_truth();
  std::string table = "timestamp,x,y,z,qx,qy,qz,qw\n";
  std::istringstream lines(drive().poses);
  for (std::string line; std::getline(lines, line);) {
    table += line.front() == '#' ? "" : std::regex_replace(line, std::regex(" +"), ",") + "\n";
  }
  const std::pair<const char*, std::string> files[] = {{"poses.txt", kitti_of(truth)}, {"gt.csv", table}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const fs::path beside = counted("{:05d}.bin", records<float>(xyzd))(drive(), folder_ / name / "scans");
    write(beside / name, content);
    const auto found = datasets::open_dataset(beside);
    ASSERT_EQ(found->ground_truth().size(), truth.size());
    EXPECT_EQ(found->ground_truth_file().filename(), name);
    EXPECT_LT((found->ground_truth().back().T_world_sensor.matrix() - truth.back().T_world_sensor.matrix()).norm(),
              1e-6);
    const fs::path file = folder_ / "truths" / name;
    write(file, content);
    const std::string out = (folder_ / fmt::format("run_{}", name)).string();
    const Outcome run =
        run_program(fmt::format("run --quiet {} --ground-truth {} --output {}", plain.string(), file.string(), out));
    ASSERT_EQ(run.status, kDone) << run.text;
    EXPECT_LT(nlohmann::json::parse(read_file(fs::path(out) / "summary.json")).at("rte_rmse_m").get<double>(), 0.05);
    const Outcome evaluated = run_program(fmt::format("evaluate {}/trajectory.tum {}", out, file.string()));
    EXPECT_EQ(evaluated.status, kDone) << evaluated.text;
  }
  fs::remove(folder_ / "poses.txt" / "scans" / "00005.bin");
  const auto misfit = datasets::open_dataset(folder_ / "poses.txt" / "scans");
  EXPECT_TRUE(misfit->ground_truth().empty());
  EXPECT_NE(fmt::format("{}", fmt::join(misfit->assumptions(), "\n")).find("poses.txt: is not used as ground truth"),
            std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::tests::forms
