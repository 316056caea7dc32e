// SPDX-License-Identifier: MIT
//
// One form for formulas that are equal, and its hash. Sums and products are flattened and sorted,
// constants folded, like terms collected (2x + 3x), powers merged (x x^2), signs pulled out of odd
// functions and of sums (sin(-x), (b - a)^2); sgn(x)^3 is sgn(x). Products of sums are not
// expanded.
//
// Nothing that can be singular disappears: x - x, 0 x, x^0 and x/x stay as they are (0 x; x/x)
// unless x is built of + - * abs sgn sin cos tanh and integer powers alone, or the caller's guard
// proves the needed fact (see simplify.hpp for guards from a box). Values change by rounding only;
// inputs so large that products overflow are not looked after.
//
// Equality up to the 64-bit hash: two different formulas share one with probability 2^-64.
// Keeps its workspace: one Canonicalizer per thread; hardly an allocation once warm, about 40 ns a
// node (bench/proof_bench).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithms/expression/expression.hpp"

namespace tribench {

struct CanonicalHash {
  std::uint64_t exact = 0;  // constants included, bit for bit after folding
  std::uint64_t shape = 0;  // any coefficient but 1, any constant, counts as the same
  bool operator==(const CanonicalHash&) const = default;
};

// What a rewrite may ask about a subformula. Empty functions answer no.
struct RewriteGuard {
  std::function<bool(const Expression&)> is_finite;    // everywhere on the domain of interest
  std::function<bool(const Expression&)> is_non_zero;  // finite and nowhere 0
};

class Canonicalizer {
 public:
  Canonicalizer() = default;
  explicit Canonicalizer(RewriteGuard guard) : guard_(std::move(guard)) {}

  CanonicalHash hash(const Expression& formula);
  // The canonical form as a tape. Its own canonical form has the same hash, but where it keeps 0
  // times something that may be singular.
  Expression canonical(const Expression& formula);

 private:
  enum class Kind : std::uint8_t { constant, variable, product, sum, function };

  // One node of the canonical tree. A sum is value + sum of number * part, a product is
  // value * product of part ^ number (number a non-zero integer), a function applies op to its
  // parts. Parts lie side by side in parts_.
  struct Item {
    Kind kind = Kind::constant;
    Op op = Op::constant;
    bool is_total = true;  // finite for all finite inputs but for overflow
    std::uint16_t variable = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t size = 1;
    double value = 0;
    CanonicalHash hash;
  };
  struct Part {
    std::uint32_t item = 0;
    double number = 1;
  };

  std::uint32_t build(const Expression& formula);
  std::uint32_t build_node(Op op, std::uint32_t left, std::uint32_t right);
  std::uint32_t constant(double value);
  std::uint32_t variable(std::uint16_t column);
  std::uint32_t sum(std::uint32_t a, std::uint32_t b, double coefficient_b);
  std::uint32_t product(std::uint32_t a, std::uint32_t b, int exponent_b);
  std::uint32_t scaled(std::uint32_t item, double factor);
  std::uint32_t power(std::uint32_t base, std::uint32_t exponent);
  std::uint32_t function(Op op, std::uint32_t argument);
  std::uint32_t magnitude(std::uint32_t argument);
  std::uint32_t opaque(Op op, std::uint32_t left, std::uint32_t right);

  void add_terms(std::uint32_t item, double coefficient, double& constant);
  void add_factors(std::uint32_t item, int exponent, double& coefficient);
  bool add_product_factors(const Item& product, int exponent, double& coefficient);
  void sort_scratch();
  void merge_terms();
  void merge_factors();
  std::uint32_t finish_sum(double constant);
  std::uint32_t finish_product(double coefficient);
  std::uint32_t keep(Item item);  // with the scratch as its parts
  std::uint32_t push(Item item);
  std::uint32_t unit_of(std::uint32_t product);
  void seal(Item& item) const;  // hash, size and totality of a sum or product from its parts
  bool leads_negative(const Item& item) const;
  bool precedes(const Part& a, const Part& b) const;
  bool same_base(const Part& a, const Part& b) const;
  bool is_finite(std::uint32_t item) const;
  bool is_non_zero(std::uint32_t item) const;

  Expression emit(std::uint32_t item) const;
  void emit(std::uint32_t item, std::vector<Node>& tape) const;
  void emit_sum(const Item& item, std::vector<Node>& tape) const;
  void emit_term(std::uint32_t item, double coefficient, std::vector<Node>& tape) const;
  void emit_power(const Part& part, std::vector<Node>& tape) const;
  void emit_product(const Item& item, double coefficient, std::vector<Node>& tape) const;

  RewriteGuard guard_;
  std::vector<Item> items_;
  std::vector<Part> parts_;
  std::vector<Part> scratch_;  // the terms or factors being collected
  std::vector<std::uint32_t> stack_;
};

}  // namespace tribench
