// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::formats {

// Rows of plain numbers, read straight from the characters: where a number ends is known once it is read, so neither
// lines nor cells are searched for before. Nearly all rows of texts are so. Any other row is for a reader that looks at
// the line as a whole, which also knows what to say about it.

/// The number that begins at `at`, as std::from_chars has it; where it ends, or null where there is none that fits the
/// type. What follows the number is not looked at.
template <class Number>
const char* take_number(const char* at, const char* end, Number& number) {
  const auto [stop, fault] = std::from_chars(at, end, number);
  return fault == std::errc() ? stop : nullptr;
}

/// Whether a number of a row may end there: at the end of text or line, a blank or the delimiter.
inline bool ends_number(const char* at, const char* end, char delimiter) {
  return at == end || *at == '\n' || *at == delimiter || is_blank(*at);
}

/// Takes a row of `count` >= 1 numbers, with its line feed, from the front of `rest`. Between the numbers stands the
/// delimiter with any blanks around it; a blank as delimiter is any run of blanks. take(k, at, end) reads number k and
/// returns where it ends, as take_number does.
///
/// False, and `rest` as it was, for a row that is anything else: another number of cells, nothing in a cell, text,
/// quotation marks, a plus sign, a comment. What was taken of it is to be forgotten then.
template <class Take>
bool take_plain_row(std::string_view& rest, char delimiter, std::size_t count, const Take& take) {
  const char* at = rest.data();
  const char* const end = at + rest.size();
  const bool between_blanks = delimiter == ' ';
  const auto skip_blanks = [&] {
    while (at != end && is_blank(*at) && (between_blanks || *at != delimiter)) {
      ++at;
    }
  };
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0 && !between_blanks) {
      if (at == end || *at != delimiter) {
        return false;
      }
      ++at;
    }
    skip_blanks();
    at = take(k, at, end);
    if (at == nullptr || !ends_number(at, end, delimiter)) {
      return false;
    }
    skip_blanks();
  }
  if (at != end && *at++ != '\n') {
    return false;
  }
  rest.remove_prefix(static_cast<std::size_t>(at - rest.data()));
  return true;
}

}  // namespace dynamic_icp::formats
