// SPDX-License-Identifier: MIT
#include "algorithms/expression/input_box.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "algorithms/expression/name_index.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/formula_name.hpp"
#include "foundation/sign.hpp"

namespace tribench {
namespace {

constexpr std::string_view kExample = "write ranges as 'v=-2:2,g=-60:60'";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

double number_in(std::string_view text, std::string_view part) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw_bad_input(fmt::format("'{}' in '{}' is not a finite number", text, part), "--box",
                    kExample);
  }
  return value;
}

void add_range(std::string_view part, NamedBox& box, NameIndex& places) {
  const std::size_t equals = part.find('=');
  const std::size_t colon = part.find(':');
  if (equals == std::string_view::npos || colon == std::string_view::npos || colon < equals) {
    throw_bad_input(fmt::format("'{}' is not NAME=LOW:HIGH", part), "--box", kExample);
  }
  const std::string name(trimmed(part.substr(0, equals)));
  require_formula_name(name, "--box");
  if (places.find(name)) {
    throw_bad_input(fmt::format("the name '{}' is given twice", name), "--box", kExample);
  }
  if (box.names.size() == kMaxInputs) {
    throw_bad_input(fmt::format("more than {} inputs", kMaxInputs), "--box",
                    "leave out what the formula does not use");
  }
  InputRange range{number_in(part.substr(equals + 1, colon - equals - 1), part),
                   number_in(part.substr(colon + 1), part)};
  if (range.low > range.high) {
    throw_bad_input(
        fmt::format("the range of {} runs from {} down to {}", name, range.low, range.high),
        "--box", "give the lower end first");
  }
  box.names.push_back(name);
  box.ranges.push_back(range);
}

// A range given to a sign beside its input says nothing that the input does not; the sign comes
// back where a formula uses it (parse_over). Less than the input's own signs would be another
// question.
void leave_out_signs(NamedBox& box) {
  NamedBox kept;
  NameIndex places(box.names);
  for (std::size_t j = 0; j < box.names.size(); ++j) {
    const std::string& name = box.names[j];
    const auto base = name.starts_with(kSignPrefix)
                          ? places.find(std::string_view(name).substr(kSignPrefix.size()))
                          : std::nullopt;
    if (!base) {
      kept.names.push_back(name);
      kept.ranges.push_back(box.ranges[j]);
      continue;
    }
    const InputRange& of = box.ranges[*base];
    if (box.ranges[j].low > sign(of.low) || box.ranges[j].high < sign(of.high)) {
      throw_bad_input(
          fmt::format("'{}' follows from '{}' and has no range of its own", name, box.names[*base]),
          "--box", fmt::format("leave it out, or give '{}' less", box.names[*base]));
    }
  }
  box = std::move(kept);
}

}  // namespace

NamedBox parse_box(std::string_view text) {
  NamedBox box;
  NameIndex places(box.names);
  while (!trimmed(text).empty()) {
    const std::size_t comma = text.find(',');
    add_range(trimmed(text.substr(0, comma)), box, places);
    text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
  }
  leave_out_signs(box);
  return box;
}

std::string print_box(const NamedBox& box) {
  std::string text;
  for (std::size_t j = 0; j < box.names.size(); ++j) {
    if (box.ranges[j].sign_of) continue;
    text += fmt::format("{}{}={}:{}", text.empty() ? "" : ",", box.names[j],
                        print_number(box.ranges[j].low), print_number(box.ranges[j].high));
  }
  return text;
}

Expression parse_over(std::string_view formula, NamedBox& box) {
  std::vector<std::string> names = box.names;
  Expression parsed = parse_collecting_names(formula, names);
  NameIndex places(box.names);
  for (std::size_t j = box.names.size(); j < names.size(); ++j) {
    const std::string& name = names[j];
    const auto base = name.starts_with(kSignPrefix)
                          ? places.find(std::string_view(name).substr(kSignPrefix.size()))
                          : std::nullopt;
    if (!base) {
      throw_bad_input(fmt::format("the formula's input '{}' has no range", name), "--box",
                      fmt::format("add {}=LOW:HIGH; sgn_X needs the range of X", name));
    }
    box.names.push_back(name);
    box.ranges.push_back({0, 0, base});
  }
  return parsed;
}

void set_signs(const InputBox& box, std::vector<double>& point) {
  for (std::size_t j = 0; j < box.size(); ++j) {
    if (box[j].sign_of) point[j] = sign(point[*box[j].sign_of]);
  }
}

void check_box(const Expression& formula, const InputBox& box) {
  if (columns_used(formula) > box.size()) {
    throw_bad_input(fmt::format("the formula uses input {} but the box has only {}",
                                columns_used(formula) - 1, box.size()),
                    "box", "give a range for every input");
  }
  for (std::size_t j = 0; j < box.size(); ++j) {
    if (box[j].sign_of) {
      if (*box[j].sign_of >= box.size() || box[*box[j].sign_of].sign_of) {
        throw_bad_input(fmt::format("input {} is the sign of {}, which is no input with a range", j,
                                    *box[j].sign_of),
                        "box");
      }
    } else if (!std::isfinite(box[j].low) || !std::isfinite(box[j].high) ||
               box[j].low > box[j].high) {
      throw_bad_input(
          fmt::format("the range {}:{} of input {} is not one", box[j].low, box[j].high, j), "box",
          "give two finite numbers, the lower first");
    }
  }
}

}  // namespace tribench
