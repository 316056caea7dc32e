// SPDX-License-Identifier: MIT
#include "algorithms/expression/canonical_forms.hpp"

#include <bit>
#include <cmath>
#include <tuple>

namespace tribench {
namespace {

using Kind = CanonicalForms::Kind;
using Item = CanonicalForms::Item;
using Part = CanonicalForms::Part;

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

// Appends what is not yet among the parts and names its place in the item.
void place_parts(std::span<const Part> added, std::vector<Part>& parts, Item& item) {
  item.first = static_cast<std::uint32_t>(parts.size());
  item.count = static_cast<std::uint32_t>(added.size());
  parts.insert(parts.end(), added.begin(), added.end());
}

std::uint32_t appended(const Item& item, std::vector<Item>& items) {
  items.push_back(item);
  return static_cast<std::uint32_t>(items.size() - 1);
}

// Hash, size and totality of a sum or product from its parts.
void seal(const CanonicalForms& forms, Item& item) {
  const std::uint64_t seed = item.kind == Kind::sum ? 4 : 3;
  const double neutral = item.kind == Kind::sum ? 0 : 1;
  if (item.value == 0) item.value = 0;  // never -0
  std::uint64_t exact = bits_of(item.value);
  std::uint64_t shape = shape_of(item.value, neutral);
  item.size = item.value == neutral ? 1 : 2;
  item.is_total = true;
  for (const Part& part : forms.parts(item)) {
    const Item& inner = forms.at(part.item);
    const bool is_exponent = item.kind == Kind::product;
    exact += mix(inner.hash.exact, bits_of(part.number));
    shape += mix(inner.hash.shape, is_exponent ? bits_of(part.number) : shape_of(part.number, 1));
    item.size += inner.size + (part.number == 1 ? 0 : 1);
    item.is_total = item.is_total && inner.is_total && !(is_exponent && part.number < 0);
  }
  item.hash = {mix(seed, exact), mix(seed, shape)};
}

}  // namespace

void CanonicalForms::clear() {
  items_.clear();
  parts_.clear();
}

std::uint32_t CanonicalForms::constant(double value) {
  Item item;
  item.value = value == 0 ? 0 : value;
  item.is_total = std::isfinite(value);
  item.hash = {mix(1, bits_of(value)), mix(1, 2)};
  return appended(item, items_);
}

std::uint32_t CanonicalForms::variable(std::uint16_t column) {
  Item item;
  item.kind = Kind::variable;
  item.variable = column;
  item.hash = {mix(2, column), mix(2, column)};
  return appended(item, items_);
}

std::uint32_t CanonicalForms::sum(double value, std::span<const Part> terms) {
  Item item;
  item.kind = Kind::sum;
  place_parts(terms, parts_, item);
  return with_value(item, value);
}

std::uint32_t CanonicalForms::product(double value, std::span<const Part> factors) {
  Item item;
  item.kind = Kind::product;
  place_parts(factors, parts_, item);
  return with_value(item, value);
}

std::uint32_t CanonicalForms::with_value(Item item, double value) {
  item.value = value;
  seal(*this, item);
  return appended(item, items_);
}

std::uint32_t CanonicalForms::opaque(Op op, std::uint32_t left, std::uint32_t right) {
  Item item;
  item.kind = Kind::function;
  item.op = op;
  item.first = static_cast<std::uint32_t>(parts_.size());
  item.count = op == Op::pow ? 2 : 1;
  item.size = 1 + items_[left].size;
  item.is_total = items_[left].is_total && (op == Op::abs || op == Op::sgn || op == Op::sin ||
                                            op == Op::cos || op == Op::tanh || op == Op::atan);
  const auto seed = static_cast<std::uint64_t>(op) + 16;
  item.hash = {mix(seed, items_[left].hash.exact), mix(seed, items_[left].hash.shape)};
  parts_.push_back({left, 1});
  if (op == Op::pow) {
    parts_.push_back({right, 1});
    item.size += items_[right].size;
    item.hash.exact = mix(item.hash.exact, items_[right].hash.exact);
    item.hash.shape = mix(item.hash.shape, items_[right].hash.shape);
  }
  return appended(item, items_);
}

std::uint32_t CanonicalForms::unit_of(std::uint32_t index) {
  const Item product = items_[index];
  if (product.count == 1 && parts_[product.first].number == 1) return parts_[product.first].item;
  return with_value(product, 1);
}

bool CanonicalForms::precedes(const Part& a, const Part& b) const {
  const Item& x = items_[a.item];
  const Item& y = items_[b.item];
  return std::tie(x.size, x.kind, x.op, x.variable, x.hash.exact, b.number) <
         std::tie(y.size, y.kind, y.op, y.variable, y.hash.exact, a.number);
}

bool CanonicalForms::same_base(const Part& a, const Part& b) const {
  return items_[a.item].hash.exact == items_[b.item].hash.exact;
}

bool CanonicalForms::leads_negative(const Item& item) const {
  if (item.kind == Kind::product) return item.value < 0;
  return item.kind == Kind::sum && parts_[item.first].number < 0;
}

bool CanonicalForms::is_finite(std::uint32_t item) const {
  return items_[item].is_total || (guard_.is_finite && guard_.is_finite(written_out(*this, item)));
}

bool CanonicalForms::is_non_zero(std::uint32_t item) const {
  return guard_.is_non_zero && guard_.is_non_zero(written_out(*this, item));
}

}  // namespace tribench
