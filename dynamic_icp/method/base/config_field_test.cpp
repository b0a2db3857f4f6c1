// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/config_field.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp {
namespace {

struct Settings {
  double size_m = 0.3;
  int count = 10;
  bool active = true;
};

ConfigFields fields(Settings& settings) {
  return {{"size_m", &settings.size_m, 0.01, 100.0, "m", "edge length"},
          {"count", &settings.count, 1, 1000, "", "how many"},
          {"active", &settings.active, 0, 0, "", "whether at all"}};
}

std::string message_of(const ConfigFields& all, const char* key, const char* text) {
  try {
    set_field(all, key, text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ConfigField, SetsEveryKindOfValue) {
  Settings settings;
  ConfigFields all;
  append_fields(all, "grid", fields(settings));
  set_field(all, "grid.size_m", "0.25");
  set_field(all, "grid.count", "7");
  set_field(all, "grid.active", "false");
  EXPECT_EQ(settings.size_m, 0.25);
  EXPECT_EQ(settings.count, 7);
  EXPECT_FALSE(settings.active);
}

TEST(ConfigField, TextReadsBackToTheSameValue) {
  Settings settings;
  settings.size_m = 0.1 + 0.2;
  const ConfigFields all = fields(settings);
  const std::string text = value_text(all[0]);
  settings.size_m = 1.0;
  set_field(all, "size_m", text);
  EXPECT_EQ(settings.size_m, 0.1 + 0.2);
}

TEST(ConfigField, ErrorsNameTheKeyAndTheRange) {
  Settings settings;
  ConfigFields all;
  append_fields(all, "grid", fields(settings));
  EXPECT_EQ(message_of(all, "grid.size_m", "-1"), "configuration key 'grid.size_m' is '-1', expected 0.01 to 100 m");
  EXPECT_EQ(message_of(all, "grid.count", "2.5"),
            "configuration key 'grid.count' is '2.5', expected a whole number from 1 to 1000");
  EXPECT_EQ(message_of(all, "grid.active", "maybe"),
            "configuration key 'grid.active' is 'maybe', expected true or false");
  for (const char* text : {"", "nan", "inf", "0.3m", "1e400", " 1"}) {
    EXPECT_NE(message_of(all, "grid.size_m", text), "no error") << text;
  }
  EXPECT_EQ(settings.size_m, 0.3) << "a refused value must not be taken over";
}

TEST(ConfigField, UnknownKeysSuggestTheNearest) {
  Settings settings;
  ConfigFields all;
  append_fields(all, "grid", fields(settings));
  EXPECT_NE(message_of(all, "grid.sise_m", "1").find("did you mean 'grid.size_m'"), std::string::npos);
  EXPECT_NE(message_of(all, "count", "1").find("did you mean 'grid.count'"), std::string::npos);
}

TEST(ConfigField, ChecksConfigurationsFilledInByCode) {
  Settings settings;
  EXPECT_NO_THROW(check_fields(fields(settings)));
  settings.size_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check_fields(fields(settings)), UsageError);
  settings.size_m = 0.3;
  settings.count = 0;
  EXPECT_THROW(check_fields(fields(settings)), UsageError);
}

}  // namespace
}  // namespace dynamic_icp
