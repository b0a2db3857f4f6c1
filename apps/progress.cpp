// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/progress.hpp"

#include <cstdio>

#include <unistd.h>

#include "apps/messages.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kBarWidth = 30;
constexpr std::size_t kBetweenLines = 100;  // where the end is not known
constexpr std::chrono::milliseconds kRedrawPeriod{100};

}  // namespace

Progress::Progress(std::string what, std::size_t total, bool quiet)
    : what_(std::move(what)), total_(total), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (!quiet_ && terminal_ && done_ > 0 && total_ > 0) {
    draw_bar();
    tell("\n");
  }
}

void Progress::advance(std::size_t steps) {
  const std::size_t before = done_;
  done_ += steps;
  if (quiet_) {
    return;
  }
  if (total_ == 0) {
    if (done_ / kBetweenLines != before / kBetweenLines) {
      tell("{}: {}\n", what_, done_);
    }
  } else if (terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (now - drawn_ >= kRedrawPeriod) {
      drawn_ = now;
      draw_bar();
    }
  } else if (done_ * 10 / total_ != before * 10 / total_) {
    tell("{}: {} of {}\n", what_, done_, total_);
  }
}

void Progress::draw_bar() {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  const std::size_t filled = kBarWidth * done_ / total_;
  tell("\r{} [{}{}] {}/{}  {:.0f}/s ", what_, std::string(filled, '='), std::string(kBarWidth - filled, ' '), done_,
       total_, static_cast<double>(done_) / seconds);
  std::fflush(stderr);
}

}  // namespace dynamic_icp::apps
