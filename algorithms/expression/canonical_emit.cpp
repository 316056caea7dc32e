// SPDX-License-Identifier: MIT
//
// The canonical tree written back as a tape.
#include <algorithm>
#include <cmath>

#include "algorithms/expression/canonical.hpp"

namespace tribench {

Expression Canonicalizer::emit(std::uint32_t item) const {
  std::vector<Node> tape;
  emit(item, tape);
  return Expression(std::move(tape));
}

void Canonicalizer::emit(std::uint32_t index, std::vector<Node>& tape) const {
  const Item& item = items_[index];
  switch (item.kind) {
    case Kind::constant:
      tape.push_back(Node::constant(item.value));
      return;
    case Kind::variable:
      tape.push_back(Node::input(item.variable));
      return;
    case Kind::sum:
      return emit_sum(item, tape);
    case Kind::product:
      return emit_product(item, item.value, tape);
    case Kind::function:
      for (std::uint32_t p = item.first; p < item.first + item.count; ++p) {
        emit(parts_[p].item, tape);
      }
      tape.push_back({0, 0, 0, item.op});
      return;
  }
}

void Canonicalizer::emit_term(std::uint32_t index, double coefficient,
                              std::vector<Node>& tape) const {
  if (items_[index].kind == Kind::product && items_[index].value == 1) {
    return emit_product(items_[index], coefficient, tape);
  }
  if (coefficient != 1 && coefficient != -1) tape.push_back(Node::constant(coefficient));
  emit(index, tape);
  if (coefficient == -1) tape.push_back({0, 0, 0, Op::neg});
  if (coefficient != 1 && coefficient != -1) tape.push_back({0, 0, 0, Op::mul});
}

void Canonicalizer::emit_sum(const Item& item, std::vector<Node>& tape) const {
  for (std::uint32_t p = item.first; p < item.first + item.count; ++p) {
    const double number = parts_[p].number;
    if (p == item.first) {
      emit_term(parts_[p].item, number, tape);
      continue;
    }
    emit_term(parts_[p].item, std::abs(number), tape);
    tape.push_back({0, 0, 0, number < 0 ? Op::sub : Op::add});
  }
  if (item.value == 0) return;
  tape.push_back(Node::constant(std::abs(item.value)));
  tape.push_back({0, 0, 0, item.value < 0 ? Op::sub : Op::add});
}

// Numerator first, then one division a divisor: 3*a*b/c/d^2. The coefficient comes last where the
// first factor is a sum, or where it is 0: it is a factor of the whole, not of what it stands
// before.
void Canonicalizer::emit_product(const Item& item, double coefficient,
                                 std::vector<Node>& tape) const {
  const auto begin = parts_.begin() + item.first;
  const auto end = begin + item.count;
  const auto first = std::find_if(begin, end, [](const Part& p) { return p.number > 0; });
  const bool has_numerator = first != end;
  const bool negates = coefficient == -1 && has_numerator;
  const bool is_scaled = coefficient != 1 && !negates;
  const bool scales_last =
      is_scaled && has_numerator && (items_[first->item].kind == Kind::sum || coefficient == 0);
  bool is_open = (is_scaled && !scales_last) || !has_numerator;
  if (is_open) tape.push_back(Node::constant(coefficient));
  for (const bool divides : {false, true}) {
    for (auto part = begin; part != end; ++part) {
      if ((part->number < 0) != divides) continue;
      emit_power(*part, tape);
      if (is_open) tape.push_back({0, 0, 0, divides ? Op::div : Op::mul});
      is_open = true;
    }
  }
  if (scales_last) {
    tape.push_back(Node::constant(coefficient));
    tape.push_back({0, 0, 0, Op::mul});
  }
  if (negates) tape.push_back({0, 0, 0, Op::neg});
}

void Canonicalizer::emit_power(const Part& part, std::vector<Node>& tape) const {
  emit(part.item, tape);
  const double exponent = std::abs(part.number);
  if (exponent == 1) return;
  tape.push_back(Node::constant(exponent));
  tape.push_back({0, 0, 0, Op::pow});
}

}  // namespace tribench
