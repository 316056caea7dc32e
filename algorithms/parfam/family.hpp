// SPDX-License-Identifier: MIT
//
// ParFam's parametric families f(x) = Q_out(x, g_1(Q_1(x)), ..., g_k(Q_k(x))) with every Q a ratio
// of polynomials, and the grids over them in order of cost.
//
// Source: Scholl et al. 2023, and the published program's get_complete_model_parameter_list.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "algorithms/expression/operator_set.hpp"
#include "algorithms/parfam/monomials.hpp"

namespace tribench::parfam {

struct Family {
  int degree_in = 0;  // of each Q_i's numerator
  int degree_in_denominator = 0;
  int degree_out = 1;
  int degree_out_denominator = 0;
  std::vector<Op> functions;      // g_1 .. g_k
  bool enforce_function = false;  // only monomials that hold a g in the output's numerator

  bool operator==(const Family&) const = default;
};
std::string describe(const Family& family);
// The family that "2/0 exp 2/0" names: the output's degrees, then, where there are any, the
// functions (separated by commas) and the degrees of their arguments. Throws Error (bad_input).
Family parse_family(const std::string& text);
// Whether the operators have its functions and, where it has denominators, a division.
bool is_within(const Family& family, const OperatorSet& operators);

// What a grid ranges over.
struct GridLimits {
  int degree_in = 2;
  int degree_in_denominator = 1;
  int degree_out = 2;
  int degree_out_denominator = 1;
  int functions = 1;  // at once
  std::vector<Op> base_functions = {Op::sqrt, Op::cos, Op::exp};
  bool both_enforce = false;
};
// The wrapper's default (51 families) and that of the Feynman experiments (589).
GridLimits small_grid();
GridLimits big_grid();

// The published order: the polynomial of the highest degree; rational functions; then families
// with functions, cheap to expensive.
std::vector<Family> published_grid(const GridLimits& limits);

// The monomials of one family over given inputs, as explicit lists that may be thinned out.
// Parameters in the published order: for each function its numerator's coefficients and then its
// denominator's; the output's numerator; the output's denominator. A denominator of degree 0 is 1
// and has no parameters.
struct Structure {
  std::size_t inputs = 0;
  std::vector<Op> functions;
  std::vector<std::vector<Monomial>> numerators;    // per function, over the inputs
  std::vector<std::vector<Monomial>> denominators;  // per function, may be empty
  std::vector<Monomial> out_numerator;              // over the inputs, then the functions
  std::vector<Monomial> out_denominator;            // may be empty

  std::size_t inner_parameters() const;
  std::size_t parameters() const {
    return inner_parameters() + out_numerator.size() + out_denominator.size();
  }
};

inline constexpr int kMaximalPotence = 3;  // the published cap on an input's exponent

// caps: per input.
Structure make_structure(const Family& family, std::span<const int> caps);
// The parameters that it would have, without making it.
double parameter_count(const Family& family, std::span<const int> caps);

}  // namespace tribench::parfam
