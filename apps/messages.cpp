// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/messages.hpp"

#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kMessageIndent = 2;

void write_to_stderr(std::string_view text) { (void)std::fwrite(text.data(), 1, text.size(), stderr); }

}  // namespace

void tell_text(std::string_view text) noexcept {
  try {
    const bool redraws = text.find_first_of("\r\x1b") != std::string_view::npos;
    const std::string lines = wrapped(text, redraws ? 0 : terminal_width(stderr), kMessageIndent);
    write_to_stderr(lines);
  } catch (const std::exception&) {  // no memory to wrap it
    write_to_stderr(text);
  }
}

}  // namespace dynamic_icp::apps
