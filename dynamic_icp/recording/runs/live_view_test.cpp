// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What is sent is read by Foxglove's own client in tests/interop.
#include "dynamic_icp/recording/runs/live_view.hpp"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"

#include "testing/wall_drive.hpp"

namespace dynamic_icp::runs {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

LiveViewSettings on_free_port() {
  LiveViewSettings settings;
  settings.access.port = 0;
  return settings;
}

TEST(LiveView, WaitsForNobodyAndCountsWhatItLeavesOut) {
  const formats::Trajectory truth;
  LiveView view(on_free_port(), "test", truth, {});
  EXPECT_NE(view.authority(), "127.0.0.1:0");
  for (int k = 0; k < 500; ++k) {
    odometry::Frame frame;
    frame.stamp = Stamp{k};
    view.add({}, std::move(frame), 0.0);
  }
  EXPECT_LT(view.end("done"), 500U);
}

TEST(LiveView, TimesThatNoMessageHoldsAreNotShown) {
  const formats::Trajectory truth;
  LiveView view(on_free_port(), "test", truth, {});
  odometry::Frame frame;
  frame.stamp = Stamp{-5};
  view.add({}, std::move(frame), 0.0);
  EXPECT_EQ(view.end("done"), 0U);
}

TEST(LiveView, ARunIsTheSameWithAndWithout) {
  TestFolder folder;
  report::WallDrive().write(folder);
  RunSettings settings;
  settings.threads = 1;
  settings.save_labels = true;
  settings.output = folder.path() / "without";
  ASSERT_TRUE(run_recording({folder.path() / "drive", {}}, settings));
  settings.output = folder.path() / "with";
  settings.live = on_free_port();
  std::string authority;
  RunCallbacks callbacks;
  callbacks.listening = [&](const std::string& where) { authority = where; };
  ASSERT_TRUE(run_recording({folder.path() / "drive", {}}, settings, callbacks));
  EXPECT_TRUE(authority.starts_with("127.0.0.1:")) << authority;
  for (const char* file : {"trajectory.tum", "labels/000000.bin", "labels/000005.bin"}) {
    EXPECT_EQ(content_of(folder.path() / "with" / file), content_of(folder.path() / "without" / file)) << file;
  }
}

TEST(LiveView, APortThatIsTakenIsAnErrorBeforeTheFirstScan) {
  TestFolder folder;
  report::WallDrive().write(folder);
  const formats::Trajectory truth;
  const LiveView other(on_free_port(), "test", truth, {});
  RunSettings settings;
  settings.output = folder.path() / "out";
  settings.live = on_free_port();
  const std::string authority = other.authority();
  settings.live->access.port = static_cast<std::uint16_t>(std::stoi(authority.substr(authority.find(':') + 1)));
  EXPECT_THROW(run_recording({folder.path() / "drive", {}}, settings), DataError);
  EXPECT_FALSE(std::filesystem::exists(settings.output));
}

}  // namespace
}  // namespace dynamic_icp::runs
