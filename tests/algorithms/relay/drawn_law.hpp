// SPDX-License-Identifier: MIT
//
// Rows of a law drawn over a box, for tests of searches.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/regressor.hpp"
#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench::testing {

struct DrawnInput {
  std::string name;
  double low;
  double high;
  bool is_log = false;       // drawn uniformly in its logarithm
  bool either_sign = false;  // half of the values turned
};

struct DrawnLaw {
  std::vector<Input> inputs;
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::vector<const double*> pointers;
  std::vector<double> target;

  DrawnLaw(const std::string& law, const std::vector<DrawnInput>& drawn, std::size_t rows,
           double noise = 0, std::uint64_t seed = 1) {
    RandomStream random(seed);
    for (const DrawnInput& input : drawn) {
      std::vector<double>& column = columns.emplace_back();
      for (std::size_t r = 0; r < rows; ++r) {
        double value = input.is_log ? elementary::exp(random.uniform(elementary::log(input.low),
                                                                     elementary::log(input.high)))
                                    : random.uniform(input.low, input.high);
        if (input.either_sign && random.chance(0.5)) value = -value;
        column.push_back(value);
      }
      names.push_back(input.name);
      Input described;
      described.name = input.name;
      described.low = input.either_sign ? -input.high : input.low;
      described.high = input.high;
      inputs.push_back(described);
    }
    for (const auto& column : columns) pointers.push_back(column.data());
    target.resize(rows);
    Evaluator().evaluate(parse(law, names), {pointers, rows}, target);
    double square = 0;
    for (const double y : target) square += y * y / static_cast<double>(rows);
    for (double& y : target) y += noise * std::sqrt(square) * random.normal();
  }
  DrawnLaw(const DrawnLaw&) = delete;
  DrawnLaw& operator=(const DrawnLaw&) = delete;

  TrainingData data() const { return {inputs, pointers, target, {}}; }

  // Root mean square of what a formula leaves, of the target's.
  double error_of(const Expression& formula) const {
    std::vector<double> values(target.size());
    Evaluator().evaluate(formula, {pointers, target.size()}, values);
    double left = 0;
    double whole = 0;
    for (std::size_t r = 0; r < values.size(); ++r) {
      left += (values[r] - target[r]) * (values[r] - target[r]);
      whole += target[r] * target[r];
    }
    return std::sqrt(left / whole);
  }
};

}  // namespace tribench::testing
