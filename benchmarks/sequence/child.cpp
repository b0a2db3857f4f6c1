// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/child.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::speed {
namespace {

constexpr int kDataFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kCannotExecute = 127;

/// What a child wrote, and how it ended.
struct Ended {
  std::string text;
  int status = 0;  ///< exit status, or 128 + the signal that killed it
};

void write_all(int to, const std::string& text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t step = ::write(to, text.data() + written, text.size() - written);
    if (step < 0 && errno != EINTR) {
      ::_exit(kDataFailed);
    }
    written += step > 0 ? static_cast<std::size_t>(step) : 0;
  }
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 4096> buffer{};
  while (true) {
    const ssize_t got = ::read(from, buffer.data(), buffer.size());
    if (got > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(got));
    } else if (got == 0 || errno != EINTR) {
      return text;
    }
  }
}

/// Forks; the child calls `body` with the end of the pipe it writes to and leaves with what that returns.
Ended run_child(const std::function<int(int to)>& body) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    throw DataError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw DataError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }
  if (child == 0) {
    ::close(ends[0]);
    ::_exit(body(ends[1]));
  }
  ::close(ends[1]);
  Ended ended;
  ended.text = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ended;
}

}  // namespace

std::string text_of_child(const std::function<std::string()>& work) {
  Ended ended = run_child([&work](int to) {
    try {
      write_all(to, work());
      return 0;
    } catch (const UsageError& error) {
      write_all(to, error.what());
      return kWrongUsage;
    } catch (const std::exception& error) {
      write_all(to, error.what());
      return kDataFailed;
    }
  });
  switch (ended.status) {
    case 0:
      return std::move(ended.text);
    case kWrongUsage:
      throw UsageError(ended.text);
    case kDataFailed:
      throw DataError(ended.text);
    default:
      throw DataError(fmt::format("the run ended with status {} (128 + signal: killed)", ended.status));
  }
}

std::string output_of_program(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  Ended ended = run_child([&pointers](int to) {
    if (::dup2(to, STDOUT_FILENO) >= 0) {
      ::execv(pointers.front(), pointers.data());
    }
    return kCannotExecute;
  });
  if (ended.status != 0) {
    throw DataError(fmt::format("{}: ended with status {}", program.string(), ended.status));
  }
  return std::move(ended.text);
}

}  // namespace dynamic_icp::speed
