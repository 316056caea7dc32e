// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "algorithms/regressor.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"
#include "foundation/suggestion.hpp"

namespace tribench {
namespace {

const ParameterSpec& spec_of(const std::vector<ParameterSpec>& specs, const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterSpec& spec : specs) {
    if (spec.name == name) return spec;
    names.push_back(spec.name);
  }
  throw_bad_input(fmt::format("unknown parameter '{}'", name), {},
                  names.empty() ? std::string("it has no parameters") : did_you_mean(name, names));
}

const char* kind_name(const ParameterSpec& spec) {
  static constexpr const char* kKinds[] = {"true or false", "a whole number", "a number", "a text"};
  return kKinds[spec.default_value.index()];
}

bool is_number(const ParameterSpec& spec) {
  return std::holds_alternative<std::int64_t>(spec.default_value) ||
         std::holds_alternative<double>(spec.default_value);
}

// What the parameter takes: "a whole number from 1 to 1000, or -1".
std::string accepted(const ParameterSpec& spec) {
  if (!spec.choices.empty()) return fmt::format("one of: {}", fmt::join(spec.choices, ", "));
  if (!is_number(spec)) return kind_name(spec);
  return fmt::format("{} from {} to {}{}", kind_name(spec), spec.low, spec.high,
                     spec.besides ? fmt::format(", or {}", *spec.besides) : std::string());
}

template <typename Value>
[[noreturn]] void refuse(const ParameterSpec& spec, const Value& value,
                         std::string_view how = "cannot be used") {
  throw_bad_input(fmt::format("parameter '{}' = '{}' {}", spec.name, value, how), {},
                  "use " + accepted(spec));
}

// The value in the kind of the default: an integer stands for a number, nothing else converts.
ParameterValue converted(const ParameterSpec& spec, const ParameterValue& given) {
  if (std::holds_alternative<double>(spec.default_value) &&
      std::holds_alternative<std::int64_t>(given)) {
    return static_cast<double>(std::get<std::int64_t>(given));
  }
  if (spec.default_value.index() != given.index()) {
    std::visit([&spec](const auto& value) { refuse(spec, value); }, given);
  }
  return given;
}

void check_range(const ParameterSpec& spec, const ParameterValue& value) {
  const auto check_number = [&](auto number) {
    const auto real = static_cast<double>(number);
    if ((real >= spec.low && real <= spec.high) || (spec.besides && real == *spec.besides)) return;
    refuse(spec, number, "is out of range");
  };
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    check_number(*integer);
  } else if (const auto* number = std::get_if<double>(&value)) {
    check_number(*number);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    if (!spec.choices.empty() && std::ranges::count(spec.choices, *text) == 0) refuse(spec, *text);
  }
}

}  // namespace

ParameterValue parameter_from_text(const std::vector<ParameterSpec>& specs, const std::string& name,
                                   std::string_view text) {
  const ParameterSpec& spec = spec_of(specs, name);
  if (std::holds_alternative<std::string>(spec.default_value)) return std::string(text);
  if (std::holds_alternative<bool>(spec.default_value)) {
    if (text == "true" || text == "false") return text == "true";
  } else if (std::holds_alternative<std::int64_t>(spec.default_value)) {
    if (const auto whole = read_number<std::int64_t>(text)) return *whole;
  } else if (const auto number = read_number<double>(text)) {
    return *number;
  }
  refuse(spec, text);
}

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
