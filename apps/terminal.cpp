// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/terminal.hpp"

#include <algorithm>

#include <sys/ioctl.h>
#include <unistd.h>

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kUsualWidth = 80;  // of terminals that do not say
constexpr std::size_t kLeastRoom = 20;   // behind an indent: narrower is harder to read than broken words

/// Number of characters of UTF-8 text.
std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

/// Appends one line without its end. Blanks stay as they are, but for those at which it is broken.
void append_wrapped(std::string_view line, std::size_t width, std::size_t indent, std::string& text) {
  std::size_t used = 0;  // of the line being filled
  bool is_first_word = true;
  while (!line.empty()) {
    const std::size_t word_begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t word_end = std::min(line.find(' ', word_begin), line.size());
    const std::string_view word = line.substr(word_begin, word_end - word_begin);
    const std::size_t length = word_begin + characters(word);
    if (!is_first_word && used + length > width && used > indent) {
      text += '\n';
      text.append(indent, ' ');
      text += word;
      used = indent + characters(word);
    } else {
      text += line.substr(0, word_end);
      used += length;
    }
    is_first_word = false;
    line.remove_prefix(word_end);
  }
}

}  // namespace

std::size_t terminal_width(std::FILE* stream) {
  const int descriptor = ::fileno(stream);
  if (descriptor < 0 || ::isatty(descriptor) != 1) {
    return 0;
  }
  winsize size = {};
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualWidth;
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  if (width < indent + kLeastRoom) {
    return std::string(text);
  }
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    append_wrapped(text.substr(0, end), width, indent, result);
    result += end < text.size() ? "\n" : "";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

void print_wrapped(std::string_view text, std::size_t indent) {
  fmt::print("{}", wrapped(text, terminal_width(stdout), indent));
}

}  // namespace dynamic_icp::apps
