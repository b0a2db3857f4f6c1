// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/nearest_key.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp {
namespace {

TEST(NearestKey, TakesTheFewestChanges) {
  const std::vector<std::string> keys = {"speed_mps", "spacing_m", "grid.size_m"};
  EXPECT_EQ(nearest_key("sped_mps", keys), "speed_mps");
  EXPECT_EQ(nearest_key("spacing", keys), "spacing_m");
  EXPECT_EQ(nearest_key("sise_m", keys), "grid.size_m");
  EXPECT_EQ(nearest_key("", std::vector<std::string>{"ab", "cd"}), "ab");
  EXPECT_EQ(nearest_key("speed", {}), "");
  EXPECT_EQ(nearest_key("speed" + std::string(100'000'000, 's'), keys), "speed_mps")
      << "of endless words the beginning counts";
}

TEST(NearestKey, APartOfAKeyIsNearerThanAnotherWord) {
  const std::vector<std::string> keys = {"sweep.levels", "filter.voxel.voxel_size_m", "window.knot_spacing_s",
                                         "kiss-icp"};
  EXPECT_EQ(nearest_key("voxel", keys), "filter.voxel.voxel_size_m");
  EXPECT_EQ(nearest_key("window.knot", keys), "window.knot_spacing_s");
  EXPECT_EQ(nearest_key("sweep.level", keys), "sweep.levels");
  EXPECT_EQ(close_key("kiss", keys), "kiss-icp");
  EXPECT_EQ(close_key("KISS-ICP", keys), "kiss-icp");
  EXPECT_EQ(nearest_key("levels", std::vector<std::string>{"levels_of_all", "levels"}), "levels") << "the same word";
}

/// The optimal string alignment distance by its definition.
std::size_t edits(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) {
    return a.size() + b.size();
  }
  const std::string_view shorter_a = a.substr(0, a.size() - 1);
  const std::string_view shorter_b = b.substr(0, b.size() - 1);
  std::size_t least = std::min(
      {edits(shorter_a, b) + 1, edits(a, shorter_b) + 1, edits(shorter_a, shorter_b) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    least = std::min(least, edits(a.substr(0, a.size() - 2), b.substr(0, b.size() - 2)) + 1);
  }
  return least;
}

TEST(NearestKey, IsTheFirstOfThoseWithTheFewestChanges) {
  std::mt19937 random(7);
  const auto word = [&](std::size_t longest) {
    std::string text(random() % (longest + 1), 'a');
    std::generate(text.begin(), text.end(), [&] { return "ab."[random() % 3]; });
    return text;
  };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::string> keys(5);
    std::generate(keys.begin(), keys.end(), [&] { return word(6); });
    const std::string typed = word(6);
    const auto distance = [&](const std::string& key) {
      const std::size_t changes = 2 * std::min(edits(typed, key), edits(typed, key.substr(key.rfind('.') + 1)));
      const bool is_part = typed.size() >= 3 && key.find(typed) != std::string::npos;
      return is_part ? std::min<std::size_t>(changes, 1) : changes;
    };
    const auto expected = std::min_element(keys.begin(), keys.end(), [&](const std::string& a, const std::string& b) {
      return distance(a) < distance(b);
    });
    EXPECT_EQ(nearest_key(typed, keys).data(), expected->data()) << typed;
  }
}

TEST(ParseNumber, TakesWholeTextsOnly) {
  EXPECT_EQ(parse_number<double>("-1.5e2"), -150.0);
  EXPECT_EQ(parse_number<int>("+7"), 7);
  for (const char* text : {"", "+", "-", "+-1", "++1", " 1", "1 ", "1,5", "0x1", "one"}) {
    EXPECT_FALSE(parse_number<double>(text)) << text;
    EXPECT_FALSE(parse_number<int>(text)) << text;
  }
  EXPECT_FALSE(parse_number<int>("1.0"));
  EXPECT_FALSE(parse_number<int>("3000000000"));
  EXPECT_FALSE(parse_number<double>("1e999"));
}

TEST(CloseKey, IsSilentWhereAWordIsFarFromAll) {
  const std::vector<std::string> commands = {"run", "evaluate", "benchmark", "info"};
  EXPECT_EQ(close_key("evalute", commands), "evaluate");
  EXPECT_EQ(close_key("benchmrak", commands), "benchmark");
  EXPECT_EQ(close_key("rum", commands), "run");
  EXPECT_EQ(close_key("ifno", commands), "info");
  for (const char* typed : {"rnu", "urn", "rn", "ruun"}) {
    EXPECT_EQ(close_key(typed, commands), "run") << typed;
  }
  EXPECT_EQ(close_key("nur", commands), "") << "two changes of three letters";
  EXPECT_EQ(close_key("fly", commands), "");
  EXPECT_EQ(close_key("fly", {}), "");
  EXPECT_EQ(did_you_mean("evalute", commands), " (did you mean 'evaluate'?)");
  EXPECT_EQ(did_you_mean("fly", commands), "");
}

}  // namespace
}  // namespace dynamic_icp
