// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithms/expression/name_index.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/suggestion.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

// kFunctionNames are in the order of Op.
std::optional<Op> function_of(std::string_view name) {
  const auto found = std::ranges::find(kFunctionNames, name);
  if (found == kFunctionNames.end()) return std::nullopt;
  return static_cast<Op>(static_cast<int>(Op::exp) + (found - kFunctionNames.begin()));
}

// Functions that are written out when they are read: x stands for the argument.
struct Shorthand {
  std::string_view name;
  std::string_view formula;
};
constexpr std::array<Shorthand, 7> kShorthands = {
    {{"tan", "sin(x)/cos(x)"},
     {"sinh", "tanh(x)*((exp(x) + exp(-x))/2)"},  // a difference would lose the digits near 0
     {"cosh", "(exp(x) + exp(-x))/2"},
     {"log2", "log(x)/0.6931471805599453"},
     {"log10", "log(x)/2.302585092994046"},
     // Finite to both ends of -1 .. 1, and no difference near them is of rounded numbers: by the
     // half of the angle, and for acos, which goes to 0 there, by the quarter.
     {"asin", "2*atan(x/(1 + sqrt((1 - x)*(1 + x))))"},
     {"acos", "4*atan(sqrt(1 - x)/(1.4142135623730951 + sqrt(1 + x)))"}}};
constexpr std::size_t kMostWrittenOut = 100'000;  // nodes: each may hold its argument twice

const Shorthand* shorthand_of(std::string_view name) {
  const auto* const found = std::ranges::find(kShorthands, name, &Shorthand::name);
  return found == kShorthands.end() ? nullptr : found;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names(kFunctionNames.begin(), kFunctionNames.end());
  for (const Shorthand& shorthand : kShorthands) names.emplace_back(shorthand.name);
  return names;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  return known.empty() ? "there are no names" : did_you_mean(word, known);
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }

// The text from left to right, in numbers, names and signs.
class Cursor {
 public:
  // subject: "formula", as messages call the text.
  Cursor(std::string_view text, std::string_view subject) : text_(text), subject_(subject) {}

  std::size_t position() const { return at_; }
  bool is_at_end() const { return at_ == text_.size(); }
  // The next byte as it stands there; 0 at the end.
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  // The same behind blanks.
  char peek() {
    while (is_space(next())) ++at_;
    return next();
  }
  bool take(char wanted) {
    if (peek() != wanted || is_at_end()) return false;
    ++at_;
    return true;
  }
  void expect_close() {
    if (take(')')) return;
    fail(is_at_end() ? std::string("a '(' is never closed")
                     : fmt::format("'{}' where ')' is expected", character()),
         "add a ')'");
  }

  bool starts_number() const {
    const bool has_point = next() == '.' && at_ + 1 < text_.size();
    return is_digit(next()) || (has_point && is_digit(text_[at_ + 1]));
  }
  double number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) {
      fail(fmt::format("the number {} is out of range", clipped(std::string_view(first, end))),
           "use a double-precision number");
    }
    at_ += static_cast<std::size_t>(end - first);
    return value;
  }
  std::string_view name() {
    const std::size_t start = at_;
    while (begins_name(next()) || is_digit(next())) ++at_;
    return text_.substr(start, at_ - start);
  }

  // All bytes of the character at hand: formulas are typed and pasted in UTF-8.
  std::string_view character() const {
    std::size_t end = at_ + 1;
    while (end < text_.size() && !begins_character(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }

  [[noreturn]] void fail(const std::string& what, const std::string& mend) const {
    fail_at(at_, what, mend);
  }
  [[noreturn]] void fail_at(std::size_t at, const std::string& what,
                            const std::string& mend) const {
    const auto place = std::ranges::count_if(text_.substr(0, at), begins_character) + 1;
    throw_bad_input(what, fmt::format("{}, character {}", subject_, place), mend);
  }

 private:
  std::string_view text_;
  std::string_view subject_;
  std::size_t at_ = 0;
};

// Recursive descent that appends to a postfix tape.
class Parser {
 public:
  Parser(std::string_view text, std::vector<std::string>& names, bool collect,
         std::vector<Hole>* holes = nullptr)
      : cursor_(text, holes == nullptr ? "formula" : "template"),
        names_(names),
        places_(names),
        collect_(collect),
        holes_(holes) {}

  Expression run() {
    sum();
    cursor_.peek();
    if (!cursor_.is_at_end()) {
      cursor_.fail(fmt::format("unexpected '{}'", cursor_.character()), "write an operator");
    }
    return Expression(std::move(tape_));
  }

 private:
  class Nesting {
   public:
    explicit Nesting(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > kMaxNesting) {
        parser_.cursor_.fail(
            fmt::format("the formula is nested deeper than {} levels", kMaxNesting), "split it");
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
      if (cursor_.take('+')) {
        product();
        emit(Op::add);
      } else if (cursor_.take('-')) {
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
      if (cursor_.take('*')) {
        if (cursor_.next() == '*') cursor_.fail("'**' is not an operator", "write ^");
        factor();
        emit(Op::mul);
      } else if (cursor_.take('/')) {
        factor();
        emit(Op::div);
      } else {
        return;
      }
    }
  }

  void factor() {
    const Nesting nesting(*this);
    if (!cursor_.take('-')) return power();
    cursor_.peek();
    if (cursor_.starts_number()) {
      const double magnitude = cursor_.number();
      if (cursor_.peek() != '^') {
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
    if (!cursor_.take('^')) return;
    factor();
    emit(Op::pow);
  }

  void atom() {
    cursor_.peek();
    if (cursor_.is_at_end())
      cursor_.fail("the formula ends where a value is expected", "complete it");
    if (cursor_.starts_number()) {
      tape_.push_back(Node::constant(cursor_.number()));
    } else if (begins_name(cursor_.next())) {
      named();
    } else if (cursor_.take('(')) {
      sum();
      cursor_.expect_close();
    } else {
      cursor_.fail(
          fmt::format("'{}' where a number, a name or '(' is expected", cursor_.character()),
          "mend it");
    }
  }

  void named() {
    const std::size_t start = cursor_.position();
    const std::string_view name = cursor_.name();
    const std::optional<Op> function = function_of(name);
    const Shorthand* shorthand = shorthand_of(name);
    if (cursor_.peek() == '(') {
      if (!function && shorthand == nullptr) {
        if (holes_ != nullptr) return hole(name, start);
        cursor_.fail_at(start, fmt::format("'{}' is not a function", name),
                        suggestion(name, function_names()));
      }
      cursor_.take('(');
      const std::size_t argument = tape_.size();
      sum();
      cursor_.expect_close();
      if (function) {
        emit(*function);
      } else {
        write_out(*shorthand, argument, start);
      }
      return;
    }
    if (function) {
      cursor_.fail(fmt::format("the function {} needs an argument", name),
                   fmt::format("write {}(...)", name));
    }
    variable(name, start);
  }

  // Puts the shorthand's formula in the place of its argument, which the tape ends with.
  void write_out(const Shorthand& shorthand, std::size_t argument, std::size_t start) {
    const std::vector<Node> inside(tape_.begin() + static_cast<std::ptrdiff_t>(argument),
                                   tape_.end());
    tape_.resize(argument);
    std::vector<std::string> x = {"x"};
    const Expression formula = Parser(shorthand.formula, x, false).run();
    for (const Node& node : formula.nodes()) {
      if (node.is_variable()) {
        tape_.insert(tape_.end(), inside.begin(), inside.end());
      } else {
        tape_.push_back(node);
      }
    }
    if (tape_.size() <= kMostWrittenOut) return;
    cursor_.fail_at(
        start,
        fmt::format("'{}' is {} here, and the formula has more than {} parts written out",
                    shorthand.name, shorthand.formula, kMostWrittenOut),
        "nest fewer of these");
  }

  void variable(std::string_view name, std::size_t start) {
    const std::size_t place = places_.find(name).value_or(names_.size());
    if (place == names_.size()) {
      if (!collect_) {
        cursor_.fail_at(start, fmt::format("'{}' is not an input", name), suggestion(name, names_));
      }
      if (!is_formula_name(name)) {
        cursor_.fail_at(start, fmt::format("'{}' cannot name an input", name),
                        fmt::format("call it {}", formula_name_for(name)));
      }
      names_.emplace_back(name);
    }
    if (place >= kMaxInputs) {
      cursor_.fail_at(
          start,
          fmt::format("'{}' is an input beyond the {} that a formula can name", name, kMaxInputs),
          "leave out inputs that it does not use");
    }
    tape_.push_back(Node::input(place));
  }

  // name(a, b): the arguments leave the tape, and a variable beyond the names stays.
  void hole(std::string_view name, std::size_t start) {
    const auto refuse = [&](const char* what, const char* mend) {
      cursor_.fail_at(start, fmt::format("'{}' {}", name, what), mend);
    };
    if (inside_hole_) refuse("stands inside another part", "let that part find its inner form");
    if (std::ranges::count(*holes_, name, &Hole::name) > 0) {
      refuse("stands twice", "give every part a name of its own");
    }
    if (places_.find(name)) {
      refuse("is an input, which takes no arguments", "give the part another name");
    }
    Hole hole{std::string(name), {}};
    std::vector<Node> outside = std::exchange(tape_, {});
    inside_hole_ = true;
    cursor_.take('(');
    if (cursor_.peek() != ')') {
      do {
        sum();
        hole.arguments.emplace_back(std::exchange(tape_, {}));
      } while (cursor_.take(','));
    }
    cursor_.expect_close();
    inside_hole_ = false;
    tape_ = std::move(outside);
    tape_.push_back(Node::input(names_.size() + holes_->size()));
    holes_->push_back(std::move(hole));
  }

  void emit(Op op) { tape_.push_back({0, 0, 0, op}); }

  Cursor cursor_;
  std::vector<std::string>& names_;
  NameIndex places_;
  bool collect_;
  std::vector<Hole>* holes_;  // null where a formula has none
  bool inside_hole_ = false;
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
