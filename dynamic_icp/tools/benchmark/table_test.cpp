// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/table.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::benchmark {
namespace {

/// A row with everything that formats must escape.
Table awkward_table() {
  return {.name = "awkward",
          .title = "Awkward",
          .caption = "50% of a_b & {c}",
          .header = {{"", "Method"}, {"street_1", "RTE [m]"}, {"street_1", "RRE [deg]"}, {"", "n"}},
          .rows = {{{"a|b, \"c\" $#^~\\<>"}, {"0.1", Emphasis::kBest}, {"0.2", Emphasis::kSecond}, {"-"}},
                   {{"failed_one"}, {"failed"}, {"*3*"}, {"12"}}}};
}

TEST(Table, MarkdownEscapesAlignsAndStandsOut) {
  EXPECT_EQ(markdown(awkward_table()),
            "## Awkward\n\n"
            "| Method                | street\\_1 RTE [m] | street\\_1 RRE [deg] |   n |\n"
            "| --------------------- | ----------------: | ------------------: | --: |\n"
            "| a\\|b, \"c\" $#^~\\\\&lt;> |           **0.1** |          <u>0.2</u> |   - |\n"
            "| failed\\_one           |            failed |               \\*3\\* |  12 |\n"
            "\n50% of a\\_b & {c}\n");
}

TEST(Table, PlainTextStandsInColumns) {
  const Table table{.name = "n",
                    .title = "Accuracy",
                    .caption = "c",
                    .header = {{"", "Method"}, {"city", "RTE"}, {"city", "RRE"}, {"a_long_street", "RTE"}},
                    .rows = {{{"Allée"}, {"0.1", Emphasis::kBest}, {"20.25"}, {"7", Emphasis::kSecond}},
                             {{"b"}, {"failed"}, {"-"}, {"12"}}}};
  EXPECT_EQ(plain(table),
            "Accuracy\n"
            "        city             a_long_street\n"
            "Method     RTE     RRE            RTE\n"
            "Allée      0.1*  20.25              7+\n"
            "b       failed       -             12\n");
}

TEST(Table, MarkdownCountsCharactersNotBytes) {
  const Table table{.name = "n", .title = "t", .caption = "c", .header = {{"", "Allée"}}, .rows = {{{"Straße"}}}};
  EXPECT_EQ(markdown(table), "## t\n\n| Allée  |\n| ------ |\n| Straße |\n\nc\n");
}

TEST(Table, CsvQuotesWhatMustBeQuoted) {
  EXPECT_EQ(csv(awkward_table()),
            "Method,street_1 RTE [m],street_1 RRE [deg],n\r\n"
            "\"a|b, \"\"c\"\" $#^~\\<>\",0.1,0.2,-\r\n"
            "failed_one,failed,*3*,12\r\n");
  Table lines = awkward_table();
  lines.rows = {{{"two\nlines"}, {""}, {""}, {""}}};
  EXPECT_NE(csv(lines).find("\"two\nlines\",,,\r\n"), std::string::npos);
}

TEST(Table, CsvHoldsNoFormulas) {
  const Table table{.name = "n",
                    .title = "t",
                    .caption = "c",
                    .header = {{"", "=1+1"}, {"@a", "b"}, {"", "c"}, {"", "d"}},
                    .rows = {{{"=HYPERLINK(\"x\",1)"}, {"-0.5"}, {"-12.3%"}, {"-"}},
                             {{"+cmd|x"}, {"-1-1"}, {"@x"}, {"1e-3"}},
                             {{"\t=1"}, {"-x%"}, {"+5"}, {"a=b"}}}};
  EXPECT_EQ(csv(table),
            "'=1+1,'@a b,c,d\r\n"
            "\"'=HYPERLINK(\"\"x\"\",1)\",-0.5,-12.3%,-\r\n"
            "'+cmd|x,'-1-1,'@x,1e-3\r\n"
            "'\t=1,'-x%,+5,a=b\r\n");
}

TEST(Table, LatexEscapesGroupsAndStandsOut) {
  EXPECT_EQ(latex(awkward_table()),
            "% needs the packages booktabs and graphicx\n"
            "\\begin{table*}[ht]\n\\centering\n\\resizebox{\\textwidth}{!}{%\n"
            "\\begin{tabular}{lccc}\n\\toprule\n"
            " & \\multicolumn{2}{c}{\\textbf{street\\_1}} &  \\\\ \\cmidrule(lr){2-3}\n"
            "Method & RTE [m] & RRE [deg] & n \\\\\n\\midrule\n"
            "a|b, \"c\" \\$\\#\\textasciicircum{}\\textasciitilde{}\\textbackslash{}\\textless{}\\textgreater{} & "
            "\\textbf{0.1} & \\underline{0.2} & - \\\\\n"
            "failed\\_one & failed & *3* & 12 \\\\\n"
            "\\bottomrule\n\\end{tabular}%\n}\n\\caption{50\\% of a\\_b \\& \\{c\\}}\n\\label{tab:awkward}\n"
            "\\end{table*}\n");
}

TEST(Table, WithoutGroupsLatexHasOneHeaderLine) {
  const Table table{.name = "n", .title = "t", .caption = "c", .header = {{"", "a"}, {"", "b"}}, .rows = {}};
  EXPECT_NE(latex(table).find("\\toprule\na & b \\\\\n\\midrule\n\\bottomrule"), std::string::npos) << latex(table);
}

}  // namespace
}  // namespace dynamic_icp::benchmark
