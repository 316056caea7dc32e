// SPDX-License-Identifier: MIT
#include "algorithms/relay/function_sum.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/backward_elimination.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/relay/golden_section.hpp"
#include "algorithms/relay/monomial.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "algorithms/relay/unit_function.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kMostSizedInputs = 6;
constexpr std::size_t kFewestSumRows = 60;
constexpr std::size_t kRowsOfAColumn = 2;   // that are screened, and kFewestSumRows
constexpr std::size_t kRefinedTrials = 40;  // of a stage
constexpr std::size_t kFittedTrials = 4;    // of these
constexpr int kTrialNarrowings = 24;        // of the scale, from a step of the grid to 1e-5 of it
constexpr double kPromisingTrial = 1e-4;    // of the target's square
constexpr std::size_t kLikelySums = 8;      // of a stage, under noise
constexpr std::size_t kRowsOfAColumnUnderNoise = 4;
constexpr double kNearby = 1.1;   // of the scale, once terms are left out
constexpr double kRidge = 1e-11;  // of columns of unit length
// Of |a u| at its largest: what f makes of it is neither a straight line nor a step.
constexpr std::array kReaches = {0.6, 1.5, 4.0, 10.0, 25.0};
constexpr double kHalfReachStep = 1.65;  // the root of one over the one before, at most
// That stand in laws as they are, where u is of two inputs or more.
constexpr std::array kPlainScales = {1.0, 0.5, 2.0};
using Kind = UnitFunction::Kind;
// Not log(1 + .): a fit makes products' logarithms of it, which others find in a shorter form.
constexpr std::array kSummedFunctions = {
    UnitFunction{Kind::exponential}, UnitFunction{Kind::power, -1},   UnitFunction{Kind::tanh},
    UnitFunction{Kind::power, 0.5},  UnitFunction{Kind::power, -0.5}, UnitFunction{Kind::sine},
    UnitFunction{Kind::atan},        UnitFunction{Kind::cosh},        UnitFunction{Kind::sinh}};

const std::vector<std::vector<std::vector<double>>>& argument_powers() {
  static const std::vector<std::vector<std::vector<double>>> of_inputs = {
      {{1}, {2}, {-1}, {-2}, {0.5}, {-0.5}},
      {{1, -1},
       {-1, 1},
       {1, 1},
       {2, -2},
       {-2, 2},
       {2, 2},
       {-1, -1},
       {2, -1},
       {-1, 2},
       {1, -2},
       {-2, 1},
       {1, 2},
       {2, 1},
       {0.5, -0.5},
       {-0.5, 0.5},
       {0.5, 0.5}},
      {{1, -1, -1},
       {-1, 1, -1},
       {-1, -1, 1},
       {1, 1, -1},
       {1, -1, 1},
       {-1, 1, 1},
       {1, 1, 1},
       {1, 2, -1},
       {1, -1, 2},
       {2, 1, -1},
       {-1, 1, 2},
       {2, -1, 1},
       {-1, 2, 1}}};
  return of_inputs;
}

void append(std::vector<Monomial>& list, std::vector<Monomial> more) {
  list.insert(list.end(), more.begin(), more.end());
}

std::vector<Monomial> inputs_and_one(const LogRows& rows) {
  std::vector<Monomial> terms = {{}};
  append(terms, monomials({{1}}, rows));
  return terms;
}

struct SumOfTerms {
  std::vector<Monomial> plain;  // b's
  std::vector<Monomial> sizes;  // c's
};

SumOfTerms terms_of(SumTerms width, const LogRows& rows) {
  SumOfTerms terms{inputs_and_one(rows), inputs_and_one(rows)};
  append(terms.plain, monomials({{1, 1}, {2}}, rows));
  if (width == SumTerms::few) return terms;
  append(terms.plain, monomials({{1, -1}, {-1, 1}}, rows));
  append(terms.sizes, monomials({{1, 1}, {1, -1}, {-1, 1}}, rows));
  return terms;
}

// What c is of: a wave's sine and cosine have sizes of their own.
std::vector<UnitFunction> parts_of(const UnitFunction& function) {
  if (function.kind != Kind::sine) return {function};
  return {function, UnitFunction{Kind::cosine}};
}

struct SumTrial {
  std::size_t argument;
  UnitFunction function;
  double scale;
  double left;  // of the target's square
};

void keep_best(std::vector<SumTrial>& trials, std::size_t most) {
  std::ranges::stable_sort(trials, {}, &SumTrial::left);
  trials.resize(std::min(most, trials.size()));
}

// The regressions on some of the rows for given terms.
class SumScreen {
 public:
  SumScreen(const LogRows& rows, const SumOfTerms& terms, std::size_t rows_of_a_column)
      : rows_(rows) {
    const std::size_t wanted = rows_of_a_column * (terms.plain.size() + terms.sizes.size());
    const std::size_t count = std::min(std::max(kFewestSumRows, wanted), rows.rows());
    for (std::size_t i = 0; i < count; ++i) screened_.push_back(i * rows.rows() / count);
    sizes_ = unit_columns(terms.sizes);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(unit_columns(terms.plain));
    plain_ = qr.householderQ() * Eigen::MatrixXd::Identity(qr.rows(), qr.rank());
    target_ = screened(rows.target().values);
    square_ = target_.squaredNorm();
    f_.resize(target_.size());
    target_ -= plain_ * (plain_.transpose() * target_);
  }

  Eigen::VectorXd screened(const std::vector<double>& values) const {
    Eigen::VectorXd some(static_cast<Eigen::Index>(screened_.size()));
    for (Eigen::Index i = 0; i < some.size(); ++i) {
      some[i] = values[screened_[static_cast<std::size_t>(i)]];
    }
    return some;
  }

  bool has_rows_to_spare() const { return plain_.cols() + 2 * sizes_.cols() < target_.size(); }

  std::uint64_t node_rows() const {
    return static_cast<std::uint64_t>(plain_.rows() * plain_.cols() * sizes_.cols()) / 2;
  }

  // What is left of the target's square beside the best b and c; u on the screened rows.
  double left_of(const Eigen::VectorXd& u, const UnitFunction& function, double scale) {
    const std::vector<UnitFunction> parts = parts_of(function);
    const Eigen::Index terms = sizes_.cols();
    columns_.resize(u.size(), terms * static_cast<Eigen::Index>(parts.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for (Eigen::Index i = 0; i < u.size(); ++i) f_[i] = parts[k].value(scale * u[i]);
      const double largest = f_.cwiseAbs().maxCoeff();
      if (!f_.allFinite() || !(largest > 0)) return HUGE_VAL;
      columns_.middleCols(static_cast<Eigen::Index>(k) * terms, terms).noalias() =
          (f_ / largest).asDiagonal() * sizes_;
    }
    along_.noalias() = plain_.transpose() * columns_;
    columns_.noalias() -= plain_ * along_;
    gram_.noalias() = columns_.transpose() * columns_;
    gram_.diagonal().array() += kRidge;
    const Eigen::LLT<Eigen::MatrixXd> llt(gram_);
    if (llt.info() != Eigen::Success) return HUGE_VAL;
    const Eigen::VectorXd c = llt.solve(columns_.transpose() * target_);
    const double left = (target_ - columns_ * c).squaredNorm() / square_;
    return std::isfinite(left) ? left : HUGE_VAL;
  }

 private:
  Eigen::MatrixXd unit_columns(const std::vector<Monomial>& terms) const {
    Eigen::MatrixXd columns(screened_.size(), terms.size());
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      columns.col(column) = screened(terms[k].values(rows_)).stableNormalized();
    }
    return columns;
  }

  const LogRows& rows_;
  std::vector<std::size_t> screened_;
  Eigen::MatrixXd sizes_;   // c's terms
  Eigen::MatrixXd plain_;   // an orthonormal basis of b's
  Eigen::VectorXd target_;  // what b leaves
  double square_ = 0;       // of all of the target
  Eigen::VectorXd f_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd along_;
  Eigen::MatrixXd gram_;
};

// One stage: given terms, all products u of so many inputs.
class FunctionSumSearch {
 public:
  FunctionSumSearch(const LogRows& rows, const OperatorSet& operators, const SumOfTerms& terms,
                    std::size_t inputs_of_u, std::size_t rows_of_a_column, Budget& budget)
      : rows_(rows),
        operators_(operators),
        terms_(terms),
        arguments_(monomials(argument_powers()[inputs_of_u - 1], rows)),
        screen_(rows, terms, rows_of_a_column),
        budget_(budget) {}

  // Those that leave least, their scales refined; none where the budget ends before all are seen.
  std::vector<SumTrial> best_trials(std::size_t most) {
    std::vector<SumTrial> trials;
    if (!screen_.has_rows_to_spare()) return trials;
    for (std::size_t k = 0; k < arguments_.size(); ++k) {
      if (!budget_.in_time() || budget_.exhausted()) return {};
      add_trials(k, trials);
    }
    keep_best(trials, kRefinedTrials);
    for (SumTrial& trial : trials) refine(trial);
    keep_best(trials, most);
    return trials;
  }

  std::vector<Expression> find_exact() {
    std::vector<Expression> formulas;
    for (const SumTrial& trial : best_trials(kFittedTrials)) {
      if (trial.left > kPromisingTrial) break;
      if (auto found = exact(trial)) formulas.push_back(std::move(*found));
    }
    return formulas;
  }

  std::vector<Expression> find_likely() {
    std::vector<Expression> formulas;
    for (const SumTrial& trial : best_trials(kLikelySums)) {
      Expression formula = written(trial);
      if (!formula.empty()) formulas.push_back(std::move(formula));
    }
    return formulas;
  }

 private:
  Eigen::VectorXd screened_argument(std::size_t k) const {
    return screen_.screened(arguments_[k].values(rows_));
  }

  // Of every function the best scale.
  void add_trials(std::size_t k, std::vector<SumTrial>& trials) {
    const Eigen::VectorXd u = screened_argument(k);
    std::vector<double> scales;
    for (const double reach : kReaches) scales.push_back(reach / u.cwiseAbs().maxCoeff());
    if (arguments_[k].powers.size() > 1) {
      scales.insert(scales.end(), kPlainScales.begin(), kPlainScales.end());
    }
    for (const UnitFunction& function : kSummedFunctions) {
      if (!function.is_written_with(operators_)) continue;
      SumTrial best{k, function, 0, HUGE_VAL};
      for (const double scale : scales) {
        look_at(u, scale, best);
        if (function.kind == Kind::exponential) look_at(u, -scale, best);
      }
      if (std::isfinite(best.left)) trials.push_back(best);
    }
  }

  void look_at(const Eigen::VectorXd& u, double scale, SumTrial& best) {
    budget_.spend(screen_.node_rows());
    const double left = screen_.left_of(u, best.function, scale);
    if (!(left < best.left)) return;
    best.scale = scale;
    best.left = left;
  }

  void refine(SumTrial& trial) {
    const Eigen::VectorXd u = screened_argument(trial.argument);
    const double scale = least_by_golden_sections(
        [&](double a) { return screen_.left_of(u, trial.function, a); },
        trial.scale / kHalfReachStep, trial.scale * kHalfReachStep, kTrialNarrowings);
    budget_.spend(2 * std::uint64_t{kTrialNarrowings} * screen_.node_rows());
    look_at(u, scale, trial);
  }

  std::optional<Expression> exact(const SumTrial& trial) {
    Expression formula = written(trial);
    if (formula.empty()) return std::nullopt;
    std::vector<const double*> inputs;
    for (const Factor& x : rows_.inputs()) inputs.push_back(x.values.data());
    ConstantFitOptions options;
    options.function_tolerance = 1e-15;
    options.step_tolerance = 1e-15;
    const ConstantFitResult fit =
        ConstantFitter().fit(formula, {inputs, rows_.rows()}, rows_.target().values, {}, options);
    budget_.spend(fit.node_rows);
    if (!operators_.admits(formula) || !explains(formula, rows_)) return std::nullopt;
    return formula;
  }

  struct Column {
    Monomial product;
    std::size_t part;  // of the function; 0 is none
  };

  std::vector<Column> columns_of(const SumTrial& trial) const {
    std::vector<Column> columns;
    for (std::size_t part = 0; part <= parts_of(trial.function).size(); ++part) {
      for (const Monomial& term : part == 0 ? terms_.plain : terms_.sizes) {
        columns.push_back({term, part});
      }
    }
    return columns;
  }

  Eigen::MatrixXd products_of(const std::vector<Column>& columns) const {
    Eigen::MatrixXd products(rows_.rows(), columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      products.col(static_cast<Eigen::Index>(k)) = as_vector(columns[k].product.values(rows_));
    }
    return products;
  }

  // The products times what of the function they belong to; u on all rows.
  static Eigen::MatrixXd values_of(const std::vector<Column>& columns,
                                   const Eigen::MatrixXd& products, const std::vector<double>& u,
                                   const UnitFunction& function, double scale) {
    Eigen::MatrixXd values = products;
    const std::vector<UnitFunction> parts = parts_of(function);
    for (std::size_t part = 1; part <= parts.size(); ++part) {
      std::vector<double> f;
      for (const double each : u) f.push_back(parts[part - 1].value(scale * each));
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (columns[k].part != part) continue;
        values.col(static_cast<Eigen::Index>(k)).array() *= as_vector(f).array();
      }
    }
    return values;
  }

  // By regressions on all rows: of the terms that they ask for, and with the scale that is best for
  // these. Empty where a row has no value: only some were screened.
  Expression written(SumTrial trial) const {
    const Eigen::VectorXd target = as_vector(rows_.target().values);
    const std::vector<double> u = arguments_[trial.argument].values(rows_);
    std::vector<Column> columns = columns_of(trial);
    Eigen::MatrixXd products = products_of(columns);
    for (bool is_fewer = true; is_fewer;) {
      const Eigen::MatrixXd values = values_of(columns, products, u, trial.function, trial.scale);
      if (!values.allFinite()) return {};
      const std::vector<Eigen::Index> asked = backward_elimination(values, target);
      is_fewer = asked.size() < columns.size();
      std::vector<Column> kept;
      for (const Eigen::Index k : asked) kept.push_back(columns[static_cast<std::size_t>(k)]);
      columns = std::move(kept);
      products = Eigen::MatrixXd(products(Eigen::all, asked));
      const auto left_at = [&](double scale) {
        const Eigen::MatrixXd values = values_of(columns, products, u, trial.function, scale);
        if (!values.allFinite()) return HUGE_VAL;
        const Eigen::VectorXd fit = Eigen::HouseholderQR<Eigen::MatrixXd>(values).solve(target);
        return (target - values * fit).squaredNorm();
      };
      const double scale = least_by_golden_sections(left_at, trial.scale / kNearby,
                                                    trial.scale * kNearby, kTrialNarrowings);
      if (left_at(scale) < left_at(trial.scale)) trial.scale = scale;
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(
        values_of(columns, products, u, trial.function, trial.scale));
    return sum_of_columns(columns, qr.solve(target), trial);
  }

  Expression sum_of_columns(const std::vector<Column>& columns, const Eigen::VectorXd& coefficients,
                            const SumTrial& trial) const {
    const std::vector<UnitFunction> parts = parts_of(trial.function);
    std::vector<Expression> sums(parts.size() + 1);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      Expression& sum = sums[columns[k].part];
      sum = sum_of(sum, columns[k].product.times(coefficients[static_cast<Eigen::Index>(k)]));
    }
    Expression formula = sums[0];
    const Expression argument = arguments_[trial.argument].times(trial.scale);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (sums[k + 1].empty()) continue;
      formula = sum_of(formula, sums[k + 1] * parts[k].formula(argument));
    }
    return formula;
  }

  static Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
  }

  const LogRows& rows_;
  const OperatorSet& operators_;
  const SumOfTerms& terms_;
  std::vector<Monomial> arguments_;
  SumScreen screen_;
  Budget& budget_;
};

bool is_possible(const LogRows& rows, const OperatorSet& operators) {
  const std::size_t inputs = rows.inputs().size();
  return inputs >= 2 && inputs <= kMostSizedInputs && rows.rows() >= kFewestSumRows &&
         operators.allows(Op::mul) && operators.allows(Op::add);
}

struct Stage {
  SumTerms terms;
  std::size_t inputs_of_u;
};
constexpr std::array kFewStages = {Stage{SumTerms::few, 1}, Stage{SumTerms::few, 2}};
constexpr std::array kLikelyStages = {Stage{SumTerms::few, 1}, Stage{SumTerms::few, 2},
                                      Stage{SumTerms::few, 3}};
constexpr std::array kManyStages = {Stage{SumTerms::few, 3}, Stage{SumTerms::many, 1},
                                    Stage{SumTerms::many, 2}, Stage{SumTerms::many, 3}};

}  // namespace

std::vector<Expression> find_function_sums(const LogRows& rows, const OperatorSet& operators,
                                           SumTerms terms, Budget& budget) {
  if (!is_possible(rows, operators)) return {};
  const auto stages = terms == SumTerms::few ? std::span<const Stage>(kFewStages) : kManyStages;
  for (const Stage& stage : stages) {
    const SumOfTerms of_stage = terms_of(stage.terms, rows);
    auto found =
        FunctionSumSearch(rows, operators, of_stage, stage.inputs_of_u, kRowsOfAColumn, budget)
            .find_exact();
    if (!found.empty()) return found;
  }
  return {};
}

std::vector<Expression> likely_function_sums(const LogRows& rows, const OperatorSet& operators,
                                             Budget& budget) {
  std::vector<Expression> formulas;
  if (!is_possible(rows, operators)) return formulas;
  for (const Stage& stage : kLikelyStages) {
    const SumOfTerms of_stage = terms_of(stage.terms, rows);
    FunctionSumSearch search(rows, operators, of_stage, stage.inputs_of_u, kRowsOfAColumnUnderNoise,
                             budget);
    for (Expression& formula : search.find_likely()) {
      formulas.push_back(std::move(formula));
    }
  }
  return formulas;
}

}  // namespace tribench::relay
