// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Documents that are made from the program, or say what the program does, are true.
#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <sstream>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

TEST(Documents, ConfigurationPageIsWhatTheProgramPrints) {
  EXPECT_EQ(read_file(source_folder() / "docs" / "configuration.md"), run_program("config --markdown").text)
      << "make it again: build/dynamic-icp config --markdown > docs/configuration.md";
}

TEST(Documents, TheExamplesInCppAreThoseThatAreCompiled) {
  const std::string page = read_file(source_folder() / "docs" / "cpp.md");
  for (const char* name : {"consumer.cpp", "callback.cpp"}) {
    const std::string example = read_file(source_folder() / "tests" / "consumer" / name);
    const std::size_t begin = example.find("#include");
    std::size_t end = example.size();
    if (std::string(name) == "callback.cpp") {  // its main only makes up scans
      end = example.find("\nint main");
    }
    ASSERT_NE(end, std::string::npos) << name;
    EXPECT_NE(page.find(example.substr(begin, end - begin)), std::string::npos) << name;
  }
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

/// Every page of the documentation with its text.
std::map<fs::path, std::string> pages() {
  std::map<fs::path, std::string> texts;
  for (const char* folder : {"", "docs", "docs/derivations", "docs/results", "docs/site"}) {
    for (const fs::directory_entry& page : fs::directory_iterator(source_folder() / folder)) {
      if (page.path().extension() == ".md") {
        texts[page.path()] = read_file(page.path());
      }
    }
  }
  return texts;
}

/// A page without its blocks of code.
std::string without_code(const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  bool in_code = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_fence = line.starts_with("```");
    if (!in_code && !is_fence) {
      kept += line + "\n";
    }
    in_code ^= is_fence;
  }
  return kept;
}

/// The anchors of the headings of a page, as GitHub and the site (docs/site) make them: small letters, hyphens for
/// blanks, nothing else but letters, digits and underscores.
std::vector<std::string> anchors(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(without_code(text));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t title = line.find_first_not_of('#');
    if (title == 0 || title > 6 || title == std::string::npos || line[title] != ' ') {
      continue;
    }
    std::string anchor;
    for (const char c : line.substr(title + 1)) {
      const auto letter = static_cast<unsigned char>(c);
      if (c == ' ') {
        anchor += '-';
      } else if (std::isalnum(letter) != 0 || c == '-' || c == '_') {
        anchor += static_cast<char>(std::tolower(letter));
      }
    }
    found.push_back(anchor);
  }
  return found;
}

TEST(Documents, LinksLeadToFilesAndHeadings) {
  EXPECT_EQ(anchors("# One: `two`, (three)\n```\n# no\n```\n## C++\n#no\n"),
            (std::vector<std::string>{"one-two-three", "c"}));
  int headings = 0;
  for (const auto& [page, whole] : pages()) {
    const std::string text = without_code(whole);
    for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
      const std::string link = text.substr(at + 2, text.find(')', at + 2) - at - 2);
      if (link.empty() || link.find("://") != std::string::npos) {
        continue;
      }
      const std::size_t hash = link.find('#');
      const fs::path target = hash == 0 ? page : page.parent_path() / link.substr(0, hash);
      EXPECT_TRUE(fs::exists(target)) << page << ": " << link;
      if (hash != std::string::npos && target.extension() == ".md" && fs::exists(target)) {
        const std::vector<std::string> known = anchors(read_file(target));
        EXPECT_TRUE(std::find(known.begin(), known.end(), link.substr(hash + 1)) != known.end())
            << page << ": " << link;
        ++headings;
      }
    }
  }
  EXPECT_GT(headings, 20);
}

TEST(Documents, ScriptsTheyNameExist) {
  const std::regex script("scripts/[a-z0-9_]+\\.(sh|py)");
  for (const auto& [page, text] : pages()) {
    for (std::sregex_iterator found(text.begin(), text.end(), script), end; found != end; ++found) {
      EXPECT_TRUE(fs::exists(source_folder() / found->str())) << page << ": " << found->str();
    }
  }
}

TEST(Documents, CommandsTheyShowAreUnderstood) {
  // The program with what follows, up to a comment, the next command or the end of the line or the code.
  const std::regex command("(?:\n|/|`|&& )dynamic-icp ([a-z]+)([^#&`|\n]*)");
  const std::regex option(" (--[a-z][a-z-]*)");
  const std::regex setting(" --set ([a-z_0-9.]+)=");
  const std::string keys = read_file(source_folder() / "docs" / "configuration.md");
  std::map<std::string, std::string> help;
  int options = 0;
  for (const auto& [page, text] : pages()) {
    for (std::sregex_iterator found(text.begin(), text.end(), command), end; found != end; ++found) {
      const std::string name = found->str(1);
      const std::string arguments = found->str(2);
      std::string& known = help[name];
      if (known.empty()) {
        known = run_program(name + " --help").text;
      }
      ASSERT_NE(known.find("dynamic-icp " + name), std::string::npos) << page << ": " << found->str();
      for (std::sregex_iterator word(arguments.begin(), arguments.end(), option); word != end; ++word) {
        EXPECT_TRUE(std::regex_search(known, std::regex("[ ,]" + word->str(1) + "[ ,\n]")))
            << page << ": " << found->str();
        ++options;
      }
      for (std::sregex_iterator key(arguments.begin(), arguments.end(), setting); key != end && name == "run"; ++key) {
        EXPECT_NE(keys.find("`" + key->str(1) + "`"), std::string::npos) << page << ": " << found->str();
      }
    }
  }
  EXPECT_GT(options, 20);
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

/// The string literals of a line of C++, where it is no comment.
std::vector<std::string> literals(const std::string& line) {
  static const std::regex kPiece(R"re(//.*|'(?:\\.|[^'])'|"((?:\\.|[^"\\])*)")re");
  std::vector<std::string> found;
  for (std::sregex_iterator piece(line.begin(), line.end(), kPiece), end; piece != end; ++piece) {
    if ((*piece)[1].matched) {
      found.push_back((*piece)[1]);
    }
  }
  return found;
}

// A message of the library is also read by those who call it from C++ or Python: the program names the options.
TEST(Documents, NoMessageOfTheLibrarySpeaksOfOptions) {
  const std::regex option(R"((^|[^\w(-])--(\{|[a-z]))");
  EXPECT_EQ(literals(R"(f("a \"b\" --c", '"', "d");  // "--e")"), (std::vector<std::string>{R"(a \"b\" --c)", "d"}));
  EXPECT_TRUE(std::regex_search("use --force", option));
  int sources = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_folder() / "dynamic_icp")) {
    const std::string name = entry.path().filename().string();
    const bool is_source = entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp";
    // The benchmark starts the program with options.
    if (!is_source || name.ends_with("_test.cpp") || name == "cell_plan.cpp" || name == "cell_run.cpp") {
      continue;
    }
    std::istringstream lines(read_file(entry.path()));
    for (std::string line; std::getline(lines, line);) {
      for (const std::string& literal : literals(line)) {
        EXPECT_FALSE(std::regex_search(literal, option) || literal == "--") << entry.path() << ": " << line;
      }
    }
    ++sources;
  }
  EXPECT_GT(sources, 100);
}

}  // namespace
}  // namespace dynamic_icp::tests
