// SPDX-License-Identifier: MIT
#include "harness/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "foundation/error.hpp"
#include "foundation/plain_name.hpp"
#include "problems/variant.hpp"

namespace tribench {
namespace {

std::string text_of(const ParameterValue& value) {
  return std::visit([](const auto& plain) { return fmt::format("{}", plain); }, value);
}

std::vector<std::string> multiplied(const std::vector<std::string>& suffixes,
                                    const std::string& key, const std::vector<double>& values) {
  std::vector<std::string> all;
  for (const std::string& suffix : suffixes) {
    for (const double value : values) all.push_back(suffix + variant_suffix(key, value));
  }
  return all;
}

}  // namespace

Sweep::Sweep(const TomlTable& grid, const Registry& registry) : registry_(registry) {
  const std::vector<std::string> keys = grid.keys("sweep");
  const TomlTable table = grid.table("sweep", keys);
  // Before they are made: of the problems' values, and of each method's.
  std::map<std::string, std::size_t> combinations;
  const auto multiply = [&](const std::string& of, std::size_t values, const std::string& place) {
    std::size_t& product = combinations.try_emplace(of, 1).first->second;
    product *= std::min(values, Grid::kMostCells);
    if (product <= Grid::kMostCells) return;
    throw_bad_input(fmt::format("the sweep has more than {} combinations", Grid::kMostCells), place,
                    "sweep fewer values");
  };
  for (const std::string& key : keys) {
    if (key == kNoiseKey || key == kRowsKey) {
      std::vector<double> values;
      table.read(key, values);
      if (values.empty()) throw_bad_input(fmt::format("'{}' has no value", key), table.place(key));
      multiply("", values.size(), table.place(key));
      for (const double value : values) {
        at_place(table.place(key), [&] { check_variant(variant_suffix(key, value)); });
      }
      suffixes_ = multiplied(suffixes_, key, values);
      continue;
    }
    const std::size_t dot = key.rfind('.');
    if (dot == std::string::npos || dot == 0) {
      throw_bad_input(fmt::format("'{}' cannot be swept", key), table.place(key),
                      "sweep noise, rows or \"METHOD.PARAMETER\"");
    }
    parameters_.push_back(
        {key.substr(0, dot), key.substr(dot + 1), table.value_array(key), table.place(key)});
    multiply(parameters_.back().method, parameters_.back().values.size(), table.place(key));
  }
}

std::vector<std::string> Sweep::over_problems(const std::vector<std::string>& problems) const {
  std::vector<std::string> all;
  for (const std::string& problem : problems) {
    for (const std::string& suffix : suffixes_) {
      all.push_back(problem + suffix);
    }
  }
  return all;
}

std::vector<Method> Sweep::over_method(const Method& method) const {
  std::vector<Method> all = {method};
  for (const Parameter& parameter : parameters_) {
    if (parameter.method != method.name) continue;
    std::vector<Method> more;
    for (const Method& one : all) {
      for (const ParameterValue& value : parameter.values) {
        Method changed = one;
        changed.name = fmt::format("{}-{}-{}", one.name, parameter.name, text_of(value));
        require_plain_name(changed.name, "a method of a sweep", parameter.place);
        changed.parameters[parameter.name] = value;
        if (!changed.is_external()) {
          at_place(parameter.place,
                   [&] { return registry_.make(changed.algorithm, changed.parameters); });
        }
        more.push_back(std::move(changed));
      }
    }
    all = std::move(more);
  }
  return all;
}

void Sweep::require_methods(const std::vector<std::string>& names) const {
  for (const Parameter& parameter : parameters_) {
    if (std::ranges::count(names, parameter.method) > 0) continue;
    throw_bad_input(fmt::format("'{}' is swept, and the grid does not run it", parameter.method),
                    parameter.place, fmt::format("methods: {}", fmt::join(names, ", ")));
  }
}

}  // namespace tribench
