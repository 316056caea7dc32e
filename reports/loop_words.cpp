// SPDX-License-Identifier: MIT
#include "reports/loop_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "foundation/text.hpp"
#include "reports/figures.hpp"

namespace tribench {
namespace {

// Shares of the searches with movements left out that find an effect again.
constexpr double kVerySure = 0.95;
constexpr double kSure = 0.8;
constexpr std::size_t kNamedEffects = 3;  // in the headline
constexpr std::size_t kNamedSizes = 5;    // that would have been seen
constexpr std::size_t kNamedMovements = 3;

bool known(double value) { return std::isfinite(value); }

// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& items, std::string_view last = "and") {
  if (items.empty()) return {};
  std::string text = items[0];
  for (std::size_t i = 1; i < items.size(); ++i) {
    text += i + 1 == items.size() ? fmt::format(" {} ", last) : ", ";
    text += items[i];
  }
  return text;
}

// What an experiment's code, or a sentence that stands for one, asks for.
std::string ask_of(const LoopRecord& record, const std::string& code) {
  return code.empty() ? code : plain_text(record, code);
}

std::string amount(const LoopUnit& unit, double value) {
  return fmt::format("{} {}", figure(unit.factor * value, kLoopDigits), unit.name);
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

std::string where_judged(const LoopError& error) {
  switch (error.judged_on) {
    case LoopJudgedOn::pieces_of_movements:
      return "on pieces of the recording that it never saw";
    case LoopJudgedOn::rows_of_the_fit:
      return "on the rows that it was fitted to";
    case LoopJudgedOn::other_movements:
      break;
  }
  return "on movements that it never saw";
}

// " Simulated 0.5 s ahead, the joint is 0.82 -> 0.31 deg off."
std::string motion_sentence(const LoopRecord& record) {
  const LoopMotion& motion = record.motion;
  if (!known(motion.after)) return {};
  const LoopUnit unit = length_unit(motion.unit, motion.after);
  const auto shown = [&](double value) { return figure(unit.factor * value, kLoopDigits); };
  return fmt::format(
      " Simulated {} s ahead, the joint is {}{} {} off{}.", figure(motion.horizon_s, 2),
      record.effects.empty() ? "" : shown(motion.before) + " -> ", shown(motion.after), unit.name,
      motion.held_out ? "" : " on the movements of the fit");
}

std::string error_sentence(const LoopRecord& record) {
  const LoopError& error = record.error;
  const LoopUnit unit = torque_unit(record);
  if (!known(error.mae_before)) return "No error before and after could be computed.";
  const auto shown = [&](double value) { return figure(unit.factor * value, kLoopDigits); };
  std::string text;
  if (record.effects.empty()) {
    text =
        fmt::format("Mean error {} {} {}", shown(error.mae_after), unit.name, where_judged(error));
  } else {
    text = fmt::format("Mean error {} -> {} {} {}", shown(error.mae_before), shown(error.mae_after),
                       unit.name, where_judged(error));
    if (!error.confirmed) {
      text += ", which do not confirm the effects";
    } else if (known(error.difference_low) && known(error.difference_high)) {
      text += fmt::format(" (better by {} to {})", figure(unit.factor * error.difference_low, 2),
                          figure(unit.factor * error.difference_high, 2));
    }
  }
  const double room = error.mae_after - error.ceiling;
  if (known(room) && record.verdict == LoopVerdict::none && room > 0.5 * error.mae_after) {
    text += fmt::format(
        "; {} {} of it lasts from row to row and goes with none of the inputs: noise that "
        "lasts, or a cause in time that no column tells",
        figure(unit.factor * room, 2), unit.name);
  } else if (known(room) && record.verdict != LoopVerdict::cannot_tell) {
    text += room > 0.01 * error.mae_after ? fmt::format("; at most {} {} more can be had",
                                                        figure(unit.factor * room, 2), unit.name)
                                          : std::string("; the rest is noise");
  }
  return text + '.' + motion_sentence(record);
}

bool is_very_sure(const LoopEffect& effect) {
  return known(effect.chosen_share) && effect.chosen_share >= kVerySure;
}

std::string found_again(double share) {
  return fmt::format("Found again in {} of the repeats.", percent(share));
}

std::string grade_of(const LoopEffect& effect) {
  if (!effect.objection.empty()) return "not physical";
  if (effect.provisional) return "provisional";
  if (!known(effect.chosen_share)) return "passes the test";
  if (is_very_sure(effect)) return "very sure";
  if (effect.chosen_share >= kSure) return "sure";
  return "likely";
}

std::vector<std::string> doubts_of(const LoopRecord& record, const LoopEffect& effect) {
  std::vector<std::string> all;
  if (!effect.objection.empty()) {
    all.push_back(fmt::format("Not physical ({}): it stands for something else.",
                              plain_text(record, effect.objection)));
  } else if (!record.error.confirmed) {
    all.push_back("The movements that were left out do not confirm it.");
  } else if (effect.told_by_others) {
    all.push_back(
        "The other effects together can tell nine tenths of it: they may be there to cancel it.");
  } else if (effect.provisional && !record.leftover.varying.term.empty()) {
    all.push_back(fmt::format(
        "It shows between movements only, and may stand for the {}, which differs between them.",
        varying_term(record)));
  } else if (effect.provisional && !record.leftover.inputs.empty()) {
    all.push_back("It shares an input with what is still unexplained.");
  }
  if (effect.another_shape) all.push_back("This cause, but another curve than those known.");
  // That searches without some of them find it all the same says more than their number.
  if (effect.few_movements && !is_very_sure(effect)) {
    all.push_back("Few movements carry it: record more.");
  }
  return all;
}

void add_rivals(LoopCard& card, const LoopRecord& record, const LoopEffect& effect) {
  std::vector<std::string> exact;
  std::vector<std::string> near;
  std::string ask;
  for (const LoopAlias& alias : effect.aliases) {
    (alias.exact ? exact : near).push_back(family_title(record, alias.family));
    if (alias.exact && ask.empty()) ask = ask_of(record, alias.separate_by);
  }
  if (!exact.empty()) {
    card.rivals = fmt::format("These data cannot tell it from {}.", listed(exact, "or"));
  }
  if (!near.empty()) {
    card.rivals +=
        fmt::format("{}It could also be {}.", card.rivals.empty() ? "" : " ", listed(near, "or"));
  }
  const bool settled = card.rivals.empty() && (card.grade == "very sure" || card.grade == "sure");
  if (settled) return;
  if (ask.empty() && !effect.separate_by.empty()) ask = ask_of(record, effect.separate_by[0]);
  if (!ask.empty()) card.settle = fmt::format("To settle it: {}.", ask);
}

// " (every 2.50 mm)" of an effect that repeats.
std::string period_words(const LoopRecord& record, const std::string& family) {
  for (const LoopEffectPicture& picture : record.pictures.effects) {
    if (picture.family != family || !(picture.x.period > 0)) continue;
    const LoopUnit unit = length_unit(picture.x.unit, picture.x.period);
    return fmt::format(" (every {} {})", figure(unit.factor * picture.x.period), unit.name);
  }
  return {};
}

std::string bristles_of(const LoopRecord& record, const LoopEffect& effect) {
  const LoopBristles& b = effect.bristles;
  if (b.law.empty()) return {};
  std::string text = fmt::format("As bristles: stiffness {} {}", figure(b.stiffness, kLoopDigits),
                                 b.stiffness_unit);
  if (std::isfinite(b.stiffness_high)) {
    text += fmt::format(" ({} .. {})", figure(b.stiffness_low), figure(b.stiffness_high));
  }
  text += fmt::format(", sliding from {} {} on", figure(b.sliding), b.sliding_unit);
  if (known(b.mae_after) && b.mae_after < record.error.mae_after) {
    text += fmt::format("; with them as a state the error is {}, not {}",
                        amount(torque_unit(record), b.mae_after),
                        amount(torque_unit(record), record.error.mae_after));
  }
  return text + '.';
}

LoopCard card_of(const LoopRecord& record, const LoopEffect& effect) {
  LoopCard card;
  card.family = effect.family;
  card.title =
      capitalised(family_phrase(record, effect.family)) + period_words(record, effect.family);
  card.noun = family_title(record, effect.family);
  if (known(effect.rms)) {
    card.amount = amount(torque_unit(record), effect.rms);
    if (record.friction_rms > 0) {
      card.share = percent(effect.rms / record.friction_rms) + " of friction";
    }
  }
  card.grade = grade_of(effect);
  card.sure = known(effect.chosen_share) ? found_again(effect.chosen_share)
                                         : "It passes the test against chance.";
  card.bristles = bristles_of(record, effect);
  card.doubts = doubts_of(record, effect);
  add_rivals(card, record, effect);
  return card;
}

std::string effects_clause(const LoopRecord& record) {
  std::vector<std::string> phrases;
  for (const LoopEffect& effect : record.effects) {
    if (phrases.size() == kNamedEffects && record.effects.size() > kNamedEffects + 1) break;
    phrases.push_back(family_phrase(record, effect.family));
  }
  if (phrases.size() < record.effects.size()) {
    phrases.push_back(fmt::format("{} more effects", record.effects.size() - phrases.size()));
  }
  return capitalised(listed(phrases));
}

std::string leftover_inputs(const LoopRecord& record) {
  std::vector<std::string> names;
  for (const std::string& input : record.leftover.inputs) names.push_back(spaced(input));
  return listed(names);
}

bool differs_by_movement(const LoopRecord& record) {
  return record.leftover.inputs == std::vector<std::string>{"movement"};
}

// "the payload differs from movement to movement".
std::string varying_clause(const LoopRecord& record) {
  return fmt::format("the {} differs from movement to movement", varying_term(record));
}

// Where it differs most: "'m7' (1.2 N m), 'm9' (-0.8 N m)".
std::string varying_movements(const LoopRecord& record) {
  std::vector<LoopVarying::OfMovement> movements = record.leftover.varying.movements;
  std::ranges::stable_sort(movements, std::greater{},
                           [](const LoopVarying::OfMovement& one) { return std::abs(one.torque); });
  std::vector<std::string> texts;
  for (const LoopVarying::OfMovement& one : movements) {
    if (texts.size() == kNamedMovements) break;
    texts.push_back(
        fmt::format("'{}' ({})", one.movement, amount(torque_unit(record), one.torque)));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string headline_of(const LoopRecord& record) {
  switch (record.verdict) {
    case LoopVerdict::cannot_tell:
      return record.candidates.empty()
                 ? "These data cannot tell: nothing in them can be tested."
                 : "These data cannot tell: too few movements show what seems to be missing.";
    case LoopVerdict::none:
      if (record.candidates.empty()) return "These data can test none of the known effects.";
      return record.untestable.empty() ? "Nothing is missing: what is left is noise."
                                       : "Nothing is missing that these data can show.";
    case LoopVerdict::effects:
      return effects_clause(record) + '.';
    case LoopVerdict::unknown:
      break;
  }
  const std::string inputs = leftover_inputs(record);
  if (record.effects.empty() && differs_by_movement(record)) {
    return fmt::format("Something is missing that no column tells: {}.", varying_clause(record));
  }
  if (record.effects.empty()) {
    return inputs.empty() ? "Something is missing that is none of the known effects."
                          : fmt::format(
                                "Something is missing that depends on {} and is none of "
                                "the known effects.",
                                inputs);
  }
  return fmt::format("{}; something more is missing that no known effect explains.",
                     effects_clause(record));
}

std::string leftover_of(const LoopRecord& record) {
  const std::string inputs = leftover_inputs(record);
  if (record.verdict != LoopVerdict::unknown || inputs.empty()) return {};
  if (differs_by_movement(record)) {
    return fmt::format(
        "Still unexplained: {}, and no column says why; most in {}. It tells {} of what is left.",
        varying_clause(record), varying_movements(record), percent(record.leftover.varying.share));
  }
  // An effect whose parameters are not physical fits there, and so leaves nothing to be tested.
  if (record.leftover.p > record.alpha_leftover) {
    return fmt::format(
        "Still unexplained: something in {}, where only an effect fits that cannot "
        "be physical.",
        inputs);
  }
  std::string text = fmt::format("Still unexplained: something that depends on {}.", inputs);
  const double share = record.leftover.chosen_share;
  return known(share) ? fmt::format("{} {}", text, found_again(share)) : text;
}

std::string next_movement_words(const LoopRecord& record) {
  const LoopNextMovement& one = record.next_movements[0];
  std::string text = one.kind == "constant" ? fmt::format("a pass at {}", figure(one.velocity))
                                            : "a movement of two sines";
  for (const LoopSymbol& symbol : record.symbols) {
    if (symbol.name == "v" && one.kind == "constant") text += ' ' + symbol.unit;
  }
  if (known(one.load_factor) && one.load_factor != 1) {
    text += fmt::format(" with {} times the load", figure(one.load_factor, 2));
  }
  return text;
}

// The effect that most needs to be settled: provisional or with a rival, found least often.
const LoopCard* least_sure(const LoopRecord& record, const std::vector<LoopCard>& cards) {
  const LoopCard* worst = nullptr;
  double worst_share = 2;
  for (std::size_t i = 0; i < cards.size(); ++i) {
    const LoopEffect& effect = record.effects[i];
    double share = known(effect.chosen_share) ? effect.chosen_share : 1;
    if (effect.provisional || !effect.aliases.empty()) share -= 1;
    if (cards[i].settle.empty() || !(share < worst_share)) continue;
    worst = &cards[i];
    worst_share = share;
  }
  return worst;
}

std::string next_of(const LoopRecord& record, const LoopWords& words) {
  if (record.verdict == LoopVerdict::cannot_tell) {
    return words.needed.empty() ? "Record more movements." : "Record " + words.needed[0] + '.';
  }
  if (differs_by_movement(record)) {
    return "Say what was changed between the movements (load, grease, temperature) in a column, or "
           "diagnose each kind alone (--where COLUMN=VALUE).";
  }
  if (!record.next_movements.empty()) {
    return fmt::format("Record {}: there the explanations left differ most.",
                       next_movement_words(record));
  }
  if (record.verdict == LoopVerdict::unknown && record.learned.empty()) {
    return "Let a method grow it from what is left (--learn pysr), or record movements that vary "
           "its inputs one by one.";
  }
  if (const LoopCard* card = least_sure(record, words.cards)) {
    std::string ask = card->settle;
    const std::string lead = "To settle it: ";
    if (ask.starts_with(lead)) ask = ask.substr(lead.size());
    return fmt::format("To be sure of the {}: {}", card->noun, ask);
  }
  for (const LoopUntestable& one : record.untestable) {
    if (one.ask.empty()) continue;
    return fmt::format("To test what these data cannot show ({}): {}.",
                       family_title(record, one.family), ask_of(record, one.ask));
  }
  return "Nothing: the model stands as it is.";
}

// Which ripples nobody looked for. Empty where that is not known.
std::string ripples_not_looked_at(const LoopRecord& record) {
  if (!known(record.shortest_wave)) return {};
  if (record.shortest_wave_unit == "rad") {
    return fmt::format("ripples of more than {:.0f} waves a turn, unless --gear-ratio names them",
                       2 * std::numbers::pi / record.shortest_wave);
  }
  return fmt::format("ripples of less than {}, unless --screw-lead names them",
                     amount({1000, "mm"}, record.shortest_wave));
}

// Where nothing was found: what would have been, and where nobody looked.
std::string detectable_of(const LoopRecord& record) {
  if (record.verdict != LoopVerdict::none) return {};
  const LoopUnit unit = torque_unit(record);
  std::vector<std::string> sizes;
  std::vector<std::string> without;  // the stretches that hold it are too few for one
  for (const LoopCandidate& one : record.candidates) {
    if (std::isinf(one.detectable)) without.push_back(family_title(record, one.family));
    if (!known(one.detectable) || sizes.size() == kNamedSizes) continue;
    sizes.push_back(fmt::format("{} above {} {}", family_title(record, one.family),
                                figure(unit.factor * one.detectable, 2), unit.name));
  }
  std::vector<std::string> sentences;
  if (!sizes.empty()) sentences.push_back("Would have been seen: " + listed(sizes) + '.');
  if (sizes.empty() && !without.empty()) {
    sentences.push_back("Not known from which size on they would show: " + listed(without) + '.');
  }
  if (const std::string ripples = ripples_not_looked_at(record); !ripples.empty()) {
    sentences.push_back(fmt::format("Not looked at: {}.", ripples));
  }
  for (const LoopDataStep& step : record.steps) {
    if (step.not_looked_at.empty()) continue;
    sentences.push_back(fmt::format("Not looked at: {}.", plain_text(record, step.not_looked_at)));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

// Families with the same reason in one line.
std::vector<std::string> untestable_lines(const LoopRecord& record) {
  std::vector<std::string> reasons;
  std::map<std::string, std::vector<std::string>> families;
  std::map<std::string, std::vector<std::string>> asks;
  for (const LoopUntestable& one : record.untestable) {
    const std::string reason = plain_text(record, one.reason);
    if (std::ranges::count(reasons, reason) == 0) reasons.push_back(reason);
    families[reason].push_back(family_title(record, one.family));
    const std::string ask = ask_of(record, one.ask);
    if (!ask.empty() && std::ranges::count(asks[reason], ask) == 0) asks[reason].push_back(ask);
  }
  std::vector<std::string> lines;
  for (const std::string& reason : reasons) {
    std::string line = fmt::format("{}: {}.", capitalised(listed(families[reason])), reason);
    if (!asks[reason].empty()) line += fmt::format(" To test it: {}.", listed(asks[reason], "or"));
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> aliased_lines(const LoopRecord& record) {
  std::vector<std::string> lines;
  for (const LoopCoincidence& pair : record.aliased) {
    std::string line =
        fmt::format("{} and {} (correlation {}).", capitalised(family_title(record, pair.first)),
                    family_title(record, pair.second), figure(pair.correlation));
    const std::string ask = ask_of(record, pair.separate_by);
    if (!ask.empty()) line += fmt::format(" To tell them apart: {}.", ask);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> burst_lines(const LoopRecord& record) {
  std::vector<std::string> lines;
  for (const LoopBurst& burst : record.bursts) {
    const std::string name =
        burst.movement_name.empty() ? std::to_string(burst.movement) : burst.movement_name;
    lines.push_back(fmt::format("Movement {}, {} to {} s, peak {}.", name, figure(burst.begin),
                                figure(burst.end), amount(torque_unit(record), burst.peak)));
  }
  return lines;
}

}  // namespace

std::string closed_share(const LoopError& error) {
  const double low = error.closed_fraction;
  if (!known(low)) return {};
  const double high = known(error.closed_fraction_high) ? error.closed_fraction_high : low;
  if (std::lround(100 * high) <= std::lround(100 * low)) return percent(low);
  return fmt::format("{:.0f} .. {}", 100 * low, percent(high));
}

// "One column without a role explains part of what is left: 'v_other' (43 %). ..."
std::string unused_of(const LoopRecord& record) {
  constexpr std::size_t kNamed = 3;
  const std::vector<LoopUnusedColumn>& columns = record.unused_columns;
  if (columns.empty()) return {};
  std::vector<std::string> named;
  for (std::size_t k = 0; k < columns.size() && k < kNamed; ++k) {
    named.push_back(fmt::format("'{}' ({})", columns[k].column, percent(columns[k].share)));
  }
  const bool one = columns.size() == 1;
  return fmt::format(
      "{} without a role explain{} part of what is left: {}{}. Say what {} (--roles '{}=ROLE'), "
      "unless {} the torque told otherwise.",
      one ? "One column" : fmt::format("{} columns", columns.size()), one ? "s" : "",
      fmt::join(named, ", "), columns.size() > kNamed ? ", ..." : "", one ? "it is" : "they are",
      columns.front().column, one ? "it is" : "they are");
}

LoopWords loop_words(const LoopRecord& record) {
  LoopWords words;
  words.headline = headline_of(record);
  words.error = error_sentence(record);
  for (const LoopEffect& effect : record.effects) words.cards.push_back(card_of(record, effect));
  words.leftover = leftover_of(record);
  words.detectable = detectable_of(record);
  for (const std::string& one : record.needed) words.needed.push_back(plain_text(record, one));
  words.unused = unused_of(record);
  words.untestable = untestable_lines(record);
  words.aliased = aliased_lines(record);
  words.bursts = burst_lines(record);
  for (const auto* list : {&record.warnings, &record.notes}) {
    for (const std::string& one : *list) {
      words.remarks.push_back(capitalised(plain_text(record, one)) + '.');
    }
  }
  words.next = next_of(record, words);
  return words;
}

}  // namespace tribench
