// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/text_lines.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {

std::optional<std::string_view> take_line(std::string_view& rest) {
  if (rest.empty()) {
    return std::nullopt;
  }
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

std::vector<PlacedLine> read_lines(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  std::vector<PlacedLine> lines;
  std::string_view rest = text;
  for (std::size_t number = 1; const std::optional<std::string_view> line = take_line(rest); ++number) {
    if (!words_of(*line).empty()) {
      lines.push_back({fmt::format("{}: line {}", path.string(), number), std::string(*line)});
    }
  }
  return lines;
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::size_t kUsualWords = 8;
  std::vector<std::string_view> words;
  words.reserve(kUsualWords);
  split_words(line, words);
  return words;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  // One character after the other: searches for a set of them take longer than to read the numbers.
  for (const char *at = line.data(), *const end = at + line.size();;) {
    at = std::find_if_not(at, end, is_blank);
    if (at == end) {
      return;
    }
    const char* const begin = at;
    at = std::find_if(at, end, is_blank);
    words.emplace_back(begin, static_cast<std::size_t>(at - begin));
  }
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::string quoted_text(std::string_view text) {
  constexpr std::size_t kMaxLength = 40;
  std::string result(text.substr(0, kMaxLength));
  for (char& c : result) {
    c = c >= ' ' && c <= '~' ? c : '?';
  }
  return "'" + result + (text.size() > kMaxLength ? "...'" : "'");
}

}  // namespace dynamic_icp::formats
