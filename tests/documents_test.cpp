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

/// What stands after a word, up to the end of its line.
std::string rest_of_line(const std::string& text, std::size_t after) {
  return text.substr(after, text.find('\n', after) - after);
}

TEST(Documents, TheMapNamesEveryModuleAndWhatItIncludes) {
  const std::string map = read_file(source_folder() / "docs" / "map.md");
  int modules = 0;
  for (const std::string layer : {"method", "recording", "tools"}) {
    EXPECT_NE(map.find("\n  " + layer + "/"), std::string::npos) << layer;
    for (const fs::directory_entry& module : fs::directory_iterator(source_folder() / "dynamic_icp" / layer)) {
      const std::string name = module.path().filename().string();
      const std::size_t line = map.find("\n    " + name + "/ ");
      ASSERT_NE(line, std::string::npos) << name;
      const std::string listed = rest_of_line(map, map.find("<- ", line) + 3);
      const std::string build = read_file(module.path() / "CMakeLists.txt");
      const std::size_t depends = build.find("DEPENDS ", build.find("dynamic_icp_module("));
      std::string named = depends == std::string::npos ? "nothing" : rest_of_line(build, depends + 8);
      named = named.substr(0, named.find(" SOURCES"));
      EXPECT_EQ(listed, named) << name;
      ++modules;
    }
  }
  EXPECT_GE(modules, 20);
}

TEST(Documents, LinksLeadToFiles) {
  for (const fs::path& folder :
       {fs::path(), fs::path("docs"), fs::path("docs/derivations"), fs::path("docs/results")}) {
    for (const fs::directory_entry& page : fs::directory_iterator(source_folder() / folder)) {
      if (page.path().extension() != ".md") {
        continue;
      }
      const std::string text = read_file(page.path());
      for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
        const std::string target = text.substr(at + 2, text.find_first_of(")#", at + 2) - at - 2);
        if (!target.empty() && target.find("://") == std::string::npos) {
          EXPECT_TRUE(fs::exists(page.path().parent_path() / target)) << page.path() << ": " << target;
        }
      }
    }
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
