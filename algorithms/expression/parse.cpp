// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace {

// kFunctionNames are in the order of Op.
std::optional<Op> function_of(std::string_view name) {
  const auto found = std::ranges::find(kFunctionNames, name);
  if (found == kFunctionNames.end()) return std::nullopt;
  return static_cast<Op>(static_cast<int>(Op::exp) + (found - kFunctionNames.begin()));
}

// Recursive descent that appends to a postfix tape.
class Parser {
 public:
  Parser(std::string_view text, std::vector<std::string>& names, bool collect,
         std::vector<Hole>* holes = nullptr)
      : text_(text), names_(names), collect_(collect), holes_(holes) {}

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
        if (holes_ != nullptr) return hole(name, start);
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
      if (!is_formula_name(name)) {
        at_ = start;
        fail(fmt::format("'{}' cannot name an input", name),
             fmt::format("call it {}", formula_name_for(name)));
      }
      names_.emplace_back(name);
      found = names_.end() - 1;
    }
    if (found - names_.begin() >= static_cast<std::ptrdiff_t>(kMaxInputs)) {
      at_ = start;
      fail(fmt::format("'{}' is an input beyond the {} that a formula can name", name, kMaxInputs),
           "leave out inputs that it does not use");
    }
    tape_.push_back(Node::input(static_cast<std::size_t>(found - names_.begin())));
  }

  // name(a, b): the arguments leave the tape, and a variable beyond the names stays.
  void hole(std::string_view name, std::size_t start) {
    const auto refuse = [&](const char* what, const char* mend) {
      at_ = start;
      fail(fmt::format("'{}' {}", name, what), mend);
    };
    if (inside_hole_) refuse("stands inside another part", "let that part find its inner form");
    if (std::ranges::count(*holes_, name, &Hole::name) > 0) {
      refuse("stands twice", "give every part a name of its own");
    }
    if (std::ranges::count(names_, name) > 0) {
      refuse("is an input, which takes no arguments", "give the part another name");
    }
    Hole hole{std::string(name), {}};
    std::vector<Node> outside = std::exchange(tape_, {});
    inside_hole_ = true;
    take('(');
    if (peek() != ')') {
      do {
        sum();
        hole.arguments.emplace_back(std::exchange(tape_, {}));
      } while (take(','));
    }
    expect_close();
    inside_hole_ = false;
    tape_ = std::move(outside);
    tape_.push_back(Node::input(names_.size() + holes_->size()));
    holes_->push_back(std::move(hole));
  }

  static std::vector<std::string> function_names() {
    return {kFunctionNames.begin(), kFunctionNames.end()};
  }

  static std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
    return known.empty() ? "there are no names" : did_you_mean(word, known);
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
    throw_bad_input(
        what, fmt::format("{}, character {}", holes_ == nullptr ? "formula" : "template", place),
        mend);
  }

  std::string_view text_;
  std::vector<std::string>& names_;
  bool collect_;
  std::vector<Hole>* holes_;  // null where a formula has none
  bool inside_hole_ = false;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Node> tape_;
};

}  // namespace

Expression parse(std::string_view text, std::span<const std::string> names) {
  std::vector<std::string> known(names.begin(), names.end());
  return Parser(text, known, false).run();
}

Expression parse_with_holes(std::string_view text, std::span<const std::string> names,
                            std::vector<Hole>& holes) {
  std::vector<std::string> known(names.begin(), names.end());
  holes.clear();
  return Parser(text, known, false, &holes).run();
}

Expression parse_collecting_names(std::string_view text, std::vector<std::string>& names) {
  return Parser(text, names, true).run();
}

}  // namespace tribench
