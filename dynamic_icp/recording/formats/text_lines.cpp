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
  constexpr std::string_view kBlank = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kBlank); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlank, end);
  }
  return words;
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
