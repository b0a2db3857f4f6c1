// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/process.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>

#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/unfinished.hpp"

#include "apps/exit_status.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr int kAskingToEnd[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

pthread_t main_thread;

// Of StopOnSignal. Handlers of these signals do not interrupt each other, see clean_up_on_signals.
std::atomic<const char*> stop_notice = nullptr;  // set: the next signal is noted only
std::atomic<int> noted_signal = 0;
static_assert(std::atomic<const char*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

/// Whether the signal was noted, and is to do no more.
bool note(int signal) {
  if (signal != SIGINT && signal != SIGTERM) {
    return false;
  }
  const char* const notice = stop_notice.exchange(nullptr);
  if (notice == nullptr) {
    return false;
  }
  noted_signal = signal;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, notice, std::strlen(notice));
  return true;
}

extern "C" void clean_up_and_end(int signal) {
  const int before = errno;
  if (note(signal)) {
    errno = before;
    return;
  }
  if (::pthread_equal(::pthread_self(), main_thread) == 0) {
    ::pthread_kill(main_thread, signal);  // it must write no more
    while (true) {
      ::pause();
    }
  }
  formats::remove_unfinished();
  // As if it had never been caught: who waits for the program sees which signal ended it.
  ::signal(signal, SIG_DFL);
  sigset_t own;
  ::sigemptyset(&own);
  ::sigaddset(&own, signal);
  ::raise(signal);
  ::pthread_sigmask(SIG_UNBLOCK, &own, nullptr);
}

std::atomic<bool> memory_has_ended = false;

/// Called by `new` where it finds no memory.
void note_end_of_memory() {
  memory_has_ended = true;
  throw std::bad_alloc();
}

[[noreturn]] void end_without_memory() {
  constexpr std::string_view kMessage = "dynamic-icp: the machine has no memory left\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  formats::remove_unfinished();
  ::_exit(kDataOrMachineFailed);
}

/// Called where an exception has nowhere to go. Where a function that may throw none did, it is not told which.
[[noreturn]] void end_of_exceptions() {
  const std::exception_ptr error = std::current_exception();
  if (error == nullptr && memory_has_ended) {
    end_without_memory();
  }
  try {
    if (error != nullptr) {
      std::rethrow_exception(error);
    }
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (...) {  // a mistake in the program
  }
  std::abort();
}

constexpr std::size_t kReservedStack = 1 << 20;  // bytes: temporary matrices are up to 128 KiB each

/// In a call of its own: the compiler may touch all that a call needs when it begins.
[[gnu::noinline]] void touch_stack() {
  constexpr std::size_t kPage = 4096;
  [[maybe_unused]] volatile char stack[kReservedStack];
  for (std::size_t k = kReservedStack; k > 0; k -= kPage) {  // downwards, as it grows
    stack[k - 1] = 0;
  }
}

}  // namespace

void open_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      // Takes the lowest number that is free: this one.
      [[maybe_unused]] const int opened = ::open("/dev/null", O_RDWR);
    }
  }
}

void clean_up_on_signals() {
  main_thread = ::pthread_self();
  ::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond `ulimit -f` is an error of the write, which is told
  struct sigaction action = {};
  action.sa_handler = clean_up_and_end;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  for (const int signal : kAskingToEnd) {
    ::sigaddset(&action.sa_mask, signal);
  }
  for (const int signal : kAskingToEnd) {
    struct sigaction before = {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL) {
      ::sigaction(signal, &action, nullptr);
    }
  }
}

void clean_up_without_memory() {
  std::set_new_handler(note_end_of_memory);
  std::set_terminate(end_of_exceptions);
}

void reserve_stack() {
  rlimit limit = {};
  if (::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur >= 4 * kReservedStack) {  // else the user wants it small
    touch_stack();
  }
}

StopOnSignal::StopOnSignal(const char* notice) {
  noted_signal = 0;
  stop_notice = notice;
}

StopOnSignal::~StopOnSignal() { stop_notice = nullptr; }

int StopOnSignal::signal() { return noted_signal; }

}  // namespace dynamic_icp::apps
