// SPDX-License-Identifier: MIT
//
// What a formula's value changes by with its constants, in every row.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

// A row for each row of `inputs`, a column for each of the constants at `places` on the tape;
// `values` gets the formula's own, a row each. NaN and infinity stay where they arise. Cost: some
// two evaluations and one more for every constant.
Eigen::MatrixXd jacobian_of(const Expression& formula, std::span<const std::size_t> places,
                            const Inputs& inputs, std::span<double> values);

}  // namespace tribench
