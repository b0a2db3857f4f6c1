// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/tools/drawing/svg.hpp"

// For the tests of this room: a small, strict check that a text is well-formed XML.
namespace dynamic_icp::drawing {

/// What is wrong with `text` as XML; empty when it is well-formed. Checks that tags are nested and closed, attributes
/// are quoted and not repeated, there is one root element, and "<" and "&" occur as markup and entities only.
class WellFormed {
 public:
  static std::string fault_of(std::string_view text) { return WellFormed(text).check(); }

 private:
  explicit WellFormed(std::string_view text) : rest_(text) {}

  std::string check() {
    while (!rest_.empty()) {
      const bool is_markup = rest_.front() == '<';
      const std::string fault = is_markup ? take_markup() : take_text();
      if (!fault.empty()) {
        return fault + " before: " + std::string(rest_.substr(0, 60));
      }
    }
    return !open_.empty() ? "unclosed " + open_.back() : roots_ == 1 ? "" : "not one root element";
  }

  std::string take_text() {
    const std::string_view text = take(rest_.find('<'));
    const bool only_space = text.find_first_not_of(" \n\t\r") == std::string_view::npos;
    return open_.empty() && !only_space ? "text outside of the root" : entity_fault(text);
  }

  std::string take_markup() {
    for (const auto& [begin, end] : {std::pair("<?", "?>"), std::pair("<!DOCTYPE", ">")}) {
      if (rest_.starts_with(begin)) {
        take(rest_.find(end));
        take(std::string_view(end).size());
        return open_.empty() ? "" : "declaration inside of an element";
      }
    }
    take(1);
    if (rest_.starts_with('/')) {
      take(1);
      const std::string name(take(rest_.find('>')));
      take(1);
      if (open_.empty() || open_.back() != name) {
        return "closing tag " + name + " that was not open";
      }
      open_.pop_back();
      return "";
    }
    return take_opening_tag();
  }

  std::string take_opening_tag() {
    const std::string name(take(rest_.find_first_of(" \n/>")));
    if (name.empty()) {
      return "'<' that opens no tag";
    }
    roots_ += open_.empty() ? 1 : 0;
    std::set<std::string> seen;
    while (true) {
      take(rest_.find_first_not_of(" \n"));
      if (rest_.starts_with("/>") || rest_.starts_with('>')) {
        break;
      }
      const std::string key(take(rest_.find('=')));
      take(1);
      if (key.empty() || !rest_.starts_with('"') || !seen.insert(key).second) {
        return "attribute '" + key + "' is repeated or not quoted";
      }
      take(1);
      const std::string_view value = take(rest_.find('"'));
      take(1);
      if (value.find('<') != std::string_view::npos || !entity_fault(value).empty()) {
        return "attribute '" + key + "' holds markup";
      }
    }
    if (rest_.starts_with('>')) {
      open_.push_back(name);
    } else {
      take(1);
    }
    take(1);
    return "";
  }

  static std::string entity_fault(std::string_view text) {
    constexpr std::array<std::string_view, 5> kEntities = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
    for (std::size_t at = text.find('&'); at != std::string_view::npos; at = text.find('&', at + 1)) {
      bool known = false;
      for (const std::string_view entity : kEntities) {
        known = known || text.substr(at).starts_with(entity);
      }
      if (!known) {
        return "'&' that begins no entity";
      }
    }
    return "";
  }

  std::string_view take(std::size_t count) {
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view rest_;
  std::vector<std::string> open_;
  int roots_ = 0;
};

/// Whether "nan" or "inf" stands in the text as a word of its own, as a number that is not finite is printed.
inline bool holds_non_finite(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (const std::string_view word : {"nan", "inf", "NaN", "Infinity"}) {
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
      const bool inside_a_word =
          (at > 0 && is_letter(text[at - 1])) || (at + word.size() < text.size() && is_letter(text[at + word.size()]));
      if (!inside_a_word) {
        return true;
      }
    }
  }
  return false;
}

/// How often `part` occurs in `text`.
inline std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

/// The vertices of each polyline in the picture, px.
inline std::vector<std::vector<Pixel>> polylines_of(const std::string& svg) {
  std::vector<std::vector<Pixel>> lines;
  for (std::size_t at = svg.find("<polyline"); at != std::string::npos; at = svg.find("<polyline", at + 1)) {
    const char* text = svg.c_str() + svg.find("points=\"", at) + 8;
    lines.emplace_back();
    while (*text != '"') {
      char* comma = nullptr;
      char* end = nullptr;
      const double x = std::strtod(text, &comma);
      const double y = std::strtod(comma + 1, &end);
      lines.back().push_back({x, y});
      text = *end == ' ' ? end + 1 : end;
    }
  }
  return lines;
}

}  // namespace dynamic_icp::drawing
