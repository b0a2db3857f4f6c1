// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/child_text.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/benchmark/child_process.hpp"

namespace dynamic_icp::speed {
namespace {

constexpr int kDataFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kCannotExecute = 127;  // as shells have it

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
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) {
    throw DataError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  const auto [from, to] = pipe;
  std::fflush(nullptr);
  const pid_t child = benchmark::fork_child();
  if (child == 0) {
    ::close(from);
    ::_exit(body(to));
  }
  ::close(to);
  std::string text = read_all(from);
  ::close(from);
  const benchmark::EndedChild how = benchmark::wait_for_child(child);
  return {std::move(text), how.signal == 0 ? how.exit_status : 128 + how.signal};
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

std::string output_of_program(const std::filesystem::path& program, const std::string& argument) {
  Ended ended = run_child([&](int to) {
    if (::dup2(to, STDOUT_FILENO) >= 0) {
      ::execl(program.c_str(), program.c_str(), argument.c_str(), nullptr);
    }
    return kCannotExecute;
  });
  if (ended.status != 0) {
    throw DataError(fmt::format("{}: ended with status {}", program.string(), ended.status));
  }
  return std::move(ended.text);
}

}  // namespace dynamic_icp::speed
