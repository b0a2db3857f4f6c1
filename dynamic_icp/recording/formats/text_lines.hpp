// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dynamic_icp::formats {

/// Takes the next line, without its line feed, from the front of `rest`; nothing when `rest` is empty.
std::optional<std::string_view> take_line(std::string_view& rest);

/// A line of a file and where it is: "<file>: line <n>".
struct PlacedLine {
  std::string place;
  std::string text;
};

/// The lines of a text file that hold something but blanks. Throws as read_text_file does.
std::vector<PlacedLine> read_lines(const std::filesystem::path& path);

/// White space within a line.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// The words of a line: what stands between blanks, tabs, carriage returns and the like.
std::vector<std::string_view> words_of(std::string_view line);

/// The same into a list that is used again, for many lines.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// With the letters A to Z as a to z, whatever the locale.
std::string lower_case(std::string_view text);

/// Text of a file as it may appear in a message: in quotation marks, short and printable.
std::string quoted_text(std::string_view text);

}  // namespace dynamic_icp::formats
