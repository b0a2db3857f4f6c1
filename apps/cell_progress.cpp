// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/cell_progress.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "apps/messages.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kCellBarWidth = 20;
constexpr std::size_t kLongestNames = 40;  // the line must not wrap, or it could not redraw itself
constexpr const char* kClearLine = "\r\x1b[K";

}  // namespace

CellProgress::CellProgress(std::size_t total, bool quiet)
    : total_(total), quiet_(quiet), terminal_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

CellProgress::~CellProgress() {
  if (terminal_) {
    tell("{}", kClearLine);
  }
}

void CellProgress::start(const std::string& name) {
  running_.push_back(name);
  draw();
}

void CellProgress::end(const std::string& name, const std::string& outcome, bool failed) {
  ++done_;
  const auto ended = std::find(running_.begin(), running_.end(), name);
  if (ended != running_.end()) {
    running_.erase(ended);
  }
  if (failed || !(quiet_ || terminal_)) {
    say(fmt::format("benchmark: {} of {}: {}: {}", done_, total_, name, outcome));
  }
  draw();
}

void CellProgress::say(const std::string& line) const {
  tell("{}{}\n", terminal_ ? kClearLine : "", line);
  std::fflush(stderr);
}

void CellProgress::draw() const {
  if (terminal_ && total_ > 0) {
    const std::size_t filled = kCellBarWidth * done_ / total_;
    std::string names = fmt::format("{}", fmt::join(running_, ", "));
    if (names.size() > kLongestNames) {
      names = names.substr(0, kLongestNames) + "...";
    }
    tell("{}benchmark [{}{}] {}/{}  {} ", kClearLine, std::string(filled, '='),
         std::string(kCellBarWidth - filled, ' '), done_, total_, names);
    std::fflush(stderr);
  }
}

}  // namespace dynamic_icp::apps
