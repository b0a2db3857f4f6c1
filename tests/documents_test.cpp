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

}  // namespace
}  // namespace dynamic_icp::tests
