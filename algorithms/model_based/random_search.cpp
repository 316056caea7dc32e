// SPDX-License-Identifier: MIT
#include "algorithms/model_based/random_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "algorithms/admission.hpp"
#include "algorithms/expression/build.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/constant_fit.hpp"

namespace tribench {
namespace {

struct Found {
  Expression formula;
  double mean_square = 0;
};

// A random formula with about `size` nodes.
void grow(RandomStream& random, std::span<const Op> operators, std::size_t inputs, std::size_t size,
          std::vector<Node>& tape) {
  if (size <= 1) {
    tape.push_back(random.chance(0.5) ? Node::constant(random.normal())
                                      : Node::input(random.below(inputs)));
    return;
  }
  const Op op = operators[random.below(operators.size())];
  if (op == Op::pow) {  // integer powers only
    grow(random, operators, inputs, size > 2 ? size - 2 : 1, tape);
    tape.push_back(Node::constant(static_cast<double>(2 + random.below(2))));
  } else if (arity(op) == 2) {
    const std::size_t left = 1 + random.below(std::max<std::size_t>(1, size - 2));
    grow(random, operators, inputs, left, tape);
    grow(random, operators, inputs, size > left + 1 ? size - 1 - left : 1, tape);
  } else {
    grow(random, operators, inputs, size - 1, tape);
  }
  tape.push_back({0, 1, 0, op});
}

// offset + factor * f with the best two numbers; nothing where f is not finite on the rows.
std::optional<Found> scaled(const Expression& f, std::span<const double> values,
                            std::span<const double> target) {
  const auto n = static_cast<double>(values.size());
  double mean_f = 0;
  double mean_y = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    mean_f += values[row] / n;
    mean_y += target[row] / n;
  }
  double variance = 0;
  double covariance = 0;
  double total = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    variance += (values[row] - mean_f) * (values[row] - mean_f);
    covariance += (values[row] - mean_f) * (target[row] - mean_y);
    total += (target[row] - mean_y) * (target[row] - mean_y);
  }
  if (!std::isfinite(variance) || !(variance > 0)) return std::nullopt;
  const double factor = covariance / variance;
  const double error = (total - factor * covariance) / n;
  using namespace build;
  return Found{constant(mean_y - factor * mean_f) + constant(factor) * f, error};
}

class RandomSearch : public Regressor {
 public:
  explicit RandomSearch(const Parameters& parameters)
      : formulas_(parameters.integer("formulas")),
        size_(static_cast<std::size_t>(parameters.integer("size"))) {}

  FitResult fit(FitContext& context) const override;

 private:
  std::int64_t formulas_;
  std::size_t size_;
};

FitResult RandomSearch::fit(FitContext& context) const {
  const FiniteRows data(context.data);
  const std::vector<Op>& operators = context.operators.operators();
  if (data.rows() == 0) return FitResult::unsupported("there is no row without missing values");
  if (operators.empty() || data.columns.empty()) {
    return FitResult::unsupported("random search needs inputs and operators");
  }
  const Admission admission(context);
  RandomStream random = context.random.split("random_search");
  Evaluator evaluator;
  std::vector<double> values(data.rows());
  std::map<int, Found> best;  // by complexity
  double least = std::numeric_limits<double>::infinity();
  FitResult result;
  for (std::int64_t i = 0; i < formulas_; ++i) {
    std::vector<Node> tape;
    grow(random, operators, data.columns.size(), 1 + random.below(size_), tape);
    const Expression formula(std::move(tape));
    if (!context.budget.spend(node_rows(formula, data.rows()))) {
      result.reason = StopReason::budget;
      break;
    }
    evaluator.evaluate(formula, data.table(), values);
    const auto found = scaled(formula, values, data.target);
    if (!found) continue;
    const int complexity = paper_complexity(found->formula);
    const auto place = best.find(complexity);
    if (place != best.end() && place->second.mean_square <= found->mean_square) continue;
    if (!admission.admits(found->formula)) continue;
    best.insert_or_assign(complexity, *found);
    if (found->mean_square >= least) continue;
    least = found->mean_square;
    if (context.progress != nullptr) context.progress->improved(least, context.budget.spent());
  }
  least = std::numeric_limits<double>::infinity();
  for (const auto& [complexity, found] : best) {
    if (found.mean_square >= least) continue;
    least = found.mean_square;
    result.front.push_back(found.formula);
  }
  result.chosen = result.front.empty() ? 0 : result.front.size() - 1;
  return result;
}

}  // namespace

AlgorithmEntry random_search_entry() {
  return {"random_search",
          "placebo: the best of many random formulas",
          {{"formulas", "formulas drawn", std::int64_t{20000}, 1, 1e9},
           {"size", "largest number of nodes drawn", std::int64_t{20}, 1, 200}},
          false,
          [](const Parameters& parameters, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<RandomSearch>(parameters);
          }};
}

}  // namespace tribench
