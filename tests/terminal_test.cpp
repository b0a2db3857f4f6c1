// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What the program prints on a terminal: lines end between words, and nowhere else.
#include <cstdlib>
#include <sstream>
#include <string>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

/// The program on a terminal of so many columns, both streams.
Outcome run_on_terminal(const std::string& arguments, unsigned short columns) {
  Outcome outcome;
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_TRUE(terminal >= 0 && ::grantpt(terminal) == 0 && ::unlockpt(terminal) == 0);
  winsize size = {};
  size.ws_row = 24;
  size.ws_col = columns;
  ::ioctl(terminal, TIOCSWINSZ, &size);
  const std::string name = ::ptsname(terminal);
  const int shown = ::open(name.c_str(), O_RDWR | O_NOCTTY);
  const std::string command = "exec '" DYNAMIC_ICP_PROGRAM "' " + arguments;
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(shown, STDOUT_FILENO);
    ::dup2(shown, STDERR_FILENO);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(shown);
  char buffer[4096];
  for (ssize_t got = 0; (got = ::read(terminal, buffer, sizeof(buffer))) > 0;) {
    outcome.text.append(buffer, static_cast<std::size_t>(got));
  }
  ::close(terminal);
  int status = 0;
  ::waitpid(child, &status, 0);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

/// The words of a text without blanks and ends of lines, which are all that wrapping may change.
std::string words(const std::string& text) {
  std::string result;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    result += word + " ";
  }
  return result;
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line.erase(line.find_last_not_of("\r") + 1);
    longest = std::max(longest, line.size());
  }
  return longest;
}

class Terminal : public ProgramTest {};

TEST_F(Terminal, HelpIsWrappedBetweenWords) {
  for (const char* arguments : {"--help", "run --help", "info --help", "benchmark --help", "help evaluate"}) {
    const Outcome piped = run_program(arguments);
    const Outcome shown = run_on_terminal(arguments, 90);
    EXPECT_EQ(shown.status, kDone) << arguments;
    EXPECT_LE(longest_line(shown.text), 90u) << arguments << "\n" << shown.text;
    EXPECT_EQ(words(shown.text), words(piped.text)) << arguments;
    EXPECT_GT(longest_line(piped.text), 100u) << "what goes elsewhere is not wrapped: " << arguments;
  }
}

TEST_F(Terminal, InfoAndMessagesAreWrappedBetweenWords) {
  const std::string about = "info " + street().string();
  const Outcome piped = run_program(about);
  const Outcome shown = run_on_terminal(about, 80);
  EXPECT_LE(longest_line(shown.text), 80u) << shown.text;
  EXPECT_EQ(words(shown.text), words(piped.text));
  EXPECT_GT(longest_line(piped.text), 80u);

  const std::string mistyped = "run x -o y --method kis-icp";
  EXPECT_LE(longest_line(run_on_terminal(mistyped, 60).text), 60u);
  EXPECT_EQ(words(run_on_terminal(mistyped, 60).text), words(run_program(mistyped).text));
}

}  // namespace
}  // namespace dynamic_icp::tests
