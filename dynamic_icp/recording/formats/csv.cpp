// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"
#include "dynamic_icp/recording/formats/plain_rows.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kMaxCsvColumns = 1024;

std::string_view bare(std::string_view cell) {
  while (!cell.empty() && is_blank(cell.front())) {
    cell.remove_prefix(1);
  }
  while (!cell.empty() && is_blank(cell.back())) {
    cell.remove_suffix(1);
  }
  const bool quoted = cell.size() >= 2 && (cell.front() == '"' || cell.front() == '\'') && cell.back() == cell.front();
  return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

/// The next line with something in it, and the number of lines taken for it.
struct NextLine {
  std::string_view text;
  std::size_t lines = 0;
};

std::optional<NextLine> next_line(std::string_view& rest) {
  NextLine next;
  while (const std::optional<std::string_view> line = take_line(rest)) {
    ++next.lines;
    next.text = bare(*line);
    if (!next.text.empty()) {
      next.text = *line;
      return next;
    }
  }
  return std::nullopt;
}

bool is_comment(std::string_view line) { return bare(line).starts_with('#'); }

bool are_names(const std::vector<std::string_view>& cells) { return std::any_of(cells.begin(), cells.end(), is_name); }

std::optional<double> number_of(std::string_view cell) {
  return cell.empty() ? std::optional(std::numeric_limits<double>::quiet_NaN()) : parse_number<double>(cell);
}

/// A column while it is read: whole numbers as long as all are. It grows as the bytes of an array, which need not be
/// copied then.
class GrowingColumn {
 public:
  explicit GrowingColumn(std::size_t rows) { bytes_.reserve(rows * kNumberBytes); }

  bool add(std::string_view cell) {
    if (whole_) {
      if (const std::optional<std::int64_t> number = parse_number<std::int64_t>(cell)) {
        append_value(bytes_, *number);
        return true;
      }
      make_floating();
    }
    const std::optional<double> number = number_of(cell);
    append_value(bytes_, number.value_or(0.0));
    return number.has_value();
  }

  /// The same for a number among the characters that follow; where it ends, or null, and nothing added, where there is
  /// none that ends as those of a row do.
  const char* take(const char* at, const char* end, char delimiter) {
    if (whole_) {
      std::int64_t number = 0;
      if (const char* const stop = take_number(at, end, number); stop != nullptr && ends_number(stop, end, delimiter)) {
        append_value(bytes_, number);
        return stop;
      }
    }
    double number = 0.0;
    const char* const stop = take_number(at, end, number);
    if (stop == nullptr || !ends_number(stop, end, delimiter)) {
      return nullptr;
    }
    if (whole_) {
      make_floating();
    }
    append_value(bytes_, number);
    return stop;
  }

  /// Forgets what came after that many rows.
  void shorten(std::size_t rows) { bytes_.resize(rows * kNumberBytes); }

  /// Once: the bytes go with it.
  [[nodiscard]] NpyArray take_array() {
    const std::size_t rows = bytes_.size() / kNumberBytes;
    return {whole_ ? NpyType::kInt64 : NpyType::kFloat64, {rows}, std::move(bytes_), {}};
  }

 private:
  static constexpr std::size_t kNumberBytes = 8;  // of either type
  static_assert(sizeof(std::int64_t) == kNumberBytes && sizeof(double) == kNumberBytes);

  void make_floating() {
    std::string numbers;
    numbers.reserve(bytes_.capacity());
    for (std::size_t at = 0; at < bytes_.size(); at += kNumberBytes) {
      append_value(numbers, static_cast<double>(value_at<std::int64_t>(bytes_, at)));
    }
    bytes_ = std::move(numbers);
    whole_ = false;
  }

  bool whole_ = true;
  std::string bytes_;
};

/// As cells_of, into a list that is used again.
void split_cells(std::string_view line, char delimiter, std::vector<std::string_view>& cells) {
  if (delimiter == ' ') {
    split_words(line, cells);
    std::transform(cells.begin(), cells.end(), cells.begin(), bare);
    return;
  }
  cells.clear();
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find(delimiter, begin), line.size());
    cells.push_back(bare(line.substr(begin, end - begin)));
    if (end == line.size()) {
      return;
    }
    begin = end + 1;
  }
}

/// About as many rows as there are, by the length of the first line; never more memory than the text's own size.
std::size_t likely_rows(std::string_view rows, std::size_t columns) {
  const std::size_t line = std::max<std::size_t>({rows.find('\n') + 1, 8 * columns, 1});
  return rows.size() / line + 1;
}

/// Adds the cells of a row that are not all plain numbers.
void add_cells(const std::vector<std::string_view>& cells, std::string_view origin, std::size_t line,
               std::vector<GrowingColumn>& columns) {
  if (cells.size() != columns.size()) {
    throw DataError(fmt::format("{}: line {}: {} columns, expected {} as in the first row", origin, line, cells.size(),
                                columns.size()));
  }
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (!columns[k].add(cells[k])) {
      throw DataError(
          fmt::format("{}: line {}: column {} is {}, expected a number{}", origin, line, k + 1, quoted_text(cells[k]),
                      cells[k].find(',') != std::string_view::npos ? " with a decimal point (sed 's/,/./g')" : ""));
    }
  }
}

/// Reads what follows a header into the columns.
void read_rows(std::string_view rest, const CsvHeader& header, std::string_view origin,
               std::vector<GrowingColumn>& columns) {
  const auto take = [&](std::size_t k, const char* at, const char* end) {
    return columns[k].take(at, end, header.delimiter);
  };
  std::vector<std::string_view> cells;
  std::size_t line = header.first_line - 1;
  for (std::size_t rows = 0; !columns.empty();) {
    if (take_plain_row(rest, header.delimiter, columns.size(), take)) {
      ++line;
      ++rows;
      continue;
    }
    std::for_each(columns.begin(), columns.end(), [rows](GrowingColumn& column) { column.shorten(rows); });
    const std::optional<NextLine> next = next_line(rest);
    if (!next) {
      return;
    }
    line += next->lines;
    if (!is_comment(next->text)) {
      split_cells(next->text, header.delimiter, cells);
      add_cells(cells, origin, line, columns);
      ++rows;
    }
  }
}

}  // namespace

char delimiter_of(std::string_view line) {
  for (const char delimiter : {';', ',', '\t'}) {
    if (line.find(delimiter) != std::string_view::npos) {
      return delimiter;
    }
  }
  return ' ';
}

std::vector<std::string_view> cells_of(std::string_view line, char delimiter) {
  std::vector<std::string_view> cells;
  split_cells(line, delimiter, cells);
  return cells;
}

bool is_name(std::string_view cell) { return !number_of(cell); }

std::string column_name(std::string_view cell) {
  cell = cell.substr(std::min(cell.find_first_not_of("# \t"), cell.size()));
  const std::size_t bracket = cell.find_last_of("[(");
  if (bracket == std::string_view::npos || bracket == 0 || (cell.back() != ']' && cell.back() != ')')) {
    return std::string(bare(cell));
  }
  const std::string unit = lower_case(bare(cell.substr(bracket + 1, cell.size() - bracket - 2)));
  const bool is_of_angles = unit == "deg" || unit == "degrees" || unit == "rad" || unit == "radians";
  return std::string(bare(cell.substr(0, bracket))) + (is_of_angles ? '_' + unit : "");
}

CsvHeader parse_csv_header(std::string_view text, std::string_view origin) {
  CsvHeader header;
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) {
    rest.remove_prefix(kByteOrderMark.size());
  }
  std::string_view candidate;  // the last comment before the first row, or the line of names
  std::size_t candidate_line = 0;
  bool has_names = false;
  for (std::size_t line = 0;;) {
    header.begin = text.size() - rest.size();
    header.first_line = line + 1;
    const std::optional<NextLine> next = next_line(rest);
    if (!next) {
      break;
    }
    line += next->lines;
    const char delimiter = delimiter_of(next->text);
    const std::vector<std::string_view> cells = cells_of(next->text, delimiter);
    const bool in_comment = is_comment(next->text);
    if (in_comment && has_names) {
      continue;
    }
    if (in_comment || (are_names(cells) && !has_names)) {
      candidate = next->text;
      candidate_line = line;
      has_names = !in_comment;
      continue;
    }
    header.delimiter = delimiter;
    header.columns = cells.size();
    break;
  }
  if (candidate.empty()) {
    return header;
  }
  std::string_view names = candidate;
  const bool in_comment = is_comment(candidate);
  if (in_comment) {
    names = names.substr(names.find('#') + 1);
  }
  for (const std::string_view cell : cells_of(names, header.columns > 0 ? header.delimiter : delimiter_of(names))) {
    header.names.push_back(column_name(cell));
  }
  if (header.columns == 0 || header.names.size() == header.columns) {
    return header;
  }
  if (!in_comment) {
    throw DataError(fmt::format("{}: line {}: {} names, but the row after it has {} numbers", origin, candidate_line,
                                header.names.size(), header.columns));
  }
  header.names.clear();  // any comment
  return header;
}

CsvTable parse_csv(std::string_view text, std::string_view origin) {
  const CsvHeader header = parse_csv_header(text, origin);
  if (header.columns > kMaxCsvColumns) {
    throw DataError(fmt::format("{}: line {}: {} columns, expected at most {}", origin, header.first_line,
                                header.columns, kMaxCsvColumns));
  }
  std::string_view rest = text.substr(header.begin);
  const std::size_t count = std::max(header.columns, header.names.size());
  std::vector<GrowingColumn> columns(count, GrowingColumn(0));
  for (GrowingColumn& column : columns) {
    column = GrowingColumn(likely_rows(rest, count));
  }
  read_rows(rest, header, origin, columns);
  CsvTable table;
  table.names = header.names;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    table.columns.push_back(columns[k].take_array());
    table.columns.back().origin = fmt::format(
        "{}: column {}", origin, table.names.empty() ? fmt::format("{}", k + 1) : fmt::format("'{}'", table.names[k]));
  }
  return table;
}

CsvTable read_csv(const std::filesystem::path& path) {
  return with_memory_for(path, [&] { return parse_csv(read_text_file(path), path.string()); });
}

}  // namespace dynamic_icp::formats
