// SPDX-License-Identifier: MIT
//
// Published figures beside ours: a run's folder may hold reference.csv with the columns
//   table,problem,published_method,methods,mae,complexity,note
// `problem` is a problem of the run, `methods` the names of our methods to set beside it, separated
// by blanks; `mae` and `complexity` are as published, `note` says what is known of a difference.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reports/run_folder.hpp"
#include "reports/summary.hpp"

namespace tribench {

struct PublishedFigure {
  std::string table;
  std::string problem;
  std::string published_method;
  std::string methods;
  double mae = kMissing;
  double complexity = kMissing;
  std::string note;
};

// Empty without the file; damaged rows are left out and said in `complaints`.
std::vector<PublishedFigure> read_published(const std::filesystem::path& file,
                                            std::vector<std::string>& complaints);

// A published figure and one of our rows; `ours` is null where the run has none.
struct PublishedRow {
  PublishedFigure published;
  std::string operators;
  const MethodRow* ours = nullptr;
};
std::vector<PublishedRow> match_published(const std::vector<PublishedFigure>& figures,
                                          const RunSummary& summary);

std::string published_markdown(const std::vector<PublishedRow>& rows);
nlohmann::ordered_json published_json(const std::vector<PublishedRow>& rows);

}  // namespace tribench
