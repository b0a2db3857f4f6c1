// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/yaml_map.hpp"

#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/formats/yaml_node.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr Limits kAny = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

YamlMap yaml_of(std::string_view text) { return YamlMap::parse(text, "file.yaml"); }

TEST(YamlMap, ReadsValues) {
  const YamlMap map = yaml_of("name: two words\nspeed: 1.5e1\ncount: +7\nopen: true\nsize: [1, -2.5, 3]\nkind: van\n");
  EXPECT_EQ(map.text("name"), "two words");
  EXPECT_EQ(map.number("speed", {0.0, 70.0}), 15.0);
  EXPECT_EQ(map.number("count", {7.0, 7.0}), 7.0);
  EXPECT_EQ(map.whole_number("count", {0.0, 10.0}), 7);
  EXPECT_TRUE(map.flag("open", false));
  EXPECT_EQ(map.numbers("size", 3, kAny), (std::vector<double>{1.0, -2.5, 3.0}));
  EXPECT_EQ(map.numbers("size", 0, kAny).size(), 3u);
  EXPECT_EQ(map.choice("kind", {"car", "van"}), "van");
  EXPECT_EQ(map.origin(), "file.yaml");
  EXPECT_NO_THROW(map.finish());
}

TEST(YamlMap, TakesFallbacksForMissingKeysOnly) {
  const YamlMap map = yaml_of("here: 1\n");
  EXPECT_EQ(map.text("name", "none"), "none");
  EXPECT_EQ(map.number("speed", {0.0, 1.0}, 9.0), 9.0);
  EXPECT_EQ(map.whole_number("count", {0.0, 1.0}, 9), 9);
  EXPECT_TRUE(map.flag("open", true));
  EXPECT_EQ(map.choice("kind", {"car"}, "car"), "car");
  EXPECT_TRUE(map.list("parts").empty());
  EXPECT_TRUE(map.kinds("parts").empty());
  EXPECT_TRUE(map.entries("routes").empty());
  EXPECT_FALSE(map.has("there"));
  EXPECT_TRUE(map.has("here"));
  EXPECT_THROW((void)map.number("here", {2.0, 3.0}, 2.5), UsageError);
}

TEST(YamlMap, ReadsMapsInTheOrderOfTheFile) {
  const YamlMap map = yaml_of(
      "vehicle: {start: 1}\nlanes:\n- {count: 1}\n- {count: 2}\n"
      "parts:\n- box: {size: 4}\n- ground:\n- box: {size: 5}\nroutes:\n  z: {n: 1}\n  a: {n: 2}\n");
  EXPECT_EQ(map.map("vehicle").number("start", kAny), 1.0);
  ASSERT_EQ(map.list("lanes").size(), 2u);
  EXPECT_EQ(map.list("lanes")[1].number("count", kAny), 2.0);
  const auto parts = map.kinds("parts");
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[1].first, "ground");
  EXPECT_EQ(parts[2].first, "box");
  EXPECT_EQ(parts[2].second.number("size", kAny), 5.0);
  const auto routes = map.entries("routes");
  ASSERT_EQ(routes.size(), 2u);
  EXPECT_EQ(routes[0].first, "z");
  EXPECT_EQ(routes[1].second.number("n", kAny), 2.0);
}

TEST(YamlMap, TextsMayHaveEveryCharacter) {
  for (const char* text : {"Stra\xC3\x9F"
                           "e",
                           "\xE2\x82\xAC", "\xF0\x9F\x9A\x97", "\xEF\xBF\xBD"}) {
    EXPECT_EQ(yaml_of(std::string("a: ") + text + "\n").text("a"), text);
  }
}

TEST(YamlMap, ReadsTexts) {
  const YamlMap map = YamlMap::parse("a: [one, 2, 'three four']\nb: []\nc: [x, [y]]\nd: x\n", "f.yaml");
  EXPECT_EQ(map.texts("a"), (std::vector<std::string>{"one", "2", "three four"}));
  for (const char* key : {"b", "c", "d", "e"}) {
    EXPECT_THROW(static_cast<void>(map.texts(key)), UsageError) << key;
  }
}

TEST(YamlMap, ReadsRows) {
  const YamlMap map = yaml_of("profile:\n- [1, 2]\n- [3, 4]\n- [5, 6]\n");
  const std::vector<std::vector<double>> expected = {{1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}};
  EXPECT_EQ(map.rows("profile", 2, kAny), expected);
  EXPECT_EQ(map.rows("profile", 0, kAny), expected);
}

TEST(YamlMap, ReadsSettings) {
  double size = 1.0;
  int count = 1;
  const ConfigFields fields = {{"grid.size", &size, 0.0, 10.0, "m", ""}, {"count", &count, 0.0, 10.0, "", ""}};
  const YamlMap map = yaml_of("config:\n  grid: {size: 2}\n  count: 3\n");
  map.settings("config", fields);
  map.settings("absent", fields);
  EXPECT_EQ(size, 2.0);
  EXPECT_EQ(count, 3);
  EXPECT_NO_THROW(map.finish());
}

TEST(YamlMap, FinishFindsKeysNobodyAskedForAnywhere) {
  const YamlMap map = yaml_of("speed: 1\nvehicle:\n  start: 2\n  lateral: 3\n");
  (void)map.number("speed", kAny);
  const YamlMap vehicle = map.map("vehicle");
  (void)vehicle.number("start", kAny);
  EXPECT_THROW(map.finish(), UsageError);
  (void)vehicle.number("lateral", kAny);
  EXPECT_NO_THROW(map.finish());
}

TEST(YamlMap, MapsTakenTwiceAreOne) {
  const YamlMap map = yaml_of("m: {a: 1}\nl: [{a: 1}, {a: 2}]\n");
  (void)map.map("m");
  (void)map.map("m").number("a", kAny);
  (void)map.list("l")[0].number("a", kAny);
  EXPECT_THROW(map.finish(), UsageError);
  EXPECT_EQ(map.list("l")[1].number("a", kAny), 2.0);
  EXPECT_NO_THROW(map.finish());
}

TEST(YamlMap, BlankDocumentsMayBeAllowed) {
  for (const char* text : {"", "\n", "# nothing\n", "---\n"}) {
    EXPECT_THROW(yaml_of(text), UsageError);
    const YamlMap map = YamlMap::parse(text, "file.yaml", YamlMap::Blank::kEmptyMap);
    EXPECT_FALSE(map.has("key"));
    EXPECT_NO_THROW(map.finish());
  }
}

TEST(YamlMap, LoadsFiles) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("yaml_map_test-" + std::to_string(::getpid()) + ".yaml");
  write_whole_file(path, "speed: 4\n");
  EXPECT_EQ(YamlMap::load(path).number("speed", kAny), 4.0);
  std::filesystem::remove(path);
  EXPECT_THROW(YamlMap::load(path), DataError);
}

/// A text, what is read from it and parts of the message that must come.
struct Fault {
  const char* text;
  std::function<void(const YamlMap&)> read;
  std::vector<std::string> parts;
};

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no UsageError";
}

void expect_messages(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    const std::string message = message_of([&] { fault.read(yaml_of(fault.text)); });
    EXPECT_EQ(message.rfind("file.yaml: line ", 0), 0u) << message;
    for (const std::string& part : fault.parts) {
      EXPECT_NE(message.find(part), std::string::npos) << message << "\n lacks: " << part;
    }
  }
}

TEST(YamlMap, ErrorsInValuesNameLineKeyFoundAndAllowed) {
  const auto number = [](const YamlMap& map) { (void)map.number("b", {0.0, 70.0}); };
  const auto whole = [](const YamlMap& map) { (void)map.whole_number("b", {1.0, 5.0}); };
  const auto flag = [](const YamlMap& map) { (void)map.flag("b", true); };
  const auto text = [](const YamlMap& map) { (void)map.text("b"); };
  const auto choice = [](const YamlMap& map) { (void)map.choice("b", {"car", "van"}); };
  const auto deep = [](const YamlMap& map) { (void)map.map("m").map("n").number("b", {0.0, 70.0}); };
  expect_messages({
      {"a: 1\nb: 71\n", number, {"line 2", "'b' is '71'", "expected 0 to 70"}},
      {"a: 1\nb: nan\n", number, {"line 2", "'nan'", "0 to 70"}},
      {"a: 1\nb: .inf\n", number, {"line 2", "'.inf'"}},
      {"b: 1e999\n", number, {"line 1", "'1e999'"}},
      {"b: 5 m\n", number, {"'5 m'"}},
      {"b: fast\n", [](const YamlMap& map) { (void)map.number("b", kAny); }, {"'fast'", "expected a finite number"}},
      {"b: inf\n", [](const YamlMap& map) { (void)map.number("b", kAny); }, {"'inf'"}},
      {"b: [1, 2]\n", number, {"'b' is a list of 2"}},
      {"a: 1\nb:\n", number, {"line 2", "'b' is nothing"}},
      {"b: {c: 1}\n", number, {"'b' is a map"}},
      {"a: 1\n", number, {"line 1", "'b' is missing", "0 to 70"}},
      {"m:\n  n:\n    c: 1\n", deep, {"line 2", "'b' is missing in 'm.n'"}},
      {"m:\n  n:\n    b: -1\n", deep, {"line 3", "'m.n.b' is '-1'"}},
      {"b: 1.5\n", whole, {"'1.5'", "expected a whole number from 1 to 5"}},
      {"b: 6\n", whole, {"'6'", "1 to 5"}},
      {"b: 3000000000\n", whole, {"'3000000000'"}},
      {"b: yes\n", flag, {"'yes'", "one of: true, false"}},
      {"b: ''\n", text, {"'b' is ''", "a text"}},
      {"b: [1]\n", text, {"a list of 1", "a text"}},
      {"\n\nb: bus\n", choice, {"line 3", "'bus'", "one of: car, van"}},
  });
}

TEST(YamlMap, ErrorsInListsAndMapsNameLineKeyFoundAndAllowed) {
  const auto numbers = [](const YamlMap& map) { (void)map.numbers("b", 3, {0.0, 9.0}); };
  const auto rows = [](const YamlMap& map) { (void)map.rows("b", 2, {0.0, 9.0}); };
  const auto even_rows = [](const YamlMap& map) { (void)map.rows("b", 0, {0.0, 9.0}); };
  const auto map = [](const YamlMap& top) { (void)top.map("b"); };
  const auto list = [](const YamlMap& top) { (void)top.list("b"); };
  const auto kinds = [](const YamlMap& top) { (void)top.kinds("b"); };
  const auto entries = [](const YamlMap& top) { (void)top.entries("b"); };
  expect_messages({
      {"b: [1, 2]\n", numbers, {"line 1", "'b' is a list of 2", "a list of 3 numbers", "0 to 9"}},
      {"b: 1\n", numbers, {"'b' is '1'", "3 numbers"}},
      {"b: []\n",
       [](const YamlMap& m) {
         (void)m.numbers("b", 0, {0.0, 9.0});
       },
       {"a list of 0"}},
      {"b:\n- 1\n- 2\n- 10\n", numbers, {"line 4", "number 3 of 'b' is '10'", "0 to 9"}},
      {"b:\n- 1\n- [2]\n- 10\n", numbers, {"line 3", "number 2 of 'b' is a list of 1"}},
      {"b:\n- [1, 2]\n- [3]\n", rows, {"line 3", "row 2 of 'b' is a list of 1", "2 numbers"}},
      {"b:\n- [1, 2]\n- [3, x]\n", rows, {"line 3", "number 2 of row 2 of 'b' is 'x'", "0 to 9"}},
      {"b: 5\n", rows, {"'b' is '5'", "lists of 2 numbers"}},
      {"b:\n- [1, 2, 3]\n- [3, 4]\n", even_rows, {"line 3", "row 2", "3 numbers"}},
      {"a: 1\nb: 5\n", map, {"line 2", "'b' is '5'", "expected a map"}},
      {"b: {c: 1}\n", list, {"'b' is a map", "a list of maps"}},
      {"b:\n- {c: 1}\n- 5\n", list, {"line 3", "'b' is '5'"}},
      {"b:\n- {c: {}}\n- {d: {}, e: {}}\n", kinds, {"line 3", "'b'", "has 2 keys"}},
      {"b:\n- {c: {}}\n- {d: 5}\n", kinds, {"line 3", "'b.d' is '5'", "a map"}},
      {"b: {c: 1}\n", entries, {"'b.c' is '1'", "a map"}},
      {"a: 1\nb: 2\n", [](const YamlMap& m) { m.fail("b", "is no good"); }, {"line 2: 'b' is no good"}},
      {"a: 1\nm:\n  b: 2\n", [](const YamlMap& m) { m.map("m").fail("odd"); }, {"line 2: odd"}},
  });
}

TEST(YamlMap, ErrorsInKeysNameLineAndTheNearestKey) {
  const auto speed = [](const YamlMap& map) {
    (void)map.number("speed_mps", kAny, 0.0);
    (void)map.number("lateral_m", kAny, 0.0);
    map.finish();
  };
  const auto deep = [](const YamlMap& map) {
    (void)map.kinds("parts")[0].second.number("size", kAny);
    map.finish();
  };
  double size = 1.0;
  const ConfigFields fields = {{"size", &size, 0.0, 10.0, "m", ""}};
  const auto settings = [&](const YamlMap& map) { map.settings("config", fields); };
  expect_messages({
      {"speed_mps: 1\nlatteral_m: 2\n", speed, {"line 2", "unknown key 'latteral_m'", "did you mean 'lateral_m'?"}},
      {"parts:\n- box:\n    size: 1\n    seize: 2\n", deep, {"line 4", "'parts.box.seize'", "'size'"}},
      {"config:\n  size: 11\n", settings, {"line 2", "'size' is '11'", "0 to 10 m"}},
      {"config:\n  sise: 1\n", settings, {"line 2", "'sise'", "did you mean 'size'"}},
      {"config: 5\n", settings, {"line 1", "'config' is '5'", "a map"}},
      {"config: &me\n  more: *me\n", settings, {"line 2", "unknown configuration key"}},
  });
}

TEST(YamlMap, RefusesWhatIsNoMapOrNoYaml) {
  for (const char* text : {"a: 1\nb: 2\na: 3\n", "m:\n  a: 1\n  a: 2\n"}) {
    const std::string message = message_of([&] {
      const YamlMap map = yaml_of(text);
      (void)map.map("m");
    });
    EXPECT_NE(message.find("line 3: "), std::string::npos) << message;
    EXPECT_NE(message.find("is set twice"), std::string::npos) << message;
  }
  EXPECT_NE(message_of([] { yaml_of("- 1\n"); }).find("line 1: holds a list of 1, expected a map"), std::string::npos);
  EXPECT_NE(message_of([] { yaml_of("\n5\n"); }).find("line 2: holds '5'"), std::string::npos);
  EXPECT_NE(message_of([] { yaml_of("a: 1\n[1]: 2\n"); }).find("line 2: a key is a list of 1"), std::string::npos);
  const auto fault_of = [](const std::string& text) -> std::string {
    try {
      yaml_of(text);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no DataError";
  };
  EXPECT_EQ(fault_of("a: 1\n---\na: 2\n"), "file.yaml: line 2: another document begins here, expected one");
  for (const char* text : {",a: 1\n", ",b  1a&:\n"}) {  // of which yaml-cpp makes documents without end
    EXPECT_EQ(fault_of(text), "file.yaml: line 1: is no YAML: nothing begins so");
  }
  EXPECT_EQ(fault_of("#" + std::string(8U << 20U, '[')),
            "file.yaml: has 8388609 bytes, expected at most 8388608 of YAML");
  const auto nodes = [](std::size_t count) {  // the map, its key and the list are three of them
    std::string text = "a: [0";
    for (std::size_t k = 4; k < count; ++k) {
      text += k % 100 == 0 ? ",\n0" : ",0";
    }
    return text + "]\n";
  };
  EXPECT_EQ(fault_of(nodes(kMaxYamlNodes)), "no DataError");
  EXPECT_EQ(fault_of(nodes(kMaxYamlNodes + 1)).rfind("file.yaml: line 3001: has more than 300000 values", 0), 0U)
      << fault_of(nodes(kMaxYamlNodes + 1));
  // The parser makes nothing of a list in a list before it knows that it is no key.
  for (const std::string opening : {"[", "{", "[\"]\","}) {
    std::string text = "a: 1\nb: ";
    while (text.size() < 3 * kMaxYamlPart) {
      text += opening;
    }
    EXPECT_EQ(fault_of(text).rfind("file.yaml: line 2: ", 0), 0U) << fault_of(text);
  }
  EXPECT_EQ(fault_of("a: '" + std::string(kMaxYamlPart / 2, 'b') + "'\n"), "no DataError");
  EXPECT_NE(fault_of("a: '" + std::string(2 * kMaxYamlPart, 'b') + "'\n").find("a part of more than 262144 bytes"),
            std::string::npos);
  for (const char* text : {"a: {b: 1\n", "a: *nobody\n", "a: 1\n\x04 b: 2\n", "a: \xC3\n", "a: \xC0\x80\n",
                           "a: \xED\xA0\x80\n", "a: \xF5\x80\x80\x80\n", "a: \x80\n", "a: \xFF\n"}) {
    EXPECT_EQ(fault_of(text).rfind("file.yaml: line ", 0), 0u) << fault_of(text);
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
