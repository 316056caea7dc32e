// SPDX-License-Identifier: MIT
#include "algorithms/parfam/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/parfam/elimination.hpp"
#include "algorithms/parfam/subset.hpp"
#include "foundation/elementary.hpp"
#include "foundation/parallel_for.hpp"

namespace tribench::parfam {
namespace {

// More candidates than this make best subsets slow and their choice arbitrary.
constexpr double kMostMonomials = 130;
constexpr std::size_t kMostTerms = 16;
// A family with more inner parameters is no longer searched well by a few starts.
constexpr std::size_t kMostInner = 40;

// The usable rows with inputs divided by their largest magnitude.
struct ScaledRows {
  std::vector<double> scales;
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;
  std::vector<int> caps;  // highest exponent that is worth a monomial

  std::size_t rows() const { return target.size(); }
};

ScaledRows scale_rows(const FiniteRows& data, std::span<const Input> inputs) {
  ScaledRows scaled;
  scaled.target = data.target;
  for (std::size_t j = 0; j < data.columns.size(); ++j) {
    const std::vector<double>& column = data.columns[j];
    double largest = 0;
    bool three_valued = true;
    for (double value : column) {
      largest = std::max(largest, std::abs(value));
      three_valued = three_valued && (value == 0 || std::abs(value) == 1);
    }
    scaled.scales.push_back(largest > 0 ? largest : 1);
    scaled.columns.push_back(column);
    for (double& value : scaled.columns.back()) value /= scaled.scales.back();
    // The square of a sign is 1, or a second indicator of standstill: not worth a monomial.
    const int most = three_valued ? 1 : kMaximalPotence + 2;
    scaled.caps.push_back(inputs[j].max_degree > 0 ? std::min(most, inputs[j].max_degree) : most);
  }
  for (const auto& column : scaled.columns) scaled.pointers.push_back(column.data());
  return scaled;
}

// Every k-th row, so that all movements are there.
ScaledRows sample_rows(const ScaledRows& all, std::size_t most) {
  if (all.rows() <= most) {
    ScaledRows copy = all;
    copy.pointers.clear();
    for (const auto& column : copy.columns) copy.pointers.push_back(column.data());
    return copy;
  }
  ScaledRows sample;
  sample.scales = all.scales;
  sample.caps = all.caps;
  for (const auto& column : all.columns) {
    sample.columns.emplace_back();
    for (std::size_t i = 0; i < most; ++i) {
      sample.columns.back().push_back(column[i * all.rows() / most]);
    }
  }
  for (std::size_t i = 0; i < most; ++i) {
    sample.target.push_back(all.target[i * all.rows() / most]);
  }
  for (const auto& column : sample.columns) sample.pointers.push_back(column.data());
  return sample;
}

class Search {
 public:
  Search(FitContext& context, const SearchOptions& options)
      : context_(context),
        options_(options),
        data_(context.data),
        all_(scale_rows(data_, context.data.inputs)),
        sample_(sample_rows(all_, options.sample_rows)),
        front_(data_, context,
               options.inner.denominators == Denominators::constrained ||
                   context.operators.proved_free_only()) {
    if (options.inner.denominators != Denominators::constrained) return;
    const auto guard_of = [&](const ScaledRows& rows) {
      return PoleGuard(context.data.inputs, rows.scales, rows.pointers, rows.rows(),
                       context.operators);
    };
    guard_.emplace(guard_of(all_));
    sample_guard_.emplace(guard_of(sample_));
  }

  FitResult run();

 private:
  void add_polynomials();
  std::vector<Family> families() const;
  std::vector<Structure> structures() const;
  void add_families();
  void add_path(const TrainedModel& model);

  FitContext& context_;
  const SearchOptions& options_;
  FiniteRows data_;
  ScaledRows all_;
  ScaledRows sample_;
  Front front_;
  std::optional<PoleGuard> guard_;  // of constrained denominators, on all rows
  std::optional<PoleGuard> sample_guard_;
};

void Search::add_polynomials() {
  std::vector<Monomial> monomials;
  for (int degree = 1; degree <= options_.polynomial_degree; ++degree) {
    if (monomial_count(degree, all_.caps) > kMostMonomials) break;
    monomials = monomials_up_to(degree, all_.caps);
  }
  if (monomials.empty()) return;
  const std::size_t m = monomials.size();
  if (!context_.budget.spend(m * m / 8 * all_.rows())) return;
  MonomialColumns columns(all_.pointers, all_.rows());
  std::vector<const double*> pointers;
  for (const Monomial& monomial : monomials) pointers.push_back(columns.column(monomial));
  pointers.push_back(all_.target.data());
  std::vector<double> gram((m + 1) * (m + 1));
  columns::gram(pointers.data(), m + 1, all_.rows(), gram.data());
  for (const Subset& subset : best_subsets(gram, m, kMostTerms)) {
    Structure structure;
    structure.inputs = data_.columns.size();
    for (std::size_t k : subset.chosen) structure.out_numerator.push_back(monomials[k]);
    Projection projection(structure, all_.pointers, all_.target, options_.inner.denominators,
                          context_.budget);
    TrainedModel model{structure, {}, {}, projection.sum_squares({})};
    if (!std::isfinite(model.sum_squares)) return;
    model.coefficients.assign(projection.coefficients().begin(), projection.coefficients().end());
    front_.offer(formula_of(model, all_.scales, options_.inner.denominators, context_.operators));
  }
}

// Base functions in the order of what they cost to compute and to read.
std::vector<Family> Search::families() const {
  if (options_.family) return {*options_.family};
  GridLimits limits;
  limits.base_functions.clear();
  for (Op op : {Op::exp, Op::sqrt, Op::tanh, Op::cos, Op::sin, Op::log}) {
    if (context_.operators.allows(op)) limits.base_functions.push_back(op);
  }
  const bool divides = context_.operators.allows(Op::div);
  limits.degree_in_denominator = divides ? 1 : 0;
  limits.degree_out_denominator = divides ? 1 : 0;
  limits.functions = limits.base_functions.empty() ? 0 : options_.functions;
  limits.both_enforce = true;
  std::vector<Family> grid = published_grid(limits);
  grid.erase(grid.begin());  // the polynomial: best subsets have it
  return grid;
}

std::vector<Structure> Search::structures() const {
  std::vector<int> caps = all_.caps;
  for (int& cap : caps) cap = std::min(cap, kMaximalPotence);
  std::vector<Structure> result;
  const bool one_plus_q = options_.inner.denominators != Denominators::safe;
  for (const Family& family : families()) {
    // Two for each function and one more are dropped below.
    const auto dropped = static_cast<double>(2 * family.functions.size() + 1);
    const double count = parameter_count(family, caps) - dropped;
    if (2 * count > static_cast<double>(sample_.rows())) continue;
    Structure structure = make_structure(family, caps);
    for (std::size_t i = 0; i < structure.functions.size(); ++i) {
      // exp's constant is a factor of its coefficient; a ratio has its scale in the numerator.
      if (structure.functions[i] == Op::exp && structure.denominators[i].empty()) {
        structure.numerators[i].erase(structure.numerators[i].begin());
      }
      if (one_plus_q && !structure.denominators[i].empty()) {
        structure.denominators[i].erase(structure.denominators[i].begin());
      }
    }
    if (one_plus_q && !structure.out_denominator.empty()) {
      structure.out_denominator.erase(structure.out_denominator.begin());
    }
    if (structure.inner_parameters() + structure.out_denominator.size() > kMostInner) continue;
    if (structure.parameters() * 2 > sample_.rows()) continue;
    result.push_back(std::move(structure));
  }
  return result;
}

// What a family promises: its fit on the sample against its number of parameters.
double promise(const TrainedModel& model, std::size_t rows, double floor) {
  const auto n = static_cast<double>(rows);
  const auto p = static_cast<double>(model.coefficients.size() + model.inner.size());
  return n * elementary::log(std::max(model.sum_squares, floor) / n) + p * elementary::log(n);
}

void Search::add_families() {
  const std::vector<Structure> grid = structures();
  if (grid.empty()) return;
  std::vector<std::optional<TrainedModel>> found(grid.size());
  std::vector<Budget> shares;
  const std::uint64_t share = context_.budget.remaining() / 2 / grid.size();
  for (std::size_t i = 0; i < grid.size(); ++i) shares.push_back(context_.budget.share(share));
  const RandomStream random = context_.random.split("families");
  InnerSearchOptions inner = options_.inner;
  inner.guard = sample_guard_ ? &*sample_guard_ : nullptr;
  parallel_for(grid.size(), context_.threads, [&](std::size_t i) {
    found[i] =
        search_family(grid[i], sample_.pointers, sample_.target, inner, shares[i], random.split(i));
  });
  for (const Budget& part : shares) context_.budget.settle(part);
  double squares = 0;
  for (double y : sample_.target) squares += y * y;
  const double floor = 1e-24 * squares;
  std::vector<const TrainedModel*> ranked;
  for (const auto& model : found) {
    if (model) ranked.push_back(&*model);
  }
  std::ranges::stable_sort(ranked, {}, [&](const TrainedModel* model) {
    return promise(*model, sample_.rows(), floor);
  });
  for (std::size_t i = 0; i < std::min(options_.refined, ranked.size()); ++i) add_path(*ranked[i]);
}

void Search::add_path(const TrainedModel& model) {
  const Denominators denominators = options_.inner.denominators;
  for (TrainedModel& step : eliminate(model, all_.pointers, all_.target, denominators,
                                      guard_ ? &*guard_ : nullptr, context_.budget)) {
    if (guard_ && !guard_->make_proved(step, all_.target, context_.budget)) continue;
    front_.offer(formula_of(step, all_.scales, options_.inner.denominators, context_.operators));
  }
}

FitResult Search::run() {
  if (data_.rows() == 0) return FitResult::unsupported("there is no row without missing values");
  if (!context_.operators.allows(Op::add) || !context_.operators.allows(Op::mul)) {
    return FitResult::unsupported("ParFam needs + and *");
  }
  if (options_.family && !is_within(*options_.family, context_.operators)) {
    return FitResult::unsupported("the operators do not have what the family needs");
  }
  front_.offer(build::constant(0));
  add_polynomials();
  add_families();
  return front_.result(options_.choice);
}

}  // namespace

FitResult search(FitContext& context, const SearchOptions& options) {
  return Search(context, options).run();
}

}  // namespace tribench::parfam
