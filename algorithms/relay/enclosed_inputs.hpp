// SPDX-License-Identifier: MIT
//
// Fewer inputs, read off a formula that was found: where it reads a and b only as a*b, the law
// hardly reads them otherwise, whatever it makes of the product; and what the formula does not read
// at all the law hardly needs.
//
// Under noise, where no polynomial's slopes say what depends on what (reduction.hpp): a search that
// has come near a law often has its inner quantity before its outer function.
//
// Source: recursion on simpler problems, Udrescu et al. 2020 (AI Feynman 2.0), there where a test
// of symmetry says so; here the best formula so far does.
#pragma once

#include <cstddef>
#include <optional>

#include "algorithms/expression/expression.hpp"
#include "algorithms/relay/reduction.hpp"

namespace tribench::relay {

// A guess: y = g(inputs), `inputs` the smallest parts of the formula, itself not among them, that
// have two inputs to themselves, and what else it reads. None where g would have as many inputs as
// the `inputs` that the problem has, or none.
std::optional<Reduction> enclosed_inputs(const Expression& found, std::size_t inputs);

}  // namespace tribench::relay
