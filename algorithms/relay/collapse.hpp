// SPDX-License-Identifier: MIT
//
// Fewer variables: y = prod f_i^a_i * g(prod f_i^b_i), a law of many inputs as a function g of one.
// It is what dimensional analysis gives where units are known; here the rows tell. For exponents b
// the rows are put in the order of prod f_i^b_i; what log |y| then has beyond a product of powers
// is smooth from row to row, and the differences from neighbours' interpolation are small, where b
// is right and only there.
//
// Source: differencing estimators of partially linear models, Yatchew 1997; Buckingham 1914.
#pragma once

#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/relay/log_rows.hpp"

namespace tribench::relay {

struct Collapse {
  Expression outer;
  Expression inner;
  // What is rough, of what a product of powers alone leaves: 1 where the order says nothing.
  double roughness = 1;
  bool is_smooth = false;  // not only plausible by its exponents
};

// The smoothest, best first, at most `most`; those rougher than 0.05 are left out, but for
// those with a_i that are halves to 3e-4. Factors are the
// inputs, their sines and cosines, and sums and differences (factors.hpp). `orders`: how many inner
// products are tried, short ones first. Fewer than two inputs: none.
// Cost: some 50 us an order for 500 rows and five inputs.
std::vector<Collapse> find_collapses(const LogRows& rows, const OperatorSet& operators,
                                     std::size_t orders, std::size_t most, Budget& budget);

}  // namespace tribench::relay
