// SPDX-License-Identifier: MIT
#include "harness/study/simulated_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/study/figure_table.hpp"
#include "problems/joint_simulation/motion.hpp"
#include "problems/joint_simulation/noise.hpp"

namespace tribench {
namespace {

bool is_null(const LoopOutcome& one) { return one.planted.empty(); }

bool is_strong(const LoopOutcome& one) { return !is_null(one) && one.scale >= 1; }

bool has_memory(const LoopOutcome& one) {
  return one.cause().starts_with("presliding") || one.cause().starts_with("lag");
}

bool has_bristles(const LoopOutcome& one) { return one.stiffness > 0; }

bool is_stiffness_right(const LoopOutcome& one) {
  return std::abs(one.said_stiffness / one.stiffness - 1) <= 0.1;
}

bool is_stiffness_in_interval(const LoopOutcome& one) {
  return one.said_low <= one.stiffness && one.stiffness <= one.said_high;
}

bool is_named(const LoopOutcome& one) {
  return one.says == Says::exact || one.says == Says::another_shape;
}

void add_noise_figures(FigureTable& table) {
  for (const simulation::NoiseKind kind : simulation::kNoiseKinds) {
    const std::string noise(simulation::noise_name(kind));
    table.rate(
        "false alarm, noise " + noise,
        [noise](const LoopOutcome& o) { return is_null(o) && o.noise == noise; },
        [](const LoopOutcome& o) { return o.is_any(); }, {1, false});
  }
  // Nothing that is planted here is a burst.
  for (const simulation::NoiseKind kind : simulation::kNoiseKinds) {
    const std::string noise(simulation::noise_name(kind));
    table.rate(
        "false burst, noise " + noise, [noise](const LoopOutcome& o) { return o.noise == noise; },
        [](const LoopOutcome& o) { return o.events > 0; }, {1, false});
  }
}

void add_memory_figures(FigureTable& table) {
  table.rate("presliding and lag named, k >= 1",
             [](const LoopOutcome& o) { return has_memory(o) && is_strong(o); }, is_named,
             {95, true});
  table.rate("stiffness within 10 %, k >= 1",
             [](const LoopOutcome& o) { return has_bristles(o) && is_strong(o); },
             is_stiffness_right, {95, true});
  table.rate(
      "stiffness in its 95 % interval, k >= 1",
      [](const LoopOutcome& o) { return has_bristles(o) && is_strong(o) && o.said_stiffness > 0; },
      is_stiffness_in_interval, {90, true});
  table.rate(
      "a memory where none is", [](const LoopOutcome& o) { return !has_memory(o); },
      [](const LoopOutcome& o) {
        return std::ranges::any_of(o.claimed, [](const std::string& family) {
          return family == "hysteresis" || family == "lag";
        });
      },
      {1, false});
}

void add_design_figures(FigureTable& table) {
  for (const simulation::Design kind : simulation::kDesigns) {
    const std::string design(simulation::design_name(kind));
    table.rate(
        "false alarm, design " + design,
        [design](const LoopOutcome& o) { return is_null(o) && o.design == design; },
        [](const LoopOutcome& o) { return o.is_any(); }, {1, false});
    table.rate(fmt::format("named, design {}, k >= 1", design),
               [design](const LoopOutcome& o) { return is_strong(o) && o.design == design; },
               is_named, {95, true});
  }
}

}  // namespace

std::vector<LoopFigure> simulated_figures(const std::vector<LoopOutcome>& outcomes) {
  FigureTable table(outcomes);
  table.rate("named, k >= 1", is_strong, is_named, {95, true});
  table.rate(
      "confidently wrong", [](const LoopOutcome& o) { return !is_null(o); },
      [](const LoopOutcome& o) { return o.says == Says::wrong; }, {0.5, false});
  add_memory_figures(table);
  add_noise_figures(table);
  add_design_figures(table);
  return std::move(table.figures);
}

std::vector<CauseAnswers> cause_answers(const std::vector<LoopOutcome>& outcomes) {
  struct Errors {
    double after = 0;
    double noise = 0;
  };
  std::vector<CauseAnswers> answers;
  std::vector<Errors> errors;
  for (const LoopOutcome& one : outcomes) {
    const auto known = std::ranges::find_if(answers, [&](const CauseAnswers& a) {
      return a.cause == one.cause() && a.scale == one.scale;
    });
    const auto at = static_cast<std::size_t>(known - answers.begin());
    if (known == answers.end()) {
      answers.push_back({std::string(one.cause()), one.scale, 0, {}, 0});
      errors.emplace_back();
    }
    ++answers[at].runs;
    ++answers[at].counts[static_cast<std::size_t>(one.says)];
    errors[at].after += one.mae_after;
    errors[at].noise += one.mae_noise;
  }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].error_ratio = errors[i].after / errors[i].noise;
  }
  return answers;
}

}  // namespace tribench
