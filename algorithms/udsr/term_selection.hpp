// SPDX-License-Identifier: MIT
//
// The linear token by itself, at twice its degree, with its terms selected by the evidence: sparse
// polynomials in the inputs.
//
// Inside a formula the token's degree is kept low, since what stands above it is inverted and every
// sequence pays for all its terms. By itself it is a linear regression, in which hundreds of
// subsets of terms are compared in milliseconds. Dropping terms one by one (pruning.hpp) finds one
// path through them; noise lets many others within two nats.
//
// Source: beam search over subsets by the size of the residual, level by level, after the
// all-subset regression of Furnival & Wilson 1974, which it equals wherever the beam holds every
// subset that leads to a best one.
#pragma once

#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/udsr/scoring.hpp"

namespace tribench::udsr {

// Monomials up to a total degree in the inputs that are no signs, each with and without each sign:
// a polynomial of its own on either side of zero. The degree is `degree` or the highest for which
// every term has five rows; no monomial has more than its cap (exponent_caps).
std::vector<Monomial> wide_terms(std::span<const Input> inputs, int degree, std::size_t rows);

// The polynomials of at most 12 of these terms with the most evidence, the best first: at most 100,
// none with less than exp(-15) of the best one's. Coefficients by least squares. Where
// the seconds run out, of as many terms as were looked at by then.
std::vector<Expression> select_terms(std::span<const Monomial> terms, const ScoringProblem& problem,
                                     Budget& budget);

}  // namespace tribench::udsr
