// SPDX-License-Identifier: MIT
//
// loop.md: the answer in sentences, then the details in tables; two screens.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reports/figures.hpp"
#include "reports/loop_report.hpp"
#include "reports/loop_words.hpp"
#include "reports/markdown.hpp"

namespace tribench {
namespace {

constexpr std::size_t kMostListed = 6;  // of a list or table; loop.json has all

std::string interval(const LoopUnit& unit, double low, double high) {
  return fmt::format("{} .. {}", figure(unit.factor * low, kLoopDigits),
                     figure(unit.factor * high, kLoopDigits));
}

std::string errors_of(const LoopRecord& record) {
  const LoopError& error = record.error;
  const LoopUnit unit = torque_unit(record);
  MarkdownTable table({{fmt::format("mean absolute error ({})", unit.name)}, {"", Align::right}});
  const auto add = [&](const char* label, double value) {
    if (std::isfinite(value)) table.add({label, figure(unit.factor * value, kLoopDigits)});
  };
  add("before", error.mae_before);
  add("after", error.mae_after);
  if (std::isfinite(error.difference_low)) {
    table.add({"improvement, 95 %", interval(unit, error.difference_low, error.difference_high)});
  }
  add("the noise at least: no model does better", error.ceiling);
  add("the noise at most: a smooth model of these inputs gets there", error.attainable);
  const std::string closed = closed_share(error);
  if (!closed.empty()) table.add({"of the gap to the noise closed", closed});
  std::string text = "\n## Error before and after\n\n" + table.text();
  text += fmt::format("\nJudged on: {}{}.\n",
                      error.how.empty() ? "nothing" : plain_text(record, error.how),
                      error.test_movements > 0 ? fmt::format(" ({})", error.test_movements) : "");
  if (!error.ceiling_note.empty()) {
    text += fmt::format("No share of the gap: {}.\n", plain_text(record, error.ceiling_note));
  }
  return text;
}

std::string card_line(const LoopCard& card) {
  std::string text = fmt::format("- **{}**: {}", card.title, card.amount);
  if (!card.share.empty()) text += ", " + card.share;
  text += fmt::format("; {}. {}", card.grade, card.sure);
  if (!card.bristles.empty()) text += ' ' + card.bristles;
  for (const std::string& doubt : card.doubts) text += ' ' + doubt;
  if (!card.rivals.empty()) text += ' ' + card.rivals;
  if (!card.settle.empty()) text += ' ' + card.settle;
  return text + '\n';
}

std::string effects_table(const LoopRecord& record) {
  if (record.effects.empty()) return {};
  MarkdownTable table(
      {{"effect"}, {"parameters, 95 %"}, {"p", Align::right}, {"evidence, nats", Align::right}});
  for (const LoopEffect& effect : record.effects) {
    table.add({family_title(record, effect.family), parameter_words(effect),
               figure(effect.adjusted_p, 2),
               fmt::format("{} +- {}", figure(effect.gain), figure(effect.gain_error, 2))});
  }
  return "\n## The effects in figures\n\n" + table.text() +
         "\np: chance that noise looks like this anywhere in the search; evidence: log likelihood "
         "gained "
         "on movements left out.\n";
}

std::string list_of(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = fmt::format("\n## {}\n\n", title);
  for (std::size_t i = 0; i < std::min(lines.size(), kMostListed); ++i)
    text += fmt::format("- {}\n", lines[i]);
  if (lines.size() > kMostListed)
    text += fmt::format("- and {} more in loop.json\n", lines.size() - kMostListed);
  return text;
}

std::string next_movements_of(const LoopRecord& record) {
  if (record.next_movements.empty()) return {};
  MarkdownTable table({{"movement"},
                       {"velocity", Align::right},
                       {"from", Align::right},
                       {"to", Align::right},
                       {"load", Align::right},
                       {"tells apart"},
                       {"by", Align::right}});
  for (std::size_t i = 0; i < std::min(record.next_movements.size(), kMostListed); ++i) {
    const LoopNextMovement& one = record.next_movements[i];
    table.add({plain_text(record, one.kind), figure(one.velocity), figure(one.from), figure(one.to),
               figure(one.load_factor), plain_text(record, one.between), figure(one.separation)});
  }
  return "\n## Next movements\n\nBest first; `load` is the factor on the gravity torque, `by` the "
         "mean "
         "squared difference of the explanations over the noise's variance. `next_movements.csv` "
         "has all.\n\n" +
         table.text();
}

std::string model_of(const LoopRecord& record) {
  if (record.formula.empty()) return {};
  std::string text = "\n## The model now\n\n";
  for (const LoopTerm& term : record.terms) {
    if (term.formula.empty()) continue;
    text += fmt::format("- {}: `{}`\n",
                        term.family.empty() ? "base" : family_title(record, term.family),
                        readable_formula(term.formula));
  }
  MarkdownTable table(
      {{"symbol"}, {"is"}, {"unit"}, {"seen from", Align::right}, {"to", Align::right}});
  for (const LoopSymbol& symbol : record.symbols) {
    if (!symbol.used || symbol.name.starts_with("sgn_")) continue;
    table.add({markdown_code(symbol.name), symbol.meaning, symbol.unit, figure(symbol.low),
               figure(symbol.high)});
  }
  return text + "\n" + table.text() +
         "\nFour digits; `loop.json` has all, `loop.html` the C code.\n";
}

std::string data_of(const LoopRecord& record) {
  if (record.steps.empty()) return {};
  MarkdownTable table({{"what was done to the data"}, {"rows left", Align::right}});
  for (const LoopDataStep& step : record.steps) {
    table.add({plain_text(record, step.what), std::to_string(step.rows)});
  }
  return "\n## The data\n\n" + table.text();
}

}  // namespace

std::string loop_markdown(const LoopRecord& record) {
  const LoopWords words = loop_words(record);
  std::string text = fmt::format("# Closing the loop: {}\n\n**{}**\n\n{}\n\n", record.title,
                                 words.headline, words.error);
  for (const LoopCard& card : words.cards) text += card_line(card);
  for (const std::string* one : {&words.leftover, &words.detectable}) {
    if (!one->empty()) text += fmt::format("{}{}\n", words.cards.empty() ? "" : "\n", *one);
  }
  if (!words.unused.empty()) text += words.unused + '\n';
  for (const std::string& one : words.needed) text += fmt::format("- Needed: {}.\n", one);
  text += fmt::format("\nNext: {}\n", words.next);
  text += errors_of(record) + effects_table(record) + model_of(record);
  text += list_of("What these data cannot show", words.untestable);
  text += list_of("What these data cannot tell apart", words.aliased);
  text += list_of("Bursts, left out of every fit and no friction", words.bursts);
  text += next_movements_of(record) + data_of(record);
  text += list_of("Remarks", words.remarks);
  return without_tags(text);
}

}  // namespace tribench
