// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/process.hpp"

#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/unfinished.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr int kAskingToEnd[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

pthread_t main_thread;

extern "C" void clean_up_and_end(int signal) {
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

}  // namespace dynamic_icp::apps
