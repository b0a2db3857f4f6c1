// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/table.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp::benchmark {
namespace {

/// The text with each character that `replacement` knows replaced; it gives nothing for the others.
template <class Replacement>
std::string escaped(const std::string& text, const Replacement& replacement) {
  std::string result;
  for (const char c : text) {
    const std::string_view other = replacement(c);
    result += other.empty() ? std::string(1, c) : std::string(other);
  }
  return result;
}

std::string markdown_text(const std::string& text) {
  return escaped(text, [](char c) -> std::string_view {
    switch (c) {
      case '|':
        return "\\|";
      case '*':
        return "\\*";
      case '_':
        return "\\_";
      case '`':
        return "\\`";
      case '\\':
        return "\\\\";
      case '<':
        return "&lt;";
      case '\n':
        return " ";
      default:
        return {};
    }
  });
}

std::string latex_text(const std::string& text) {
  return escaped(text, [](char c) -> std::string_view {
    switch (c) {
      case '\\':
        return "\\textbackslash{}";
      case '~':
        return "\\textasciitilde{}";
      case '^':
        return "\\textasciicircum{}";
      case '&':
        return "\\&";
      case '%':
        return "\\%";
      case '$':
        return "\\$";
      case '#':
        return "\\#";
      case '_':
        return "\\_";
      case '{':
        return "\\{";
      case '}':
        return "\\}";
      case '<':
        return "\\textless{}";
      case '>':
        return "\\textgreater{}";
      default:
        return {};
    }
  });
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

/// Header and rows as Markdown writes them.
TextRows markdown_rows(const Table& table) {
  TextRows rows(1);
  for (const TableColumn& column : table.header) {
    rows[0].push_back(markdown_text(joint_title(column)));
  }
  for (const std::vector<TableCell>& row : table.rows) {
    rows.emplace_back();
    for (const TableCell& cell : row) {
      rows.back().push_back(emphasised(markdown_text(cell.text), cell.emphasis, {"**", "**"}, {"<u>", "</u>"}));
    }
  }
  return rows;
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
  return '"' + escaped(text, [](char c) -> std::string_view { return c == '"' ? "\"\"" : ""; }) + '"';
}

std::string joined(const std::vector<std::string>& texts, std::string_view separator, std::string_view end) {
  std::string line;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    line += (i > 0 ? std::string(separator) : "") + texts[i];
  }
  return line + std::string(end);
}

/// The two lines of a LaTeX header: groups over their columns with a rule, if there are any, and titles.
std::string latex_header(const std::vector<TableColumn>& header) {
  std::vector<std::string> groups;
  std::vector<std::string> titles;
  std::string rules;
  for (std::size_t i = 0; i < header.size();) {
    std::size_t end = i;
    for (; end < header.size() && header[end].group == header[i].group; ++end) {
      titles.push_back(latex_text(header[end].title));
    }
    if (header[i].group.empty()) {
      groups.insert(groups.end(), end - i, "");
    } else {
      groups.push_back(fmt::format("\\multicolumn{{{}}}{{c}}{{\\textbf{{{}}}}}", end - i, latex_text(header[i].group)));
      rules += fmt::format("\\cmidrule(lr){{{}-{}}}", i + 1, end);
    }
    i = end;
  }
  const std::string above = rules.empty() ? "" : joined(groups, " & ", " \\\\ ") + rules + "\n";
  return above + joined(titles, " & ", " \\\\\n");
}

}  // namespace

std::string markdown(const Table& table) {
  const TextRows rows = markdown_rows(table);
  std::vector<std::size_t> widths(table.header.size(), 3);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], width_of(row[i]));
    }
  }
  std::string text = fmt::format("## {}\n\n", markdown_text(table.title));
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
  return text + "\n" + markdown_text(table.caption) + "\n";
}

std::string csv(const Table& table) {
  std::vector<std::string> titles;
  for (const TableColumn& column : table.header) {
    titles.push_back(csv_text(joint_title(column)));
  }
  std::string text = joined(titles, ",", "\r\n");
  for (const std::vector<TableCell>& row : table.rows) {
    std::vector<std::string> texts;
    for (const TableCell& cell : row) {
      texts.push_back(csv_text(cell.text));
    }
    text += joined(texts, ",", "\r\n");
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
      texts.push_back(emphasised(latex_text(cell.text), cell.emphasis, {"\\textbf{", "}"}, {"\\underline{", "}"}));
    }
    text += joined(texts, " & ", " \\\\\n");
  }
  text += fmt::format("\\bottomrule\n\\end{{tabular}}%\n}}\n\\caption{{{}}}\n\\label{{tab:{}}}\n\\end{{table*}}\n",
                      latex_text(table.caption), table.name);
  return text;
}

}  // namespace dynamic_icp::benchmark
