// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/child_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
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
constexpr int kDataFailed = 1;
constexpr int kWrongUsage = 2;

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

pid_t forked() {
  // Whoever started us may have left it ignored: then children leave no status behind to wait for.
  std::signal(SIGCHLD, SIG_DFL);
  const pid_t child = ::fork();
  if (child < 0) {
    throw DataError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }
  return child;
}

/// How a child ended; any of them where `pid` is -1.
EndedChild wait_for(pid_t pid) {
  int status = 0;
  rusage usage{};
  pid_t ended_pid = -1;
  do {
    ended_pid = ::wait4(pid, &status, 0, &usage);
  } while (ended_pid < 0 && errno == EINTR);
  if (ended_pid < 0) {
    throw DataError(fmt::format("cannot wait for a process: {}", std::strerror(errno)));
  }
  return {.pid = ended_pid,
          .exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
          .peak_memory_mib = static_cast<double>(usage.ru_maxrss) / 1024.0};  // Linux counts in KiB
}

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
  explicit Descriptor(int opened) : number(opened) {}
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
  const Descriptor from(pipe[0]);
  std::fflush(nullptr);
  pid_t child = -1;
  {
    const Descriptor to(pipe[1]);
    child = forked();
    if (child == 0) {
      ::close(from.number);
      ::_exit(body(to.number));
    }
  }
  Ended ended;
  ended.text = read_all(from.number);
  const EndedChild how = wait_for(child);
  ended.status = how.signal == 0 ? how.exit_status : 128 + how.signal;
  return ended;
}

}  // namespace

pid_t start_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                  const std::filesystem::path& messages) {
  const Descriptor message_file(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  const Descriptor nowhere("/dev/null", O_RDWR);
  const CommandLine command(program, arguments);
  const pid_t parent = ::getpid();
  const pid_t child = forked();
  if (child == 0) {
    become(command, message_file.number, nowhere.number, parent);
  }
  return child;
}

EndedChild wait_for_child() { return wait_for(-1); }

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
  const CommandLine command(program, arguments);
  Ended ended = run_child([&command](int to) {
    if (::dup2(to, STDOUT_FILENO) >= 0) {
      command.execute();
    }
    return kCannotExecute;
  });
  if (ended.status != 0) {
    throw DataError(fmt::format("{}: ended with status {}", program.string(), ended.status));
  }
  return std::move(ended.text);
}

}  // namespace dynamic_icp::benchmark
