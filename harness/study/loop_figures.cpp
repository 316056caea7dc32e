// SPDX-License-Identifier: MIT
#include "harness/study/loop_figures.hpp"

#include <fmt/format.h>

#include "harness/study/figure_table.hpp"
#include "problems/friction/planted_effects.hpp"

namespace tribench {
namespace {

using Choice = FigureTable::Choice;

Choice in_group(std::string group) {
  return [group = std::move(group)](const LoopOutcome& o) { return o.group == group; };
}
Choice in_group(std::string group, double scale) {
  return [group = std::move(group), scale](const LoopOutcome& o) {
    return o.group == group && o.scale == scale;
  };
}

void add_null_figures(FigureTable& table) {
  const Choice effect = [](const LoopOutcome& o) { return !o.claimed.empty(); };
  const Choice unknown = [](const LoopOutcome& o) { return o.unknown; };
  const Choice any = [](const LoopOutcome& o) { return o.is_any(); };
  table.rate("false alarm, library", in_group("null"), effect, {0.5, false});
  table.rate("false alarm, leftover", in_group("null"), unknown, {0.5, false});
  table.rate("false alarm, any", in_group("null"), any, {1, false});
  table.rate("false alarm, any, hard noise", in_group("hard"), any, {1.5, false});
  table.rate("false alarm, any, constant velocities only", in_group("constant_velocity"), any,
             {1.5, false});
  table.rate("for comparison: rows taken for independent, F test and BH 5 %", in_group("null"),
             [](const LoopOutcome& o) { return o.naive.f_test; }, {100, false});
  table.rate("for comparison: rows taken for independent, BIC", in_group("null"),
             [](const LoopOutcome& o) { return o.naive.bic; }, {100, false});
  table.rate("false burst per clean run", in_group("null"),
             [](const LoopOutcome& o) { return o.events > 0; }, {1, false});
}

void add_single_figures(FigureTable& table) {
  const Choice first = [](const LoopOutcome& o) { return o.is_first_right(); };
  const Choice exact = [](const LoopOutcome& o) { return o.is_exact(); };
  const auto without_temperature = [](double scale) {
    return [scale](const LoopOutcome& o) {
      return o.group == "single" && o.scale == scale && o.family() != "temperature";
    };
  };
  for (const auto& [scale, target] :
       {std::pair{4.0, 99.0}, {2.0, 99.0}, {1.0, 99.0}, {0.5, 95.0}, {0.25, 75.0}}) {
    table.rate(fmt::format("first pick right, k = {}", scale), in_group("single", scale), first,
               {target, true});
  }
  for (const double scale : {4.0, 2.0, 1.0}) {
    table.rate(fmt::format("exact verdict, k = {}", scale), in_group("single", scale), exact,
               {97, true});
    table.rate(fmt::format("first pick right without temperature, k = {}", scale),
               without_temperature(scale), first, {99.5, true});
  }
  table.rate("temperature found, k >= 1",
             [](const LoopOutcome& o) {
               return o.group == "single" && o.family() == "temperature" && o.scale >= 1;
             },
             first, {95, true});
  table.rate(
      "truth in winner or alias set among detections, k = 0.25",
      [](const LoopOutcome& o) {
        return o.group == "single" && o.scale == 0.25 && !o.claimed.empty();
      },
      [](const LoopOutcome& o) { return o.is_covered(); }, {98, true});
  table.rate(
      "confidently wrong",
      [](const LoopOutcome& o) { return o.group == "single" || o.group == "outside"; },
      [](const LoopOutcome& o) { return o.is_wrong(); }, {0.5, false});
  const auto after = [](const LoopOutcome& o) { return o.mae_after; };
  const auto ceiling = [](const LoopOutcome& o) { return o.mae_noise; };
  for (const auto& [scale, target] :
       {std::pair{0.5, 1.01}, {1.0, 1.01}, {2.0, 1.01}, {4.0, 1.02}}) {
    table.ratio(fmt::format("held-out MAE after / ceiling, k = {}", scale),
                in_group("single", scale), after, ceiling, 1, {target, false});
  }
  for (const auto& [scale, target] :
       {std::pair{0.25, 80.0}, {0.5, 93.0}, {1.0, 98.0}, {2.0, 99.0}, {4.0, 99.0}}) {
    table.ratio(
        fmt::format("closed fraction [%], k = {}", scale), in_group("single", scale),
        [](const LoopOutcome& o) { return o.mae_before - o.mae_after; },
        [](const LoopOutcome& o) { return o.mae_before - o.mae_noise; }, 100, {target, true});
  }
}

void add_other_figures(FigureTable& table) {
  const Choice exact = [](const LoopOutcome& o) { return o.is_exact(); };
  struct PairTargets {
    double scale, exact, precision, recall;
  };
  for (const PairTargets& t : {PairTargets{0.5, 75, 96, 87}, {1, 95, 99, 97}, {2, 96, 99, 98}}) {
    const Choice pairs = in_group("pair", t.scale);
    table.rate(fmt::format("two effects, exact, k = {}", t.scale), pairs, exact, {t.exact, true});
    table.share(
        fmt::format("two effects, precision, k = {}", t.scale), pairs,
        [](const LoopOutcome& o) { return o.right(); },
        [](const LoopOutcome& o) { return o.claimed.size(); }, {t.precision, true});
    table.share(
        fmt::format("two effects, recall, k = {}", t.scale), pairs,
        [](const LoopOutcome& o) { return o.right(); },
        [](const LoopOutcome& o) { return o.planted.size(); }, {t.recall, true});
  }
  const auto slow = [](const LoopOutcome& o) { return o.family() == "slow_oscillation"; };
  const Choice sharp = [slow](const LoopOutcome& o) {
    return o.group == "outside" && o.scale >= 0.5 && !slow(o);
  };
  table.rate("UNKNOWN found, bumps and interaction, k >= 0.5", sharp,
             [](const LoopOutcome& o) { return o.unknown; }, {99, true});
  table.rate("UNKNOWN located, the same", sharp, [](const LoopOutcome& o) { return o.located; },
             {93, true});
  table.rate(
      "UNKNOWN found, slow oscillation, k >= 1",
      [slow](const LoopOutcome& o) { return o.group == "outside" && o.scale >= 1 && slow(o); },
      [](const LoopOutcome& o) { return o.unknown; }, {85, true});
  for (const auto& [scale, target] : {std::pair{8.0, 95.0}, {16.0, 100.0}}) {
    table.share(
        fmt::format("bursts found, {} sd", scale), in_group("collision", scale),
        [](const LoopOutcome& o) { return o.bursts_found; },
        [](const LoopOutcome& o) { return o.bursts; }, {target, true});
  }
}

// The planted families at k >= 1 that were missed most, so that a table that falls short says why.
void add_family_figures(FigureTable& table) {
  for (const PlantedShape& shape : planted_shapes()) {
    const std::string family(shape.family);
    table.rate(
        fmt::format("exact verdict, {}, k >= 1", family),
        [family](const LoopOutcome& o) { return o.family() == family && o.scale >= 1; },
        [](const LoopOutcome& o) { return o.is_exact(); }, {shape.in_library ? 97.0 : 0.0, true});
  }
}

}  // namespace

std::vector<LoopFigure> loop_figures(const std::vector<LoopOutcome>& outcomes) {
  FigureTable table(outcomes);
  add_null_figures(table);
  add_single_figures(table);
  add_other_figures(table);
  add_family_figures(table);
  return std::move(table.figures);
}

}  // namespace tribench
