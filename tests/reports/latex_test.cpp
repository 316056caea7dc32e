// SPDX-License-Identifier: MIT
#include "reports/latex.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "foundation/output_file.hpp"
#include "reports/run_folder.hpp"
#include "tests/reports/sample_run.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string sample_tables(const fs::path& folder) {
  write_sample_run(folder, 2);
  write_file(folder / kPublishedFile,
             "table,problem,published_method,kind,methods,mae,complexity,note\n"
             "Table 1,A/j2/no_load,PySR,symbolic,pysr,0.041,15,\n"
             "Table 1,A/j2/no_load,GP & co_,symbolic,nothing,1.5,20,\n");
  const RunFolder run = read_run_folder(folder);
  std::vector<std::string> complaints;
  const RunSummary summary = summarise(run);
  return latex_tables(
      run.name, summary,
      match_published(read_published(folder / kPublishedFile, complaints), summary));
}

TEST(Latex, IsByteForByteWhatWasAgreed) {
  expect_golden(sample_tables(fresh_folder("latex")), "reports/tables.tex");
}

TEST(Latex, EveryRowHasAsManyCellsAsColumnsAndEveryBraceItsPartner) {
  std::istringstream lines(sample_tables(fresh_folder("latex_rows")));
  std::size_t columns = 0;
  std::size_t rows = 0;
  int depth = 0;
  for (std::string line; std::getline(lines, line);) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const bool escaped = i > 0 && line[i - 1] == '\\';
      if (line[i] == '{' && !escaped) ++depth;
      if (line[i] == '}' && !escaped) --depth;
    }
    const std::string begin = "\\begin{tabular}{";
    if (line.starts_with(begin)) {
      columns = line.size() - begin.size() - 1;
    } else if (line.ends_with("\\\\")) {
      std::size_t cells = 1;
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '&' && line[i - 1] != '\\') ++cells;
      }
      for (std::size_t at = 0; (at = line.find("\\multicolumn{2}", at)) != std::string::npos;
           ++at) {
        ++cells;
      }
      EXPECT_EQ(cells, columns) << line;
      ++rows;
    }
  }
  EXPECT_EQ(depth, 0);
  EXPECT_GT(rows, 12U);
}

TEST(Latex, EscapesWhatLatexWouldEat) {
  EXPECT_EQ(latex_text("a_b & 5 % {x} #1 $ ~ ^ \\"),
            "a\\_b \\& 5 \\% \\{x\\} \\#1 \\$ \\textasciitilde{} \\textasciicircum{} "
            "\\textbackslash{}");
}

TEST(Latex, Compiles) {
  if (std::system("command -v pdflatex >/dev/null 2>&1") != 0) GTEST_SKIP() << "no pdflatex";
  const fs::path folder = fresh_folder("latex_compiles");
  write_file(folder / "paper.tex",
             "\\documentclass{article}\\usepackage{booktabs,graphicx}\\begin{document}\n" +
                 sample_tables(folder) + "\\end{document}\n");
  const std::string command = "cd " + folder.string() +
                              " && pdflatex -halt-on-error -interaction=batchmode paper.tex "
                              ">/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(fs::exists(folder / "paper.pdf"));
}

}  // namespace
}  // namespace tribench
