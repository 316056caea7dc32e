// SPDX-License-Identifier: MIT
//
// A file with a model, as `fit --save` writes it and other hands change it: refused with its name,
// or a formula and intervals that can be evaluated.
#include "algorithms/states/state_text.hpp"
#include "harness/cli/fit_output.hpp"
#include "harness/cli/model_argument.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

void try_model(const std::string& file) {
  const nlohmann::json model = model_argument(file);
  std::vector<std::string> names;
  const StatefulFormula formula =
      parse_stateful_collecting(model["formula"].get<std::string>(), names);
  if (!formula.states.empty()) return;
  const std::vector<std::vector<double>> columns(names.size(), {-1.0, 0.0, 0.5});
  std::vector<const double*> pointers;
  for (const std::vector<double>& column : columns) pointers.push_back(column.data());
  const FitIntervals intervals = read_fit_intervals(model, formula.formula, file);
  const std::vector<double> halves = curve_half_widths(formula.formula, intervals, {pointers, 3});
  fuzz::expect(halves.size() == 3, "as many half widths as rows");
}

}  // namespace

TRIBENCH_FUZZ_TARGET(model) {
  const fuzz::MemoryFile file(input);
  fuzz::reads([&] { try_model(file.path()); });
}
