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

/// A command line as exec takes it.
class CommandLine {
 public:
  CommandLine(const std::filesystem::path& program, const std::vector<std::string>& arguments)
      : words_({program.string()}) {
    words_.insert(words_.end(), arguments.begin(), arguments.end());
    for (std::string& word : words_) {
      pointers_.push_back(word.data());
    }
    pointers_.push_back(nullptr);
  }
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Nothing is allocated or locked: it may stand between fork and exec.
  void execute() const { ::execv(pointers_.front(), pointers_.data()); }

 private:
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
};

/// In the child, between fork and exec: nothing here allocates or locks.
[[noreturn]] void become(const CommandLine& program, int messages, int nowhere, pid_t parent) {
  // Not even kill -9 on the benchmark leaves runs behind that would disturb the next one.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() == parent && ::dup2(nowhere, STDIN_FILENO) >= 0 && ::dup2(nowhere, STDOUT_FILENO) >= 0 &&
      ::dup2(messages, STDERR_FILENO) >= 0) {
    program.execute();
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

pid_t fork_child() {
  // Whoever started us may have left it ignored: then children leave no status behind to wait for.
  std::signal(SIGCHLD, SIG_DFL);
  const pid_t child = ::fork();
  if (child < 0) {
    throw DataError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }
  return child;
}

EndedChild wait_for_child(pid_t child) {
  int status = 0;
  rusage usage{};
  pid_t ended_pid = -1;
  do {
    ended_pid = ::wait4(child, &status, 0, &usage);
  } while (ended_pid < 0 && errno == EINTR);
  if (ended_pid < 0) {
    throw DataError(fmt::format("cannot wait for a process: {}", std::strerror(errno)));
  }
  return {.pid = ended_pid,
          .exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
          .peak_memory_mib = static_cast<double>(usage.ru_maxrss) / 1024.0};  // Linux counts in KiB
}

pid_t start_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& messages) {
  const Descriptor message_file(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  const Descriptor nowhere("/dev/null", O_RDWR);
  const CommandLine command(program, arguments);
  const pid_t parent = ::getpid();
  const pid_t child = fork_child();
  if (child == 0) {
    become(command, message_file.number, nowhere.number, parent);
  }
  return child;
}

}  // namespace dynamic_icp::benchmark
