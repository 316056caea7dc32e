// SPDX-License-Identifier: MIT
#include "harness/study/figure_table.hpp"

#include <fmt/format.h>

#include "reports/statistics/intervals.hpp"

namespace tribench {
namespace {

bool is_met(double value, FigureTable::Target target) {
  return target.at_least ? value >= target.value : value <= target.value;
}

std::string text_of(FigureTable::Target target) {
  return fmt::format("{} {:.4g}", target.at_least ? ">=" : "<=", target.value);
}

}  // namespace

void FigureTable::rate(const std::string& name, const Choice& among, const Choice& hit,
                       Target target) {
  share(
      name, among, [&hit](const LoopOutcome& one) -> std::size_t { return hit(one) ? 1 : 0; },
      [](const LoopOutcome&) -> std::size_t { return 1; }, target);
}

void FigureTable::share(const std::string& name, const Choice& among, const Count& hit,
                        const Count& trial, Target target) {
  std::size_t hits = 0;
  std::size_t trials = 0;
  for (const LoopOutcome& one : outcomes_) {
    if (!among(one)) continue;
    hits += hit(one);
    trials += trial(one);
  }
  add_rate(name, hits, trials, target);
}

void FigureTable::ratio(const std::string& name, const Choice& among, const Size& above,
                        const Size& below, double factor, Target target) {
  double a = 0;
  double b = 0;
  for (const LoopOutcome& one : outcomes_) {
    if (!among(one)) continue;
    a += above(one);
    b += below(one);
  }
  if (b == 0) return;
  LoopFigure figure;
  figure.name = name;
  figure.value = figure.low = figure.high = factor * a / b;
  figure.target = text_of(target);
  figure.met = is_met(figure.value, target);
  figures.push_back(figure);
}

void FigureTable::add_rate(const std::string& name, std::size_t hits, std::size_t trials,
                           Target target) {
  if (trials == 0) return;
  const ConfidenceInterval interval = wilson(hits, trials, kConfidence);
  LoopFigure figure;
  figure.name = name;
  figure.hits = hits;
  figure.trials = trials;
  figure.value = 100 * static_cast<double>(hits) / static_cast<double>(trials);
  figure.low = 100 * interval.low;
  figure.high = 100 * interval.high;
  figure.target = text_of(target) + " %";
  figure.met = is_met(figure.value, target);
  figures.push_back(figure);
}

}  // namespace tribench
