// SPDX-License-Identifier: MIT
//
// What `tribench fit` answers: for a terminal, as JSON, as a file that `tribench predict` reads.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "algorithms/fitting/fit_intervals.hpp"
#include "harness/category_fit.hpp"
#include "harness/cell_task.hpp"
#include "problems/preparation/data_options.hpp"

namespace tribench {

struct FitAnswer {
  CellResult result;
  std::optional<FitIntervals> intervals;
  std::string no_intervals;  // why there are none
  std::string ended;         // "finished", "evaluations", "seconds", "stopped"
  std::string reproduce;     // the command that gives the same again, or nearly
  bool reproduces_exactly = true;
  std::vector<std::string> inputs;
  std::string target;
  std::string operators;  // the set's name; empty where the form is fixed
  DataOptions reading;    // of the data
};

nlohmann::ordered_json fit_json(const FitAnswer& answer);
void print_fit(const FitAnswer& answer);

// How the data of such a fit were read; the default where the JSON does not say. Throws Error
// (bad_input) with the file.
DataOptions read_fit_reading(const nlohmann::json& model, const std::string& file);

// Of one shape for several categories.
nlohmann::ordered_json category_json(const CategoryFit& fit);
void print_category_fit(const CategoryFit& fit);

// Of a file with the JSON of a fit of this formula. Throws Error (bad_input) with the file where it
// has none, or those of another formula.
FitIntervals read_fit_intervals(const nlohmann::json& model, const Expression& formula,
                                const std::string& file);

}  // namespace tribench
