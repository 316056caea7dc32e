// SPDX-License-Identifier: MIT
//
// The canonical tree written back as a tape.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/expression/canonical_forms.hpp"

namespace tribench {
namespace {

using Kind = CanonicalForms::Kind;
using Item = CanonicalForms::Item;
using Part = CanonicalForms::Part;

class CanonicalWriter {
 public:
  explicit CanonicalWriter(const CanonicalForms& forms) : forms_(forms) {}
  void emit(std::uint32_t item);
  std::vector<Node> take() { return std::move(tape_); }

 private:
  void emit_sum(const Item& item);
  void emit_term(std::uint32_t item, double coefficient);
  void emit_power(const Part& part);
  void emit_product(const Item& item, double coefficient);

  const CanonicalForms& forms_;
  std::vector<Node> tape_;
};

void CanonicalWriter::emit(std::uint32_t index) {
  const Item& item = forms_.at(index);
  switch (item.kind) {
    case Kind::constant:
      tape_.push_back(Node::constant(item.value));
      return;
    case Kind::variable:
      tape_.push_back(Node::input(item.variable));
      return;
    case Kind::sum:
      return emit_sum(item);
    case Kind::product:
      return emit_product(item, item.value);
    case Kind::function:
      for (const Part& part : forms_.parts(item)) emit(part.item);
      tape_.push_back({0, 0, 0, item.op});
      return;
  }
}

void CanonicalWriter::emit_term(std::uint32_t index, double coefficient) {
  if (forms_.at(index).kind == Kind::product && forms_.at(index).value == 1) {
    return emit_product(forms_.at(index), coefficient);
  }
  if (coefficient != 1 && coefficient != -1) tape_.push_back(Node::constant(coefficient));
  emit(index);
  if (coefficient == -1) tape_.push_back({0, 0, 0, Op::neg});
  if (coefficient != 1 && coefficient != -1) tape_.push_back({0, 0, 0, Op::mul});
}

void CanonicalWriter::emit_sum(const Item& item) {
  bool is_first = true;
  for (const auto& [term, number] : forms_.parts(item)) {
    if (std::exchange(is_first, false)) {
      emit_term(term, number);
      continue;
    }
    emit_term(term, std::abs(number));
    tape_.push_back({0, 0, 0, number < 0 ? Op::sub : Op::add});
  }
  if (item.value == 0) return;
  tape_.push_back(Node::constant(std::abs(item.value)));
  tape_.push_back({0, 0, 0, item.value < 0 ? Op::sub : Op::add});
}

// Numerator first, then one division a divisor: 3*a*b/c/d^2. The coefficient comes last where the
// first factor is a sum, or where it is 0: it is a factor of the whole, not of what it stands
// before.
void CanonicalWriter::emit_product(const Item& item, double coefficient) {
  const std::span<const Part> parts = forms_.parts(item);
  const auto first = std::ranges::find_if(parts, [](const Part& p) { return p.number > 0; });
  const bool has_numerator = first != parts.end();
  const bool negates = coefficient == -1 && has_numerator;
  const bool is_scaled = coefficient != 1 && !negates;
  const bool scales_last =
      is_scaled && has_numerator && (forms_.at(first->item).kind == Kind::sum || coefficient == 0);
  bool is_open = (is_scaled && !scales_last) || !has_numerator;
  if (is_open) tape_.push_back(Node::constant(coefficient));
  for (const bool divides : {false, true}) {
    for (const Part& part : parts) {
      if ((part.number < 0) != divides) continue;
      emit_power(part);
      if (is_open) tape_.push_back({0, 0, 0, divides ? Op::div : Op::mul});
      is_open = true;
    }
  }
  if (scales_last) {
    tape_.push_back(Node::constant(coefficient));
    tape_.push_back({0, 0, 0, Op::mul});
  }
  if (negates) tape_.push_back({0, 0, 0, Op::neg});
}

void CanonicalWriter::emit_power(const Part& part) {
  emit(part.item);
  const double exponent = std::abs(part.number);
  if (exponent == 1) return;
  tape_.push_back(Node::constant(exponent));
  tape_.push_back({0, 0, 0, Op::pow});
}

}  // namespace

Expression written_out(const CanonicalForms& forms, std::uint32_t item) {
  CanonicalWriter writer(forms);
  writer.emit(item);
  return Expression(writer.take());
}

}  // namespace tribench
