// SPDX-License-Identifier: MIT
#include "harness/study/loop_methods.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "algorithms/campaign/rules.hpp"
#include "harness/loop/bristles_of.hpp"
#include "harness/loop/judged_diagnosis.hpp"

namespace tribench {

namespace {

LoopAnswer diagnose(const LoopCase& one, const PlantedData& planted,
                    const std::vector<std::string>& without) {
  const loop::Observations data = loop::observe(planted.data);
  loop::DiagnosisOptions options;
  options.physical_vetoes = !one.any_sign;
  options.gear_ratios = {one.gear_ratio};
  options.without = without;
  const std::vector<int> test = loop::held_out_movements(data, loop::JudgingOptions().test_share);
  const loop::Diagnosis diagnosis = loop::diagnose(data, loop::coulomb_viscous_base, options, test);
  const std::optional<loop::Bristles> bristles = loop::bristles_of(diagnosis, data);
  LoopAnswer answer;
  for (const loop::EffectFinding& effect : diagnosis.effects) {
    if (diagnosis.verdict == loop::Verdict::cannot_tell) break;  // named as what might be
    answer.effects.push_back({effect.family, {}, effect.another_shape, 0});
    if (bristles && effect.family == diagnosis.families[bristles->family].name) {
      answer.effects.back().stiffness = bristles->stiffness;
      answer.effects.back().stiffness_low = bristles->low;
      answer.effects.back().stiffness_high = bristles->high;
    }
    for (const loop::AliasFinding& alias : effect.aliases) {
      answer.effects.back().aliases.push_back(alias.family);
    }
  }
  answer.unknown = diagnosis.verdict == loop::Verdict::unknown;
  answer.inputs = diagnosis.leftover.inputs;
  for (const loop::EventFinding& event : diagnosis.events) {
    answer.bursts.push_back({event.movement, event.begin, event.end});
  }
  const Eigen::VectorXd before = loop::predict(diagnosis.before, data);
  const Eigen::VectorXd after = loop::predict(diagnosis.after, data);
  answer.before.assign(data.rows(), std::numeric_limits<double>::quiet_NaN());
  answer.after = answer.before;
  answer.with_state = answer.before;
  const Eigen::VectorXd with_state = bristles ? loop::predict(*bristles, data) : after;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (!std::ranges::binary_search(test, data.movement[i])) continue;
    if (diagnosis.masked[i] != 0) continue;
    answer.before[i] = before[static_cast<Eigen::Index>(i)];
    answer.after[i] = after[static_cast<Eigen::Index>(i)];
    answer.with_state[i] = with_state[static_cast<Eigen::Index>(i)];
  }
  return answer;
}

}  // namespace

LoopMethod diagnosis_without(std::vector<std::string> rules) {
  for (const std::string& rule : rules) loop::find_rule(rule);
  return [rules = std::move(rules)](const LoopCase& one, const PlantedData& planted) {
    return diagnose(one, planted, rules);
  };
}

}  // namespace tribench
