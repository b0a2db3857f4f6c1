// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What an installation brings beside the program: its manual and what completes commands in shells.
#include <regex>
#include <set>
#include <sstream>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

class Manual : public ProgramTest {
 protected:
  /// What a shell prints of a script that comes after its completion; nothing where the shell is not installed.
  std::string with_completion(const std::string& shell, const std::string& script) {
    if (run_shell("command -v " + shell).status != 0) {
      return "";
    }
    const fs::path file = folder_ / ("completion." + shell);
    write_file(file, run_program("completion " + shell).text + script);
    const Outcome outcome = run_shell(shell + " " + file.string());
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return outcome.text;
  }
};

std::set<std::string> lines_of(const std::string& text) {
  std::set<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.insert(line);
  }
  return lines;
}

/// The long options of a help text or of a page of the manual.
std::set<std::string> options_of(const std::string& text) {
  static const std::regex kOption(R"(--[a-z][a-z-]*)");
  return {std::sregex_token_iterator(text.begin(), text.end(), kOption), std::sregex_token_iterator()};
}

TEST_F(Manual, HasAPageForEveryCommandWithAllItsOptions) {
  const std::string help = run_program("--help").text;
  const std::set<std::string> commands = lines_of(run_program("manual --list").text);
  EXPECT_GE(commands.size(), 12U);
  for (const std::string& name : commands) {
    EXPECT_NE(help.find("\n  " + name + " "), std::string::npos) << name;
    const std::string page = std::regex_replace(run_program("manual " + name).text, std::regex(R"(\\-)"), "-");
    EXPECT_EQ(options_of(page), options_of(std::regex_replace(run_program(name + " --help").text,
                                                              std::regex("'dynamic-icp COMMAND --help'"), "--help")))
        << name;
  }
  EXPECT_EQ(run_program("manual fly").status, kWrongUsage);
}

TEST_F(Manual, IsWhatTroffUnderstands) {
  if (run_shell("command -v groff").status != 0) {
    GTEST_SKIP() << "groff is not installed";
  }
  for (const std::string& name : lines_of("\n" + run_program("manual --list").text)) {  // that of the program is ""
    const fs::path file = folder_ / (name + ".1");
    write_file(file, run_program("manual " + name).text);
    EXPECT_EQ(run_shell("groff -man -ww -z -Tutf8 " + file.string()).text, "") << name;
  }
}

TEST_F(Manual, BashCompletesCommandsAndOptions) {
  const std::string found = with_completion("bash", R"(
complete_words() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _dynamic_icp; echo "${COMPREPLY[*]}"; }
complete_words dynamic-icp conv
complete_words dynamic-icp help eval
complete_words dynamic-icp run --max
complete_words dynamic-icp convert x -
)");
  if (found.empty()) {
    GTEST_SKIP() << "bash is not installed";
  }
  EXPECT_EQ(found.substr(0, found.find(" -h")), "convert\nevaluate\n--max-frames --max-scans\n--help");
  EXPECT_NE(found.find(" --columns "), std::string::npos) << found;
}

TEST_F(Manual, FishCompletesCommandsAndOptions) {
  const std::string found = with_completion("fish", R"(
complete -C 'dynamic-icp conv'
complete -C 'dynamic-icp run --save-ma'
)");
  if (found.empty()) {
    GTEST_SKIP() << "fish is not installed";
  }
  EXPECT_TRUE(found.starts_with("convert\tWrite a recording in another layout\n--save-map\t")) << found;
}

TEST_F(Manual, ZshUnderstandsItsCompletion) {
  if (run_shell("command -v zsh").status != 0) {
    GTEST_SKIP() << "zsh is not installed";
  }
  write_file(folder_ / "_dynamic-icp", run_program("completion zsh").text);
  EXPECT_EQ(run_shell("zsh -n " + (folder_ / "_dynamic-icp").string()).text, "");
  // Stands in for the completion system, which works in interactive shells only: prints what is offered.
  write_file(folder_ / "complete.zsh", R"(
_describe() { print -l -- $commands }
_arguments() { print -l -- "$@" }
words=(dynamic-icp '') CURRENT=2
source $1
words=(dynamic-icp run --max) CURRENT=3
_dynamic_icp
)");
  const std::string offered =
      run_shell("zsh " + (folder_ / "complete.zsh").string() + " " + (folder_ / "_dynamic-icp").string()).text;
  EXPECT_NE(offered.find("\nconvert:Write a recording in another layout\n"), std::string::npos) << offered;
  EXPECT_NE(offered.find("\n--max-frames[Maximum number of scans"), std::string::npos) << offered;
  EXPECT_NE(offered.find("\n--save-map["), std::string::npos) << offered;
}

TEST_F(Manual, NoOtherShell) {
  const Outcome outcome = run_program("completion tcsh");
  EXPECT_EQ(outcome.status, kWrongUsage);
  EXPECT_NE(outcome.text.find("expected bash, zsh or fish"), std::string::npos) << outcome.text;
}

TEST_F(Manual, TheVersionSaysHowTheProgramWasBuilt) {
  const std::string text = run_program("--version").text;
  EXPECT_TRUE(std::regex_search(text, std::regex("^dynamic-icp [0-9]+\\.[0-9]+\\.[0-9]+\n"))) << text;
  for (const std::string row : {"\ncompiler  ", "\nSIMD      ", "\nfeatures  "}) {
    EXPECT_NE(text.find(row), std::string::npos) << text;
  }
  if (fs::exists(source_folder() / ".git")) {
    EXPECT_TRUE(std::regex_search(text, std::regex("\ncommit    [0-9a-f]{12}\\+?\n"))) << text;
  }
}

}  // namespace
}  // namespace dynamic_icp::tests
