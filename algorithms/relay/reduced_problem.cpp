// SPDX-License-Identifier: MIT
#include "algorithms/relay/reduced_problem.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench::relay {
namespace {

constexpr double kSmoother = 0.7;  // than the problem before, for each input less
constexpr double kSmooth = 1e-5;   // enough, however smooth that was

bool is_one(const Expression& formula) {
  return formula.size() == 1 && formula.node(0).is_constant() && formula.node(0).value == 1;
}

// To rounding, row by row.
bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kSame = 1e-9;
  for (std::size_t r = 0; r < a.size(); ++r) {
    if (std::isnan(a[r]) && std::isnan(b[r])) continue;
    if (!(std::abs(a[r] - b[r]) <= kSame * std::abs(a[r]))) return false;
  }
  return true;
}

Input input_over(const std::vector<double>& values, std::size_t place) {
  Input input;
  input.name = fmt::format("u{}", place);
  bool is_first = true;
  for (const double x : values) {
    if (!std::isfinite(x)) continue;
    input.low = is_first ? x : std::min(input.low, x);
    input.high = is_first ? x : std::max(input.high, x);
    is_first = false;
  }
  return input;
}

}  // namespace

ReducedProblem::ReducedProblem(std::span<const Input> inputs, const FiniteRows& rows)
    : inputs_(inputs.begin(), inputs.end()), columns_(rows.columns), target_(rows.target) {
  for (const auto& column : columns_) pointers_.push_back(column.data());
}

ReducedProblem::ReducedProblem(const ReducedProblem& parent, Reduction reduction)
    : steps_(parent.steps_) {
  most_roughness_ = parent.roughness_;
  for (std::size_t k = reduction.inputs.size(); k < parent.inputs_.size(); ++k) {
    most_roughness_ *= kSmoother;
  }
  most_roughness_ = std::max(most_roughness_, kSmooth);
  const std::size_t rows = parent.target_.size();
  const Inputs table{parent.pointers_, rows};
  Evaluator evaluator;
  for (const Expression& formula : reduction.inputs) {
    columns_.emplace_back(rows);
    evaluator.evaluate(formula, table, columns_.back());
    inputs_.push_back(input_over(columns_.back(), inputs_.size()));
  }
  for (const auto& column : columns_) pointers_.push_back(column.data());
  std::vector<double> outer(rows);
  evaluator.evaluate(reduction.outer, table, outer);
  target_ = formed_target(parent.target_, reduction.form);
  for (std::size_t r = 0; r < rows; ++r) {
    target_[r] = reduction.is_sum ? target_[r] - outer[r] : target_[r] / outer[r];
    const bool is_row =
        std::ranges::all_of(columns_, [r](const auto& column) { return std::isfinite(column[r]); });
    if (!is_row) target_[r] = std::numeric_limits<double>::quiet_NaN();
  }
  const auto first = std::ranges::find_if(parent.target_, [](double y) { return y != 0; });
  const bool is_negative = first != parent.target_.end() && *first < 0;
  steps_.push_back({std::move(reduction), is_negative ? -1.0 : 1.0});
}

bool ReducedProblem::is_same_as(const ReducedProblem& other) const {
  if (inputs() != other.inputs() || !are_same(target_, other.target_)) return false;
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    if (!are_same(columns_[j], other.columns_[j])) return false;
  }
  return true;
}

Expression ReducedProblem::restored(Expression found) const {
  using namespace build;
  for (std::size_t k = steps_.size(); k-- > 0;) {
    const auto& [reduction, sign] = steps_[k];
    found = substituted(found, reduction.inputs);
    if (reduction.is_sum) {
      found = reduction.outer + found;
    } else if (!is_one(reduction.outer)) {
      found = reduction.outer * found;
    }
    found = solved_for_target(reduction.form, found, sign);
  }
  return found;
}

}  // namespace tribench::relay
