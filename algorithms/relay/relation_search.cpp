// SPDX-License-Identifier: MIT
#include "algorithms/relay/relation_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/relay/factors.hpp"
#include "algorithms/relay/subset_fits.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr double kExactRelation = 1e-8;      // of a row's target, root mean square
constexpr double kNoPart = 1e-10;            // of a row's target, that a term explains
constexpr double kPromisingRelation = 1e-5;  // in the Gram matrix, whose rounding is larger
constexpr std::size_t kMostRelationTerms = 6;
constexpr std::size_t kLikelyOfASize = 3;
constexpr std::size_t kMostLikelyTerms = 3;
constexpr std::size_t kSums = 300;  // that are grown (subset_fits.hpp)
// Of a product, by the number of inputs: one, two, more.
int most_degree(std::size_t inputs) { return inputs == 1 ? 14 : inputs == 2 ? 7 : 4; }
constexpr std::size_t kFewInputs = 2;  // of which every kind of factor is tried, below the bar too

// A column: a known factor that is no input, to the power 0, 1 or 2, and powers of the inputs.
struct Product {
  std::optional<std::size_t> factor;  // among those beyond the inputs
  int factor_power = 1;
  std::vector<int> exponents;              // per input
  bool is_beside = false;                  // times the target
  std::optional<std::size_t> log_of = {};  // log |input|, where T is the logarithm

  int degree() const {
    int sum = factor ? std::abs(factor_power) + 1 : 0;
    for (const int a : exponents) sum += std::abs(a);
    return sum;
  }
};

bool is_root(FactorKind kind) {
  return kind == FactorKind::root || kind == FactorKind::root_product;
}

// What the columns marked as beside are: none are taken, multiples of T(y), or of y beside y^2.
enum class Shape { sum, ratio, quadratic };

// Whether a formula's values are nearer to the target than another's, in most rows.
bool is_nearer(const Expression& formula, const Expression& other, const LogRows& rows) {
  const Factor a = factor_of(formula, rows);
  const Factor b = factor_of(other, rows);
  std::size_t nearer = 0;
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    const double y = rows.target().values[r];
    if (std::abs(a.values[r] - y) <= std::abs(b.values[r] - y)) ++nearer;
  }
  return 2 * nearer >= rows.rows();
}

class Search {
 public:
  Search(const LogRows& rows, const OperatorSet& operators, Columns columns, std::size_t most,
         std::size_t most_beside)
      : rows_(rows), operators_(operators), signs_(signs_of_target(rows)) {
    if (columns == Columns::with_roots) {
      factors_ = known_factors(rows, operators, {FactorKind::root, FactorKind::root_product});
      std::erase_if(factors_,
                    [](const KnownFactor& known) { return known.kind == FactorKind::input; });
    }
    if (columns == Columns::with_factors) {
      factors_ = known_factors(rows, operators,
                               {FactorKind::wave, FactorKind::angle_sum, FactorKind::decay,
                                FactorKind::difference, FactorKind::logarithm});
      const std::size_t n = rows.inputs().size();
      if (n == kFewInputs + 1) {
        factors_ = known_factors(
            rows, operators,
            {FactorKind::wave, FactorKind::angle_sum, FactorKind::wave_product, FactorKind::decay,
             FactorKind::difference, FactorKind::power, FactorKind::logarithm});
      } else if (n <= kFewInputs) {
        factors_ =
            known_factors(rows, operators,
                          {FactorKind::wave, FactorKind::wave_product, FactorKind::difference,
                           FactorKind::sum, FactorKind::root, FactorKind::power,
                           FactorKind::logarithm, FactorKind::exponential, FactorKind::angle_sum});
      }
      std::erase_if(factors_,
                    [](const KnownFactor& known) { return known.kind == FactorKind::input; });
    }
    list_products(most, most_beside);
    const std::size_t count = std::min(most, products_.size());
    most_steps_ = 300 * count * count;
  }

  // A ratio has one multiple of T(y) on the right, for the plain form and the logarithm.
  std::optional<Expression> run(TargetForm form, Shape shape, Budget& budget) const;
  // The sums of every size that leave least where every row's target is as uncertain as any
  // other's.
  void add_likely(TargetForm form, Shape shape, Budget& budget,
                  std::vector<Expression>& likely) const;

 private:
  struct Regression;

  Regression regression(TargetForm form, Shape shape, const std::vector<double>& scale) const;
  // None where there is nothing to choose from, or no budget.
  std::optional<SubsetFits> subset_fits(const Regression& all, Budget& budget) const;
  // From sums of `terms` terms to those of one more. False: no budget.
  bool grow(std::vector<SparseSum>& sums, std::size_t terms, Shape shape, const SubsetFits& fits,
            const Regression& all, Budget& budget) const;
  void list_products(std::size_t most, std::size_t most_beside);
  std::vector<double> values_of(const Product& product) const;
  Expression formula_of(const Product& product, double coefficient, TargetForm form) const;
  std::optional<Expression> exact(TargetForm form, Shape shape, SparseSum sum,
                                  const Regression& all) const;
  Expression with_coefficients(TargetForm form, Shape shape, SparseSum sum,
                               const Regression& all) const;
  Expression root_of_quadratic(const SparseSum& sum, std::span<const double> coefficients) const;
  Expression assembled(TargetForm form, const SparseSum& sum,
                       std::span<const double> coefficients) const;

  const LogRows& rows_;
  const OperatorSet& operators_;
  std::vector<KnownFactor> factors_;
  std::optional<std::vector<std::size_t>> signs_;
  std::vector<Product> products_;
  std::size_t most_steps_ = 0;  // of the search for a ratio: 0.1 s for 500 columns
};

// By increasing degree.
void Search::list_products(std::size_t most, std::size_t most_beside) {
  const std::size_t n = rows_.inputs().size();
  const int most_of_all = most_degree(n);
  std::vector<std::vector<std::vector<int>>> by_degree(static_cast<std::size_t>(most_of_all) + 1);
  std::vector<int> exponents(n, 0);
  std::size_t count = 0;
  const auto extend = [&](auto&& self, std::size_t next, int degree, int left) -> void {
    if (count > 4 * most) return;
    if (next == n) {
      if (left > 0) return;
      by_degree[static_cast<std::size_t>(degree)].push_back(exponents);
      ++count;
      return;
    }
    for (int a = -left; a <= left; ++a) {
      if (a < 0 && !rows_.inputs()[next].has_logs()) continue;
      exponents[next] = a;
      self(self, next + 1, degree, left - std::abs(a));
    }
    exponents[next] = 0;
  };
  for (int degree = 0; degree <= most_of_all; ++degree) extend(extend, 0, degree, degree);
  for (std::size_t j = 0; j < n; ++j) {
    if (!rows_.inputs()[j].has_logs()) continue;
    products_.push_back({std::nullopt, 1, std::vector<int>(n, 0), false, j});
  }
  for (int degree = 0; degree <= most_of_all && products_.size() < most; ++degree) {
    for (const auto& powers : by_degree[static_cast<std::size_t>(degree)]) {
      products_.push_back({std::nullopt, 1, powers, false});
    }
    // A factor to the power of one or two counts as one degree more.
    for (int rest = 2; rest <= 3 && rest <= degree; ++rest) {
      for (const auto& powers : by_degree[static_cast<std::size_t>(degree - rest)]) {
        if (products_.size() >= most) break;
        for (std::size_t f = 0; f < factors_.size(); ++f) {
          // The square of a root is an input's power again.
          if (is_root(factors_[f].kind) && rest > 2) continue;
          // Products of waves stand alone: they are many.
          if (factors_[f].kind == FactorKind::wave_product && degree > rest) continue;
          // A length times a wave of its angle.
          if (factors_[f].kind == FactorKind::angle_sum && (degree > rest + 1 || rest > 2))
            continue;
          products_.push_back({f, rest - 1, powers, false});
          if (!factors_[f].factor.has_logs()) continue;
          if (n > kFewInputs && !is_root(factors_[f].kind)) continue;
          products_.push_back({f, 1 - rest, powers, false});
        }
      }
    }
  }
  if (products_.size() > most) products_.resize(most);
  // Multiples of the target come in hundreds only: each is tried with all pairs of the others.
  const std::size_t plain = products_.size();
  for (std::size_t k = 0; k < plain && products_.size() < most + most_beside; ++k) {
    if (products_[k].log_of || products_[k].degree() > 3) continue;
    products_.push_back(products_[k]);
    products_.back().is_beside = true;
  }
}

std::vector<double> Search::values_of(const Product& product) const {
  if (product.log_of) return rows_.inputs()[*product.log_of].logs;
  std::vector<double> values(rows_.rows(), 1.0);
  std::vector<double> power(rows_.rows());
  for (std::size_t j = 0; j < product.exponents.size(); ++j) {
    if (product.exponents[j] == 0) continue;
    columns::integer_power(rows_.inputs()[j].values.data(), product.exponents[j], power.data(),
                           power.size());
    columns::mul(values.data(), power.data(), values.data(), values.size());
  }
  if (product.factor) {
    columns::integer_power(factors_[*product.factor].factor.values.data(), product.factor_power,
                           power.data(), power.size());
    columns::mul(values.data(), power.data(), values.data(), values.size());
  }
  return values;
}

// The columns of one regression, and what they stand for.
struct Search::Regression {
  std::vector<double> scale;  // a row's weight
  std::vector<double> target;
  std::vector<std::vector<double>> columns;
  std::vector<std::size_t> places;  // of the columns, among the products
  std::vector<char> once;           // multiples of the target
};

Search::Regression Search::regression(TargetForm form, Shape shape,
                                      const std::vector<double>& scale) const {
  Regression all;
  const std::size_t n = rows_.rows();
  const std::vector<double> formed = formed_target(rows_.target().values, form);
  all.target = formed;
  all.scale = scale;
  for (std::size_t k = 0; k < products_.size(); ++k) {
    const Product& product = products_[k];
    // A constant share of T(y) says nothing; of y beside y^2 it does.
    const bool is_fit =
        shape == Shape::quadratic || (shape == Shape::ratio && product.degree() > 0);
    if (product.is_beside && !is_fit) continue;
    if (product.log_of && (form != TargetForm::logarithm || shape != Shape::sum)) continue;
    std::vector<double> values = values_of(product);
    if (product.is_beside) {
      const std::vector<double>& of = shape == Shape::quadratic ? rows_.target().values : formed;
      columns::mul(values.data(), of.data(), values.data(), n);
    }
    columns::mul(values.data(), all.scale.data(), values.data(), n);
    const double square = columns::dot(values.data(), values.data(), n);
    if (!std::isfinite(square) || square == 0) continue;
    all.columns.push_back(std::move(values));
    all.places.push_back(k);
    all.once.push_back(product.is_beside ? 1 : 0);
  }
  columns::mul(all.target.data(), all.scale.data(), all.target.data(), n);
  return all;
}

std::optional<SubsetFits> Search::subset_fits(const Regression& all, Budget& budget) const {
  const std::size_t count = all.columns.size();
  const std::size_t n = rows_.rows();
  // A product in the Gram matrix costs an eighth of what a node of a formula does.
  if (count < 2 || !budget.spend(count * count / 16 * n)) return std::nullopt;
  if (!std::ranges::all_of(all.target, [](double x) { return std::isfinite(x); })) {
    return std::nullopt;
  }
  std::vector<const double*> pointers;
  for (const auto& column : all.columns) pointers.push_back(column.data());
  pointers.push_back(all.target.data());
  std::vector<double> gram((count + 1) * (count + 1));
  columns::gram(pointers.data(), count + 1, n, gram.data());
  return SubsetFits(std::move(gram), all.once);
}

bool Search::grow(std::vector<SparseSum>& sums, std::size_t terms, Shape shape,
                  const SubsetFits& fits, const Regression& all, Budget& budget) const {
  if (!budget.spend(kSums * all.columns.size() * terms * terms)) return false;
  sums = fits.grown(sums, budget);
  if (terms > 2 || shape == Shape::sum || !budget.spend(most_steps_ / 4)) return true;
  std::ranges::copy(fits.best_with_one_marked(most_steps_, budget), std::back_inserter(sums));
  std::ranges::stable_sort(sums, {}, &SparseSum::left);
  return true;
}

std::optional<Expression> Search::run(TargetForm form, Shape shape, Budget& budget) const {
  if (!keeps_sign(form) && shape != Shape::quadratic && !signs_) return std::nullopt;
  const std::vector<double> formed = formed_target(rows_.target().values, form);
  const Regression all = regression(form, shape, relative_scale(formed, form));
  const std::optional<SubsetFits> fits = subset_fits(all, budget);
  if (!fits) return std::nullopt;
  std::vector<SparseSum> sums = fits->best_pairs();
  for (std::size_t terms = 2; !sums.empty(); ++terms) {
    for (const SparseSum& sum : sums) {
      if (sum.left > kPromisingRelation * kPromisingRelation) break;
      if (auto found = exact(form, shape, sum, all)) return found;
    }
    if (terms == kMostRelationTerms || !grow(sums, terms, shape, *fits, all, budget)) break;
  }
  return std::nullopt;
}

void Search::add_likely(TargetForm form, Shape shape, Budget& budget,
                        std::vector<Expression>& likely) const {
  if (!keeps_sign(form) && shape != Shape::quadratic && !signs_) return;
  const Regression all = regression(form, shape, noise_scale(rows_.target().values, form));
  const std::optional<SubsetFits> fits = subset_fits(all, budget);
  if (!fits) return;
  std::vector<SparseSum> sums = fits->best_pairs();
  for (std::size_t terms = 2; !sums.empty(); ++terms) {
    std::size_t taken = 0;
    for (const SparseSum& sum : sums) {
      if (taken == kLikelyOfASize) break;
      Expression formula = with_coefficients(form, shape, sum, all);
      if (formula.empty() || !operators_.admits(formula)) continue;
      likely.push_back(std::move(formula));
      ++taken;
    }
    if (terms == kMostLikelyTerms || !grow(sums, terms, shape, *fits, all, budget)) break;
  }
}

Expression Search::with_coefficients(TargetForm form, Shape shape, SparseSum sum,
                                     const Regression& all) const {
  std::vector<const double*> pointers;
  for (const std::size_t term : sum.terms) pointers.push_back(all.columns[term].data());
  const std::vector<double> coefficients = solve_least_squares(pointers, all.target).coefficients;
  for (std::size_t& term : sum.terms) term = all.places[term];
  return shape == Shape::quadratic ? root_of_quadratic(sum, coefficients)
                                   : assembled(form, sum, coefficients);
}

// Without the terms that explain less than what may be left over.
std::optional<Expression> Search::exact(TargetForm form, Shape shape, SparseSum sum,
                                        const Regression& all) const {
  const double n = static_cast<double>(rows_.rows());
  std::vector<double> coefficients;
  for (bool is_shorter = true; is_shorter && !sum.terms.empty();) {
    std::vector<const double*> pointers;
    for (const std::size_t term : sum.terms) pointers.push_back(all.columns[term].data());
    LinearFit fit = solve_least_squares(pointers, all.target);
    if (!(std::sqrt(fit.sum_squares / n) <= kExactRelation)) return std::nullopt;
    coefficients = std::move(fit.coefficients);
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < sum.terms.size(); ++k) {
      const double square = columns::dot(pointers[k], pointers[k], rows_.rows());
      if (std::abs(coefficients[k]) * std::sqrt(square / n) > kNoPart) kept.push_back(sum.terms[k]);
    }
    is_shorter = kept.size() < sum.terms.size();
    sum.terms = std::move(kept);
  }
  for (std::size_t& term : sum.terms) term = all.places[term];
  Expression formula = shape == Shape::quadratic ? root_of_quadratic(sum, coefficients)
                                                 : assembled(form, sum, coefficients);
  if (formula.empty() || !operators_.admits(formula) || !explains(formula, rows_))
    return std::nullopt;
  return formula;
}

// Below a root, less the inputs that bring the sign and stand before it.
Expression Search::formula_of(const Product& product, double coefficient, TargetForm form) const {
  std::vector<Expression> factors;
  std::vector<double> exponents(product.exponents.begin(), product.exponents.end());
  for (const Factor& input : rows_.inputs()) factors.push_back(input.formula);
  if (is_even_power(form)) {
    for (const std::size_t j : *signs_) exponents[j] += form == TargetForm::square ? -2 : 2;
  }
  if (product.factor) {
    factors.push_back(factors_[*product.factor].factor.formula);
    exponents.push_back(product.factor_power);
  }
  return product_of(coefficient, factors, exponents);
}

// y^2 = b y + c: b / 2 and the root that is on all rows on the same side of it. Empty where there
// is no such side, or nothing but b or c.
Expression Search::root_of_quadratic(const SparseSum& sum,
                                     std::span<const double> coefficients) const {
  Expression half;
  Expression rest;
  for (std::size_t k = 0; k < sum.terms.size(); ++k) {
    const Product& product = products_[sum.terms[k]];
    if (product.is_beside) {
      half = sum_of(half, formula_of(product, coefficients[k] / 2, TargetForm::plain));
    } else {
      rest = sum_of(rest, formula_of(product, coefficients[k], TargetForm::plain));
    }
  }
  if (half.empty() || rest.empty()) return {};
  const Expression root = function(Op::sqrt, power(half, 2) + rest);
  Expression above = half + root;
  Expression below = half - root;
  return is_nearer(above, below, rows_) ? above : below;
}

Expression Search::assembled(TargetForm form, const SparseSum& sum,
                             std::span<const double> coefficients) const {
  Expression right;
  Expression beside;
  std::vector<Expression> powers;
  std::vector<double> exponents;
  double log_constant = 0;
  const bool is_ratio =
      std::ranges::any_of(sum.terms, [&](std::size_t term) { return products_[term].is_beside; });
  for (std::size_t k = 0; k < sum.terms.size(); ++k) {
    const Product& product = products_[sum.terms[k]];
    if (product.log_of) {
      powers.push_back(rows_.inputs()[*product.log_of].formula);
      const double power = coefficients[k];
      const bool is_half = std::abs(power - nearest_half(power)) <= kExactRelation;
      exponents.push_back(is_half ? nearest_half(power) : power);
      continue;
    }
    if (form == TargetForm::logarithm && product.degree() == 0 && !is_ratio) {
      log_constant = coefficients[k];
      continue;
    }
    Expression& side = product.is_beside ? beside : right;
    const double c = product.is_beside ? -coefficients[k] : coefficients[k];
    side = sum_of(side, formula_of(product, c, form));
  }
  if (right.empty() && (is_ratio || form != TargetForm::logarithm)) right = constant(0);
  if (!beside.empty()) right = right / (constant(1) + beside);
  if (keeps_sign(form)) return solved_for_target(form, right, 1);
  double sign = rows_.target().values[0] < 0 ? -1.0 : 1.0;
  if (form == TargetForm::logarithm) {
    if (!right.empty()) {
      powers.push_back(function(Op::exp, right));
      exponents.push_back(1);
    }
    return product_of(sign * elementary::exp(log_constant), powers, exponents);
  }
  for (const std::size_t j : *signs_) {
    if (rows_.inputs()[j].values[0] < 0) sign = -sign;
  }
  Expression root = solved_for_target(form, right, sign);
  for (const std::size_t j : *signs_) root = rows_.inputs()[j].formula * root;
  return root;
}

}  // namespace

std::optional<Expression> find_relation(const LogRows& rows, const OperatorSet& operators,
                                        Columns columns, std::size_t most, Budget& budget) {
  if (rows.rows() < 20 || !operators.allows(Op::mul) || !operators.allows(Op::div)) {
    return std::nullopt;
  }
  most = std::min(most, kMostColumns);
  const Search search(rows, operators, columns, most, most / 4);
  std::optional<Expression> shortest;
  const auto look = [&](TargetForm form, Shape shape) {
    if (budget.exhausted()) return;
    auto found = search.run(form, shape, budget);
    if (found && (!shortest || found->size() < shortest->size())) shortest = std::move(found);
  };
  // Roots of roots and roots in ratios are no laws that are known here.
  if (columns == Columns::with_roots) {
    look(TargetForm::plain, Shape::sum);
    return shortest;
  }
  for (const TargetForm form : kTargetForms) look(form, Shape::sum);
  if (!shortest) look(TargetForm::plain, Shape::ratio);
  if (!shortest && rows.inputs().size() <= kFewInputs) look(TargetForm::logarithm, Shape::ratio);
  return shortest;
}

std::optional<Expression> find_root(const LogRows& rows, const OperatorSet& operators,
                                    Columns columns, std::size_t most, Budget& budget) {
  if (rows.rows() < 20 || !operators.allows(Op::mul) || !operators.allows(Op::div) ||
      !operators.allows(Op::sqrt)) {
    return std::nullopt;
  }
  most = std::min(most, kMostColumns);
  const Search search(rows, operators, columns, most, most / 2);
  return search.run(TargetForm::square, Shape::quadratic, budget);
}

std::vector<Expression> likely_relations(const LogRows& rows, const OperatorSet& operators,
                                         Columns columns, std::size_t most, Budget& budget) {
  std::vector<Expression> likely;
  if (rows.rows() < 20 || !operators.allows(Op::mul) || !operators.allows(Op::div)) return likely;
  const Search search(rows, operators, columns, most, most / 4);
  for (const TargetForm form : kTargetForms) {
    if (!budget.exhausted()) search.add_likely(form, Shape::sum, budget, likely);
  }
  if (!budget.exhausted()) search.add_likely(TargetForm::plain, Shape::ratio, budget, likely);
  if (!budget.exhausted() && operators.allows(Op::sqrt)) {
    search.add_likely(TargetForm::square, Shape::quadratic, budget, likely);
  }
  return likely;
}

}  // namespace tribench::relay
