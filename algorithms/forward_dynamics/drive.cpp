// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench::forward {
namespace {

constexpr std::size_t kMostRowsBack = 1000;

struct DelayedName {
  std::string name;
  std::size_t rows_back = 0;
};

// "q_2" is q two rows before, unless something is called q_2.
DelayedName split_delay(const std::string& name) {
  const std::size_t bar = name.rfind('_');
  if (bar == std::string::npos || bar == 0) return {name, 0};
  const std::string_view digits = std::string_view(name).substr(bar + 1);
  std::size_t rows = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), rows);
  if (error != std::errc() || stop != digits.data() + digits.size() || rows == 0 ||
      rows > kMostRowsBack) {
    return {name, 0};
  }
  return {name.substr(0, bar), rows};
}

std::optional<ControlInput> undelayed(const std::string& name, const NamedColumns& columns,
                                      std::vector<std::string>& used) {
  const auto column = std::ranges::find(columns.columns, name, &NamedColumns::Column::name);
  const Role role = column == columns.columns.end() ? Role::none : column->role;
  if (role == Role::position || (column == columns.columns.end() && name == "q")) {
    return ControlInput{ControlInput::Kind::position};
  }
  if (role == Role::velocity || (column == columns.columns.end() && name == "v")) {
    return ControlInput{ControlInput::Kind::velocity};
  }
  if (column == columns.columns.end()) return std::nullopt;
  const auto known = std::ranges::find(used, name);
  const auto place = static_cast<std::size_t>(known - used.begin());
  if (known == used.end()) used.push_back(name);
  return ControlInput{ControlInput::Kind::column, place};
}

std::vector<ControlInput> bind_control(const std::vector<std::string>& names,
                                       const NamedColumns& columns, std::vector<std::string>& used,
                                       std::string_view place) {
  std::vector<ControlInput> inputs;
  for (const std::string& name : names) {
    std::optional<ControlInput> input = undelayed(name, columns, used);
    if (!input) {
      const DelayedName delayed = split_delay(name);
      if (delayed.rows_back > 0) input = undelayed(delayed.name, columns, used);
      if (input) input->rows_back = delayed.rows_back;
    }
    if (!input) {
      std::vector<std::string> known = {"q", "v"};
      for (const auto& each : columns.columns) known.push_back(each.name);
      throw_bad_input(fmt::format("a controller sees no '{}'", name), place,
                      did_you_mean(name, known));
    }
    inputs.push_back(*input);
  }
  return inputs;
}

}  // namespace

Controller parse_controller(std::string_view law, std::string_view limit,
                            const NamedColumns& columns, std::string_view place) {
  Controller controller;
  std::vector<std::string> names;
  controller.law = parse_collecting_names(law, names);
  controller.inputs = bind_control(names, columns, controller.columns, place);
  if (limit.empty()) return controller;
  std::vector<std::string> limit_names;
  controller.limit = parse_collecting_names(limit, limit_names);
  controller.limit_inputs = bind_control(limit_names, columns, controller.columns, "--limit");
  return controller;
}

ControlRun::ControlRun(const Controller& controller, std::vector<std::span<const double>> columns)
    : controller_(controller), columns_(std::move(columns)) {
  for (const auto* inputs : {&controller.inputs, &controller.limit_inputs}) {
    for (const ControlInput& input : *inputs) kept_ = std::max(kept_, input.rows_back + 1);
  }
}

void ControlRun::begin(std::size_t /*row*/, double position, double velocity, double row_s) {
  positions_.clear();
  velocities_.assign(kept_, velocity);
  for (std::size_t back = 1; back <= kept_; ++back) {
    positions_.push_back(position - static_cast<double>(back) * row_s * velocity);
  }
}

double ControlRun::value(const Expression& formula, std::span<const ControlInput> inputs,
                         std::size_t row) {
  point_.clear();
  for (const ControlInput& input : inputs) {
    switch (input.kind) {
      case ControlInput::Kind::position:
        point_.push_back(positions_[input.rows_back]);
        break;
      case ControlInput::Kind::velocity:
        point_.push_back(velocities_[input.rows_back]);
        break;
      case ControlInput::Kind::column:
        point_.push_back(columns_[input.column][row - std::min(row, input.rows_back)]);
        break;
    }
  }
  return evaluator_.evaluate_at(formula, point_);
}

double ControlRun::next(std::size_t row, double position, double velocity) {
  positions_.insert(positions_.begin(), position);
  positions_.pop_back();
  velocities_.insert(velocities_.begin(), velocity);
  velocities_.pop_back();
  const double output = value(controller_.law, controller_.inputs, row);
  if (!controller_.limit) return output;
  const double limit = value(*controller_.limit, controller_.limit_inputs, row);
  return std::clamp(output, -limit, limit);
}

}  // namespace tribench::forward
