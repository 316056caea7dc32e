// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/pysr/growth.hpp"

namespace tribench::pysr {
namespace {

// More terms than this cost more to rank than they find.
constexpr std::size_t kMostTerms = 120;
// Two terms whose squared cosine differs from 1 by less are proportional on these rows.
constexpr double kProportional = 1e-10;

class Builder {
 public:
  Builder(const Rows& rows, const OperatorSet& operators) : rows_(rows), operators_(operators) {}

  TermLibrary build() {
    offer(Expression::constant(1));
    const std::size_t inputs = rows_.columns.size();
    const int degree = inputs <= 2 ? 4 : (inputs <= 5 ? 3 : 2);
    for (int d = 1; d <= degree; ++d) {
      std::vector<int> powers(inputs, 0);
      monomials(powers, 0, d);
    }
    const std::size_t count = library_.terms.size();
    for (std::size_t i = 1; i < count; ++i) {
      if (degrees_[i] <= 2) functions_of(i);
    }
    return std::move(library_);
  }

 private:
  // Offers every monomial of total degree `left` in the inputs from `input` on.
  void monomials(std::vector<int>& powers, std::size_t input, int left) {
    if (is_full()) return;  // of thousands of inputs there are millions
    if (left == 0) return offer_monomial(powers);
    if (input == powers.size()) return;
    for (int power = left; power >= 0; --power) {
      powers[input] = power;
      monomials(powers, input + 1, left - power);
    }
    powers[input] = 0;
  }

  void offer_monomial(const std::vector<int>& powers) {
    std::optional<Expression> product;
    int degree = 0;
    for (std::size_t j = 0; j < powers.size(); ++j) {
      if (powers[j] == 0) continue;
      degree += powers[j];
      Expression factor = Expression::variable(j);
      if (powers[j] > 1) {
        factor = Expression::binary(Op::pow, factor, Expression::constant(powers[j]));
      }
      product = product ? Expression::binary(Op::mul, *product, factor) : factor;
    }
    offer(*product, degree);
  }

  void functions_of(std::size_t term) {
    const Expression argument = library_.terms[term].formula;
    const std::vector<double>& values = library_.terms[term].values;
    const double largest = std::abs(
        *std::ranges::max_element(values, {}, [](double value) { return std::abs(value); }));
    const bool one_sign = std::ranges::min(values) >= 0 || std::ranges::max(values) <= 0;
    if (operators_.allows(Op::sqrt) && std::ranges::min(values) >= 0) {
      offer(Expression::unary(Op::sqrt, argument));
    }
    const auto scaled = [&](double scale) {
      return Expression::binary(Op::mul, Expression::constant(scale / largest), argument);
    };
    if (operators_.allows(Op::exp)) {
      // A one-sided argument is let decay (a Stribeck or Gaussian shape); a two-sided one bends.
      if (one_sign) {
        for (const double scale : {-3.0, -10.0, -30.0})
          offer(Expression::unary(Op::exp, scaled(scale)));
      } else if (degrees_[term] == 1) {
        for (const double scale : {-2.0, 2.0}) offer(Expression::unary(Op::exp, scaled(scale)));
      }
    }
    if (one_sign || degrees_[term] > 1) return;
    for (const Op op : {Op::tanh, Op::sin, Op::cos}) {
      if (!operators_.allows(op)) continue;
      for (const double scale : {3.0, 12.0}) offer(Expression::unary(op, scaled(scale)));
    }
    if (operators_.allows(Op::abs)) offer(Expression::unary(Op::abs, argument));
  }

  bool is_full() const { return library_.terms.size() >= kMostTerms; }

  void offer(const Expression& formula, int degree = 9) {
    if (is_full()) return;
    if (formula.size() > 1 && !operators_.admits(formula)) return;
    std::vector<double> values(rows_.size());
    evaluator_.evaluate(formula, rows_.inputs(), values);
    const double square = columns::dot(values.data(), values.data(), values.size());
    if (!std::isfinite(square) || !(square > 0)) return;
    for (std::size_t i = 0; i < library_.terms.size(); ++i) {
      const double along =
          columns::dot(values.data(), library_.terms[i].values.data(), values.size());
      if (along * along >= (1 - kProportional) * square * squares_[i]) return;
    }
    std::vector<double> squares(values.size());
    columns::mul(values.data(), values.data(), squares.data(), values.size());
    library_.terms.push_back({formula, std::move(values), std::move(squares)});
    squares_.push_back(square);
    degrees_.push_back(degree);
  }

  const Rows& rows_;
  const OperatorSet& operators_;
  Evaluator evaluator_;
  TermLibrary library_;
  std::vector<double> squares_;
  std::vector<int> degrees_;
};

}  // namespace

TermLibrary make_term_library(const Rows& rows, const OperatorSet& operators) {
  return Builder(rows, operators).build();
}

TermLibraries make_term_libraries(const Form& form, const Rows& rows,
                                  const OperatorSet& operators) {
  TermLibraries libraries;
  for (std::size_t part = 0; part < form.parts(); ++part) {
    std::vector<std::vector<double>> arguments;
    for (const std::size_t column : form.arguments(part)) {
      arguments.push_back(rows.columns[column]);
    }
    libraries.push_back(make_term_library({std::move(arguments), rows.target}, operators));
    for (Term& term : libraries.back().terms) term.formula = form.over_columns(term.formula, part);
  }
  return libraries;
}

}  // namespace tribench::pysr
