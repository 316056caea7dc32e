// SPDX-License-Identifier: MIT
//
// One form for formulas that are equal, and its hash. Sums and products are flattened and sorted,
// constants folded, like terms collected (2x + 3x), powers merged (x x^2), signs pulled out of odd
// functions and of sums (sin(-x), (b - a)^2); sgn(x)^3 is sgn(x). Products of sums are not
// expanded.
//
// Nothing that can be singular disappears: x - x, 0 x, x^0 and x/x stay as they are (0 x; x/x)
// unless x is built of + - * abs sgn sin cos tanh atan and integer powers alone, or the caller's
// guard proves the needed fact (see simplify.hpp for guards from a box). Values change by rounding
// only; inputs so large that products overflow are not looked after.
//
// Equality up to the 64-bit hash: two different formulas share one with probability 2^-64.
// Keeps its workspace: one Canonicalizer per thread; hardly an allocation once warm, about 40 ns a
// node (bench/proof_bench).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "algorithms/expression/canonical_forms.hpp"
#include "algorithms/expression/expression.hpp"

namespace tribench {

class Canonicalizer {
 public:
  Canonicalizer() = default;
  explicit Canonicalizer(RewriteGuard guard) : forms_(std::move(guard)) {}

  CanonicalHash hash(const Expression& formula) { return forms_.at(build(formula)).hash; }
  // The canonical form as a tape. Its own canonical form has the same hash, but where it keeps 0
  // times something that may be singular.
  Expression canonical(const Expression& formula) { return written_out(forms_, build(formula)); }

 private:
  using Kind = CanonicalForms::Kind;
  using Item = CanonicalForms::Item;
  using Part = CanonicalForms::Part;

  std::uint32_t build(const Expression& formula);
  std::uint32_t build_node(Op op, std::uint32_t left, std::uint32_t right);
  std::uint32_t sum(std::uint32_t a, std::uint32_t b, double coefficient_b);
  std::uint32_t product(std::uint32_t a, std::uint32_t b, int exponent_b);
  std::uint32_t scaled(std::uint32_t item, double factor);
  std::uint32_t power(std::uint32_t base, std::uint32_t exponent);
  std::uint32_t function(Op op, std::uint32_t argument);
  std::uint32_t magnitude(std::uint32_t argument);

  // Collect in the scratch; `finish` makes one node of what was collected.
  void add_terms(std::uint32_t item, double coefficient, double& constant);
  void add_factors(std::uint32_t item, int exponent, double& coefficient);
  bool add_product_factors(const Item& product, int exponent, double& coefficient);
  std::uint32_t finish_sum(double constant);
  std::uint32_t finish_product(double coefficient);

  CanonicalForms forms_;
  std::vector<Part> scratch_;  // the terms or factors being collected
  std::vector<std::uint32_t> stack_;
};

// Whether it is the constant 0, as what cancels is in canonical form.
bool is_zero(const Expression& formula);

}  // namespace tribench
