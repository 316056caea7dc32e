// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/joint_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "algorithms/forward_dynamics/memory.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench::forward {
namespace {

constexpr std::string_view kSign = "sgn_";

const std::vector<std::pair<std::string_view, Source>>& known_names() {
  static const std::vector<std::pair<std::string_view, Source>> kNames = {
      {"q", Source::position},     {"v", Source::velocity},
      {"a", Source::acceleration}, {"sgn_v", Source::direction},
      {"t", Source::time},         {"tau_m", Source::motor_torque},
      {"g", Source::gravity},      {"sgn_g", Source::gravity_sign},
      {"sin_q", Source::sine},     {"cos_q", Source::cosine},
  };
  return kNames;
}

std::optional<Source> source_of(Role role, bool has_gravity) {
  switch (role) {
    case Role::position:
      return Source::position;
    case Role::velocity:
      return Source::velocity;
    case Role::velocity_sign:
      return Source::direction;
    case Role::acceleration:
      return Source::acceleration;
    case Role::time:
      return Source::time;
    case Role::motor_torque:
      return Source::motor_torque;
    case Role::gravity_torque:
      return has_gravity ? std::optional(Source::gravity) : std::nullopt;
    case Role::gravity_sign:
      return has_gravity ? std::optional(Source::gravity_sign) : std::nullopt;
    default:
      return std::nullopt;
  }
}

std::optional<Source> sign_of(Source source) {
  if (source == Source::velocity) return Source::direction;
  if (source == Source::gravity) return Source::gravity_sign;
  return std::nullopt;
}

class Binder {
 public:
  Binder(const NamedColumns& columns, std::string_view place) : columns_(columns), place_(place) {}

  void bind(const std::string& name) {
    if (std::ranges::count(columns_.states, name) > 0) return remember(name);
    if (bind_column(name) || bind_known(name) || bind_sign(name)) return;
    if (memory_of(name)) return remember(name);
    throw_bad_input(fmt::format("'{}' is neither a column nor a quantity of the simulation", name),
                    place_, did_you_mean(name, all_names()));
  }

  JointInputs take() { return std::move(inputs_); }

 private:
  const NamedColumns::Column* column(std::string_view name) const {
    const auto found = std::ranges::find(columns_.columns, name, &NamedColumns::Column::name);
    return found == columns_.columns.end() ? nullptr : &*found;
  }
  const NamedColumns::Column* column(Role role) const {
    const auto found = std::ranges::find(columns_.columns, role, &NamedColumns::Column::role);
    return found == columns_.columns.end() ? nullptr : &*found;
  }

  void add(Source source, std::size_t place = 0) { inputs_.bindings.push_back({source, place}); }

  static std::size_t place_in(std::vector<std::string>& list, const std::string& name) {
    const auto found = std::ranges::find(list, name);
    const auto place = static_cast<std::size_t>(found - list.begin());
    if (found == list.end()) list.push_back(name);
    return place;
  }

  void remember(const std::string& name) { add(Source::memory, place_in(inputs_.memories, name)); }

  void record(Source source, const std::string& name) {
    add(source, place_in(inputs_.recorded, name));
  }

  bool bind_column(const std::string& name) {
    const NamedColumns::Column* found = column(name);
    if (found == nullptr) return false;
    if (const auto source = source_of(found->role, columns_.has_gravity)) {
      add(*source);
    } else {
      record(Source::recorded, name);
    }
    return true;
  }

  bool bind_known(const std::string& name) {
    const auto known =
        std::ranges::find(known_names(), name, &std::pair<std::string_view, Source>::first);
    if (known == known_names().end()) return false;
    const bool of_gravity =
        known->second == Source::gravity || known->second == Source::gravity_sign;
    if (!of_gravity || columns_.has_gravity) {
      add(known->second);
      return true;
    }
    const NamedColumns::Column* recorded = column(Role::gravity_torque);
    if (recorded == nullptr) {
      throw_bad_input(fmt::format("'{}' is the gravity torque, and none is known", name), place_,
                      "give it as a formula in q: --gravity '4.9*sin(q)'");
    }
    record(known->second == Source::gravity ? Source::recorded : Source::recorded_sign,
           recorded->name);
    return true;
  }

  bool bind_sign(const std::string& name) {
    if (!name.starts_with(kSign)) return false;
    const NamedColumns::Column* of = column(name.substr(kSign.size()));
    if (of == nullptr) return false;
    const auto source = source_of(of->role, columns_.has_gravity);
    if (!source) {
      record(Source::recorded_sign, of->name);
      return true;
    }
    const auto sign = sign_of(*source);
    if (!sign) return false;
    add(*sign);
    return true;
  }

  std::vector<std::string> all_names() const {
    std::vector<std::string> names(columns_.states);
    for (const auto& [name, source] : known_names()) names.emplace_back(name);
    for (const auto& each : columns_.columns) names.push_back(each.name);
    names.emplace_back("d");
    names.emplace_back("v_lag30");
    return names;
  }

  const NamedColumns& columns_;
  std::string_view place_;
  JointInputs inputs_;
};

}  // namespace

bool JointInputs::uses(Source source) const {
  return std::ranges::any_of(bindings,
                             [source](const Binding& each) { return each.source == source; });
}

JointInputs bind_inputs(std::span<const std::string> names, const NamedColumns& columns,
                        std::string_view place) {
  Binder binder(columns, place);
  for (const std::string& name : names) binder.bind(name);
  return binder.take();
}

}  // namespace tribench::forward
