// SPDX-License-Identifier: MIT
#include "algorithms/expression/certificate_formula.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "algorithms/expression/input_box.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr int kDeepest = 4000;  // print nests a level of a formula at most twice

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

// Shunting-yard by recursive descent: a sum of products of powers, each at its level of binding.
class Reading {
 public:
  Reading(std::string_view text, ClaimedBox& box) : text_(text), box_(box) {}

  ClaimedFormula run() {
    level(0);
    if (skip(); at_ != text_.size()) refuse("text behind the formula");
    return std::move(formula_);
  }

 private:
  // 0: + and -, 1: * and /, both to the left.
  void level(int tightness) {
    const std::string_view signs = tightness == 0 ? "+-" : "*/";
    tightness == 0 ? level(1) : signed_power();
    while (skip(), at_ < text_.size() && signs.find(text_[at_]) != std::string_view::npos) {
      const char sign = text_[at_++];
      tightness == 0 ? level(1) : signed_power();
      push(sign == '+' ? Op::add : sign == '-' ? Op::sub : sign == '*' ? Op::mul : Op::div);
    }
  }

  // Binds tighter than the minus in front, and groups to the right.
  void signed_power() {
    if (++depth_ > kDeepest) refuse("nested too deep");
    if (take('-')) {
      skip();
      const std::size_t start = formula_.size();
      const bool is_number = at_ < text_.size() && is_digit(text_[at_]);
      signed_power();
      // A minus belongs to a number that stands alone.
      if (is_number && formula_.size() == start + 1) {
        formula_.back().value = -formula_.back().value;
      } else {
        push(Op::neg);
      }
    } else {
      operand();
      if (take('^')) {
        signed_power();
        push(Op::pow);
      }
    }
    --depth_;
  }

  void operand() {
    skip();
    if (take('(')) return closed_sum();
    if (at_ < text_.size() && is_digit(text_[at_])) return number();
    const std::size_t start = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || (at_ > start && is_digit(text_[at_])))) {
      ++at_;
    }
    const std::string_view word = text_.substr(start, at_ - start);
    for (int op = static_cast<int>(Op::exp); op <= static_cast<int>(Op::atan); ++op) {
      if (op_name(static_cast<Op>(op)) != word) continue;
      if (!take('(')) refuse("a function without an argument");
      closed_sum();
      return push(static_cast<Op>(op));
    }
    formula_.push_back({Op::variable, 0, input(word)});
  }

  void closed_sum() {
    level(0);
    if (!take(')')) refuse("a bracket that is not closed");
  }

  void number() {
    double value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) refuse("a number that is none");
    at_ = static_cast<std::size_t>(end - text_.data());
    formula_.push_back({Op::constant, value, 0});
  }

  std::size_t input(std::string_view name) {
    if (const auto place = box_.place_of(name)) return *place;
    const auto whole = name.starts_with(kSignPrefix)
                           ? box_.place_of(name.substr(kSignPrefix.size()))
                           : std::optional<std::size_t>();
    if (!whole || box_.sign_of[*whole]) refuse("an input without a range");
    box_.add_name(name);
    box_.ranges.push_back({-1, 1});
    box_.sign_of.push_back(whole);
    return box_.names.size() - 1;
  }

  void push(Op op) { formula_.push_back({op, 0, 0}); }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(char wanted) {
    skip();
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }
  [[noreturn]] static void refuse(std::string_view what) {
    throw_bad_input("the formula has " + std::string(what), "certificate");
  }

  std::string_view text_;
  ClaimedBox& box_;
  std::size_t at_ = 0;
  int depth_ = 0;
  ClaimedFormula formula_;
};

double finite_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw_bad_input("the box has a bound that is no finite number", "certificate");
  }
  return value;
}

}  // namespace

std::optional<std::size_t> ClaimedBox::place_of(std::string_view name) const {
  const auto found = places_.find(name);
  if (found == places_.end()) return std::nullopt;
  return found->second;
}

void ClaimedBox::add_name(std::string_view name) {
  places_.try_emplace(std::string(name), names.size());
  names.emplace_back(name);
}

ClaimedBox read_claimed_box(std::string_view text) {
  ClaimedBox box;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::size_t colon = std::min(part.find(':'), part.size());
    const std::string_view name = part.substr(0, equals);
    const bool is_name =
        !name.empty() && is_letter(name[0]) &&
        std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); });
    if (!is_name || box.place_of(name) || !(equals < colon && colon < part.size())) {
      throw_bad_input("the box is not NAME=LOW:HIGH,...", "certificate");
    }
    box.add_name(name);
    box.ranges.push_back({finite_number(part.substr(equals + 1, colon - equals - 1)),
                          finite_number(part.substr(colon + 1))});
    if (box.ranges.back().low > box.ranges.back().high) {
      throw_bad_input("a range of the box ends before it starts", "certificate");
    }
  }
  // A name sgn_X beside X is the sign of X, never an input of its own.
  for (const std::string& name : box.names) {
    const bool is_sign =
        name.starts_with(kSignPrefix) && box.place_of(name.substr(kSignPrefix.size()));
    if (is_sign) throw_bad_input("the box gives a range to a sign", "certificate");
    box.sign_of.emplace_back();
  }
  return box;
}

ClaimedFormula read_claimed_formula(std::string_view text, ClaimedBox& box) {
  return Reading(text, box).run();
}

}  // namespace tribench
