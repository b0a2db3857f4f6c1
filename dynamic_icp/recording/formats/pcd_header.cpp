// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pcd_header.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::formats {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::size_t kMaxNumbersOfAPoint = 1U << 20U;
// No file has that many but a damaged one; each is looked up among the others by its name.
constexpr std::size_t kMaxFields = 1024;

/// Text of the file as it may stand in a message: it may be anything.
std::string printable(std::string_view text) {
  constexpr std::size_t kMaxLength = 40;
  std::string result(text.substr(0, kMaxLength));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

/// TYPE and SIZE as they stand in the file; nothing for what is no type of numbers.
std::optional<NpyType> type_of(std::string_view type, std::string_view size) {
  const bool is_known = type == "F" || type == "I" || type == "U";
  return is_known ? type_of_code(fmt::format("{:c}{}", std::tolower(type.front()), size)) : std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view content, std::string_view origin) : content_(content), origin_(origin) {}

  PcdHeader read() {
    read_entries();
    add_fields();
    header_.points = count_points();
    return std::move(header_);
  }

 private:
  /// An entry as it was found.
  struct Entry {
    Words words;  ///< after the key
    std::size_t line = 0;
  };

  [[noreturn]] void fail(std::size_t line, std::string_view message) const {
    throw DataError(fmt::format("{}: line {}: {}", origin_, std::max<std::size_t>(1, line), message));
  }

  void read_entries() {
    std::string_view rest = content_;
    while (const std::optional<std::string_view> line = take_line(rest)) {
      ++header_.lines;
      Words words = words_of(*line);
      if (words.empty() || words.front().front() == '#') {
        continue;
      }
      const std::string_view key = words.front();
      words.erase(words.begin());
      check_key(key);
      if (!entries_.emplace(key, Entry{words, header_.lines}).second) {
        fail(header_.lines, fmt::format("{} for the second time", key));
      }
      if (key == "DATA") {
        header_.encoding = encoding_of(words);
        header_.data_offset = content_.size() - rest.size();
        return;
      }
    }
    fail(header_.lines, "the file ends within the header, expected DATA ascii, binary or binary_compressed");
  }

  void check_key(std::string_view key) const {
    for (const std::string_view known :
         {"VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"}) {
      if (key == known) {
        return;
      }
    }
    fail(header_.lines, fmt::format("'{}', expected an entry of a PCD header: VERSION, FIELDS, SIZE, TYPE, COUNT, "
                                    "WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA",
                                    printable(key)));
  }

  PcdEncoding encoding_of(const Words& words) const {
    const std::string_view name = words.size() == 1 ? words.front() : "";
    if (name != "ascii" && name != "binary" && name != "binary_compressed") {
      fail(header_.lines, fmt::format("DATA is '{}', expected ascii, binary or binary_compressed",
                                      printable(fmt::format("{}", fmt::join(words, " ")))));
    }
    return name == "ascii"    ? PcdEncoding::kAscii
           : name == "binary" ? PcdEncoding::kBinary
                              : PcdEncoding::kBinaryCompressed;
  }

  /// The entry of that key; must be there.
  [[nodiscard]] const Entry& entry(std::string_view key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) {
      fail(header_.lines, fmt::format("no {} in the header before DATA", key));
    }
    return found->second;
  }

  /// The same with one word for every field.
  [[nodiscard]] const Entry& entry_for_fields(std::string_view key, std::size_t fields) const {
    const Entry& found = entry(key);
    if (found.words.size() != fields) {
      fail(found.line,
           fmt::format("{} has {} words, expected one for each of the {} fields", key, found.words.size(), fields));
    }
    return found;
  }

  void add_fields() {
    const Entry& names = entries_.contains("COLUMNS") ? entry("COLUMNS") : entry("FIELDS");
    const std::size_t fields = names.words.size();
    if (fields > kMaxFields) {
      fail(names.line, fmt::format("{} fields, expected at most {}", fields, kMaxFields));
    }
    const Entry& sizes = entry_for_fields("SIZE", fields);
    const Entry& types = entry_for_fields("TYPE", fields);
    const bool counted = entries_.contains("COUNT");
    std::size_t numbers = 0;
    for (std::size_t i = 0; i < fields; ++i) {
      PcdField field;
      field.name = names.words[i];
      const std::optional<NpyType> type = type_of(types.words[i], sizes.words[i]);
      if (!type) {
        fail(types.line,
             fmt::format("field '{}' has TYPE {} and SIZE {}, expected F with 4 or 8, I or U with 1, 2, 4 or 8",
                         printable(field.name), printable(types.words[i]), printable(sizes.words[i])));
      }
      field.type = *type;
      field.count = counted ? whole_number("COUNT", entry_for_fields("COUNT", fields), i) : 1;
      if (field.count == 0) {
        fail(entry("COUNT").line, fmt::format("field '{}' has COUNT 0, expected at least 1", printable(field.name)));
      }
      if (field.count > kMaxNumbersOfAPoint || (numbers += field.count) > kMaxNumbersOfAPoint) {
        fail(entry("COUNT").line, fmt::format("more than {} numbers of a point", kMaxNumbersOfAPoint));
      }
      const auto same_name = [&](const PcdField& other) { return other.name == field.name; };
      if (!field.is_padding() && std::any_of(header_.fields.begin(), header_.fields.end(), same_name)) {
        fail(names.line, fmt::format("field '{}' for the second time", printable(field.name)));
      }
      field.offset_bytes = header_.record_bytes;
      header_.record_bytes += field.bytes();
      header_.fields.push_back(field);
    }
    if (header_.record_bytes == 0) {
      fail(names.line, "no fields, expected at least one");
    }
  }

  [[nodiscard]] std::size_t whole_number(std::string_view key, const Entry& found, std::size_t word) const {
    const std::optional<std::uint64_t> number =
        word < found.words.size() ? parse_number<std::uint64_t>(found.words[word]) : std::nullopt;
    if (!number) {
      fail(found.line, fmt::format("{} is '{}', expected a whole number", key,
                                   printable(word < found.words.size() ? found.words[word] : "")));
    }
    return static_cast<std::size_t>(*number);
  }

  [[nodiscard]] std::size_t count_points() const {
    const bool has_points = entries_.contains("POINTS");
    const std::size_t points = has_points ? whole_number("POINTS", entry("POINTS"), 0) : 0;
    if (has_points && !entries_.contains("WIDTH")) {
      return points;
    }
    const std::size_t width = whole_number("WIDTH", entry("WIDTH"), 0);
    const std::size_t height = entries_.contains("HEIGHT") ? whole_number("HEIGHT", entry("HEIGHT"), 0) : 1;
    const bool countable = height == 0 || width <= std::numeric_limits<std::size_t>::max() / height;
    if (!countable || (has_points && points != width * height)) {
      fail(entry("WIDTH").line, fmt::format("WIDTH {} and HEIGHT {}, expected {} points together", width, height,
                                            has_points ? std::to_string(points) : "fewer"));
    }
    return width * height;
  }

  std::string_view content_;
  std::string_view origin_;
  std::map<std::string_view, Entry> entries_;
  PcdHeader header_;
};

}  // namespace

PcdHeader parse_pcd_header(std::string_view content, std::string_view origin) {
  return HeaderReader(content, origin).read();
}

}  // namespace dynamic_icp::formats
