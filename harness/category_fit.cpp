// SPDX-License-Identifier: MIT
#include "harness/category_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <unordered_set>

#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/edit.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "foundation/error.hpp"
#include "harness/judge.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRows = 10;

std::vector<std::size_t> rows_in(std::span<const double> column, double category) {
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < column.size(); ++r) {
    if (column[r] == category) rows.push_back(r);
  }
  return rows;
}

template <typename T>
std::vector<T> at_rows(const std::vector<T>& values, const std::vector<std::size_t>& rows) {
  std::vector<T> taken;
  if (values.empty()) return taken;
  for (const std::size_t r : rows) taken.push_back(values[r]);
  return taken;
}

Table rows_of(const Table& table, const std::vector<std::size_t>& rows) {
  Table taken;
  for (const auto& column : table.columns) taken.columns.push_back(at_rows(column, rows));
  taken.target = at_rows(table.target, rows);
  taken.movement = at_rows(table.movement, rows);
  taken.truth = at_rows(table.truth, rows);
  return taken;
}

Problem problem_of(const Problem& problem, const CategoryColumn& column, double category) {
  Problem part = problem;
  part.stages[0].train = rows_of(problem.stages[0].train, rows_in(column.train, category));
  part.test = rows_of(problem.test, rows_in(column.test, category));
  return part;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double y : values) sum += y * y / static_cast<double>(values.size());
  return sum > 0 ? std::sqrt(sum) : 1;
}

// Of equal size in every category: one category's scale is a constant like any other.
Problem pooled(const Problem& problem, const CategoryColumn& column,
               const std::vector<double>& categories) {
  Problem all = problem;
  std::vector<double>& target = all.stages[0].train.target;
  for (const double category : categories) {
    const std::vector<std::size_t> rows = rows_in(column.train, category);
    const double size = root_mean_square(at_rows(target, rows));
    for (const std::size_t r : rows) target[r] /= size;
  }
  all.test = rows_of(problem.test, {});
  return all;
}

// A shape with its constants in each category.
struct Candidate {
  std::vector<Expression> formulas;
  std::vector<double> mean_squares;
};

// Fits the constants of shapes to each category.
class ShapeFits {
 public:
  ShapeFits(const std::vector<Problem>& parts) : parts_(parts) {
    for (const Problem& part : parts) {
      const double size = root_mean_square(part.stages[0].train.target);
      zero_losses_.push_back(size * size);
    }
  }

  // Constants start from those given, and from those of the category before. Without formulas where
  // the shape is not finite in one.
  Candidate fit(const Expression& shape) {
    Candidate candidate;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      std::vector<Expression> starts = {shape};
      if (k > 0) starts.push_back(candidate.formulas.back());
      double least = HUGE_VAL;
      Expression best = shape;
      for (Expression& start : starts) {
        const double mean_square = fit_to(start, k);
        if (!(mean_square < least)) continue;
        least = mean_square;
        best = std::move(start);
      }
      if (std::isinf(least)) return {};
      candidate.formulas.push_back(std::move(best));
      candidate.mean_squares.push_back(least);
    }
    return candidate;
  }

  // Errors of neighbouring rows are alike: by their correlation r, (1 - r) / (1 + r) of the rows
  // count (of an autoregressive process, Bartlett 1935).
  std::vector<double> rows_that_count(const Candidate& candidate) {
    std::vector<double> counts;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Table& table = parts_[k].stages[0].train;
      std::vector<double> left(table.rows());
      evaluator_.evaluate(candidate.formulas[k], TableInputs(table).inputs(), left);
      double own = 0;
      double shared = 0;
      for (std::size_t r = 0; r < left.size(); ++r) {
        left[r] -= table.target[r];
        own += left[r] * left[r];
        if (r > 0 && table.movement[r] == table.movement[r - 1]) shared += left[r] * left[r - 1];
      }
      const double alike = own > 0 ? std::clamp(shared / own, 0.0, 0.99) : 0.0;
      counts.push_back(static_cast<double>(left.size()) * (1 - alike) / (1 + alike));
    }
    return counts;
  }

  // Nodes are paid for once, numbers in each category.
  double against(const Candidate& candidate, const std::vector<double>& counts) const {
    double nats = kNodePrice * static_cast<double>(candidate.formulas[0].size());
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      nats += evidence_against(candidate.formulas[k], candidate.mean_squares[k], zero_losses_[k],
                               static_cast<std::size_t>(std::max(2.0, counts[k])), 0);
    }
    return nats;
  }

 private:
  std::size_t rows(std::size_t k) const { return parts_[k].stages[0].train.rows(); }

  double fit_to(Expression& formula, std::size_t k) {
    const Table& table = parts_[k].stages[0].train;
    const TableInputs inputs(table);
    fitter_.fit(formula, inputs.inputs(), table.target);
    const ErrorSum sum = evaluator_.sum_squared_errors(formula, inputs.inputs(), table.target);
    if (sum.status != ErrorSumStatus::complete) return HUGE_VAL;
    return sum.sum / static_cast<double>(rows(k));
  }

  const std::vector<Problem>& parts_;
  std::vector<double> zero_losses_;
  ConstantFitter fitter_;
  Evaluator evaluator_;
};

std::vector<std::size_t> places_of_own(const Expression& shape) {
  std::vector<std::size_t> places;
  for (const std::size_t place : constant_positions(shape)) {
    if (!is_exponent(shape, place)) places.push_back(place);
  }
  return places;
}

std::string shape_text(const Expression& shape, const Problem& problem) {
  std::vector<std::string> names = problem.input_names();
  std::string own = "p_own";
  while (std::ranges::count(names, own) > 0) own += '_';
  Expression written = shape;
  for (const std::size_t place : places_of_own(shape)) {
    written.set_leaf(place, Node::input(names.size()));
  }
  names.push_back(own);
  std::string text = print(written, names);
  int number = 0;
  for (std::size_t at = text.find(own); at != std::string::npos; at = text.find(own, at)) {
    text.replace(at, own.size(), fmt::format("p{}()", ++number));
  }
  return text;
}

std::vector<double> distinct(const CategoryColumn& column) {
  const std::set<double> values(column.train.begin(), column.train.end());
  if (values.size() < 2) {
    throw_bad_input("the column of categories has one value alone", "--category",
                    "without it the fit is of one category");
  }
  for (const double value : values) {
    const std::size_t rows = rows_in(column.train, value).size();
    if (rows >= kFewestRows) continue;
    throw_bad_input(fmt::format("category {} has {} training rows", value, rows), "--category",
                    fmt::format("give each at least {}, or leave it out", kFewestRows));
  }
  return {values.begin(), values.end()};
}

// The searches, and the shapes that they found.
class Searches {
 public:
  Searches(const Regressor& method, const CellTask& task, const WidenedMethod& widened,
           std::size_t count)
      : method_(method), task_(task), widened_(widened) {
    task_.limits.evaluations /= count;
    task_.limits.seconds /= static_cast<double>(count);
  }

  Record search(const Problem& problem, CategoryFit& all) {
    CellResult result = fit_and_judge(problem, method_, task_, widened_);
    all.evaluations += result.record.evaluations;
    all.was_ended_by_clock = all.was_ended_by_clock || was_ended_by_clock(result.record);
    for (const FrontRecord& entry : result.front) {
      const Expression shape = read_problem_formula(entry.formula, problem).formula;
      if (seen_.insert(canonicalizer_.hash(shape).shape).second) shapes_.push_back(shape);
    }
    return std::move(result.record);
  }
  const std::vector<Expression>& shapes() const { return shapes_; }

 private:
  const Regressor& method_;
  CellTask task_;
  const WidenedMethod& widened_;
  Canonicalizer canonicalizer_;
  std::unordered_set<std::uint64_t> seen_;  // never iterated
  std::vector<Expression> shapes_;
};

}  // namespace

CategoryFit fit_by_category(const Problem& problem, const CategoryColumn& column,
                            const Regressor& method, const CellTask& task,
                            const WidenedMethod& widened) {
  const std::vector<double> categories = distinct(column);
  const double cpu_start = process_cpu_seconds();
  CategoryFit result;
  Searches searches(method, task, widened, categories.size() + 1);
  searches.search(pooled(problem, column, categories), result);
  std::vector<Problem> parts;
  for (const double category : categories) {
    parts.push_back(problem_of(problem, column, category));
    result.categories.push_back({category, {}, empty_record(task.cell), {}});
    result.categories.back().own = searches.search(parts.back(), result);
  }
  ShapeFits fits(parts);
  std::vector<Candidate> candidates;
  for (const Expression& shape : searches.shapes()) {
    Candidate candidate = fits.fit(shape);
    if (!candidate.formulas.empty()) candidates.push_back(std::move(candidate));
  }
  if (candidates.empty()) {
    throw Error(ErrorKind::failed, "no formula is finite in all categories", task.cell.method, "");
  }
  const auto with_most_evidence = [&](const std::vector<double>& counts) {
    return *std::ranges::min_element(
        candidates, {}, [&](const Candidate& each) { return fits.against(each, counts); });
  };
  std::vector<double> counts;
  for (const Problem& part : parts) {
    counts.push_back(static_cast<double>(part.stages[0].train.rows()));
  }
  const Candidate best = with_most_evidence(fits.rows_that_count(with_most_evidence(counts)));
  result.shape = shape_text(best.formulas[0], problem);
  result.complexity = paper_complexity(best.formulas[0]);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const std::size_t place : places_of_own(best.formulas[k])) {
      result.categories[k].constants.push_back(best.formulas[k].node(place).value);
    }
    judge_formula(parts[k], {best.formulas[k], {}}, result.categories[k].record);
  }
  result.fit_cpu_s = process_cpu_seconds() - cpu_start;
  return result;
}

}  // namespace tribench
