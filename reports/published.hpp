// SPDX-License-Identifier: MIT
//
// Published figures beside ours. A grid names a CSV file (`reference`), the run's folder holds a
// copy as reference.csv:
//   table,problem,published_method,kind,methods,mae,complexity,note
// `problem` is a problem of the run; `methods` are ours to set beside the figure, separated by
// blanks, the one that means the published thing first; `mae` (in the problem's unit) and
// `complexity` are as published, empty in a row that only adds methods of ours; `note` says in a
// sentence what is known of a difference. `kind` says what the remarks may conclude: "symbolic",
// "baseline" (what symbolic regression should beat) or "simple" (what should be said when it does
// as well).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

// Its name in a run's folder.
inline constexpr const char* kPublishedFile = "reference.csv";

struct PublishedFigure {
  std::string table;
  std::string problem;
  std::string published_method;
  std::string kind;
  std::string methods;
  double mae = kMissing;
  double complexity = kMissing;
  std::string note;
};

// Empty without the file; damaged rows are left out and said in `complaints`.
std::vector<PublishedFigure> read_published(const std::filesystem::path& file,
                                            std::vector<std::string>& complaints);

// Throws Error (bad_input) naming `file` where the text is not such a file: for whoever starts a
// run, so that a mistake does not show after it.
void check_published(const std::string& text, const std::string& file);

// A published figure and one of our rows; `ours` is null where the run has none.
struct PublishedRow {
  PublishedFigure published;
  std::string operators;
  const MethodRow* ours = nullptr;
};

// The figures of one problem. Points into the summary, which must outlive it.
struct PublishedProblem {
  std::string table;
  std::string problem;
  double mae_ceiling = kMissing;   // noise ceiling
  double mae_refitted = kMissing;  // the true law, its constants fitted to the training rows
  std::vector<PublishedRow> rows;
  std::vector<std::string>
      remarks;  // what the figures say, and the notes, one sentence or two each
};

// In the order of the figures; problems that the run has no row of are left out.
std::vector<PublishedProblem> match_published(const std::vector<PublishedFigure>& figures,
                                              const RunSummary& summary);

// Our count that a published complexity stands beside: of the adaptation alone where there is one.
double published_complexity_of(const MethodRow& ours);

// A table and its remarks a problem, headings of the given level ("###").
std::string published_markdown(const std::vector<PublishedProblem>& problems,
                               std::string_view heading);
nlohmann::ordered_json published_json(const std::vector<PublishedProblem>& problems);

}  // namespace tribench
