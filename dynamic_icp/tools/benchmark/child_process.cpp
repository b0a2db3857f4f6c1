// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::benchmark {
namespace {

constexpr int kCannotExecute = 127;  // as shells have it

/// The words of a command line as exec takes them. The strings must outlive it.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

/// In the child, between fork and exec: nothing here allocates or locks.
[[noreturn]] void become(const char* program, char* const* words, int messages, int nowhere, pid_t parent) {
  // Not even kill -9 on the benchmark leaves runs behind that would disturb the next one.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() == parent && ::dup2(nowhere, STDIN_FILENO) >= 0 && ::dup2(nowhere, STDOUT_FILENO) >= 0 &&
      ::dup2(messages, STDERR_FILENO) >= 0) {
    ::execv(program, words);
  }
  ::_exit(kCannotExecute);
}

/// Closed when it goes out of scope.
struct Descriptor {
  Descriptor(const char* path, int flags) : number(::open(path, flags | O_CLOEXEC, 0666)) {
    if (number < 0) {
      throw DataError(fmt::format("{}: cannot open: {}", path, std::strerror(errno)));
    }
  }
  ~Descriptor() { ::close(number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

}  // namespace

pid_t start_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& messages) {
  const Descriptor message_file(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  const Descriptor nowhere("/dev/null", O_RDWR);
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<char*> pointers = pointers_to(words);
  // Whoever started us may have left it ignored: then children leave no status behind to wait for.
  std::signal(SIGCHLD, SIG_DFL);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    throw DataError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }
  if (child == 0) {
    become(program.c_str(), pointers.data(), message_file.number, nowhere.number, parent);
  }
  return child;
}

EndedChild wait_for_child() {
  int status = 0;
  rusage usage{};
  pid_t pid = -1;
  do {
    pid = ::wait4(-1, &status, 0, &usage);
  } while (pid < 0 && errno == EINTR);
  if (pid < 0) {
    throw DataError(fmt::format("cannot wait for a process: {}", std::strerror(errno)));
  }
  EndedChild ended;
  ended.pid = pid;
  ended.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  ended.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  ended.peak_memory_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in KiB
  return ended;
}

}  // namespace dynamic_icp::benchmark
