// SPDX-License-Identifier: MIT
#include "algorithms/pysr/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "algorithms/admission.hpp"
#include "algorithms/pysr/text_pieces.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"

namespace tribench::pysr {
namespace {

Op find_operator(std::string_view name, std::string_view place) {
  std::vector<std::string> names;
  for (int i = static_cast<int>(Op::add); i < kOpCount; ++i) {
    const Op op = static_cast<Op>(i);
    if (op_name(op) == name) return op;
    names.emplace_back(op_name(op));
  }
  throw_bad_input(fmt::format("there is no operator '{}'", name), place,
                  fmt::format("use one of {}", fmt::join(names, " ")));
}

constexpr int kLargestLimit = 1000;  // beyond the largest formula there can be

double size_in(std::string_view text, std::string_view place) {
  const std::optional<double> size = read_number<double>(text);
  if (!size || *size < 0 || *size > kLargestLimit) {
    throw_bad_input(fmt::format("'{}' is no size", text), place,
                    fmt::format("use a number from 0 to {}", kLargestLimit));
  }
  return *size;
}

// `least`: -1 where that stands for no limit.
int limit_in(std::string_view text, std::string_view place, int least = 0) {
  const std::optional<int> limit = read_number<int>(text);
  if (!limit || *limit < least || *limit > kLargestLimit) {
    throw_bad_input(fmt::format("'{}' is no limit", text), place,
                    fmt::format("use a whole number from {} to {}", least, kLargestLimit));
  }
  return *limit;
}

// "left SEPARATOR right"; throws where the separator is missing.
std::array<std::string_view, 2> halves(std::string_view text, char separator,
                                       std::string_view place, std::string_view example) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) {
    throw_bad_input(fmt::format("'{}' has no '{}'", text, separator), place,
                    fmt::format("write it as in \"{}\"", example));
  }
  return {trimmed(text.substr(0, at)), trimmed(text.substr(at + 1))};
}

}  // namespace

Validator::Validator(const Options& options, const OperatorSet& operators,
                     std::span<const Input> inputs, Form form)
    : operators_(&operators),
      form_(std::move(form)),
      inputs_(inputs.begin(), inputs.end()),
      has_priors_(std::ranges::any_of(inputs, [](const Input& one) { return one.max_degree > 0; })),
      max_depth_(options.max_depth),
      constant_size_(options.constant_size),
      variable_size_(options.variable_size),
      units_(options.units),
      unit_penalty_(options.unit_penalty) {
  op_size_.fill(1);
  for (auto& limits : argument_limit_) limits.fill(-1);
  for (const std::string_view piece : split(options.operator_sizes, ';')) {
    const auto [name, value] = halves(piece, '=', "operator_sizes", "exp=2; ^=3");
    op_size_[static_cast<std::size_t>(find_operator(name, "operator_sizes"))] =
        size_in(value, "operator_sizes");
  }
  plain_sizes_ = constant_size_ == 1 && variable_size_ == 1 &&
                 std::ranges::all_of(op_size_, [](double size) { return size == 1; });
  for (const std::string_view piece : split(options.argument_limits, ';')) {
    const auto [name, values] = halves(piece, ':', "argument_limits", "^:-1,3; exp:9");
    const Op op = find_operator(name, "argument_limits");
    const std::vector<std::string_view> limits = split(values, ',');
    if (static_cast<int>(limits.size()) != arity(op)) {
      throw_bad_input(
          fmt::format("'{}' takes {} arguments, not {}", name, arity(op), limits.size()),
          "argument_limits");
    }
    for (std::size_t k = 0; k < limits.size(); ++k) {
      argument_limit_[static_cast<std::size_t>(op)][k] = limit_in(limits[k], "argument_limits", -1);
    }
    has_argument_limits_ = true;
  }
  for (const std::string_view piece : split(options.nested_limits, ';')) {
    const auto [pair, most] = halves(piece, '=', "nested_limits", "exp>exp=0; exp>sqrt=1");
    const auto [outer, inner] = halves(pair, '>', "nested_limits", "exp>exp=0; exp>sqrt=1");
    nested_limits_.push_back({find_operator(outer, "nested_limits"),
                              find_operator(inner, "nested_limits"),
                              limit_in(most, "nested_limits")});
  }
  read_part_sizes(options.part_sizes);
  if (units_ != Units::off) read_units(options, inputs);
}

void Validator::read_part_sizes(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t part = 0; part < form_.parts(); ++part) names.push_back(form_.name(part));
  for (const std::string_view piece : split(text, ';')) {
    const auto [name, value] = halves(piece, '=', "part_sizes", "f=9; g=15");
    const auto part = std::ranges::find(names, name);
    if (part == names.end()) {
      throw_bad_input(fmt::format("the template has no part '{}'", name), "part_sizes",
                      fmt::format("use one of {}", fmt::join(names, " ")));
    }
    part_size_.resize(names.size(), std::numeric_limits<int>::max());
    part_size_[static_cast<std::size_t>(part - names.begin())] = limit_in(value, "part_sizes");
  }
}

void Validator::read_units(const Options& options, std::span<const Input> inputs) {
  for (const Input& input : inputs) input_dimensions_.push_back(parse_unit(input.unit));
  for (const Expression& column : form_.columns().formulas()) {
    const std::optional<Dimension> dimension = dimension_of(column, input_dimensions_);
    if (!dimension) {
      throw_bad_input("the template adds or takes functions of what has other units", "template",
                      "mend its units, or leave the parameter units off");
    }
    input_dimensions_.push_back(*dimension);
  }
  if (!options.target_unit.empty()) target_dimension_ = parse_unit(options.target_unit);
}

double Validator::node_size(const Node& node) const {
  if (node.is_constant()) return constant_size_;
  if (node.is_variable()) return variable_size_;
  return op_size_[static_cast<std::size_t>(node.op)];
}

int Validator::size(const Expression& formula) const {
  if (plain_sizes_) return static_cast<int>(formula.size());
  double sum = 0;
  for (const Node& node : formula.nodes()) sum += node_size(node);
  return static_cast<int>(std::lround(sum));
}

bool Validator::admits(const Expression& formula, int max_size) const {
  const int own_size = size(formula);
  if (own_size < 1 || own_size > max_size) return false;
  if (static_cast<int>(formula.size()) > max_depth_ &&
      static_cast<int>(depth(formula)) > max_depth_) {
    return false;
  }
  if (!form_.fits(formula)) return false;
  if (has_priors_ && !keeps_priors(formula, inputs_)) return false;
  if (form_.is_whole() ? !keeps_limits(formula) : !parts_fit(formula)) return false;
  return units_ != Units::hard || units_agree(formula, input_dimensions_, target_dimension_);
}

bool Validator::keeps_limits(const Expression& part) const {
  if (!operators_->admits(part)) return false;
  if (has_argument_limits_ && !arguments_fit(part)) return false;
  return std::ranges::all_of(nested_limits_,
                             [&](const NestedLimit& limit) { return nesting_fits(part, limit); });
}

bool Validator::parts_fit(const Expression& formula) const {
  for (std::size_t k = 0; k < form_.parts(); ++k) {
    const Expression part = subtree(formula, form_.place(formula, k));
    if (!part_size_.empty() && size(part) > part_size_[k]) return false;
    if (!keeps_limits(part)) return false;
  }
  return true;
}

bool Validator::arguments_fit(const Expression& formula) const {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Op op = formula.node(i).op;
    const auto& limits = argument_limit_[static_cast<std::size_t>(op)];
    const int arguments = arity(op);
    for (int k = 0; k < arguments; ++k) {
      const int limit = limits[static_cast<std::size_t>(k)];
      if (limit < 0) continue;
      const std::size_t child =
          arguments == 2 && k == 0 ? formula.left_child(i) : formula.last_child(i);
      if (size(subtree(formula, child)) > limit) return false;
    }
  }
  return true;
}

bool Validator::nesting_fits(const Expression& formula, const NestedLimit& limit) const {
  // deepest[i]: the most inner operators on any path from node i down, i included.
  std::vector<int> deepest(formula.size(), 0);
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Op op = formula.node(i).op;
    int below = 0;
    if (arity(op) >= 1) below = deepest[formula.last_child(i)];
    if (arity(op) == 2) below = std::max(below, deepest[formula.left_child(i)]);
    if (op == limit.outer && below > limit.most) return false;
    deepest[i] = below + (op == limit.inner ? 1 : 0);
  }
  return true;
}

double Validator::unit_penalty(const Expression& formula) const {
  if (units_ != Units::soft) return 0;
  return units_agree(formula, input_dimensions_, target_dimension_) ? 0 : unit_penalty_;
}

}  // namespace tribench::pysr
