// SPDX-License-Identifier: MIT
#include "algorithms/campaign/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"

namespace tribench::loop {
namespace {

constexpr std::array kRules = {
    Rule{"whitening", "rows less their share of the row before, where that agrees with plain fits"},
    Rule{"weights", "movements weigh by their own noise"},
    Rule{"bursts", "rows of a burst are left out"},
    Rule{"rescue", "what few movements carry is admitted by its gain"},
    Rule{"most_columns", "a family has two columns at most"},
    Rule{"slight", "what is next to nothing beside the other effects is left out"},
    Rule{"proxies", "what a smoother of the leftover makes superfluous is dropped"},
    Rule{"shape_of_memory", "a small effect beside one that remembers the motion is its shape"},
    Rule{"shape_of_leftover", "a leftover in the inputs of a larger effect is its shape"},
    Rule{"last_resort", "rare effects are looked for where the usual ones leave something over"},
    Rule{"unknown_ripple", "waves of any length in the position are looked for in the leftover"},
    Rule{"cancelling", "what the other effects together can tell gives way or is provisional"},
    Rule{"shaking", "what goes with what shakes the joint and not with its motion is no effect"},
    Rule{"local_defect",
         "ripples and loads that one bump in the position predicts better are dropped"},
    Rule{"random_slopes",
         "what differs from movement to movement is told though no signal says why"},
    Rule{"serial_offsets",
         "offsets and friction of movements that are like their neighbours' are told"}};

}  // namespace

std::span<const Rule> rules() { return kRules; }

const Rule& find_rule(std::string_view name) {
  const auto found = std::ranges::find(kRules, name, &Rule::name);
  if (found != kRules.end()) return *found;
  std::vector<std::string> names;
  for (const Rule& rule : kRules) names.emplace_back(rule.name);
  throw_bad_input(fmt::format("the loop has no rule '{}'", name), {}, did_you_mean(name, names));
}

}  // namespace tribench::loop
