// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/command_line.hpp"

namespace dynamic_icp::apps {
namespace {

std::string remembered;

std::string quoted(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
    return word;
  }
  std::string result = "'";
  for (const char c : word) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result + "'";
}

}  // namespace

void remember_command_line(int argc, const char* const* argv) {
  remembered = "dynamic-icp";
  for (int i = 1; i < argc; ++i) {
    remembered += " " + quoted(argv[i]);
  }
}

const std::string& command_line() { return remembered; }

}  // namespace dynamic_icp::apps
