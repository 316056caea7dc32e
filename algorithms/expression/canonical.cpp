// SPDX-License-Identifier: MIT
#include "algorithms/expression/canonical.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "algorithms/expression/apply.hpp"
#include "algorithms/expression/evaluate.hpp"

namespace tribench {
namespace {

// SplitMix64's finaliser (Steele, Lea, Flood 2014).
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  return mix(a * 0x9e3779b97f4a7c15ULL + mix(b + 0x9e3779b97f4a7c15ULL));
}

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value == 0 ? 0 : value); }

// Any constant but 1 (or 0 added) is the same to the shape.
std::uint64_t shape_of(double value, double neutral) { return value == neutral ? 1 : 2; }

// Whether a product of constants can be folded: neither overflows nor underflows to 0.
bool folds(double a, double b) {
  const double product = a * b;
  return std::isfinite(product) && (product != 0 || a == 0 || b == 0);
}

}  // namespace

CanonicalHash Canonicalizer::hash(const Expression& formula) { return items_[build(formula)].hash; }

Expression Canonicalizer::canonical(const Expression& formula) { return emit(build(formula)); }

std::uint32_t Canonicalizer::build(const Expression& formula) {
  items_.clear();
  parts_.clear();
  stack_.clear();
  for (const Node& node : formula.nodes()) {
    if (node.is_constant()) {
      stack_.push_back(constant(node.value));
    } else if (node.is_variable()) {
      stack_.push_back(variable(node.variable));
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

std::uint32_t Canonicalizer::push(Item item) {
  items_.push_back(item);
  return static_cast<std::uint32_t>(items_.size() - 1);
}

std::uint32_t Canonicalizer::constant(double value) {
  Item item;
  item.value = value == 0 ? 0 : value;
  item.is_total = std::isfinite(value);
  item.hash = {mix(1, bits_of(value)), mix(1, 2)};
  return push(item);
}

std::uint32_t Canonicalizer::variable(std::uint16_t column) {
  Item item;
  item.kind = Kind::variable;
  item.variable = column;
  item.hash = {mix(2, column), mix(2, column)};
  return push(item);
}

// ---- sums and products

bool Canonicalizer::precedes(const Part& a, const Part& b) const {
  const Item& x = items_[a.item];
  const Item& y = items_[b.item];
  return std::tie(x.size, x.kind, x.op, x.variable, x.hash.exact, b.number) <
         std::tie(y.size, y.kind, y.op, y.variable, y.hash.exact, a.number);
}

bool Canonicalizer::same_base(const Part& a, const Part& b) const {
  return items_[a.item].hash.exact == items_[b.item].hash.exact;
}

// A handful of parts, nearly sorted: insertion beats std::sort.
void Canonicalizer::sort_scratch() {
  for (std::size_t i = 1; i < scratch_.size(); ++i) {
    const Part part = scratch_[i];
    std::size_t j = i;
    for (; j > 0 && precedes(part, scratch_[j - 1]); --j) scratch_[j] = scratch_[j - 1];
    scratch_[j] = part;
  }
}

void Canonicalizer::seal(Item& item) const {
  const std::uint64_t seed = item.kind == Kind::sum ? 4 : 3;
  const double neutral = item.kind == Kind::sum ? 0 : 1;
  if (item.value == 0) item.value = 0;  // never -0
  std::uint64_t exact = bits_of(item.value);
  std::uint64_t shape = shape_of(item.value, neutral);
  item.size = item.value == neutral ? 1 : 2;
  item.is_total = true;
  for (std::uint32_t p = item.first; p < item.first + item.count; ++p) {
    const Part& part = parts_[p];
    const Item& inner = items_[part.item];
    const bool is_exponent = item.kind == Kind::product;
    exact += mix(inner.hash.exact, bits_of(part.number));
    shape += mix(inner.hash.shape, is_exponent ? bits_of(part.number) : shape_of(part.number, 1));
    item.size += inner.size + (part.number == 1 ? 0 : 1);
    item.is_total = item.is_total && inner.is_total && !(is_exponent && part.number < 0);
  }
  item.hash = {mix(seed, exact), mix(seed, shape)};
}

std::uint32_t Canonicalizer::keep(Item item) {
  item.first = static_cast<std::uint32_t>(parts_.size());
  item.count = static_cast<std::uint32_t>(scratch_.size());
  parts_.insert(parts_.end(), scratch_.begin(), scratch_.end());
  seal(item);
  return push(item);
}

std::uint32_t Canonicalizer::unit_of(std::uint32_t index) {
  Item product = items_[index];
  if (product.count == 1 && parts_[product.first].number == 1) return parts_[product.first].item;
  product.value = 1;
  seal(product);
  return push(product);
}

void Canonicalizer::add_terms(std::uint32_t index, double coefficient, double& constant) {
  const Item item = items_[index];
  if (item.kind == Kind::constant && std::isfinite(constant + coefficient * item.value)) {
    constant += coefficient * item.value;
  } else if (item.kind == Kind::sum && std::isfinite(constant + coefficient * item.value)) {
    constant += coefficient * item.value;
    for (std::uint32_t p = item.first; p < item.first + item.count; ++p) {
      scratch_.push_back({parts_[p].item, coefficient * parts_[p].number});
    }
  } else if (item.kind == Kind::product && item.value != 1 && folds(coefficient, item.value)) {
    scratch_.push_back({unit_of(index), coefficient * item.value});
  } else {
    scratch_.push_back({index, coefficient});
  }
}

void Canonicalizer::merge_terms() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scratch_.size(); ++i) {
    if (kept > 0 && same_base(scratch_[kept - 1], scratch_[i]) &&
        std::isfinite(scratch_[kept - 1].number + scratch_[i].number)) {
      scratch_[kept - 1].number += scratch_[i].number;
    } else {
      scratch_[kept++] = scratch_[i];
    }
  }
  scratch_.resize(kept);
  std::erase_if(scratch_, [this](const Part& p) { return p.number == 0 && is_finite(p.item); });
}

std::uint32_t Canonicalizer::finish_sum(double constant_term) {
  sort_scratch();
  merge_terms();
  if (scratch_.empty()) return constant(constant_term);
  if (constant_term == 0 && scratch_.size() == 1) {
    const Part only = scratch_.front();
    return only.number == 1 ? only.item : scaled(only.item, only.number);
  }
  Item item;
  item.kind = Kind::sum;
  item.value = constant_term;
  return keep(item);
}

std::uint32_t Canonicalizer::sum(std::uint32_t a, std::uint32_t b, double coefficient_b) {
  scratch_.clear();
  double constant_term = 0;
  add_terms(a, 1, constant_term);
  add_terms(b, coefficient_b, constant_term);
  return finish_sum(constant_term);
}

bool Canonicalizer::leads_negative(const Item& item) const {
  if (item.kind == Kind::product) return item.value < 0;
  return item.kind == Kind::sum && parts_[item.first].number < 0;
}

// False where the product stays a factor of its own: folding its constant would overflow, or it is
// a power of a quotient (1/(1/x) is not x where x is 0).
bool Canonicalizer::add_product_factors(const Item& product, int exponent, double& coefficient) {
  const double scale = apply(Op::pow, product.value, exponent);
  if (product.value != 1 && !folds(coefficient, scale)) return false;
  for (std::uint32_t p = product.first; p < product.first + product.count; ++p) {
    const double number = parts_[p].number * exponent;
    if (std::abs(number) > kLargestProductPower || (exponent != 1 && parts_[p].number < 0))
      return false;
  }
  coefficient *= scale;
  for (std::uint32_t p = product.first; p < product.first + product.count; ++p) {
    scratch_.push_back({parts_[p].item, parts_[p].number * exponent});
  }
  return true;
}

void Canonicalizer::add_factors(std::uint32_t index, int exponent, double& coefficient) {
  const Item item = items_[index];
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
  if (item.kind == Kind::sum && leads_negative(item)) {
    if (exponent % 2 != 0) coefficient = -coefficient;
    const std::vector<Part> outer = std::move(scratch_);
    const std::uint32_t flipped = scaled(index, -1);
    scratch_ = outer;
    scratch_.push_back({flipped, static_cast<double>(exponent)});
    return;
  }
  scratch_.push_back({index, static_cast<double>(exponent)});
}

void Canonicalizer::merge_factors() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scratch_.size(); ++i) {
    const Part& part = scratch_[i];
    if (kept > 0 && same_base(scratch_[kept - 1], part)) {
      Part& last = scratch_[kept - 1];
      const bool same_side = (last.number > 0) == (part.number > 0);
      if (std::abs(last.number + part.number) <= kLargestProductPower &&
          (same_side || is_non_zero(part.item))) {
        last.number += part.number;
        continue;
      }
    }
    scratch_[kept++] = part;
  }
  scratch_.resize(kept);
  std::erase_if(scratch_, [](const Part& p) { return p.number == 0; });
  for (Part& part : scratch_) {
    if (items_[part.item].op == Op::sgn && std::abs(part.number) > 2) {
      part.number = std::copysign(std::fmod(part.number, 2.0) == 0 ? 2 : 1, part.number);
    }
  }
}

std::uint32_t Canonicalizer::finish_product(double coefficient) {
  sort_scratch();
  merge_factors();
  if (scratch_.empty()) return constant(coefficient);
  if (scratch_.size() == 1 && scratch_.front().number == 1) {
    return scaled(scratch_.front().item, coefficient);
  }
  Item item;
  item.kind = Kind::product;
  item.value = coefficient == 0 ? 0 : coefficient;
  const std::uint32_t kept = keep(item);
  if (coefficient == 0 && is_finite(kept)) return constant(0);
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
  Item item = items_[index];
  if (factor == 1) return index;
  if (factor == 0 && is_finite(index)) return constant(0);
  if (item.kind == Kind::constant && folds(item.value, factor))
    return constant(item.value * factor);
  if (item.kind == Kind::product && folds(item.value, factor)) {
    if (item.value * factor == 1) return unit_of(index);
    item.value *= factor;
    seal(item);
    return push(item);
  }
  scratch_.clear();
  if (item.kind == Kind::sum && factor != 0 && std::isfinite(item.value * factor)) {
    for (std::uint32_t p = item.first; p < item.first + item.count; ++p) {
      scratch_.push_back({parts_[p].item, parts_[p].number * factor});
    }
    item.value *= factor;
    return keep(item);
  }
  scratch_.push_back({index, 1});
  Item product;
  product.kind = Kind::product;
  product.value = factor;
  return keep(product);
}

// ---- functions

std::uint32_t Canonicalizer::opaque(Op op, std::uint32_t left, std::uint32_t right) {
  Item item;
  item.kind = Kind::function;
  item.op = op;
  item.first = static_cast<std::uint32_t>(parts_.size());
  item.count = op == Op::pow ? 2 : 1;
  item.size = 1 + items_[left].size;
  item.is_total = items_[left].is_total && (op == Op::abs || op == Op::sgn || op == Op::sin ||
                                            op == Op::cos || op == Op::tanh);
  const auto seed = static_cast<std::uint64_t>(op) + 16;
  item.hash = {mix(seed, items_[left].hash.exact), mix(seed, items_[left].hash.shape)};
  parts_.push_back({left, 1});
  if (op == Op::pow) {
    parts_.push_back({right, 1});
    item.size += items_[right].size;
    item.hash.exact = mix(item.hash.exact, items_[right].hash.exact);
    item.hash.shape = mix(item.hash.shape, items_[right].hash.shape);
  }
  return push(item);
}

bool Canonicalizer::is_finite(std::uint32_t item) const {
  return items_[item].is_total || (guard_.is_finite && guard_.is_finite(emit(item)));
}

bool Canonicalizer::is_non_zero(std::uint32_t item) const {
  return guard_.is_non_zero && guard_.is_non_zero(emit(item));
}

}  // namespace tribench
