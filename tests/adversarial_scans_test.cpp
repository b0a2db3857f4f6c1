// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "testing/adversarial_scans.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"

namespace dynamic_icp::odometry {
namespace {

// DYNAMIC_ICP_FRAMES: frames of each pipeline, for long runs.
int frames_of_each() {
  const char* frames = std::getenv("DYNAMIC_ICP_FRAMES");
  return frames != nullptr ? std::atoi(frames) : 500;
}

class AdversarialScans : public ::testing::TestWithParam<Pipeline> {};

// A drive in a hall, most of it usable, with damage of all kinds: every frame keeps what the documentation promises.
TEST_P(AdversarialScans, GiveFiniteFrames) {
  constexpr int kScansPerDrive = 25;
  int converged_frames = 0;
  int frames = 0;
  for (std::uint64_t drive = 0; frames < frames_of_each(); ++drive) {
    adversarial::ScanGenerator scans(drive);
    const std::unique_ptr<Odometry> odometry = make_odometry(GetParam().config, {}, 1);
    std::optional<Stamp> last;
    for (int k = 0; k < kScansPerDrive; ++k) {
      const RawScan raw = scans.next();
      if (last && raw.stamp <= *last) {
        EXPECT_THROW(odometry->process(raw), DataError);
        continue;
      }
      const double dt_s = last ? seconds_between(*last, raw.stamp) : 0.0;
      const Frame frame = odometry->process(raw);
      const std::optional<std::string> fault = adversarial::fault_of(frame, raw, dt_s);
      ASSERT_FALSE(fault) << *fault << ": scan " << k << " of drive " << drive << ", " << to_string(frame.status);
      converged_frames += converged(frame.status) ? 1 : 0;
      last = raw.stamp;
      ++frames;
    }
  }
  EXPECT_GT(converged_frames, frames / 20) << "hardly any scan gets as far as the alignment";
}

INSTANTIATE_TEST_SUITE_P(Pipelines, AdversarialScans, ::testing::ValuesIn(pipelines()), [](const auto& pipeline) {
  std::string name = fmt::format("{}_{}", pipeline.param.method, pipeline.param.preset);
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace dynamic_icp::odometry
