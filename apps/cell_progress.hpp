// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dynamic_icp::apps {

/// Progress of runs that take long, on stderr: one line that redraws itself on a terminal, with the names of what is
/// running; a plain line per ended run otherwise; failures only when quiet.
class CellProgress {
 public:
  CellProgress(std::size_t total, bool quiet);
  ~CellProgress();
  CellProgress(const CellProgress&) = delete;
  CellProgress& operator=(const CellProgress&) = delete;

  void start(const std::string& name);

  /// `outcome` in a word or two, or why it failed.
  void end(const std::string& name, const std::string& outcome, bool failed);

 private:
  void say(const std::string& line) const;
  void draw() const;

  std::size_t total_;
  std::size_t done_ = 0;
  bool quiet_;
  bool terminal_;
  std::vector<std::string> running_;
};

}  // namespace dynamic_icp::apps
