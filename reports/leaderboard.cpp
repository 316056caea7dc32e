// SPDX-License-Identifier: MIT
#include "reports/leaderboard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reports/figures.hpp"
#include "reports/markdown.hpp"
#include "reports/proofs.hpp"

namespace tribench {
namespace {

constexpr std::size_t kReasonsShown = 12;
constexpr std::size_t kCellsShown = 3;
constexpr std::size_t kFormulaWidth = 120;

std::string counts_line(const RunFolder& run, const RunSummary& summary) {
  std::string text = fmt::format("{} cells: {} gave a formula, **{} failed**", summary.cells,
                                 summary.cells - summary.failed, summary.failed);
  if (run.planned > 0) {
    text += run.missing.empty() ? std::string(", none missing")
                                : fmt::format(
                                      ", **{} of {} planned are missing**: places and tests "
                                      "are of what is there, and may be of other seeds for "
                                      "one method than for another",
                                      run.missing.size(), run.planned);
  }
  return text + fmt::format("; {} of CPU time in fits.\n", duration_figure(summary.fit_cpu_s));
}

// Provenance that belongs on the first screen, and how it is called there.
constexpr std::pair<const char*, const char*> kMadeWith[] = {
    {"code.version", "tribench"},     {"code.commit", "commit"},
    {"code.dirty", "dirty"},          {"code.compiler", "compiler"},
    {"sessions.0.machine.cpu", "on"}, {"sessions.0.started", "started"},
    {"fingerprint", "results"},
};

std::string made_with(const RunFolder& run) {
  std::string text;
  for (const auto& [key, label] : kMadeWith) {
    const std::string value = run.provenance_of(key);
    if (value.empty() || value == "false") continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label, value);
  }
  return text.empty() ? text : fmt::format("Made with {}.\n", text);
}

// "**3/10**", so that trouble is seen; "0" where there is none.
std::string marked_count(std::size_t count, std::size_t of) {
  return count == 0 ? std::string("0") : fmt::format("**{}/{}**", count, of);
}

std::string winners(const RunSummary& summary) {
  MarkdownTable table({{"problem"},
                       {"operators"},
                       {"best method"},
                       {"MAE test", Align::right},
                       {"complexity", Align::right},
                       {"singular", Align::right},
                       {"how sure"}});
  for (const ProblemTable& each : summary.tables) {
    if (!each.has_best()) {
      table.add({each.problem, each.operators, "none", "-", "-", "-", certainty_of(each)});
      continue;
    }
    const MethodRow& best = each.rows.front();
    table.add({each.problem, each.operators, fmt::format("**{}**", best.method),
               figure(best.mae_test.middle), count_figure(best.complexity),
               marked_count(best.refuted, best.looked_at()), certainty_of(each)});
  }
  return table.text();
}

std::string ranks(const RunSummary& summary) {
  std::string text;
  for (const Ranking& ranking : summary.rankings) {
    if (ranking.methods.size() < 2 || ranking.test.blocks < 2) continue;
    text += fmt::format("- `{}`:", ranking.operators);
    for (std::size_t i = 0; i < ranking.methods.size(); ++i) {
      text += fmt::format("{} {} {}", i == 0 ? "" : ",", ranking.methods[i],
                          figure(ranking.test.mean_ranks[i]));
    }
    text += fmt::format(". {}\n", reading_of(ranking));
  }
  return text.empty() ? text : "\n## Mean ranks over all problems (1 is best)\n\n" + text;
}

std::string failures(const RunFolder& run, const RunSummary& summary) {
  std::string text = "\n## What failed\n\n";
  if (summary.failures.empty()) text += "No cell failed.\n";
  if (!summary.failures.empty()) {
    MarkdownTable table({{"method"}, {"reason"}, {"cells", Align::right}, {"first of them"}});
    for (std::size_t i = 0; i < std::min(kReasonsShown, summary.failures.size()); ++i) {
      const Failure& failure = summary.failures[i];
      std::string first;
      for (std::size_t c = 0; c < std::min(kCellsShown, failure.cells.size()); ++c) {
        first += fmt::format("{}{}", c == 0 ? "" : ", ", markdown_code(failure.cells[c]->cell));
      }
      table.add({failure.method, shortened(failure.reason, 80),
                 fmt::format("{}", failure.cells.size()), first});
    }
    text += table.text();
    if (summary.failures.size() > kReasonsShown) {
      text += fmt::format("\n{} more kinds of failure: see results.csv.\n",
                          summary.failures.size() - kReasonsShown);
    }
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(10, run.missing.size()); ++i) {
    text +=
        fmt::format("{}- missing: {}\n", i == 0 ? "\n" : "", markdown_code(run.missing[i].cell));
  }
  if (run.missing.size() > 10) text += fmt::format("- and {} more\n", run.missing.size() - 10);
  for (std::size_t i = 0; i < run.complaints.size(); ++i) {
    text += fmt::format("{}- {}\n", i == 0 ? "\n" : "", run.complaints[i]);
  }
  return text;
}

std::string spread_text(const MethodRow& row) {
  if (row.mae_test.count < 2) return "";
  return fmt::format("{} .. {}", figure(row.mae_test.low), figure(row.mae_test.high));
}

std::string complexity_text(const MethodRow& row) {
  const std::string text = count_figure(row.complexity);
  return row.complexity_adaptation > 0
             ? fmt::format("{} (+{})", text, count_figure(row.complexity_adaptation))
             : text;
}

bool any_figure(const ProblemTable& table, double MethodRow::*member) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const MethodRow& row) { return !std::isnan(row.*member); });
}

std::string method_table(const ProblemTable& table) {
  const bool truth = any_figure(table, &MethodRow::mae_truth);
  const bool relative = any_figure(table, &MethodRow::relative_error_test);
  std::vector<MarkdownTable::Heading> headings = {
      {"method"}, {"MAE test", Align::right}, {"over seeds", Align::right}, {"against the best"}};
  if (truth) headings.push_back({"to the truth", Align::right});
  if (relative) headings.push_back({"relative %", Align::right});
  for (const char* name : {"complexity", "CPU s", "singular", "failed"}) {
    headings.push_back({name, Align::right});
  }
  MarkdownTable text(headings);
  for (const MethodRow& row : table.rows) {
    const bool bold = row.standing == Standing::best || row.standing == Standing::equivalent;
    const std::string error = figure(row.mae_test.middle);
    std::vector<std::string> cells = {row.method, bold ? fmt::format("**{}**", error) : error,
                                      spread_text(row), standing_text(row)};
    if (truth) cells.push_back(figure(row.mae_truth));
    if (relative) cells.push_back(figure(row.relative_error_test));
    cells.push_back(complexity_text(row));
    cells.push_back(figure(row.fit_cpu_s));
    cells.push_back(marked_count(row.refuted, row.looked_at()));
    cells.push_back(marked_count(row.failed, row.cells) +
                    (row.missing > 0 ? fmt::format(" ({} missing)", row.missing) : ""));
    text.add(std::move(cells));
  }
  return text.text();
}

std::string formulas(const ProblemTable& table) {
  std::string text;
  for (const MethodRow& row : table.rows) {
    if (row.representative != nullptr) {
      text += fmt::format("- {} (seed {}): {}\n", row.method, row.representative->seed,
                          markdown_code(shortened(row.representative->formula, kFormulaWidth)));
    }
    if (row.singular != nullptr) {
      text += fmt::format("  - singular, seed {}: {} at {}\n", row.singular->seed,
                          markdown_code(shortened(row.singular->formula, kFormulaWidth)),
                          markdown_code(row.singular->witness));
    }
  }
  return text;
}

}  // namespace

std::string leaderboard_head(const RunFolder& run, const RunSummary& summary,
                             const std::string& changed) {
  std::string text = fmt::format("# {}\n\n", run.name);
  text += counts_line(run, summary);
  text += made_with(run);
  text += "\n## Who wins where\n\n";
  text += winners(summary);
  text += ranks(summary);
  text += failures(run, summary);
  if (!changed.empty()) text += "\n## What changed\n\n" + changed;
  return text;
}

std::string leaderboard(const RunFolder& run, const RunSummary& summary,
                        const std::vector<Sensitivity>& sensitivity, const std::string& changed) {
  std::string text = leaderboard_head(run, summary, changed);
  text += sensitivity_section(sensitivity);
  text += proofs_section(run);
  text +=
      "\n## How to read the tables\n\n"
      "Errors are mean absolute errors on test movements, medians over seeds, in the target's unit "
      "(N m for\n"
      "torques); *to the truth* is the error against the noise-free law where it is known. "
      "*Against the best*\n"
      "gives the factor to the best method and whether a paired signed-rank test over seeds "
      "(Holm-adjusted,\n"
      "5 %) can tell the two apart; *within 1 %* holds for an interval of the median, and for no "
      "method that fails.\n"
      "What repeats to ten digits is one draw, and an error below 1e-12 of the target is none.\n"
      "*singular* counts formulas with a point inside the input box where they\n"
      "have no finite value; *failed* counts cells without a formula, which are placed last and "
      "never left out.\n";
  std::string problem;
  for (const ProblemTable& table : summary.tables) {
    if (table.problem != problem) text += fmt::format("\n## {}\n", table.problem);
    problem = table.problem;
    text += fmt::format("\n### {}, operators `{}`\n\n", table.problem, table.operators);
    if (const std::string yardsticks = yardsticks_text(table); !yardsticks.empty()) {
      text += yardsticks + "\n\n";
    }
    text += method_table(table) + '\n';
    text += reading_of(table) + "\n\n";
    text += formulas(table);
  }
  return text;
}

}  // namespace tribench
