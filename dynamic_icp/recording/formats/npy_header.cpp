// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npy_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

// In the order of NpyType.
constexpr std::array<std::string_view, 10> kCodes = {"f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"};

constexpr std::string_view kHalfCode = "f2";  // no type of its own: it becomes float32

/// Takes the header's text, the literal of a Python dictionary, apart piece by piece.
class LiteralReader {
 public:
  LiteralReader(std::string_view content, std::size_t begin, std::size_t end, std::string_view origin)
      : text_(content.substr(0, end)), at_(begin), origin_(origin) {}

  [[noreturn]] void fail(std::string_view expected) const {
    throw DataError(fmt::format("{}: expected {} at byte {} of the NPY header", origin_, expected, at_));
  }

  /// Whether `c` is next, which is then taken.
  bool take(char c) {
    skip_blanks();
    const bool found = at_ < text_.size() && text_[at_] == c;
    at_ += found ? 1 : 0;
    return found;
  }

  void expect(char c) {
    if (!take(c)) {
      fail(fmt::format("'{}'", c));
    }
  }

  std::string_view quoted() {
    const char quote = take('"') ? '"' : '\'';
    if (quote == '\'') {
      expect('\'');
    }
    const std::size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos) {
      fail("the end of a string");
    }
    const std::string_view value = text_.substr(at_, end - at_);
    at_ = end + 1;
    return value;
  }

  bool boolean() {
    skip_blanks();
    for (const auto& [word, value] : {std::pair<std::string_view, bool>{"True", true}, {"False", false}}) {
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return value;
      }
    }
    fail("True or False");
  }

  std::vector<std::size_t> tuple() {
    std::vector<std::size_t> values;
    expect('(');
    while (!take(')')) {
      values.push_back(number());
      if (!take(',')) {
        expect(')');
        break;
      }
    }
    return values;
  }

  void expect_end() {
    skip_blanks();
    if (at_ != text_.size()) {
      fail("the end");
    }
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) {
      ++at_;
    }
  }

  std::size_t number() {
    skip_blanks();
    std::size_t value = 0;
    const auto [end, fault] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (fault != std::errc{}) {
      fail("a whole number that is not negative");
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    take('L');  // Python 2 wrote long numbers that way
    return value;
  }

  std::string_view text_;
  std::size_t at_;
  std::string_view origin_;
};

/// Reads what NumPy calls descr, e.g. '<f4'.
void read_type(LiteralReader& reader, NpyHeader& header, std::string_view origin) {
  if (reader.take('[')) {
    throw DataError(fmt::format("{}: is a table of records, expected an array of numbers", origin));
  }
  const std::string_view described = reader.quoted();
  if (described.ends_with('O')) {
    throw DataError(fmt::format("{}: holds Python objects, expected an array of numbers", origin));
  }
  const std::string_view order = described.substr(0, 1);
  const std::string_view stored =
      described == "|b1" ? "u1" : described.substr(std::min<std::size_t>(1, described.size()));
  header.is_half = stored == kHalfCode;
  const std::string_view code = header.is_half ? code_of(NpyType::kFloat32) : stored;
  const std::optional<NpyType> type = type_of_code(code);
  const bool ordered = order == "<" || order == ">" || (order == "|" && code.ends_with('1'));
  if (!type || !ordered) {
    throw DataError(fmt::format("{}: has the type '{}', expected one of {} {} after '<' or '>'", origin, described,
                                kHalfCode, fmt::join(kCodes, " ")));
  }
  header.type = *type;
  header.big_endian = order == ">";
}

/// Where the text of the header begins and ends.
std::pair<std::size_t, std::size_t> text_range(std::string_view content, std::string_view origin) {
  if (!content.starts_with(kMagic)) {
    throw DataError(fmt::format("{}: is no NPY array, expected it to begin with \\x93NUMPY", origin));
  }
  const std::size_t at = kMagic.size();
  const int version = content.size() > at ? static_cast<unsigned char>(content[at]) : 0;
  const std::size_t begin = at + (version == 1 ? 4 : 6);
  if (content.size() < begin) {
    throw DataError(fmt::format("{}: ends within the NPY header, expected at least {} bytes", origin, begin));
  }
  if (version < 1 || version > 3) {
    throw DataError(fmt::format("{}: is NPY version {}, expected 1, 2 or 3", origin, version));
  }
  const std::size_t length =
      version == 1 ? value_at<std::uint16_t>(content, at + 2) : value_at<std::uint32_t>(content, at + 2);
  if (length > content.size() - begin) {
    throw DataError(fmt::format("{}: ends within the NPY header, expected {} bytes of it, found {}", origin, length,
                                content.size() - begin));
  }
  return {begin, begin + length};
}

}  // namespace

std::string_view code_of(NpyType type) { return kCodes.at(static_cast<std::size_t>(type)); }

std::optional<NpyType> type_of_code(std::string_view code) {
  const auto* const found = std::find(kCodes.begin(), kCodes.end(), code);
  return found == kCodes.end() ? std::nullopt : std::optional(static_cast<NpyType>(found - kCodes.begin()));
}

std::size_t size_of(NpyType type) { return static_cast<std::size_t>(code_of(type)[1] - '0'); }

std::size_t data_bytes(NpyType type, const std::vector<std::size_t>& shape, std::string_view origin) {
  if (std::find(shape.begin(), shape.end(), 0U) != shape.end()) {
    return 0;
  }
  std::size_t bytes = size_of(type);
  for (const std::size_t length : shape) {
    if (length > std::numeric_limits<std::size_t>::max() / bytes) {
      throw DataError(fmt::format("{}: has the impossible shape ({})", origin, fmt::join(shape, ", ")));
    }
    bytes *= length;
  }
  return bytes;
}

NpyHeader parse_npy_header(std::string_view content, std::string_view origin) {
  const auto [begin, end] = text_range(content, origin);
  NpyHeader header;
  header.data_offset = end;
  LiteralReader reader(content, begin, end, origin);
  std::vector<std::string_view> seen;
  reader.expect('{');
  while (!reader.take('}')) {
    const std::string_view key = reader.quoted();
    reader.expect(':');
    if (key == "descr") {
      read_type(reader, header, origin);
    } else if (key == "fortran_order") {
      header.fortran_order = reader.boolean();
    } else if (key == "shape") {
      header.shape = reader.tuple();
    } else {
      reader.fail("descr, fortran_order or shape before the ':'");
    }
    seen.push_back(key);
    if (!reader.take(',')) {
      reader.expect('}');
      break;
    }
  }
  reader.expect_end();
  std::sort(seen.begin(), seen.end());
  if (seen != std::vector<std::string_view>{"descr", "fortran_order", "shape"}) {
    throw DataError(fmt::format("{}: the NPY header has the keys {}, expected descr, fortran_order and shape", origin,
                                fmt::join(seen, " ")));
  }
  return header;
}

std::string npy_header(NpyType type, const std::vector<std::size_t>& shape) {
  constexpr std::size_t kBeforeText = 10;
  constexpr std::size_t kAlignment = 64;
  std::string text =
      fmt::format("{{'descr': '{}{}', 'fortran_order': False, 'shape': ({}{}), }}", size_of(type) == 1 ? '|' : '<',
                  code_of(type), fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  const std::size_t unpadded = kBeforeText + text.size() + 1;
  text.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string header(kMagic);
  append_value<std::uint8_t>(header, 1);
  append_value<std::uint8_t>(header, 0);
  append_value(header, static_cast<std::uint16_t>(text.size()));
  return header + text;
}

}  // namespace dynamic_icp::formats
