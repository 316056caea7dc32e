// SPDX-License-Identifier: MIT
//
// loop.md: the finding in sentences, the figures in tables.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "reports/figures.hpp"
#include "reports/loop_report.hpp"
#include "reports/loop_words.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

using nlohmann::json;

std::string errors_of(const json& loop) {
  const json error = member_of(loop, "error");
  if (error.empty()) return "No error before and after was computed.\n";
  MarkdownTable table({{"on movements that nothing was fitted to"}, {"value", Align::right}});
  const auto add = [&](const char* key, const char* label) {
    const double value = number_of(error, key);
    table.add({label, figure(value)});
  };
  table.add({"test movements", count_figure(number_of(error, "test_movements"))});
  add("mae_before", "mean absolute error before");
  add("mae_after", "mean absolute error after");
  if (error.contains("ci_diff") && error["ci_diff"].size() == 2) {
    table.add({"improvement, 95 % interval over movements",
               fmt::format("{} .. {}", figure(element_of(error["ci_diff"], 0)),
                           figure(element_of(error["ci_diff"], 1)))});
  }
  add("ceiling", "the noise at least: no model does better");
  add("attainable", "the noise at most: a smooth model of these inputs gets there");
  const double closed = number_of(error, "closed_fraction");
  if (!std::isnan(closed)) {
    table.add({"share of the gap to the noise that was closed", closed_share(error)});
  }
  const std::string note = text_of(error, "ceiling_note");
  return table.text() + (note.empty() ? "" : fmt::format("\nNo closed fraction: {}.\n", note));
}

std::string effects_table(const json& effects) {
  MarkdownTable table({{"order", Align::right},
                       {"effect"},
                       {"term"},
                       {"parameters"},
                       {"rms", Align::right},
                       {"p", Align::right},
                       {"evidence", Align::right}});
  for (const json& effect : effects) {
    table.add({count_figure(number_of(effect, "order")), text_of(effect, "family"),
               markdown_code(text_of(effect, "atom")), parameters_of(effect),
               figure(number_of(effect, "rms_contribution")), figure(number_of(effect, "p_adj"), 2),
               fmt::format("{} +- {}", figure(number_of(effect, "cv_gain")),
                           figure(number_of(effect, "cv_se"), 2))});
  }
  return table.text();
}

std::string candidates_of(const json& loop) {
  const json candidates = items_of(loop, "candidates");
  if (candidates.empty()) return {};
  MarkdownTable table({{"candidate"}, {"p", Align::right}, {"score", Align::right}});
  for (const json& candidate : candidates) {
    table.add({text_of(candidate, "family"), figure(number_of(candidate, "p_adj"), 2),
               figure(number_of(candidate, "score"))});
  }
  return "\n## What was considered\n\n" + table.text();
}

std::string list_of(const char* title, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += fmt::format("- {}\n", line);
  return text.empty() ? text : fmt::format("\n## {}\n\n{}", title, text);
}

std::string next_movements_of(const json& loop) {
  MarkdownTable table({{"order", Align::right},
                       {"movement"},
                       {"velocity", Align::right},
                       {"from", Align::right},
                       {"to", Align::right},
                       {"load", Align::right},
                       {"tells apart"},
                       {"by", Align::right}});
  std::size_t order = 0;
  for (const json& one : items_of(loop, "next_movements")) {
    const auto place = [&](const char* key) { return figure(number_of(one, key)); };
    table.add({std::to_string(++order), text_of(one, "kind"), place("velocity"), place("from"),
               place("to"), place("load_factor"), text_of(one, "between"), place("separation")});
  }
  if (table.empty()) return {};
  return "\n## Next movements\n\nBest first; `load` is the factor on the gravity torque (another "
         "payload or posture), `by` the mean squared difference of the two explanations over the "
         "noise's variance. `next_movements.csv` has durations and tones too.\n\n" +
         table.text();
}

std::string movements_of(const json& loop) {
  const json pictures = member_of(loop, "pictures");
  MarkdownTable table({{"movement"}, {"MAE before", Align::right}, {"MAE after", Align::right}});
  for (const json& movement : items_of(pictures, "movements")) {
    if (!flag_of(movement, "test")) continue;
    table.add({text_of(movement, "name"), figure(number_of(movement, "mae_before")),
               figure(number_of(movement, "mae_after"))});
  }
  return table.empty() ? std::string() : "\n## Held-out movements\n\n" + table.text();
}

}  // namespace

std::string loop_markdown(const json& loop, const std::string& title) {
  std::string text = fmt::format("# Closing the loop: {}\n\n", title);
  text += fmt::format("**{}**\n", verdict_sentence(loop));
  const json effects = items_of(loop, "effects");
  if (!effects.empty()) text += '\n';
  for (const json& effect : effects) text += fmt::format("- {}\n", effect_sentence(effect, loop));
  const std::string leftover = leftover_sentence(loop);
  if (!leftover.empty()) text += fmt::format("- {}\n", leftover);
  text += "\n## Error before and after\n\n" + errors_of(loop);
  if (!effects.empty()) text += "\n## The effects\n\n" + effects_table(effects);
  text += list_of("What these data cannot show", untestable_sentences(loop));
  text += list_of("What these data cannot tell apart", aliased_sentences(loop));
  text += list_of("Bursts, left out of every fit and no friction", event_sentences(loop));
  text += list_of("Remarks", remarks(loop));
  text += next_movements_of(loop) + candidates_of(loop) + movements_of(loop);
  const std::string formula = text_of(loop, "formula");
  if (!formula.empty()) text += fmt::format("\n## The model now\n\n    {}\n", formula);
  return text;
}

}  // namespace tribench
