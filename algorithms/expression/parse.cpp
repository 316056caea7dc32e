// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

constexpr std::array kFunctions = {Op::exp, Op::log, Op::sqrt, Op::abs,
                                   Op::sgn, Op::sin, Op::cos,  Op::tanh};

std::optional<Op> function_of(std::string_view name) {
  for (const Op op : kFunctions) {
    if (op_name(op) == name) return op;
  }
  return std::nullopt;
}

// Recursive descent that appends to a postfix tape.
class Parser {
 public:
  Parser(std::string_view text, std::vector<std::string>& names, bool collect)
      : text_(text), names_(names), collect_(collect) {}

  Expression run() {
    sum();
    skip_space();
    if (at_ != text_.size()) fail(fmt::format("unexpected '{}'", character()), "write an operator");
    return Expression(std::move(tape_));
  }

 private:
  class Nesting {
   public:
    explicit Nesting(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > kMaxNesting) {
        parser_.fail(fmt::format("the formula is nested deeper than {} levels", kMaxNesting),
                     "split it");
      }
    }
    ~Nesting() { --parser_.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    Parser& parser_;
  };

  void sum() {
    product();
    while (true) {
      if (take('+')) {
        product();
        emit(Op::add);
      } else if (take('-')) {
        product();
        emit(Op::sub);
      } else {
        return;
      }
    }
  }

  void product() {
    factor();
    while (true) {
      if (take('*')) {
        if (at_ < text_.size() && text_[at_] == '*') fail("'**' is not an operator", "write ^");
        factor();
        emit(Op::mul);
      } else if (take('/')) {
        factor();
        emit(Op::div);
      } else {
        return;
      }
    }
  }

  void factor() {
    const Nesting nesting(*this);
    if (!take('-')) return power();
    skip_space();
    if (starts_number()) {
      const double magnitude = number();
      if (peek() != '^') {
        tape_.push_back(Node::constant(-magnitude));
        return;
      }
      tape_.push_back(Node::constant(magnitude));
      power_tail();
    } else {
      factor();
    }
    emit(Op::neg);
  }

  void power() {
    atom();
    power_tail();
  }

  void power_tail() {
    if (!take('^')) return;
    factor();
    emit(Op::pow);
  }

  void atom() {
    skip_space();
    if (at_ == text_.size()) fail("the formula ends where a value is expected", "complete it");
    if (starts_number()) {
      tape_.push_back(Node::constant(number()));
    } else if (starts_name()) {
      named();
    } else if (take('(')) {
      sum();
      expect_close();
    } else {
      fail(fmt::format("'{}' where a number, a name or '(' is expected", character()), "mend it");
    }
  }

  void named() {
    const std::size_t start = at_;
    const std::string_view name = identifier();
    const std::optional<Op> function = function_of(name);
    if (peek() == '(') {
      if (!function) {
        at_ = start;
        fail(fmt::format("'{}' is not a function", name), suggestion(name, function_names()));
      }
      take('(');
      sum();
      expect_close();
      emit(*function);
      return;
    }
    if (function) {
      fail(fmt::format("the function {} needs an argument", name),
           fmt::format("write {}(...)", name));
    }
    variable(name, start);
  }

  void variable(std::string_view name, std::size_t start) {
    auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
      if (!collect_) {
        at_ = start;
        fail(fmt::format("'{}' is not an input", name), suggestion(name, names_));
      }
      names_.emplace_back(name);
      found = names_.end() - 1;
    }
    tape_.push_back(Node::input(static_cast<std::size_t>(found - names_.begin())));
  }

  static std::vector<std::string> function_names() {
    std::vector<std::string> names;
    names.reserve(kFunctions.size());
    for (const Op op : kFunctions) names.emplace_back(op_name(op));
    return names;
  }

  static std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
    const std::string near = nearest_name(word, known);
    if (!near.empty()) return fmt::format("did you mean {}?", near);
    return known.empty() ? std::string("there are no names")
                         : fmt::format("known: {}", fmt::join(known, ", "));
  }

  bool starts_number() const {
    if (at_ >= text_.size()) return false;
    const auto digit = [this](std::size_t i) {
      return i < text_.size() && std::isdigit(static_cast<unsigned char>(text_[i])) != 0;
    };
    return digit(at_) || (text_[at_] == '.' && digit(at_ + 1));
  }

  double number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) {
      fail(fmt::format("the number {} is out of range", std::string_view(first, end)),
           "use a double-precision number");
    }
    at_ += static_cast<std::size_t>(end - first);
    return value;
  }

  bool starts_name() const {
    return at_ < text_.size() &&
           (std::isalpha(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_');
  }

  std::string_view identifier() {
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
      ++at_;
    }
    return text_.substr(start, at_ - start);
  }

  void emit(Op op) { tape_.push_back({0, 0, 0, op}); }

  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  char peek() {
    skip_space();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char wanted) {
    if (peek() != wanted) return false;
    ++at_;
    return true;
  }
  void expect_close() {
    if (take(')')) return;
    fail(at_ == text_.size() ? std::string("a '(' is never closed")
                             : fmt::format("'{}' where ')' is expected", character()),
         "add a ')'");
  }

  // All bytes of the character at hand: formulas are typed and pasted in UTF-8.
  std::string_view character() const {
    std::size_t end = at_ + 1;
    while (end < text_.size() && !begins_character(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }
  static bool begins_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& mend) const {
    const std::string_view before = text_.substr(0, at_);
    const auto place = std::count_if(before.begin(), before.end(), begins_character) + 1;
    throw_bad_input(what, fmt::format("formula, character {}", place), mend);
  }

  std::string_view text_;
  std::vector<std::string>& names_;
  bool collect_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Node> tape_;
};

}  // namespace

Expression parse(std::string_view text, std::span<const std::string> names) {
  std::vector<std::string> known(names.begin(), names.end());
  return Parser(text, known, false).run();
}

Expression parse_collecting_names(std::string_view text, std::vector<std::string>& names) {
  return Parser(text, names, true).run();
}

}  // namespace tribench
