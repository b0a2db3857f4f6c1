// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace dynamic_icp::benchmark {

/// How a cell of a table stands out, as in the paper: the best value bold, the second underlined.
enum class Emphasis { kNone, kBest, kSecond };

struct TableCell {
  std::string text;
  Emphasis emphasis = Emphasis::kNone;
};

/// The head of a column. Neighbours with the same group share a heading above theirs.
struct TableColumn {
  std::string group;  ///< may be empty
  std::string title;
};

/// A table without the looks of any format.
struct Table {
  std::string name;     ///< for file names: "accuracy"
  std::string title;    ///< in a few words
  std::string caption;  ///< what it shows, how it was measured and on what
  std::vector<TableColumn> header;
  std::vector<std::vector<TableCell>> rows;  ///< as long as the header; the first cell names the row
};

/// A heading, the table with columns of even width, the caption. Best **bold**, second <u>underlined</u>.
std::string markdown(const Table& table);

/// For a terminal: the title and columns of even width, two blanks apart, without the caption. Behind the
/// value the best has a * and the second a +. Groups stand above their columns.
std::string plain(const Table& table);

/// Header and rows as RFC 4180 has them, without caption and emphasis. Groups stand before the titles. Texts that a
/// spreadsheet would take for a formula, which begin with = + - @, get an apostrophe in front; numbers stay.
std::string csv(const Table& table);

/// A table* for a document that uses the packages booktabs and graphicx. Best \textbf, second \underline.
std::string latex(const Table& table);

}  // namespace dynamic_icp::benchmark
