// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Documents that are made from the program, or say what the program does, are true.
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

TEST(Documents, ConfigurationPageIsWhatTheProgramPrints) {
  EXPECT_EQ(read_file(source_folder() / "docs" / "configuration.md"), run_program("config --markdown").text)
      << "make it again: build/dynamic-icp config --markdown > docs/configuration.md";
}

TEST(Documents, TheExampleOfTheReadmeIsTheOneThatIsCompiled) {
  const std::string example = read_file(source_folder() / "tests" / "consumer" / "consumer.cpp");
  const std::string code = example.substr(example.find("#include"));
  EXPECT_NE(read_file(source_folder() / "README.md").find(code), std::string::npos);
}

TEST(Documents, MapNamesEveryRoom) {
  const std::string map = read_file(source_folder() / "docs" / "map.md");
  for (const fs::directory_entry& room : fs::directory_iterator(source_folder() / "dynamic_icp")) {
    EXPECT_NE(map.find("  " + room.path().filename().string() + "/"), std::string::npos) << room.path();
  }
}

TEST(Documents, EverySceneHasAPicture) {
  std::istringstream list(run_program("simulate --list").text);
  std::string line;
  std::getline(list, line);
  const std::string page = read_file(source_folder() / "docs" / "simulator.md");
  int scenes = 0;
  while (std::getline(list, line) && !line.empty()) {
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    EXPECT_TRUE(fs::exists(source_folder() / "docs" / "scenes" / (name + ".svg"))) << name;
    EXPECT_NE(page.find("[`" + name + "`](scenes/" + name + ".svg)"), std::string::npos) << name;
    ++scenes;
  }
  EXPECT_GE(scenes, 11);
}

}  // namespace
}  // namespace dynamic_icp::tests
