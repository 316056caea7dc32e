// SPDX-License-Identifier: MIT
//
// Formulas that no one would want between the rows: a power of 90 that fits one row under noise,
// and has 1e40 where another input is as in the next row. Evidence, which looks at the rows, does
// not see it; the box's proof only says that it is finite.
//
// Asked at crossed rows: each input as in some row, chosen for each at random, signs with what they
// are the signs of. What is there farther from the target's mean than ten times the target's range
// strays. Where it has no value says nothing: a root of a difference may have none where inputs
// that hang together are taken apart.
//
// Not a verdict alone: a product of inputs over decades does have such values. Where nothing that
// stays near comes as close to the rows, a formula that strays fits more than noise
// (harness/finished_front.cpp).
#pragma once

#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/input_box.hpp"

namespace tribench {

class CrossedRows {
 public:
  // Finite rows, at least one; always the same crossings of the same rows.
  CrossedRows(const Inputs& inputs, std::span<const double> target, const InputBox& box);
  CrossedRows(const CrossedRows&) = delete;
  CrossedRows& operator=(const CrossedRows&) = delete;

  // Cost: an evaluation on a thousand rows.
  bool strays(const Expression& formula);

 private:
  double mean_ = 0;
  double range_ = 0;
  std::vector<std::vector<double>> columns_;
  std::vector<const double*> pointers_;
  std::vector<double> values_;
  Evaluator evaluator_;
};

}  // namespace tribench
