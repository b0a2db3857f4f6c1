// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/ply.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/plain_rows.hpp"
#include "dynamic_icp/recording/formats/ply_values.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

// No file has that many but a damaged one; each is looked up among the others by its name.
constexpr std::size_t kMaxElements = 1024;
constexpr std::size_t kMaxColumns = 1024;  // of an element

/// The least and the largest number of a type.
std::pair<double, double> range_of(NpyType type) {
  return with_type(type, [](auto zero) {
    using Limits = std::numeric_limits<decltype(zero)>;
    return std::pair(static_cast<double>(Limits::lowest()), static_cast<double>(Limits::max()));
  });
}

bool is_of_type(double number, NpyType type) {
  if (is_float(type)) {
    return true;
  }
  const auto [least, most] = range_of(type);
  return number >= least && number <= most && number == std::floor(number);
}

class Reader {
 public:
  Reader(std::string_view content, const std::filesystem::path& origin) : rest_(content), origin_(origin) {}

  PlyFile read() {
    read_header();
    for (std::size_t i = 0; i < file_.elements.size(); ++i) {
      read_element(file_.elements[i], count_types_[i]);
    }
    if (encoding_ == Encoding::kAscii) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    }
    if (!rest_.empty()) {
      throw DataError(fmt::format("{}: {} bytes after the last record, expected the end of the file", origin_.string(),
                                  rest_.size()));
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(std::string_view message) const {
    throw DataError(fmt::format("{}: line {}: {}", origin_.string(), std::max<std::size_t>(1, line_), message));
  }

  std::optional<std::string_view> next_line() {
    const std::optional<std::string_view> line = take_line(rest_);
    line_ += line ? 1U : 0U;
    return line;
  }

  std::vector<std::string_view> next_header_words() {
    while (const std::optional<std::string_view> line = next_line()) {
      const std::vector<std::string_view> words = words_of(*line);
      if (!words.empty() && words[0] != "comment" && words[0] != "obj_info") {
        return words;
      }
    }
    fail("the file ends within the header, expected 'end_header'");
  }

  void read_header() {
    if (next_line().value_or("").substr(0, 3) != "ply" || next_header_words_are_no_format()) {
      fail("is no PLY, expected 'ply' and then 'format ascii|binary_little_endian|binary_big_endian 1.0'");
    }
    while (true) {
      const std::vector<std::string_view> words = next_header_words();
      if (words[0] == "end_header" && words.size() == 1) {
        return;
      }
      if (words[0] == "element" && words.size() == 3) {
        add_element(words[1], words[2]);
      } else if (words[0] == "property" && words.size() == 3) {
        add_column(words[2], words[1], std::nullopt);
      } else if (words[0] == "property" && words.size() == 5 && words[1] == "list") {
        add_column(words[4], words[3], words[2]);
      } else {
        fail(
            fmt::format("'{}', expected 'element <name> <count>', 'property [list <type>] <type> <name>' or "
                        "'end_header'",
                        fmt::join(words, " ")));
      }
    }
  }

  bool next_header_words_are_no_format() {
    const std::vector<std::string_view> words = next_header_words();
    if (words.size() != 3 || words[0] != "format" || words[2] != "1.0") {
      return true;
    }
    encoding_ = words[1] == "ascii"                  ? Encoding::kAscii
                : words[1] == "binary_little_endian" ? Encoding::kLittleEndian
                                                     : Encoding::kBigEndian;
    return encoding_ == Encoding::kBigEndian && words[1] != "binary_big_endian";
  }

  void add_element(std::string_view name, std::string_view count) {
    const std::optional<std::uint64_t> number = parse_number<std::uint64_t>(count);
    if (!number) {
      fail(fmt::format("element '{}' has the count '{}', expected a whole number", name, count));
    }
    if (file_.elements.size() == kMaxElements) {
      fail(fmt::format("more than {} elements", kMaxElements));
    }
    if (file_.find(name) != nullptr) {
      fail(fmt::format("element '{}' for the second time", name));
    }
    file_.elements.push_back({std::string(name), static_cast<std::size_t>(*number), {}});
    count_types_.emplace_back();
  }

  NpyType type_of(std::string_view name) const {
    const std::optional<NpyType> type = ply_type_of(name);
    if (!type) {
      fail(
          fmt::format("type '{}', expected one of: int8, uint8, int16, uint16, int32, uint32, float32, float64", name));
    }
    return *type;
  }

  void add_column(std::string_view name, std::string_view type, std::optional<std::string_view> count_type) {
    if (file_.elements.empty()) {
      fail(fmt::format("property '{}' before the first element", name));
    }
    PlyElement& element = file_.elements.back();
    if (element.columns.size() == kMaxColumns) {
      fail(fmt::format("element '{}' has more than {} properties", element.name, kMaxColumns));
    }
    if (element.find(name) != nullptr) {
      fail(fmt::format("property '{}' of element '{}' for the second time", name, element.name));
    }
    const NpyType length_type = type_of(count_type.value_or("uint8"));
    if (is_float(length_type)) {
      fail(fmt::format("list '{}' has lengths of type '{}', expected a whole-number type", name, *count_type));
    }
    element.columns.push_back({std::string(name), type_of(type), count_type.has_value(), {}, {}});
    count_types_.back().push_back(length_type);
  }

  /// Takes memory for the records, if the file is long enough for so many.
  void reserve(PlyElement& element, const std::vector<NpyType>& count_types) {
    const bool ascii = encoding_ == Encoding::kAscii;
    std::size_t min_bytes = 0;  // of a record
    for (std::size_t i = 0; i < count_types.size(); ++i) {
      const NpyType first = element.columns[i].is_list ? count_types[i] : element.columns[i].type;
      min_bytes += ascii ? 2 : size_of(first);  // a digit and a blank
    }
    const std::size_t room = rest_.size() + (ascii ? 1 : 0);  // the last line may have no end
    if (min_bytes == 0 ? element.count > 0 : element.count > room / min_bytes) {
      throw DataError(fmt::format("{}: {} records of element '{}', expected at most {}: the file has {} bytes left",
                                  origin_.string(), element.count, element.name, min_bytes == 0 ? 0 : room / min_bytes,
                                  rest_.size()));
    }
    for (PlyColumn& column : element.columns) {
      column.values.reserve(element.count);
      if (column.is_list) {
        column.list_begins.reserve(element.count + 1);
        column.list_begins.push_back(0);
      }
    }
  }

  void read_element(PlyElement& element, const std::vector<NpyType>& count_types) {
    reserve(element, count_types);
    const bool has_lists =
        std::any_of(element.columns.begin(), element.columns.end(), [](const PlyColumn& c) { return c.is_list; });
    if (encoding_ != Encoding::kAscii && !has_lists) {
      read_columns(element);
      return;
    }
    for (std::size_t record = 0; record < element.count; ++record) {
      if (encoding_ == Encoding::kAscii) {
        if (has_lists || !read_plain_line(element, record)) {
          read_line(element);
        }
      } else {
        read_record(element, count_types, record);
      }
    }
  }

  /// All records of an element whose records are equally long: column by column, many times as fast as one by one.
  /// That the file has as many bytes is known.
  void read_columns(PlyElement& element) {
    std::size_t record_bytes = 0;
    for (const PlyColumn& column : element.columns) {
      record_bytes += size_of(column.type);
    }
    const char* field = rest_.data();
    for (PlyColumn& column : element.columns) {
      column.values.resize(element.count);
      load_numbers(column.type, field, record_bytes, encoding_ == Encoding::kBigEndian, column.values);
      field += size_of(column.type);
    }
    rest_.remove_prefix(element.count * record_bytes);
  }

  /// A line without lists that holds nothing but plain numbers of their types; false, and nothing read, where it is any
  /// other.
  bool read_plain_line(PlyElement& element, std::size_t record) {
    const bool read =
        take_plain_row(rest_, ' ', element.columns.size(), [&](std::size_t k, const char* at, const char* end) {
          PlyColumn& column = element.columns[k];
          double number = 0.0;
          const char* const stop = take_number(at, end, number);
          column.values.push_back(number);
          return stop != nullptr && is_of_type(number, column.type) ? stop : nullptr;
        });
    if (read) {
      ++line_;
      return true;
    }
    for (PlyColumn& column : element.columns) {
      column.values.resize(record);
    }
    return false;
  }

  void read_line(PlyElement& element) {
    std::vector<std::string_view>& words = words_;
    for (words.clear(); words.empty();) {
      const std::optional<std::string_view> line = next_line();
      if (!line) {
        fail(fmt::format("the file ends here, expected {} records of element '{}'", element.count, element.name));
      }
      split_words(*line, words);
    }
    std::size_t used = 0;
    for (PlyColumn& column : element.columns) {
      std::size_t length = 1;
      if (column.is_list) {
        length = static_cast<std::size_t>(parse(words, used++, column, NpyType::kUint32));
      }
      for (std::size_t i = 0; i < length; ++i) {
        column.values.push_back(parse(words, used++, column, column.type));
      }
      end_list(column);
    }
    if (used != words.size()) {
      fail(fmt::format("{} values, expected {} for a record of element '{}'", words.size(), used, element.name));
    }
  }

  [[nodiscard]] double parse(const std::vector<std::string_view>& words, std::size_t i, const PlyColumn& column,
                             NpyType type) const {
    if (i >= words.size()) {
      fail(fmt::format("{} values, expected more: '{}' is missing", words.size(), column.name));
    }
    const std::optional<double> number = parse_number<double>(words[i]);
    if (!number || !is_of_type(*number, type)) {
      const auto [least, most] = range_of(type);
      fail(fmt::format("value {} ('{}') is '{}', expected {}", i + 1, column.name, words[i],
                       is_float(type) ? "a number" : fmt::format("a whole number from {} to {}", least, most)));
    }
    return *number;
  }

  void read_record(PlyElement& element, const std::vector<NpyType>& count_types, std::size_t record) {
    for (std::size_t i = 0; i < count_types.size(); ++i) {
      PlyColumn& column = element.columns[i];
      const auto expect_bytes = [&](double count, NpyType type) {
        if (count < 0.0 || count * static_cast<double>(size_of(type)) > static_cast<double>(rest_.size())) {
          throw DataError(fmt::format("{}: record {} of element '{}': '{}' has {} values, the file has {} bytes left",
                                      origin_.string(), record + 1, element.name, column.name, count, rest_.size()));
        }
      };
      double length = 1.0;
      if (column.is_list) {
        expect_bytes(1.0, count_types[i]);
        length = take(count_types[i]);
      }
      expect_bytes(length, column.type);
      for (std::size_t k = 0; k < static_cast<std::size_t>(length); ++k) {
        column.values.push_back(take(column.type));
      }
      end_list(column);
    }
  }

  /// The next value of a binary file, which has enough bytes left.
  double take(NpyType type) {
    double value = 0.0;
    load_numbers(type, rest_.data(), 0, encoding_ == Encoding::kBigEndian, std::span(&value, 1));
    rest_.remove_prefix(size_of(type));
    return value;
  }

  static void end_list(PlyColumn& column) {
    if (column.is_list) {
      column.list_begins.push_back(column.values.size());
    }
  }

  std::string_view rest_;
  const std::filesystem::path& origin_;
  std::vector<std::string_view> words_;  // of a line, used again
  std::size_t line_ = 0;                 // of the header and of ascii data
  Encoding encoding_ = Encoding::kAscii;
  PlyFile file_;
  std::vector<std::vector<NpyType>> count_types_;  // of the lengths of lists, for each element's columns
};

}  // namespace

std::span<const double> PlyColumn::list(std::size_t record) const {
  return std::span(values).subspan(list_begins[record], list_begins[record + 1] - list_begins[record]);
}

const PlyColumn* PlyElement::find(std::string_view column) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const PlyColumn& c) { return c.name == column; });
  return found == columns.end() ? nullptr : &*found;
}

const PlyElement* PlyFile::find(std::string_view element) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

PlyFile read_ply(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  refuse_other_kind(path, content, FileKind::kPly);
  return with_memory_for(path, [&] { return parse_ply(content, path); });
}

PlyFile parse_ply(std::string_view content, const std::filesystem::path& origin) {
  return Reader(content, origin).read();
}

}  // namespace dynamic_icp::formats
