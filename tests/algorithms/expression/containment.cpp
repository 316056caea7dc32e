// SPDX-License-Identifier: MIT
#include "tests/algorithms/expression/containment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench::testing {
namespace {

const std::vector<std::string> kInputNames = {"v", "g", "t"};
}  // namespace

Box random_box(RandomStream& random, std::size_t inputs) {
  Box box(inputs);
  for (Interval& side : box) {
    const double centre = random.chance(0.3) ? std::round(random.normal()) : 3 * random.normal();
    const double width = random.chance(0.1) ? 0 : std::exp2(random.uniform(-40, 3));
    side = random.chance(0.5) ? Interval{centre, centre + width} : Interval{centre - width, centre};
  }
  return box;
}

std::vector<std::vector<double>> sample_box(RandomStream& random, const Box& box) {
  std::vector<std::vector<double>> columns(box.size(), std::vector<double>(kSamples));
  for (std::size_t i = 0; i < kSamples; ++i) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      const Interval& side = box[j];
      const double inside = side.low + random.uniform() * (side.high - side.low);
      columns[j][i] = i < 8 ? (((i >> j) & 1) != 0 ? side.high : side.low)
                            : std::clamp(inside, side.low, side.high);
    }
  }
  return columns;
}

int count_escapes(const Expression& formula, const std::vector<std::vector<double>>& columns,
                  const Interval& bounds) {
  std::vector<const double*> pointers;
  for (const auto& column : columns) pointers.push_back(column.data());
  std::vector<double> values(kSamples);
  Evaluator().evaluate(formula, {pointers, kSamples}, values);
  int escapes = 0;
  for (const double value : values) escapes += bounds.contains(value) ? 0 : 1;
  return escapes;
}

void expect_containment(std::string_view key, int trials) {
  RandomStream random(key_of(key));
  int bounded = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Expression formula = random_formula(random, {.inputs = 3});
    const Box box = random_box(random, 3);
    const auto columns = sample_box(random, box);
    FormulaBounds bounds(formula);
    for (const bool sharpened : {false, true}) {
      const bool all = sharpened ? bounds.sharpen(box) : bounds.bound(box);
      bounded += all ? 1 : 0;
      const std::size_t known = all ? formula.size() : bounds.failed_node();
      for (std::size_t i = 0; i < known; ++i) {
        if (arity(formula.node(i).op) == 0) continue;
        ASSERT_EQ(count_escapes(subtree(formula, i), columns, bounds.at(i).range), 0)
            << print(subtree(formula, i), kInputNames) << " sharpened " << sharpened << " on v "
            << print_number(box[0].low) << " : " << print_number(box[0].high) << " bounds "
            << print_number(bounds.at(i).range.low) << " : "
            << print_number(bounds.at(i).range.high);
      }
    }
  }
  EXPECT_GT(bounded, trials / 2);
}

}  // namespace tribench::testing
