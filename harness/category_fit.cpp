// SPDX-License-Identifier: MIT
#include "harness/category_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
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
#include "algorithms/states/state_text.hpp"
#include "foundation/error.hpp"
#include "harness/judge.hpp"
#include "harness/metrics.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"
#include "problems/table.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRowsOfCategory = 10;
// Each category's search brings shapes of its own, and each shape is fitted to each category: of
// more categories than this some are asked first, and the best shapes there go on to all.
constexpr std::size_t kAskedFirst = 32;
constexpr std::size_t kGoOn = 64;

std::vector<std::size_t> rows_in(std::span<const double> column, double category) {
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < column.size(); ++r) {
    if (column[r] == category) rows.push_back(r);
  }
  return rows;
}

// frame: the problem without rows.
Problem problem_of(const Problem& frame, const Problem& problem, const CategoryColumn& column,
                   double category) {
  Problem part = frame;
  part.stages[0].train = select_rows(problem.stages[0].train, rows_in(column.train, category));
  part.test = select_rows(problem.test, rows_in(column.test, category));
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
  all.test = select_rows(problem.test, {});
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
  // Of more shapes than one until so many CPU seconds of the process.
  ShapeFits(const std::vector<Problem>& parts, double end_s) : parts_(parts), end_s_(end_s) {
    for (const Problem& part : parts) {
      const double size = root_mean_square(part.stages[0].train.target);
      zero_losses_.push_back(size * size);
    }
  }

  // The shape with the most evidence, first by all rows, then by as many as count; none where none
  // is finite in every category.
  std::optional<Candidate> best_of(const std::vector<Expression>& shapes) {
    if (parts_.size() <= kAskedFirst) return best_among(shapes);
    const std::vector<Expression> ranked = ranked_by_some(shapes);
    std::optional<Candidate> best;
    for (std::size_t begin = 0; !best && begin < ranked.size(); begin += kGoOn) {
      const std::size_t end = std::min(begin + kGoOn, ranked.size());
      best = best_among(std::span(ranked).subspan(begin, end - begin));
    }
    return best;
  }
  bool was_cut_by_clock() const { return was_cut_; }

 private:
  bool out_of_time() {
    was_cut_ = was_cut_ || process_cpu_seconds() > end_s_;
    return was_cut_;
  }

  std::optional<Candidate> best_among(std::span<const Expression> shapes) {
    std::vector<Candidate> candidates;
    for (const Expression& shape : shapes) {
      if (!candidates.empty() && out_of_time()) break;
      Candidate candidate = fit(shape, every(parts_.size()));
      if (!candidate.formulas.empty()) candidates.push_back(std::move(candidate));
    }
    if (candidates.empty()) return std::nullopt;
    const auto with_most_evidence = [&](const std::vector<double>& counts) {
      return *std::ranges::min_element(candidates, {}, [&](const Candidate& each) {
        return against(each, every(parts_.size()), counts);
      });
    };
    return with_most_evidence(rows_that_count(with_most_evidence(row_counts())));
  }

  // By their evidence in some categories; those that are not finite in one of these are left out.
  std::vector<Expression> ranked_by_some(const std::vector<Expression>& shapes) {
    const std::vector<std::size_t> asked = every(kAskedFirst);
    const std::vector<double> counts = row_counts();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      if (!order.empty() && out_of_time()) break;
      const Candidate candidate = fit(shapes[s], asked);
      if (!candidate.formulas.empty()) order.emplace_back(against(candidate, asked, counts), s);
    }
    std::ranges::sort(order);
    std::vector<Expression> ranked;
    for (const auto& [nats, s] : order) ranked.push_back(shapes[s]);
    return ranked;
  }

  // So many categories, evenly over all of them.
  std::vector<std::size_t> every(std::size_t count) const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < count; ++i) places.push_back(i * parts_.size() / count);
    return places;
  }

  std::vector<double> row_counts() const {
    std::vector<double> counts;
    for (std::size_t k = 0; k < parts_.size(); ++k) counts.push_back(static_cast<double>(rows(k)));
    return counts;
  }

  // In these categories. Constants start from those given, and from those of the category before.
  // Without formulas where the shape is not finite in one.
  Candidate fit(const Expression& shape, const std::vector<std::size_t>& categories) {
    Candidate candidate;
    for (const std::size_t k : categories) {
      std::vector<Expression> starts = {shape};
      if (!candidate.formulas.empty()) starts.push_back(candidate.formulas.back());
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
  double against(const Candidate& candidate, const std::vector<std::size_t>& categories,
                 const std::vector<double>& counts) const {
    double nats = kNodePrice * static_cast<double>(candidate.formulas[0].size());
    for (std::size_t i = 0; i < categories.size(); ++i) {
      const std::size_t k = categories[i];
      nats += evidence_against(candidate.formulas[i], candidate.mean_squares[i], zero_losses_[k],
                               static_cast<std::size_t>(std::max(2.0, counts[k])), 0);
    }
    return nats;
  }

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
  double end_s_;
  bool was_cut_ = false;
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

// The values of the column in the training rows, which test rows share.
std::vector<double> distinct(const CategoryColumn& column) {
  const std::set<double> values(column.train.begin(), column.train.end());
  if (values.size() < 2) {
    throw_bad_input("the column of categories has one value alone", column.name,
                    "without it the fit is of one category");
  }
  for (const double value : values) {
    const std::size_t rows = rows_in(column.train, value).size();
    if (rows >= kFewestRowsOfCategory) continue;
    throw_bad_input(fmt::format("category {} has {} training rows", value, rows), column.name,
                    fmt::format("give each at least {}, or leave it out", kFewestRowsOfCategory));
  }
  for (const double value : column.test) {
    if (values.contains(value)) continue;
    throw_bad_input(fmt::format("category {} has test rows and no others", value), column.name,
                    "its constants are unknown: split each category's own rows");
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
    all.fit_cpu_s += result.record.fit_cpu_s;
    all.peak_memory_mib = std::max(all.peak_memory_mib, result.record.peak_memory_mib);
    all.was_ended_by_clock = all.was_ended_by_clock || was_ended_by_clock(result.record);
    if (failure_.kind == FailureKind::none) failure_ = result.record.reason;
    for (const FrontRecord& entry : result.front) {
      if (declares_states(entry.formula)) {
        failure_ = {FailureKind::unsupported,
                    "a formula with a memory has one set of constants; leave out 'category'"};
        continue;
      }
      const Expression shape = read_problem_formula(entry.formula, problem).formula;
      if (seen_.insert(canonicalizer_.hash(shape).shape).second) shapes_.push_back(shape);
    }
    return std::move(result.record);
  }
  const std::vector<Expression>& shapes() const { return shapes_; }
  // Why there may be none.
  FailureReason failure() const {
    if (shapes_.empty() && failure_.kind != FailureKind::none) return failure_;
    return {FailureKind::error, "no formula is finite in all categories"};
  }

 private:
  const Regressor& method_;
  CellTask task_;
  const WidenedMethod& widened_;
  Canonicalizer canonicalizer_;
  std::unordered_set<std::uint64_t> seen_;  // never iterated
  std::vector<Expression> shapes_;
  FailureReason failure_;
};

// "p1()*v; joint=1: p1()=14.2; joint=2: p1()=0.3".
std::string text_with_constants(const CategoryFit& fit, const std::string& column) {
  std::string text = fit.shape;
  for (const CategoryResult& each : fit.categories) {
    text += fmt::format("; {}={}:", column, each.category);
    for (std::size_t k = 0; k < each.constants.size(); ++k) {
      text += fmt::format("{} p{}()={}", k == 0 ? "" : ",", k + 1, each.constants[k]);
    }
  }
  return text;
}

// Each row by its category's formula.
std::vector<double> values_of(const CategoryFit& fit, const Problem& problem, const Table& table,
                              const std::vector<double>& column) {
  std::vector<double> values(table.rows());
  TableEvaluator evaluator;
  for (const CategoryResult& each : fit.categories) {
    const Expression formula = read_problem_formula(each.record.formula, problem).formula;
    const std::vector<std::size_t> rows = rows_in(column, each.category);
    if (rows.empty()) continue;
    const Table own = select_rows(table, rows);
    const std::span<const double> its = evaluator.evaluate(formula, own);
    for (std::size_t i = 0; i < rows.size(); ++i) values[rows[i]] = its[i];
  }
  return values;
}

// Refuted where any is, else undecided where any is; none where one was not asked.
template <typename Judgement>
std::optional<Judgement> worst(const CategoryFit& fit,
                               std::optional<Judgement> Record::*judgement) {
  std::optional<Judgement> all = fit.categories.front().record.*judgement;
  for (const CategoryResult& each : fit.categories) {
    const std::optional<Judgement> one = each.record.*judgement;
    if (!one) return std::nullopt;
    if (*one == Judgement::refuted ||
        (*all != Judgement::refuted && *one == Judgement::undecided)) {
      all = one;
    }
  }
  return all;
}

void judge_errors(const CategoryFit& fit, const Problem& problem, const CategoryColumn& column,
                  Record& record) {
  judge_predictions(problem, values_of(fit, problem, problem.stages[0].train, column.train),
                    values_of(fit, problem, problem.test, column.test), record);
}

void judge_shape(const CategoryFit& fit, const CategoryColumn& column, Record& record) {
  record.complexity = fit.complexity;
  record.nodes = fit.categories.front().record.nodes;
  record.singularity = worst(fit, &Record::singularity);
  record.dissipative = worst(fit, &Record::dissipative);
  record.monotone = worst(fit, &Record::monotone);
  record.odd = worst(fit, &Record::odd);
  for (const CategoryResult& each : fit.categories) {
    // The slowest: all are of one shape.
    if (!(each.record.eval_ns_per_row <= record.eval_ns_per_row)) {
      record.eval_ns_per_row = each.record.eval_ns_per_row;
    }
    if (each.record.singularity != Singularity::refuted || record.grid_check) continue;
    record.witness = each.record.witness;
    record.grid_check = each.record.grid_check;
    record.note = fmt::format("witness: {}={}", column.name, each.category);
  }
  record.formula = text_with_constants(fit, column.name);
}

}  // namespace

CategoryColumn take_last_input(Problem& problem) {
  Stage& stage = problem.stages.front();
  CategoryColumn column = {problem.inputs.back().name, std::move(stage.train.columns.back()),
                           std::move(problem.test.columns.back())};
  problem.inputs.pop_back();
  stage.inputs.pop_back();
  stage.train.columns.pop_back();
  problem.test.columns.pop_back();
  return column;
}

bool has_categories(std::string_view formula) {
  return formula.find("; ") != std::string_view::npos &&
         formula.find(": p1()=") != std::string_view::npos;
}

CategoryFit fit_by_category(const Problem& problem, const CategoryColumn& column,
                            const Regressor& method, const CellTask& task,
                            const WidenedMethod& widened) {
  const std::vector<double> categories = distinct(column);
  CategoryFit result;
  Searches searches(method, task, widened, categories.size() + 1);
  searches.search(pooled(problem, column, categories), result);
  Problem frame = problem;
  frame.stages[0].train = frame.test = {};
  std::vector<Problem> parts;
  for (const double category : categories) {
    parts.push_back(problem_of(frame, problem, column, category));
    result.categories.push_back({category, {}, empty_record(task.cell), {}});
    Record& own = result.categories.back().own;
    // A share of a millisecond is no search: even its judgement takes longer.
    if (result.fit_cpu_s < task.limits.seconds) {
      own = searches.search(parts.back(), result);
    } else {
      own = empty_record(task.cell);
      mark_failed(own, FailureKind::error, "the seconds were spent on the categories before it");
      result.was_ended_by_clock = true;
    }
  }
  const double cpu_start = process_cpu_seconds();
  // What the searches have left, and a tenth at the least: they end a little late themselves.
  const double seconds = task.limits.seconds;
  ShapeFits fits(parts, cpu_start + std::max(0.1 * seconds, seconds - result.fit_cpu_s));
  const std::optional<Candidate> best = fits.best_of(searches.shapes());
  result.was_ended_by_clock = result.was_ended_by_clock || fits.was_cut_by_clock();
  result.fit_cpu_s += process_cpu_seconds() - cpu_start;
  if (!best) {
    result.failure = searches.failure();
    return result;
  }
  result.shape = shape_text(best->formulas[0], problem);
  result.complexity = paper_complexity(best->formulas[0]);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const std::size_t place : places_of_own(best->formulas[k])) {
      result.categories[k].constants.push_back(best->formulas[k].node(place).value);
    }
    judge_formula(parts[k], {best->formulas[k], {}}, result.categories[k].record);
  }
  return result;
}

CellResult fit_and_judge_by_category(const Problem& problem, const CategoryColumn& column,
                                     const Regressor& method, const CellTask& task,
                                     const WidenedMethod& widened) {
  CellResult result;
  Record& record = result.record;
  record = empty_record(task.cell);
  record.dataset = problem.dataset;
  const auto start = std::chrono::steady_clock::now();
  CategoryFit fit;
  try {
    fit = fit_by_category(problem, column, method, task, widened);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::environment) throw;
    fit.failure = {FailureKind::error, error.what()};
  }
  record.fit_cpu_s = fit.fit_cpu_s;
  record.fit_wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.peak_memory_mib = std::max(fit.peak_memory_mib, peak_memory_mib());
  record.evaluations = fit.evaluations;
  note_overspending(record, task.limits.seconds, task.limits.evaluations);
  if (fit.failure.kind != FailureKind::none) {
    mark_failed(record, fit.failure.kind, std::move(fit.failure.detail));
    return result;
  }
  judge_shape(fit, column, record);
  judge_errors(fit, problem, column, record);
  result.front = {{record.cell, record.complexity, record.nodes, record.mae_train, record.mae_test,
                   record.singularity, true, record.formula, kMissing}};
  if (fit.was_ended_by_clock) note_end_by_clock(record);
  return result;
}

}  // namespace tribench
