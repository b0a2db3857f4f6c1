// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/scenes/scene.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::scenes {
namespace {

TEST(Scenes, AreNamedOnceAndFound) {
  std::set<std::string> names;
  for (const SceneKind& kind : scene_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(&find_scene(kind.name), &kind);
    EXPECT_FALSE(kind.description.empty());
  }
}

TEST(Scenes, NamesOfTheLastReleaseAreUnderstood) {
  EXPECT_EQ(&find_scene("jam"), &find_scene("traffic-jam"));
  EXPECT_EQ(&find_scene("car-park"), &find_scene("parking"));
  EXPECT_EQ(&find_scene("standing"), &find_scene("stationary"));
}

TEST(Scenes, UnknownNameIsRefusedWithTheKnownOnes) {
  try {
    find_scene("moon");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("'moon'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("street"), std::string::npos);
  }
}

TEST(Scenes, KnobsOutOfRangeAreRefused) {
  SceneKnobs knobs;
  knobs.traffic = -1.0;
  EXPECT_THROW(build_scene(find_scene("street"), knobs, 6.0), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::scenes
