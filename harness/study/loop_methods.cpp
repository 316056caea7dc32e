// SPDX-License-Identifier: MIT
#include "harness/study/loop_methods.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "algorithms/diagnosis/rules.hpp"
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
  LoopAnswer answer;
  for (const loop::EffectFinding& effect : diagnosis.effects) {
    answer.effects.push_back({effect.family, {}, effect.another_shape});
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
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (!std::ranges::binary_search(test, data.movement[i])) continue;
    if (diagnosis.masked[i] != 0) continue;
    answer.before[i] = before[static_cast<Eigen::Index>(i)];
    answer.after[i] = after[static_cast<Eigen::Index>(i)];
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
