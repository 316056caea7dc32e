// SPDX-License-Identifier: MIT
#include "algorithms/expression/canonical.hpp"

#include <cmath>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench {
namespace {

// Whether a product of constants can be folded: neither overflows nor underflows to 0.
bool folds(double a, double b) {
  const double product = a * b;
  return std::isfinite(product) && (product != 0 || a == 0 || b == 0);
}

// A handful of parts, nearly sorted: insertion beats std::sort.
void sort_parts(const CanonicalForms& forms, std::vector<CanonicalForms::Part>& parts) {
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const CanonicalForms::Part part = parts[i];
    std::size_t j = i;
    for (; j > 0 && forms.precedes(part, parts[j - 1]); --j) parts[j] = parts[j - 1];
    parts[j] = part;
  }
}

void merge_terms(const CanonicalForms& forms, std::vector<CanonicalForms::Part>& terms) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (kept > 0 && forms.same_base(terms[kept - 1], terms[i]) &&
        std::isfinite(terms[kept - 1].number + terms[i].number)) {
      terms[kept - 1].number += terms[i].number;
    } else {
      terms[kept++] = terms[i];
    }
  }
  terms.resize(kept);
  std::erase_if(terms, [&](const auto& p) { return p.number == 0 && forms.is_finite(p.item); });
}

void merge_factors(const CanonicalForms& forms, std::vector<CanonicalForms::Part>& factors) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const CanonicalForms::Part& part = factors[i];
    if (kept > 0 && forms.same_base(factors[kept - 1], part)) {
      CanonicalForms::Part& last = factors[kept - 1];
      const bool same_side = (last.number > 0) == (part.number > 0);
      if (std::abs(last.number + part.number) <= kLargestProductPower &&
          (same_side || forms.is_non_zero(part.item))) {
        last.number += part.number;
        continue;
      }
    }
    factors[kept++] = part;
  }
  factors.resize(kept);
  std::erase_if(factors, [](const auto& p) { return p.number == 0; });
  for (CanonicalForms::Part& part : factors) {
    if (forms.at(part.item).op == Op::sgn && std::abs(part.number) > 2) {
      part.number = std::copysign(std::fmod(part.number, 2.0) == 0 ? 2 : 1, part.number);
    }
  }
}

}  // namespace

std::uint32_t Canonicalizer::build(const Expression& formula) {
  forms_.clear();
  stack_.clear();
  for (const Node& node : formula.nodes()) {
    if (node.is_constant()) {
      stack_.push_back(forms_.constant(node.value));
    } else if (node.is_variable()) {
      stack_.push_back(forms_.variable(node.variable));
    } else {
      const std::uint32_t right = stack_.back();
      if (arity(node.op) == 2) stack_.pop_back();
      stack_.back() = build_node(node.op, stack_.back(), right);
    }
  }
  return stack_.back();
}

std::uint32_t Canonicalizer::build_node(Op op, std::uint32_t left, std::uint32_t right) {
  switch (op) {
    case Op::add:
      return sum(left, right, 1);
    case Op::sub:
      return sum(left, right, -1);
    case Op::mul:
      return product(left, right, 1);
    case Op::div:
      return product(left, right, -1);
    case Op::pow:
      return power(left, right);
    case Op::neg:
      return scaled(right, -1);
    default:
      return function(op, right);
  }
}

void Canonicalizer::add_terms(std::uint32_t index, double coefficient, double& constant) {
  const Item item = forms_.at(index);
  if (item.kind == Kind::constant && std::isfinite(constant + coefficient * item.value)) {
    constant += coefficient * item.value;
  } else if (item.kind == Kind::sum && std::isfinite(constant + coefficient * item.value)) {
    constant += coefficient * item.value;
    for (const Part& part : forms_.parts(item)) {
      scratch_.push_back({part.item, coefficient * part.number});
    }
  } else if (item.kind == Kind::product && item.value != 1 && folds(coefficient, item.value)) {
    scratch_.push_back({forms_.unit_of(index), coefficient * item.value});
  } else {
    scratch_.push_back({index, coefficient});
  }
}

std::uint32_t Canonicalizer::finish_sum(double constant_term) {
  sort_parts(forms_, scratch_);
  merge_terms(forms_, scratch_);
  if (scratch_.empty()) return forms_.constant(constant_term);
  if (constant_term == 0 && scratch_.size() == 1) {
    const Part only = scratch_.front();
    return only.number == 1 ? only.item : scaled(only.item, only.number);
  }
  return forms_.sum(constant_term, scratch_);
}

std::uint32_t Canonicalizer::sum(std::uint32_t a, std::uint32_t b, double coefficient_b) {
  scratch_.clear();
  double constant_term = 0;
  add_terms(a, 1, constant_term);
  add_terms(b, coefficient_b, constant_term);
  return finish_sum(constant_term);
}

// False where the product stays a factor of its own: folding its constant would overflow, or it is
// a power of a quotient (1/(1/x) is not x where x is 0).
bool Canonicalizer::add_product_factors(const Item& product, int exponent, double& coefficient) {
  const double scale = apply(Op::pow, product.value, exponent);
  if (product.value != 1 && !folds(coefficient, scale)) return false;
  for (const Part& part : forms_.parts(product)) {
    const double number = part.number * exponent;
    if (std::abs(number) > kLargestProductPower || (exponent != 1 && part.number < 0)) return false;
  }
  coefficient *= scale;
  for (const Part& part : forms_.parts(product)) {
    scratch_.push_back({part.item, part.number * exponent});
  }
  return true;
}

void Canonicalizer::add_factors(std::uint32_t index, int exponent, double& coefficient) {
  const Item item = forms_.at(index);
  if (item.kind == Kind::constant) {
    const double scale = exponent == -1 ? 1 / item.value : apply(Op::pow, item.value, exponent);
    if (exponent == -1 && folds(coefficient, scale)) {
      coefficient /= item.value;
      return;
    }
    if (folds(coefficient, scale)) {
      coefficient *= scale;
      return;
    }
  }
  if (item.kind == Kind::product && add_product_factors(item, exponent, coefficient)) return;
  if (item.kind == Kind::sum && forms_.leads_negative(item)) {
    if (exponent % 2 != 0) coefficient = -coefficient;
    const std::vector<Part> outer = std::move(scratch_);
    const std::uint32_t flipped = scaled(index, -1);
    scratch_ = outer;
    scratch_.push_back({flipped, static_cast<double>(exponent)});
    return;
  }
  scratch_.push_back({index, static_cast<double>(exponent)});
}

std::uint32_t Canonicalizer::finish_product(double coefficient) {
  sort_parts(forms_, scratch_);
  merge_factors(forms_, scratch_);
  if (scratch_.empty()) return forms_.constant(coefficient);
  if (scratch_.size() == 1 && scratch_.front().number == 1) {
    return scaled(scratch_.front().item, coefficient);
  }
  const std::uint32_t kept = forms_.product(coefficient, scratch_);
  if (coefficient == 0 && forms_.is_finite(kept)) return forms_.constant(0);
  return kept;
}

std::uint32_t Canonicalizer::product(std::uint32_t a, std::uint32_t b, int exponent_b) {
  scratch_.clear();
  double coefficient = 1;
  add_factors(a, 1, coefficient);
  add_factors(b, exponent_b, coefficient);
  return finish_product(coefficient);
}

// factor * item, distributed over a sum.
std::uint32_t Canonicalizer::scaled(std::uint32_t index, double factor) {
  const Item item = forms_.at(index);
  if (factor == 1) return index;
  if (factor == 0 && forms_.is_finite(index)) return forms_.constant(0);
  if (item.kind == Kind::constant && folds(item.value, factor)) {
    return forms_.constant(item.value * factor);
  }
  if (item.kind == Kind::product && folds(item.value, factor)) {
    if (item.value * factor == 1) return forms_.unit_of(index);
    return forms_.with_value(item, item.value * factor);
  }
  scratch_.clear();
  if (item.kind == Kind::sum && factor != 0 && std::isfinite(item.value * factor)) {
    for (const Part& part : forms_.parts(item)) {
      scratch_.push_back({part.item, part.number * factor});
    }
    return forms_.sum(item.value * factor, scratch_);
  }
  scratch_.push_back({index, 1});
  return forms_.product(factor, scratch_);
}

bool is_zero(const Expression& formula) {
  return formula.size() == 1 && formula.node(0).is_constant() && formula.node(0).value == 0;
}

}  // namespace tribench
