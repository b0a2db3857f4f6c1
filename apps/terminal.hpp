// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/format.h>

// What is printed for people. Lines for a terminal are broken between words at its width; those for files and programs
// never are.
namespace dynamic_icp::apps {

/// Where the values of summaries begin, behind their labels.
inline constexpr std::size_t kLabelWidth = 13;

/// Columns of the terminal that a stream shows on; 0 where it shows on none.
std::size_t terminal_width(std::FILE* stream);

/// Text in which every line that is longer than `width` is broken between words, and goes on below the column `indent`.
/// A word that fits in no line stays whole. As it is where the width is 0 or leaves no room behind the indent.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

/// Prints text to standard output, wrapped for its terminal.
void print_wrapped(std::string_view text, std::size_t indent);

/// Prints lines of a label and a value, as fmt::print does; the value goes on below its beginning.
template <class... Values>
void print_row(fmt::format_string<Values...> format, Values&&... values) {
  print_wrapped(fmt::format(format, std::forward<Values>(values)...), kLabelWidth);
}

}  // namespace dynamic_icp::apps
