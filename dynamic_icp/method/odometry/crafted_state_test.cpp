// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// Saved states that somebody changed, with a checksum that fits: refused, or no harm comes of them.
#include "testing/crafted_state.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"

#include "testing/synthetic_drive.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

/// How many states of each method are tried; more with CRAFTED_STATES.
int tries() {
  const char* const wanted = std::getenv("CRAFTED_STATES");
  return wanted != nullptr ? std::atoi(wanted) : 60;
}

Drive small_drive() {
  Drive drive{street_with_cars(), agile(10.0), sweeping()};
  drive.sensor.columns = 80;
  drive.sensor.rows = 16;
  return drive;
}

TEST(CraftedState, IsRefusedOrDoesNoHarm) {
  constexpr int kScans = 5;
  const Drive drive = small_drive();
  int refused = 0;
  int loaded = 0;
  for (const Pipeline& pipeline : pipelines()) {
    SCOPED_TRACE(std::string(pipeline.method) + " " + std::string(pipeline.preset));
    const auto odometry = make_odometry(pipeline.config, {}, 1);
    std::vector<std::string> states;
    for (int k = 0; k < kScans; ++k) {
      odometry->process(drive.scan(k));
      states.push_back(odometry->save());
    }
    const RandomSource random(static_cast<std::uint64_t>(tries()));
    std::uint64_t drawn = 0;
    for (int k = 0; k < tries(); ++k) {
      const int after = k % kScans;
      std::string state = states[static_cast<std::size_t>(after)];
      crafted::remove_checksum(state);
      for (int edit = 0; edit <= k % 3; ++edit) {
        crafted::StateEdit(random.bits(drawn), random.bits(drawn + 1)).apply(state);
        drawn += 2;
      }
      StateArchive::seal(state);
      const auto other = make_odometry(pipeline.config, {}, 1);
      try {
        other->load(state);
      } catch (const DataError&) {
        ++refused;
        continue;
      }
      ++loaded;
      try {
        other->process(drive.scan(after + 1));
        other->process(drive.scan(after + 2));
      } catch (const DataError&) {  // a scan that comes too early for what was read
      }
    }
  }
  EXPECT_GT(refused, tries());
  EXPECT_GT(loaded, tries());
}

TEST(CraftedState, AllThatHoldsOfAnOwnStateIsNotAskedInVain) {
  // What is refused above is refused for what was changed: unchanged, each state is read.
  const Drive drive = small_drive();
  for (const Pipeline& pipeline : pipelines()) {
    const auto odometry = make_odometry(pipeline.config, {}, 1);
    odometry->process(drive.scan(0));
    std::string state = odometry->save();
    crafted::remove_checksum(state);
    StateArchive::seal(state);
    EXPECT_NO_THROW(make_odometry(pipeline.config, {}, 1)->load(state));
  }
}

}  // namespace
}  // namespace dynamic_icp::odometry
