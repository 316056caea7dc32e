// SPDX-License-Identifier: MIT
//
// From a token sequence to a formula with its constants, and to a reward.
//
// Reward (Petersen et al. 2021, eq. 3): 1 / (1 + NRMSE), NRMSE = sqrt(mean((y - f)^2) / var(y));
// 0 where the formula is not finite on a training row (no protected operators).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/regressor.hpp"
#include "algorithms/udsr/linear_token.hpp"
#include "algorithms/udsr/token.hpp"

namespace tribench::udsr {

struct Scored {
  double reward = 0;
  double nrmse = 0;
  Expression formula;  // empty where the reward is 0
};

bool is_sign(const Input& input);

// The degree asked for, or the highest below it whose polynomial has at least two rows a
// coefficient and no more than kMostLinearTerms of them; at least 1.
inline constexpr double kMostLinearTerms = 500;  // a weighted solve of more takes a second
int affordable_degree(std::span<const Input> inputs, int degree, std::size_t rows);

// The highest power of each input in a polynomial of this degree, the declared priors kept. The
// square of a sign is 1: higher powers would only repeat it.
std::vector<int> exponent_caps(std::span<const Input> inputs, int degree);

// The rows of one problem and what scoring needs of them. Immutable: threads may share it.
class ScoringProblem {
 public:
  // Rows with a value that is not finite are left out. degree: of the linear token, at most
  // (affordable_degree).
  ScoringProblem(const TrainingData& data, const TokenLibrary& library, int degree);

  const TokenLibrary& library() const { return *library_; }
  Inputs inputs() const { return data_.table(); }
  std::span<const double> target() const { return data_.target; }
  std::span<const int> movement() const { return data_.movement; }
  double variance() const { return variance_; }
  const PolynomialRegression& linear() const { return linear_; }
  std::size_t rows() const { return data_.rows(); }

 private:
  const TokenLibrary* library_;
  FiniteRows data_;
  double variance_ = 0;
  PolynomialRegression linear_;
};

// What stands above the linear token, undone: the values it should have and how much an error in
// each moves the formula. valid is false where too few rows can be inverted.
struct InvertedTarget {
  bool valid = false;
  Eigen::VectorXd target;
  Eigen::VectorXd weights;  // empty: all one
};

// Scores sequences; keeps its workspace. One per thread.
class Scorer {
 public:
  explicit Scorer(const ScoringProblem& problem) : problem_(&problem) {}

  Scored score(const Sequence& sequence);
  // Normalised root mean square error; infinite where a value is not finite.
  double nrmse(const Expression& formula);

 private:
  InvertedTarget invert(const Sequence& sequence, std::size_t linear_at);
  void invert_level(const Sequence& sequence, std::size_t at, std::size_t left, bool linear_left,
                    InvertedTarget& inverted);

  const ScoringProblem* problem_;
  Evaluator evaluator_;
  ConstantFitter fitter_;
  std::vector<double> values_;
};

// The sequence as a formula, constants 1, the linear token replaced by `linear`.
Expression to_expression(const TokenLibrary& library, std::span<const TokenId> sequence,
                         const Expression& linear);

// What scoring a sequence costs, known before it is done: node-rows.
std::uint64_t scoring_cost(const ScoringProblem& problem, const Sequence& sequence);

}  // namespace tribench::udsr
