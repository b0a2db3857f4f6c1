// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/table.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp::benchmark {
namespace {

/// What stands for a character.
struct Escape {
  char character;
  std::string_view text;
};

constexpr Escape kMarkdown[] = {{'|', "\\|"},   {'*', "\\*"},  {'_', "\\_"}, {'`', "\\`"},
                                {'\\', "\\\\"}, {'<', "&lt;"}, {'\n', " "}};

constexpr Escape kLatex[] = {{'\\', "\\textbackslash{}"},
                             {'~', "\\textasciitilde{}"},
                             {'^', "\\textasciicircum{}"},
                             {'&', "\\&"},
                             {'%', "\\%"},
                             {'$', "\\$"},
                             {'#', "\\#"},
                             {'_', "\\_"},
                             {'{', "\\{"},
                             {'}', "\\}"},
                             {'<', "\\textless{}"},
                             {'>', "\\textgreater{}"}};

constexpr Escape kCsv[] = {{'"', "\"\""}};

std::string escaped(const std::string& text, std::span<const Escape> escapes) {
  std::string result;
  for (const char c : text) {
    const auto escape = std::ranges::find(escapes, c, &Escape::character);
    result += escape == escapes.end() ? std::string_view(&c, 1) : escape->text;
  }
  return result;
}

/// What stands before and after an emphasised text.
struct Marks {
  const char* before;
  const char* after;
};

std::string emphasised(const std::string& text, Emphasis emphasis, Marks best, Marks second) {
  if (emphasis == Emphasis::kNone) {
    return text;
  }
  const Marks marks = emphasis == Emphasis::kBest ? best : second;
  return marks.before + text + marks.after;
}

std::string joint_title(const TableColumn& column) {
  return column.group.empty() ? column.title : column.group + " " + column.title;
}

/// Number of characters of UTF-8 text.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

using TextRows = std::vector<std::vector<std::string>>;

/// Header and rows by what these functions make of their titles and cells.
template <class Title, class Cell>
TextRows text_rows(const Table& table, const Title& title, const Cell& cell) {
  TextRows rows(1);
  for (const TableColumn& column : table.header) {
    rows[0].push_back(title(joint_title(column)));
  }
  for (const std::vector<TableCell>& row : table.rows) {
    std::ranges::transform(row, std::back_inserter(rows.emplace_back()), cell);
  }
  return rows;
}

bool is_marked(const std::string& cell) { return cell.ends_with('*') || cell.ends_with('+'); }

std::string without_trailing_blanks(const std::string& line) { return line.substr(0, line.find_last_not_of(' ') + 1); }

/// The names of groups above the first of their columns; wide ones make room for themselves.
std::string plain_groups(const std::vector<std::string>& groups, std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    std::size_t end = i + 1;  // of the columns below the name
    std::size_t room = widths[i];
    for (; end < groups.size() && groups[end].empty(); ++end) {
      room += 2 + widths[end];
    }
    if (width_of(groups[i]) > room) {
      widths[end - 1] += width_of(groups[i]) - room;
      room = width_of(groups[i]);
    }
    line += (i == 0 ? "" : "  ") + groups[i] + std::string(room - width_of(groups[i]), ' ');
    i = end - 1;
  }
  return without_trailing_blanks(line) + "\n";
}

/// Whether a spreadsheet would take the text for a formula and calculate it.
bool is_formula(std::string_view text) {
  const bool may_be = text.size() > 1 && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  if (text.ends_with('%')) {
    text.remove_suffix(1);
  }
  return may_be && !parse_number<double>(text);
}

std::string csv_text(const std::string& cell) {
  const std::string text = is_formula(cell) ? "'" + cell : cell;
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  return '"' + escaped(text, kCsv) + '"';
}

/// The two lines of a LaTeX header: groups over their columns with a rule, if there are any, and titles.
std::string latex_header(const std::vector<TableColumn>& header) {
  std::vector<std::string> groups;
  std::vector<std::string> titles;
  std::string rules;
  for (std::size_t i = 0; i < header.size();) {
    std::size_t end = i;
    for (; end < header.size() && header[end].group == header[i].group; ++end) {
      titles.push_back(escaped(header[end].title, kLatex));
    }
    if (header[i].group.empty()) {
      groups.insert(groups.end(), end - i, "");
    } else {
      groups.push_back(
          fmt::format("\\multicolumn{{{}}}{{c}}{{\\textbf{{{}}}}}", end - i, escaped(header[i].group, kLatex)));
      rules += fmt::format("\\cmidrule(lr){{{}-{}}}", i + 1, end);
    }
    i = end;
  }
  const std::string above = rules.empty() ? "" : fmt::format("{} \\\\ {}\n", fmt::join(groups, " & "), rules);
  return above + fmt::format("{} \\\\\n", fmt::join(titles, " & "));
}

}  // namespace

std::string markdown(const Table& table) {
  const TextRows rows = text_rows(
      table, [](const std::string& title) { return escaped(title, kMarkdown); },
      [](const TableCell& cell) {
        return emphasised(escaped(cell.text, kMarkdown), cell.emphasis, {"**", "**"}, {"<u>", "</u>"});
      });
  std::vector<std::size_t> widths(table.header.size(), 3);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], width_of(row[i]));
    }
  }
  std::string text = fmt::format("## {}\n\n", escaped(table.title, kMarkdown));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += "|";
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      const std::string blanks(widths[i] - width_of(rows[r][i]), ' ');
      text += i == 0 ? fmt::format(" {}{} |", rows[r][i], blanks) : fmt::format(" {}{} |", blanks, rows[r][i]);
    }
    text += "\n";
    if (r == 0) {
      text += "|";
      for (std::size_t i = 0; i < widths.size(); ++i) {
        text += fmt::format(" {}{} |", std::string(widths[i] - 1, '-'), i == 0 ? '-' : ':');
      }
      text += "\n";
    }
  }
  return text + "\n" + escaped(table.caption, kMarkdown) + "\n";
}

std::string plain(const Table& table) {
  TextRows rows;
  std::vector<std::string> groups;
  std::vector<std::string> titles;
  for (const TableColumn& column : table.header) {
    const bool is_begun = !groups.empty() && table.header[groups.size() - 1].group == column.group;
    groups.push_back(is_begun ? "" : column.group);
    titles.push_back(column.title);
  }
  const bool has_groups = std::ranges::any_of(groups, [](const std::string& group) { return !group.empty(); });
  rows.push_back(titles);
  for (const std::vector<TableCell>& row : table.rows) {
    std::ranges::transform(row, std::back_inserter(rows.emplace_back()), [](const TableCell& cell) {
      return emphasised(cell.text, cell.emphasis, {"", "*"}, {"", "+"});
    });
  }
  std::vector<std::size_t> widths(table.header.size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      // Values end in one column, marked or not.
      widths[i] = std::max(widths[i], width_of(row[i]) + (i > 0 && !is_marked(row[i]) ? 1 : 0));
    }
  }
  std::string text = table.title + "\n";
  if (has_groups) {
    text += plain_groups(groups, widths);
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string value = row[i] + (i > 0 && !is_marked(row[i]) ? " " : "");
      const std::string blanks(widths[i] - width_of(value), ' ');
      line += i == 0 ? value + blanks : "  " + blanks + value;
    }
    text += without_trailing_blanks(line) + "\n";
  }
  return text;
}

std::string csv(const Table& table) {
  std::string text;
  for (const auto& row : text_rows(table, csv_text, [](const TableCell& cell) { return csv_text(cell.text); })) {
    text += fmt::format("{}\r\n", fmt::join(row, ","));
  }
  return text;
}

std::string latex(const Table& table) {
  std::string columns(std::max<std::size_t>(table.header.size(), 1), 'c');
  columns.front() = 'l';
  std::string text =
      "% needs the packages booktabs and graphicx\n\\begin{table*}[ht]\n\\centering\n\\resizebox{\\textwidth}{!}{%\n";
  text += fmt::format("\\begin{{tabular}}{{{}}}\n\\toprule\n{}\\midrule\n", columns, latex_header(table.header));
  for (const std::vector<TableCell>& row : table.rows) {
    std::vector<std::string> texts;
    for (const TableCell& cell : row) {
      texts.push_back(emphasised(escaped(cell.text, kLatex), cell.emphasis, {"\\textbf{", "}"}, {"\\underline{", "}"}));
    }
    text += fmt::format("{} \\\\\n", fmt::join(texts, " & "));
  }
  text += fmt::format("\\bottomrule\n\\end{{tabular}}%\n}}\n\\caption{{{}}}\n\\label{{tab:{}}}\n\\end{{table*}}\n",
                      escaped(table.caption, kLatex), table.name);
  return text;
}

}  // namespace dynamic_icp::benchmark
