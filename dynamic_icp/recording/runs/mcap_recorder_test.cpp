// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What is in the file is read by @mcap/core in tests/interop.
#include "dynamic_icp/recording/runs/mcap_recorder.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

class McapRecorderTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// A frame without anything but a pose; scan `k` of a drive along x.
  static odometry::Frame frame_at(int k) {
    odometry::Frame frame;
    frame.status = odometry::FrameStatus::kConverged;
    frame.stamp = Stamp{1'700'000'000'000'000'000 + 100'000'000LL * k};
    frame.T_world_sensor.translation().x() = k;
    return frame;
  }

  /// The size of the file of so many scans without points.
  [[nodiscard]] std::uintmax_t bytes_of(int scans, const formats::Trajectory& truth = {}) const {
    const fs::path path = folder_ / "size.mcap";
    McapRecorder recorder(path, truth, {});
    for (int k = 0; k < scans; ++k) {
      recorder.add({}, frame_at(k), 0.0);
    }
    recorder.commit();
    return fs::file_size(path);
  }

  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_ = fs::temp_directory_path() / ("mcap_recorder_test-" + std::to_string(::getpid()));
};

TEST_F(McapRecorderTest, AppearsWholeOrNotAtAll) {
  const formats::Trajectory truth;
  {
    McapRecorder recorder(folder_ / "a.mcap", truth, {});
    recorder.add({}, frame_at(0), 0.0);
    EXPECT_FALSE(fs::exists(folder_ / "a.mcap"));
  }
  EXPECT_EQ(files(), 0) << "what was not committed leaves nothing";
  McapRecorder recorder(folder_ / "a.mcap", truth, {});
  recorder.add({}, frame_at(0), 0.0);
  recorder.commit();
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(formats::kind_of_file(folder_ / "a.mcap"), formats::FileKind::kMcap);
}

// A path with all poses in every message would grow with the square of the scans.
TEST_F(McapRecorderTest, PathsStaySmallOnLongDrives) {
  constexpr int kScans = 2000;
  const double per_scan = static_cast<double>(bytes_of(2 * kScans) - bytes_of(kScans)) / kScans;
  const double next = static_cast<double>(bytes_of(3 * kScans) - bytes_of(2 * kScans)) / kScans;
  EXPECT_LT(next, 1.5 * per_scan);
}

TEST_F(McapRecorderTest, GroundTruthThatIsElsewhereIsLeftOut) {
  formats::Trajectory truth;
  for (int k = 0; k < 10; ++k) {
    truth.push_back({Stamp{100'000'000LL * k}, Eigen::Isometry3d::Identity()});
  }
  EXPECT_NO_THROW(static_cast<void>(bytes_of(3, truth)));
}

TEST_F(McapRecorderTest, RefusesTimesBefore1970) {
  const formats::Trajectory truth;
  McapRecorder recorder(folder_ / "a.mcap", truth, {});
  odometry::Frame frame = frame_at(0);
  frame.stamp.ns = -5;
  EXPECT_THROW(recorder.add({}, frame, 0.0), DataError);
}

TEST_F(McapRecorderTest, AFolderThatIsNotThereIsNamed) {
  const formats::Trajectory truth;
  try {
    const McapRecorder recorder(folder_ / "missing" / "a.mcap", truth, {});
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()),
              (folder_ / "missing" / "a.mcap").string() + ": cannot create: No such file or directory");
  }
}

TEST(FoxgloveLayout, IsJson) {
  const nlohmann::json layout = nlohmann::json::parse(foxglove_layout());
  EXPECT_TRUE(layout.contains("configById"));
  // Every panel that is placed is described.
  std::vector<nlohmann::json> parts = {layout["layout"]};
  std::size_t panels = 0;
  while (!parts.empty()) {
    const nlohmann::json part = parts.back();
    parts.pop_back();
    if (part.is_string()) {
      EXPECT_TRUE(layout["configById"].contains(part.get<std::string>())) << part;
      ++panels;
    } else {
      parts.push_back(part["first"]);
      parts.push_back(part["second"]);
    }
  }
  EXPECT_EQ(panels, layout["configById"].size());
}

/// Of a channel of "#rrggbb" in [0, 1], by the transfer function of sRGB (IEC 61966-2-1).
double linear_light(const std::string& colour, std::size_t channel) {
  const double value = std::stoi(colour.substr(1 + 2 * channel, 2), nullptr, 16) / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// Lichtblick mixes the ends of a gradient in linear light.
TEST(FoxgloveLayout, PointsThatStandAreGrey) {
  const nlohmann::json layout = nlohmann::json::parse(foxglove_layout());
  const nlohmann::json& points = layout["configById"]["3D!dynamic-icp"]["topics"]["/points"];
  ASSERT_EQ(points["colorMode"], "gradient");
  EXPECT_EQ(points["colorField"], "doppler_compensated");
  EXPECT_EQ(points["minValue"].get<double>(), -points["maxValue"].get<double>());
  std::array<double, 3> middle = {};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (const nlohmann::json& end : points["gradient"]) {
      middle[channel] += linear_light(end.get<std::string>(), channel) / 2.0;
    }
  }
  EXPECT_NEAR(middle[0], middle[1], 0.02);
  EXPECT_NEAR(middle[2], middle[1], 0.02);
}

TEST(FoxgloveLayout, PanelsHaveTheirTitlesUnderTheNamesOfBothPrograms) {
  const nlohmann::json layout = nlohmann::json::parse(foxglove_layout());
  for (const auto& [name, panel] : layout["configById"].items()) {
    if (name.starts_with("Plot!")) {
      EXPECT_FALSE(panel.value("foxglovePanelTitle", "").empty()) << name;
      EXPECT_EQ(panel.value("foxglovePanelTitle", ""), panel.value("lichtblickPanelTitle", "")) << name;
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::runs
