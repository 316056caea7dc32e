// SPDX-License-Identifier: MIT
#include "algorithms/udsr/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/elementary.hpp"

namespace tribench::udsr {
namespace {

// The published code drops smaller coefficients (polyfit.py, coef_tol); ours are relative to the
// target's spread, since a unit is a choice.
constexpr double kCoefficientTolerance = 1e-9;
// An inversion that loses more rows than this does not describe the data.
constexpr double kLeastInvertible = 0.8;
// A fit of constants evaluates the formula and its Jacobian this often, about.
constexpr std::uint64_t kFitCost = 40;

std::size_t position_of(const TokenLibrary& library, const Sequence& sequence, TokenKind kind) {
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (library[sequence[i]].kind == kind) return i;
  }
  return sequence.size();
}

// x with op(x) = value, and d op / dx there.
struct Inverse {
  double argument = 0;
  double derivative = 0;
};

Inverse invert_unary(Op op, double value) {
  switch (op) {
    case Op::neg:
      return {-value, -1};
    case Op::exp:
      return {elementary::log(value), value};
    case Op::log: {
      const double x = elementary::exp(value);
      return {x, 1 / x};
    }
    case Op::sqrt:
      if (value < 0) break;
      return {value * value, 0.5 / value};
    case Op::tanh:
      return {elementary::atanh(value), 1 - value * value};
    case Op::atan: {
      if (std::abs(value) >= std::numbers::pi / 2) break;
      const double x = elementary::tan(value);
      return {x, 1 / (1 + x * x)};
    }
    default:
      break;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan};
}

// The unknown stands left (unknown op known) or right (known op unknown).
Inverse invert_binary(Op op, double value, double known, bool unknown_left) {
  switch (op) {
    case Op::add:
      return {value - known, 1};
    case Op::sub:
      return unknown_left ? Inverse{value + known, 1} : Inverse{known - value, -1};
    case Op::mul:
      return {value / known, known};
    default: {
      if (unknown_left) return {value * known, 1 / known};
      const double x = known / value;
      return {x, -known / (x * x)};
    }
  }
}

}  // namespace

bool is_sign(const Input& input) {
  return input.sign_of || input.role == Role::velocity_sign || input.role == Role::gravity_sign;
}

std::vector<int> exponent_caps(std::span<const Input> inputs, int degree) {
  std::vector<int> caps;
  for (const Input& input : inputs) {
    const int most = is_sign(input) ? 1 : degree;
    caps.push_back(input.max_degree > 0 ? std::min(most, input.max_degree) : most);
  }
  return caps;
}

int affordable_degree(std::span<const Input> inputs, int degree, std::size_t rows) {
  const double most = std::min(kMostLinearTerms, static_cast<double>(rows) / 2);
  while (degree > 1 && monomial_count(exponent_caps(inputs, degree), degree) > most) --degree;
  return degree;
}

ScoringProblem::ScoringProblem(const TrainingData& data, const TokenLibrary& library, int degree)
    : library_(&library), data_(data), linear_([&] {
        const int affordable = affordable_degree(data.inputs, degree, data_.rows());
        return PolynomialRegression(data_.pointers(), data_.rows(),
                                    exponent_caps(data.inputs, affordable), affordable);
      }()) {
  double mean = 0;
  const double n = std::max<double>(1, static_cast<double>(rows()));
  for (const double y : target()) mean += y / n;
  for (const double y : target()) variance_ += (y - mean) * (y - mean) / n;
}

Expression to_expression(const TokenLibrary& library, std::span<const TokenId> sequence,
                         const Expression& linear) {
  // Read backwards, a pre-order sequence is a stack program; the first child is popped first.
  std::vector<Expression> stack;
  for (std::size_t i = sequence.size(); i-- > 0;) {
    const Token& token = library[sequence[i]];
    switch (token.kind) {
      case TokenKind::input:
        stack.push_back(Expression::variable(token.input));
        break;
      case TokenKind::constant:
        stack.push_back(Expression::constant(1));
        break;
      case TokenKind::linear:
        stack.push_back(linear);
        break;
      case TokenKind::operation:
        if (token.children == 1) {
          stack.back() = Expression::unary(token.op, stack.back());
        } else {
          const Expression left = std::move(stack.back());
          stack.pop_back();
          stack.back() = Expression::binary(token.op, left, stack.back());
        }
        break;
    }
  }
  return std::move(stack.back());
}

std::uint64_t scoring_cost(const ScoringProblem& problem, const Sequence& sequence) {
  const TokenLibrary& library = problem.library();
  std::uint64_t per_row = sequence.size();
  if (position_of(library, sequence, TokenKind::linear) < sequence.size()) {
    per_row += sequence.size() + 4 * problem.linear().terms().size();
  }
  if (position_of(library, sequence, TokenKind::constant) < sequence.size()) per_row *= kFitCost;
  return per_row * problem.rows();
}

double Scorer::nrmse(const Expression& formula) {
  values_.resize(problem_->rows());
  evaluator_.evaluate(formula, problem_->inputs(), values_);
  double sum = 0;
  for (std::size_t r = 0; r < values_.size(); ++r) {
    const double error = problem_->target()[r] - values_[r];
    sum += error * error;
  }
  if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  const double mean = sum / static_cast<double>(values_.size());
  // A constant target has no spread to compare with; its own scale takes the place.
  return std::sqrt(problem_->variance() > 0 ? mean / problem_->variance() : mean);
}

void Scorer::invert_level(const Sequence& sequence, std::size_t at, std::size_t known_at,
                          bool linear_left, InvertedTarget& inverted) {
  const TokenLibrary& library = problem_->library();
  const Token& token = library[sequence[at]];
  values_.resize(problem_->rows());
  if (token.children == 2) {
    const std::size_t end = subtree_end(library, sequence, known_at);
    const Expression known =
        to_expression(library, std::span(sequence).subspan(known_at, end - known_at), Expression());
    evaluator_.evaluate(known, problem_->inputs(), values_);
  }
  const bool weighted = token.op != Op::add && token.op != Op::sub && token.op != Op::neg;
  if (weighted && inverted.weights.size() == 0) {
    inverted.weights = Eigen::VectorXd::Ones(inverted.target.size());
  }
  for (Eigen::Index r = 0; r < inverted.target.size(); ++r) {
    const double value = inverted.target[r];
    const Inverse inverse =
        token.children == 1
            ? invert_unary(token.op, value)
            : invert_binary(token.op, value, values_[static_cast<std::size_t>(r)], linear_left);
    inverted.target[r] = inverse.argument;
    if (inverted.weights.size() > 0) inverted.weights[r] *= inverse.derivative;
  }
}

InvertedTarget Scorer::invert(const Sequence& sequence, std::size_t linear_at) {
  const TokenLibrary& library = problem_->library();
  InvertedTarget inverted;
  inverted.target = Eigen::Map<const Eigen::VectorXd>(problem_->target().data(),
                                                      static_cast<Eigen::Index>(problem_->rows()));
  for (std::size_t at = 0; at != linear_at;) {
    const Token& token = library[sequence[at]];
    const std::size_t left = at + 1;
    const std::size_t right = token.children == 2 ? subtree_end(library, sequence, left) : left;
    const bool linear_left = token.children == 1 || linear_at < right;
    invert_level(sequence, at, linear_left ? right : left, linear_left, inverted);
    at = linear_left ? left : right;
  }
  std::size_t usable = 0;
  for (Eigen::Index r = 0; r < inverted.target.size(); ++r) {
    const bool weighted = inverted.weights.size() > 0;
    if (std::isfinite(inverted.target[r]) && (!weighted || std::isfinite(inverted.weights[r]))) {
      ++usable;
      continue;
    }
    if (!weighted) return inverted;
    inverted.target[r] = 0;
    inverted.weights[r] = 0;
  }
  inverted.valid =
      static_cast<double>(usable) >= kLeastInvertible * static_cast<double>(problem_->rows()) &&
      usable > 0;
  return inverted;
}

Scored Scorer::score(const Sequence& sequence) {
  const TokenLibrary& library = problem_->library();
  Expression linear;
  const std::size_t linear_at = position_of(library, sequence, TokenKind::linear);
  if (linear_at < sequence.size()) {
    const InvertedTarget inverted = invert(sequence, linear_at);
    if (!inverted.valid) return {};
    Eigen::VectorXd coefficients = problem_->linear().solve(inverted.target, inverted.weights);
    const double negligible = kCoefficientTolerance * coefficients.cwiseAbs().maxCoeff();
    for (double& c : coefficients) {
      if (std::abs(c) <= negligible) c = 0;
    }
    if (!coefficients.allFinite()) return {};
    linear = polynomial(problem_->linear().terms(),
                        {coefficients.data(), static_cast<std::size_t>(coefficients.size())});
  }
  Expression formula = to_expression(library, sequence, linear);
  if (position_of(library, sequence, TokenKind::constant) < sequence.size()) {
    fitter_.fit(formula, problem_->inputs(), problem_->target());
  }
  const double error = nrmse(formula);
  if (!std::isfinite(error)) return {};
  return {1 / (1 + error), error, std::move(formula)};
}

}  // namespace tribench::udsr
