// SPDX-License-Identifier: MIT
//
// The nodes of canonical formulas, each with its hash, and what may be asked of them. Nodes are
// made, never changed; a node names others by their index. Which node a formula becomes is
// canonical.hpp's.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
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

class CanonicalForms {
 public:
  enum class Kind : std::uint8_t { constant, variable, product, sum, function };

  // A sum is value + sum of number * part, a product is value * product of part ^ number (number a
  // non-zero integer), a function applies op to its parts. Parts lie side by side.
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

  CanonicalForms() = default;
  explicit CanonicalForms(RewriteGuard guard) : guard_(std::move(guard)) {}

  void clear();
  const Item& at(std::uint32_t item) const { return items_[item]; }
  std::span<const Part> parts(const Item& item) const {
    return std::span(parts_).subspan(item.first, item.count);
  }

  // Each adds a node and returns its index.
  std::uint32_t constant(double value);
  std::uint32_t variable(std::uint16_t column);
  std::uint32_t sum(double value, std::span<const Part> terms);
  std::uint32_t product(double value, std::span<const Part> factors);
  std::uint32_t with_value(Item product, double value);
  // right: of a power alone.
  std::uint32_t opaque(Op op, std::uint32_t left, std::uint32_t right);
  // The product without its constant; its only factor where it has one.
  std::uint32_t unit_of(std::uint32_t product);

  // The order of parts; parts of one base stand side by side in it.
  bool precedes(const Part& a, const Part& b) const;
  bool same_base(const Part& a, const Part& b) const;
  bool leads_negative(const Item& item) const;
  bool is_finite(std::uint32_t item) const;
  bool is_non_zero(std::uint32_t item) const;

 private:
  RewriteGuard guard_;
  std::vector<Item> items_;
  std::vector<Part> parts_;
};

// A node written back as a tape (canonical_emit.cpp).
Expression written_out(const CanonicalForms& forms, std::uint32_t item);

}  // namespace tribench
