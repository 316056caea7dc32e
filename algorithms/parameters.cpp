// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "algorithms/regressor.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

const ParameterSpec& spec_of(const std::vector<ParameterSpec>& specs, const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterSpec& spec : specs) {
    if (spec.name == name) return spec;
    names.push_back(spec.name);
  }
  const std::string near = nearest_name(name, names);
  throw_bad_input(fmt::format("unknown parameter '{}'", name), {},
                  !near.empty()   ? fmt::format("did you mean {}?", near)
                  : names.empty() ? std::string("this algorithm has no parameters")
                                  : fmt::format("known: {}", fmt::join(names, ", ")));
}

// The value in the kind of the default: an integer stands for a number, nothing else converts.
ParameterValue converted(const ParameterSpec& spec, const ParameterValue& given) {
  if (std::holds_alternative<double>(spec.default_value) &&
      std::holds_alternative<std::int64_t>(given)) {
    return static_cast<double>(std::get<std::int64_t>(given));
  }
  if (spec.default_value.index() != given.index()) {
    static constexpr const char* kKinds[] = {"true or false", "an integer", "a number", "a text"};
    throw_bad_input(
        fmt::format("parameter '{}' must be {}", spec.name, kKinds[spec.default_value.index()]));
  }
  return given;
}

void check_range(const ParameterSpec& spec, const ParameterValue& value) {
  const auto check_number = [&](double number) {
    if (number >= spec.low && number <= spec.high) return;
    throw_bad_input(fmt::format("parameter '{}' = {} is out of range", spec.name, number), {},
                    fmt::format("use {} to {}", spec.low, spec.high));
  };
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    check_number(static_cast<double>(*integer));
  } else if (const auto* number = std::get_if<double>(&value)) {
    check_number(*number);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    if (spec.choices.empty() || std::ranges::count(spec.choices, *text) > 0) return;
    throw_bad_input(fmt::format("parameter '{}' = '{}' is unknown", spec.name, *text), {},
                    fmt::format("use one of: {}", fmt::join(spec.choices, ", ")));
  }
}

}  // namespace

Parameters::Parameters(const std::vector<ParameterSpec>& specs,
                       const std::map<std::string, ParameterValue>& given) {
  for (const ParameterSpec& spec : specs) values_[spec.name] = spec.default_value;
  for (const auto& [name, value] : given) {
    const ParameterSpec& spec = spec_of(specs, name);
    const ParameterValue final_value = converted(spec, value);
    check_range(spec, final_value);
    values_[name] = final_value;
  }
}

const ParameterValue& Parameters::at(std::string_view name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) {
    throw Error(ErrorKind::failed, fmt::format("the parameter '{}' was never declared", name));
  }
  return found->second;
}

bool Parameters::flag(std::string_view name) const { return std::get<bool>(at(name)); }
std::int64_t Parameters::integer(std::string_view name) const {
  return std::get<std::int64_t>(at(name));
}
double Parameters::number(std::string_view name) const { return std::get<double>(at(name)); }
const std::string& Parameters::text(std::string_view name) const {
  return std::get<std::string>(at(name));
}

}  // namespace tribench
