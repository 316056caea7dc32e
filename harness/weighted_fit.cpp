// SPDX-License-Identifier: MIT
#include "harness/weighted_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/admission.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/evaluation_error.hpp"
#include "algorithms/fitting/free_constants.hpp"
#include "algorithms/fitting/held_out_choice.hpp"
#include "algorithms/fitting/joint_front.hpp"
#include "algorithms/fitting/relative_noise.hpp"
#include "algorithms/states/state_text.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "harness/judge.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

// The weights come from a formula that was fitted without them, then from one fitted with them.
constexpr int kRoundsOfWeights = 2;

using build::operator*;

// Row k is taken as often as points (i + 1/2) / n of the whole weight fall into its part.
std::vector<std::size_t> sampled_rows(std::span<const double> weights) {
  double whole = 0;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    if (!(weights[r] >= 0)) {
      throw_bad_input(fmt::format("the weight of row {} is {}", r + 1, weights[r]), {},
                      "weights are 0 or more; of --sigma, which is above 0, they are 1/sigma^2");
    }
    whole += weights[r];
  }
  if (!(whole > 0)) throw_bad_input("all weights are 0", {}, "give some rows a weight");
  const auto count = static_cast<double>(weights.size());
  std::vector<std::size_t> rows;
  double upto = 0;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    upto += weights[r] / whole * count;
    while (static_cast<double>(rows.size()) + 0.5 < upto && rows.size() < weights.size()) {
      rows.push_back(r);
    }
  }
  return rows;
}

// The front as a problem without weights: every row times the root of its weight, which is one more
// column, so that whatever chooses among formulas can choose here.
class WeightedRows {
 public:
  WeightedRows(const Table& table, std::span<const double> weights) {
    std::vector<std::size_t> counting;
    for (std::size_t r = 0; r < weights.size(); ++r) {
      if (weights[r] > 0) counting.push_back(r);
    }
    table_ = select_rows(table, counting);
    double largest = 0;
    for (const std::size_t r : counting) largest = std::max(largest, weights[r]);
    for (const std::size_t r : counting) roots_.push_back(std::sqrt(weights[r] / largest));
    for (std::size_t r = 0; r < roots_.size(); ++r) table_.target[r] *= roots_[r];
    for (const std::vector<double>& column : table_.columns) pointers_.push_back(column.data());
    pointers_.push_back(roots_.data());
  }
  WeightedRows(const WeightedRows&) = delete;
  WeightedRows& operator=(const WeightedRows&) = delete;

  // The place of what stands for the front.
  std::size_t choice(std::span<const Expression> front, InputBox box) const {
    const Inputs inputs{pointers_, roots_.size()};
    const auto [least, most] = std::ranges::minmax(roots_);
    box.push_back({least, most});
    std::vector<Expression> weighted;
    for (const Expression& formula : front) {
      weighted.push_back(build::input(pointers_.size() - 1) * formula);
    }
    JointFront joint(inputs, table_.target, table_.movement, box);
    joint.add(weighted, std::nullopt);
    const std::vector<Expression>& kept = joint.formulas();
    const std::size_t chosen = held_out_choice(kept, joint.chosen(), inputs, table_.target,
                                               table_.movement, [] { return true; });
    return static_cast<std::size_t>(std::ranges::find(weighted, kept[chosen]) - weighted.begin());
  }

 private:
  Table table_;
  std::vector<double> roots_;  // of the weights
  std::vector<const double*> pointers_;
};

// The constants fitted to the weighted rows, and with them exponents that a search has found. Such
// a one is the simple number nearest to it where that costs the rows no more than half of their
// number's logarithm, the price of a constant (Schwarz 1978): evidence takes exponents for a part
// of the form, which costs nothing. A form of the user's stays as it is.
class WeightedConstants {
 public:
  WeightedConstants(const Problem& problem, const Inputs& inputs, std::span<const double> weights,
                    const OperatorSet& operators, bool keeps_form)
      : problem_(problem),
        inputs_(inputs),
        weights_(weights),
        operators_(operators),
        keeps_form_(keeps_form) {
    for (const double weight : weights) rows_ += weight > 0 ? 1 : 0;
  }

  void fit(Expression& formula) {
    double squares = fitted(formula);
    if (keeps_form_) return;
    bool changed = false;
    for (const std::size_t place : constant_positions(formula)) {
      const double exponent = formula.node(place).value;
      if (!is_exponent(formula, place) || is_simple_exponent(exponent)) continue;
      std::vector<Node> nodes(formula.nodes().begin(), formula.nodes().end());
      nodes[place].value = nearest_simple_exponent(exponent);
      Expression simple(std::move(nodes));
      const double of_simple = fitted(simple);
      // False for what is not a number.
      if (!(of_simple <= squares * elementary::pow(rows_, 1 / rows_))) continue;
      formula = std::move(simple);
      squares = of_simple;
      changed = true;
    }
    const auto admits = [&](const Expression& one) { return operators_.admits(one); };
    if (changed) formula = simplify(formula, input_box(problem_.inputs), admits);
  }

 private:
  double fitted(Expression& formula) {
    return fitter_
        .fit(formula, inputs_, problem_.stages.front().train.target, weights_,
             {.exponents = FitExponents::not_simple})
        .sum_squares;
  }

  const Problem& problem_;
  Inputs inputs_;
  std::span<const double> weights_;
  const OperatorSet& operators_;
  bool keeps_form_;
  double rows_ = 0;
  ConstantFitter fitter_;
};

// Without those whose value is lost in rounding, unless nothing else is there.
std::vector<Expression> with_their_digits(const std::vector<Expression>& front,
                                          const Inputs& inputs, std::span<const double> target) {
  std::vector<Expression> kept;
  for (const Expression& formula : front) {
    if (!loses_its_digits(formula, inputs, target)) kept.push_back(formula);
  }
  return kept.empty() ? front : kept;
}

// One result of two searches; of one of them where the other found nothing.
CellResult joined(CellResult first, CellResult second) {
  if (!is_ok(first.record)) std::swap(first, second);
  if (!is_ok(second.record)) return first;
  add_costs(first.record, second.record);
  // States have their parameters of one search.
  if (declares_states(first.record.formula)) return first;
  for (FrontRecord& entry : second.front) {
    if (std::ranges::count(first.front, entry.formula, &FrontRecord::formula) > 0) continue;
    first.front.push_back(std::move(entry));
    first.front.back().chosen = false;
  }
  std::ranges::stable_sort(first.front, {}, &FrontRecord::complexity);
  return first;
}

}  // namespace

void choose_by_weights(const Problem& problem, std::span<const double> weights,
                       const CellTask& task, CellResult& result) {
  const Table& table = problem.stages.front().train;
  // A method's formulas have the same states: their columns are those of the chosen one.
  const ProblemFormula own = read_problem_formula(result.record.formula, problem);
  const Problem& judged = own.over(problem);
  std::vector<Expression> front;
  std::size_t chosen = 0;
  const TableInputs inputs(judged.stages.front().train);
  WeightedConstants constants(judged, inputs.inputs(), weights, task.operators,
                              result.keeps_form || task.method.is_external());
  for (const FrontRecord& entry : result.front) {
    if (entry.chosen) chosen = front.size();
    front.push_back(read_problem_formula(entry.formula, problem).formula);
    constants.fit(front.back());
  }
  // What a program of the user's stands for is its own to say.
  if (!task.method.is_external()) {
    front = with_their_digits(front, inputs.inputs(), table.target);
    chosen =
        WeightedRows(judged.stages.front().train, weights).choice(front, input_box(judged.inputs));
  }
  judge_formula(judged, {front.at(chosen), {}}, result.record);
  result.front = judge_front(judged, front, chosen, result.record, weights);
}

std::vector<double> choose_by_relative_noise(const Problem& problem, const CellTask& task,
                                             CellResult& result,
                                             std::span<const Expression> further) {
  const Table& table = problem.stages.front().train;
  const TableInputs inputs(table);
  const auto formula_of = [&](const auto& record) {
    return read_problem_formula(record.formula, problem).formula;
  };
  CellResult weighted = result;
  for (const Expression& formula : further) {
    weighted.front.emplace_back().formula = formula_text(problem, formula);
  }
  std::vector<double> weights;
  for (int round = 0; round < kRoundsOfWeights; ++round) {
    std::vector<Expression> front;
    for (const FrontRecord& entry : weighted.front) front.push_back(formula_of(entry));
    auto next = weights_of_relative_noise(front, inputs.inputs(), table.target);
    if (!next) return {};
    weights = std::move(*next);
    choose_by_weights(problem, weights, task, weighted);
  }
  if (!leaves_only_noise(formula_of(weighted.record), inputs.inputs(), table.target)) return {};
  result = std::move(weighted);
  std::string& note = result.record.note;
  note += fmt::format("{}the noise grows with the target: fitted and chosen by relative errors",
                      note.empty() ? "" : "; ");
  return weights;
}

CellResult fit_weighted(const Problem& problem, std::span<const double> weights,
                        const Regressor& method, const CellTask& task,
                        const WidenedMethod& widened) {
  const Table& all = problem.stages.front().train;
  std::vector<std::size_t> counting;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    if (weights[r] > 0) counting.push_back(r);
  }
  const std::vector<std::size_t> sampled = sampled_rows(weights);
  const auto search = [&](const std::vector<std::size_t>& rows, const CellTask& part) {
    Problem searched = problem;
    searched.stages.front().train = select_rows(all, rows);
    return fit_and_judge(searched, method, part, widened);
  };
  // What a program of the user's stands for is of one search.
  if (sampled == counting || task.method.is_external()) {
    CellResult result = search(sampled, task);
    if (is_ok(result.record)) choose_by_weights(problem, weights, task, result);
    return result;
  }
  CellTask half = task;
  half.limits.seconds /= 2;
  half.limits.evaluations = std::max<std::uint64_t>(half.limits.evaluations / 2, 1);
  CellResult by_weight = search(sampled, half);
  CellResult result = joined(std::move(by_weight), search(counting, half));
  if (is_ok(result.record)) choose_by_weights(problem, weights, task, result);
  return result;
}

}  // namespace tribench
