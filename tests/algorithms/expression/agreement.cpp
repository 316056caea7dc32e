// SPDX-License-Identifier: MIT
#include "tests/algorithms/expression/agreement.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "algorithms/expression/compile.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/random_formula.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/reference.hpp"

namespace tribench {
namespace {

constexpr std::size_t kVariables = 3;
constexpr std::size_t kRows = 16;
const std::vector<std::string> kNames = {"v", "g", "s"};

const RandomFormulas& formulas_of_everything() {
  static const RandomFormulas kFormulas(
      {Op::add, Op::sub, Op::mul, Op::div, Op::pow, Op::neg, Op::exp, Op::log, Op::sqrt, Op::abs,
       Op::sgn, Op::sin, Op::cos, Op::tanh, Op::atan},
      kVariables, {.constant_probability = 0.4, .constant_scale = 2});
  return kFormulas;
}

// Of every operation, deep or balanced; whole exponents among the others.
Expression draw(RandomStream& random) {
  const RandomFormulas& formulas = formulas_of_everything();
  const std::size_t size = 1 + random.below(24);
  Expression formula =
      random.chance(0.5) ? formulas.grown(size, random) : formulas.balanced(size, random);
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula.node(i).op != Op::pow || random.chance(0.3)) continue;
    const std::size_t exponent = formula.last_child(i);
    if (formula.node(exponent).is_constant()) {
      set_constant(formula, exponent, static_cast<double>(random.below(9)) - 3);
    }
  }
  return formula;
}

template <typename T>
class Agreement {
 public:
  explicit Agreement(std::uint64_t seed) : random_(seed), values_(kVariables) {
    RandomStream rows = random_.split("rows");
    for (std::vector<T>& column : values_) {
      for (std::size_t r = 0; r < kRows; ++r) {
        column.push_back(static_cast<T>(rows.uniform(-2, 2)));
      }
      column[3] = 0;
      column[5] = std::numeric_limits<T>::infinity();
      column[6] = std::numeric_limits<T>::quiet_NaN();
      columns_.push_back(column.data());
    }
    for (const VectorLevel level : available_vector_levels()) evaluators_.emplace_back(level);
  }

  // Of the next formula.
  void check() {
    const Expression formula = draw(random_);
    evaluators_.back().evaluate(formula, inputs(), expected_);
    for (std::size_t k = 0; k + 1 < evaluators_.size(); ++k) {
      evaluators_[k].evaluate(formula, inputs(), out_);
      expect_same(formula, "interpreter, another level");
    }
    for (const BasicEvaluator<T>& evaluator : evaluators_) check_code(formula, evaluator.level());
    const Expression again = parse(print(formula, kNames), kNames);
    evaluators_.back().evaluate(again, inputs(), out_);
    expect_same(formula, "printed and parsed");
    for (std::size_t r = 0; r < kRows; ++r) {
      std::vector<T> point;
      for (const std::vector<T>& column : values_) point.push_back(column[r]);
      out_[r] = reference::evaluate<T>(formula, formula.root(), point);
      if constexpr (sizeof(T) == sizeof(double)) check_bound(formula, point, expected_[r]);
    }
    expect_same(formula, "plain recursion");
  }

  // That the bound on the error decides most rows.
  void finish() const {
    if constexpr (sizeof(T) == sizeof(double)) EXPECT_GT(decided_, rows_ / 2);
  }

 private:
  BasicInputs<T> inputs() const { return {columns_, kRows}; }

  void check_code(const Expression& formula, VectorLevel level) {
    auto code = BasicCompiledFormula<T>::compile(formula, level);
    if (!code) return;
    constants_.clear();
    for (const Node& node : formula.nodes()) {
      if (node.is_constant()) constants_.push_back(static_cast<T>(node.value));
    }
    code->evaluate(constants_, inputs(), out_);
    expect_same(formula, "compiled");
  }

  void expect_same(const Expression& formula, const char* way) const {
    for (std::size_t r = 0; r < kRows; ++r) {
      ASSERT_TRUE(same(out_[r], expected_[r])) << way << ": " << print(formula, kNames) << " row "
                                               << r << ": " << out_[r] << ", not " << expected_[r];
    }
  }

  void check_bound(const Expression& formula, std::span<const double> point, double value) {
    const reference::Bounded bound = reference::evaluate_bounded(formula, formula.root(), point);
    ++rows_;
    if (std::isinf(bound.slack)) return;  // a few ulp may cross a pole or the end of a domain
    ++decided_;
    ASSERT_EQ(std::isfinite(value), std::isfinite(bound.value))
        << print(formula, kNames) << ": " << value << ", not " << bound.value;
    if (!std::isfinite(bound.value)) return;
    ASSERT_LE(std::abs(value - bound.value), bound.slack)
        << print(formula, kNames) << ": " << value << ", not " << bound.value;
  }

  RandomStream random_;
  std::vector<std::vector<T>> values_;
  std::vector<const T*> columns_;
  std::vector<BasicEvaluator<T>> evaluators_;
  std::vector<T> expected_ = std::vector<T>(kRows);
  std::vector<T> out_ = std::vector<T>(kRows);
  std::vector<T> constants_;
  long rows_ = 0;
  long decided_ = 0;
};

}  // namespace

template <typename T>
void expect_agreement(std::uint64_t seed, int formulas) {
  Agreement<T> agreement(seed);
  for (int k = 0; k < formulas && !testing::Test::HasFailure(); ++k) agreement.check();
  agreement.finish();
}

template void expect_agreement<double>(std::uint64_t seed, int formulas);
template void expect_agreement<float>(std::uint64_t seed, int formulas);

}  // namespace tribench
