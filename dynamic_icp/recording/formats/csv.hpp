// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::formats {

// Tables of numbers as text, one row a line: cells between commas, semicolons, tabs or blanks, the first of these that
// the first row has. A header of names may stand in front, also behind a '#'. Further lines that begin with '#' are
// comments; empty lines count for nothing.

/// ';', ',' or tab where the line has one, in this order (commas may be decimal ones); else a blank, for any run of
/// blanks.
char delimiter_of(std::string_view line);

/// The cells of a line, without blanks and quotation marks around them.
std::vector<std::string_view> cells_of(std::string_view line, char delimiter);

/// Whether a cell is the name of a column rather than a number. NaN, infinity and nothing at all are numbers.
bool is_name(std::string_view cell);

/// A name as it stands in a header, without '#' in front and a unit in brackets behind it; that of an angle becomes a
/// part of the name, azimuth_deg.
std::string column_name(std::string_view cell);

/// Where the rows of a table begin, and what they are like.
struct CsvHeader {
  std::vector<std::string> names;  ///< of the columns; empty: the table has none
  std::size_t columns = 0;         ///< of the first row; 0: there is no row
  char delimiter = ',';
  std::size_t begin = 0;       ///< the byte at which the rows begin
  std::size_t first_line = 1;  ///< the number of the line there
};

/// Looks at the begin of a text. Throws DataError naming `origin` and the line where header and first row differ in
/// length.
CsvHeader parse_csv_header(std::string_view text, std::string_view origin);

/// A table of numbers, column by column.
struct CsvTable {
  std::vector<std::string> names;  ///< of the columns; empty: the table has none
  std::vector<NpyArray> columns;   ///< of shape (N,): int64 where all numbers are whole ones, else float64
};

/// Reads rows of numbers after the header. Throws DataError naming `origin`, line and column for rows of another length
/// and for what is no number; empty cells are NaN. Never takes more memory than a small multiple of the text.
CsvTable parse_csv(std::string_view text, std::string_view origin);

/// The same from a file; throws as read_text_file does, too.
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace dynamic_icp::formats
