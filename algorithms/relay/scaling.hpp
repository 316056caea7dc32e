// SPDX-License-Identifier: MIT
//
// Which products of powers of the inputs a function depends on alone: from its slopes by the
// inputs' logarithms. Numbers only; reduction.hpp makes formulas of it.
#pragma once

#include <cstddef>
#include <vector>

namespace tribench::relay {

// T = prod x_j^outer[j] * g(u_1 ... u_k), u_i = prod x_j^inner[i][j].
struct Rescaled {
  std::vector<double> outer;
  std::vector<std::vector<double>> inner;
};

// slopes[j][r]: of T by log x_j; reference[r]: T itself, or 1 where the slopes are of log T; empty
// where c shall be 0. Directions d of small whole numbers along which the slope is c * reference,
// to `tolerance` of the weakest slope in it and c a small fraction, are taken, the simplest first;
// what is left of the inputs is written with the exponents of least size, in the two shortest ways.
// Empty where there is no such direction.
std::vector<Rescaled> find_scalings(const std::vector<std::vector<double>>& slopes,
                                    const std::vector<double>& reference, double tolerance);

// Mean of a[r] * b[r]; both of one size, not empty.
double mean_product(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace tribench::relay
