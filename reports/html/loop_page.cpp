// SPDX-License-Identifier: MIT
#include "reports/html/loop_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/text.hpp"
#include "reports/figures.hpp"
#include "reports/loop_words.hpp"

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostMovements = 2000;
constexpr std::size_t kMostCandidates = 20;

Json number(double value, double factor = 1) {
  // Six digits: more than a picture or a tooltip shows.
  return std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", factor * value))) : Json();
}

Json numbers(const std::vector<double>& values, double factor = 1) {
  Json array = Json::array();
  for (const double value : values) array.push_back(number(value, factor));
  return array;
}

double largest(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) {
    if (std::isfinite(value)) size = std::max(size, std::abs(value));
  }
  return size;
}

LoopUnit axis_unit(const LoopAxis& axis, const std::vector<LoopSeries>& series) {
  double size = axis.period;
  for (const LoopSeries& one : series) size = std::max(size, largest(one.x));
  return length_unit(axis.unit, size);
}

Json series_json(const std::vector<LoopSeries>& all, double x_factor, double factor,
                 const std::string& load_unit) {
  Json list = Json::array();
  for (const LoopSeries& one : all) {
    Json json = {{"name", split_words(one, load_unit)}, {"x", numbers(one.x, x_factor)}};
    const auto add = [&](const char* key, const std::vector<double>& values) {
      if (!values.empty()) json[key] = numbers(values, factor);
    };
    add("measured", one.measured);
    add("spread", one.spread);
    add("before", one.before);
    add("after", one.after);
    add("band", one.band);
    if (!one.rows.empty()) json["rows"] = numbers(one.rows);
    list.push_back(std::move(json));
  }
  return list;
}

Json picture(std::string id, const char* kind, std::string title, std::string caption) {
  return {{"id", std::move(id)},
          {"kind", kind},
          {"title", std::move(title)},
          {"caption", std::move(caption)}};
}

std::string load_unit_of(const LoopRecord& record) {
  for (const LoopSymbol& symbol : record.symbols) {
    if (symbol.name == "g") return symbol.unit;
  }
  return {};
}

Json error_picture(const LoopRecord& record) {
  const LoopError& error = record.error;
  const LoopUnit unit = torque_unit(record);
  Json json = picture("error", "error",
                      record.effects.empty() ? "How large the error is" : "Error before and after",
                      "Mean absolute error on what took no part in the fit.");
  json["x"] = fmt::format("mean error ({})", unit.name);
  json["before"] = number(error.mae_before, unit.factor);
  json["after"] = number(error.mae_after, unit.factor);
  json["before_text"] = figure(unit.factor * error.mae_before, 4);
  json["after_text"] = figure(unit.factor * error.mae_after, 4);
  json["low"] = number(error.mae_before - error.difference_high, unit.factor);
  json["high"] = number(error.mae_before - error.difference_low, unit.factor);
  json["ceiling"] = number(error.ceiling, unit.factor);
  json["attainable"] = number(error.attainable, unit.factor);
  json["changed"] = !record.effects.empty();
  return json;
}

Json friction_picture(const LoopRecord& record) {
  const LoopFrictionPicture& from = record.pictures.friction;
  const LoopUnit unit = torque_unit(record);
  const LoopUnit x = axis_unit(from.x, from.series);
  Json json = picture(
      "friction", "friction", "Friction against velocity",
      fmt::format(
          "Means of rows, with one standard deviation{}; lines: the models for the same rows.",
          from.rigid_part_removed ? ", the rigid body's part taken off" : ""));
  json["x"] = axis_title(from.x, x);
  json["y"] = fmt::format("friction ({})", unit.name);
  json["changed"] = !record.effects.empty();
  json["series"] = series_json(from.series, x.factor, unit.factor, load_unit_of(record));
  return json;
}

Json effect_picture(const LoopRecord& record, const LoopEffectPicture& from,
                    std::size_t number_of) {
  const LoopUnit unit = torque_unit(record);
  const LoopUnit x = axis_unit(from.x, from.series);
  Json json =
      picture("effect-" + std::to_string(number_of), "effect",
              capitalised(family_title(record, from.family)),
              "Points: what the rows say of it, the rest of the model taken off (means, 95 %). "
              "Line: the fitted effect with its 95 % band.");
  json["family"] = from.family;
  json["x"] = axis_title(from.x, x);
  json["y"] = fmt::format("{} ({})", from.against_motion ? "torque against the motion" : "torque",
                          unit.name);
  json["series"] = series_json(from.series, x.factor, unit.factor, load_unit_of(record));
  json["marks"] = numbers(from.marks, x.factor);
  return json;
}

// What differs from movement to movement: a figure a movement, and no mean of rows.
Json varying_picture(const LoopRecord& record, const LoopInputPicture& from) {
  const LoopUnit unit = torque_unit(record);
  Json json = picture(
      "leftover-movements", "input",
      fmt::format("{}: {}",
                  record.leftover.inputs.empty() ? "Movements seem to differ" : "Still unexplained",
                  varying_term(record)),
      "What each movement has of it beyond all of them together, fitted to the "
      "movement alone.");
  json["leftover"] = true;
  json["x"] = "movement, in the recording's order";
  json["y"] = fmt::format("torque, root mean square ({})", unit.name);
  json["changed"] = false;
  json["series"] = series_json(from.series, 1, unit.factor, {});
  return json;
}

Json input_picture(const LoopRecord& record, const LoopInputPicture& from, std::size_t number_of) {
  const LoopUnit unit = torque_unit(record);
  if (from.x.channel == "movement") return varying_picture(record, from);
  const LoopUnit x = axis_unit(from.x, from.series);
  const std::string words = axis_title(from.x, {1, {}});
  Json json = picture(
      (from.leftover ? "leftover-" : "input-") + std::to_string(number_of), "input",
      from.leftover ? "Still unexplained, against " + words : "What is left, against " + words,
      std::string("Mean residual in each direction with its 95 % interval") +
          (record.effects.empty() ? "." : "; grey: before the effects were added."));
  json["leftover"] = from.leftover;
  json["x"] = axis_title(from.x, x);
  json["y"] = fmt::format("mean residual ({})", unit.name);
  json["changed"] = !record.effects.empty();
  json["series"] = series_json(from.series, x.factor, unit.factor, load_unit_of(record));
  return json;
}

Json map_picture(const LoopRecord& record, const LoopMapPicture& from) {
  const LoopUnit unit = torque_unit(record);
  Json json = picture("leftover-map", "map", "Still unexplained",
                      "Mean residual of the rows in each cell; cells hold equally many rows.");
  json["leftover"] = true;
  json["x"] = axis_title(from.x, {1, from.x.unit});
  json["y"] = axis_title(from.y, {1, from.y.unit});
  json["z"] = fmt::format("mean residual ({})", unit.name);
  json["cells"] = Json::array();
  for (const LoopMapPicture::Cell& c : from.cells) {
    json["cells"].push_back({number(c.x0), number(c.x1), number(c.y0), number(c.y1),
                             number(c.value, unit.factor), c.rows});
  }
  return json;
}

std::string trace_name(const LoopTrace& trace) {
  const char* why = trace.why == "middle" ? "typical"
                    : trace.why == "most" ? "improved most"
                                          : "improved least";
  return fmt::format("movement {} ({}{})", trace.movement, why, trace.held_out ? ", held out" : "");
}

Json trace_picture(const LoopRecord& record) {
  const LoopUnit unit = torque_unit(record);
  const bool held_out = std::ranges::any_of(record.pictures.traces, &LoopTrace::held_out);
  Json json = picture(
      "trace", "trace", "A movement, measured and modelled",
      held_out ? "Held out: nothing was fitted to it. Drag along the time axis to look closer."
               : "Part of the fit, which the errors above are not. Drag along the time axis to "
                 "look closer.");
  json["y"] = fmt::format("{} ({})", target_words(record), unit.name);
  json["residual"] = fmt::format("residual ({})", unit.name);
  json["changed"] = !record.effects.empty();
  json["traces"] = Json::array();
  for (const LoopTrace& trace : record.pictures.traces) {
    json["traces"].push_back({{"name", trace_name(trace)},
                              {"x_title", trace.has_time ? "time (s)" : "row of the movement"},
                              {"x", numbers(trace.x)},
                              {"measured", numbers(trace.measured, unit.factor)},
                              {"before", numbers(trace.before, unit.factor)},
                              {"after", numbers(trace.after, unit.factor)}});
  }
  return json;
}

Json movements_picture(const LoopRecord& record) {
  const LoopUnit unit = torque_unit(record);
  Json json = picture("movements", "movements", "Error of each movement",
                      "Below the dashed line: better than before.");
  json["x"] = fmt::format("mean error before ({})", unit.name);
  json["y"] = fmt::format("mean error after ({})", unit.name);
  json["points"] = Json::array();
  for (const LoopMovementPoint& one : record.pictures.movements) {
    if (json["points"].size() == kMostMovements) break;
    json["points"].push_back({{"name", one.name},
                              {"group", one.held_out ? "held out" : "used for the fit"},
                              {"x", number(one.before, unit.factor)},
                              {"y", number(one.after, unit.factor)}});
  }
  return json;
}

Json evidence_picture(const LoopRecord& record) {
  Json json = picture("evidence", "evidence", "What was considered",
                      "What each effect by itself gains on movements left out. Coloured: added.");
  json["x"] = "evidence (nats)";
  json["bars"] = Json::array();
  for (const LoopCandidate& one : record.candidates) {
    if (json["bars"].size() == kMostCandidates || !std::isfinite(one.score)) continue;
    const bool found = std::ranges::count(record.effects, one.family, &LoopEffect::family) > 0;
    json["bars"].push_back({{"name", family_title(record, one.family)},
                            {"x", number(std::max(0.0, std::isfinite(one.gain) ? one.gain : 0.0))},
                            {"found", found}});
  }
  return json;
}

Json alias_picture(const LoopRecord& record) {
  const LoopAliasMap& map = record.pictures.aliases;
  Json json = picture(
      "aliases", "aliases", "What could be mistaken for what",
      "Correlation of two effects in these data, the base taken off (0: nothing in common).");
  json["names"] = Json::array();
  for (const std::string& family : map.families)
    json["names"].push_back(family_title(record, family));
  json["cells"] = Json::array();
  for (std::size_t i = 0; i < map.correlation.size(); ++i) {
    for (std::size_t j = 0; j < map.correlation[i].size(); ++j) {
      const double value = std::abs(map.correlation[i][j]);
      if (std::isfinite(value)) json["cells"].push_back({i, j, number(value)});
    }
  }
  return json;
}

bool has_series(const Json& json) {
  return json.contains("series") ? !json["series"].empty() : true;
}

Json pictures_json(const LoopRecord& record) {
  const LoopPictures& from = record.pictures;
  Json all = Json::array();
  const auto add = [&](Json json) {
    if (has_series(json)) all.push_back(std::move(json));
  };
  if (std::isfinite(record.error.mae_before)) add(error_picture(record));
  add(friction_picture(record));
  for (std::size_t i = 0; i < from.effects.size(); ++i)
    add(effect_picture(record, from.effects[i], i));
  for (const LoopMapPicture& map : from.maps) {
    if (!map.cells.empty()) add(map_picture(record, map));
  }
  for (std::size_t i = 0; i < from.inputs.size(); ++i)
    add(input_picture(record, from.inputs[i], i));
  if (!from.traces.empty()) add(trace_picture(record));
  if (from.movements.size() > 1) add(movements_picture(record));
  if (!record.candidates.empty()) add(evidence_picture(record));
  if (from.aliases.families.size() > 1) add(alias_picture(record));
  return all;
}

Json words_json(const LoopWords& words) {
  Json cards = Json::array();
  for (const LoopCard& card : words.cards) {
    cards.push_back({{"family", card.family},
                     {"title", card.title},
                     {"noun", card.noun},
                     {"amount", card.amount},
                     {"share", card.share},
                     {"grade", card.grade},
                     {"sure", card.sure},
                     {"doubts", card.doubts},
                     {"rivals", card.rivals},
                     {"bristles", card.bristles},
                     {"settle", card.settle}});
  }
  return {{"headline", words.headline}, {"error", words.error},   {"cards", cards},
          {"leftover", words.leftover}, {"next", words.next},     {"detectable", words.detectable},
          {"needed", words.needed},     {"unused", words.unused}, {"untestable", words.untestable},
          {"aliased", words.aliased},   {"bursts", words.bursts}, {"remarks", words.remarks}};
}

Json model_json(const LoopRecord& record) {
  Json terms = Json::array();
  for (const LoopTerm& term : record.terms) {
    if (term.formula.empty()) continue;
    terms.push_back({{"name", term.family.empty() ? "base" : family_title(record, term.family)},
                     {"formula", term.formula}});
  }
  Json symbols = Json::array();
  for (const LoopSymbol& symbol : record.symbols) {
    if (!symbol.used || symbol.name.starts_with("sgn_")) continue;
    symbols.push_back({{"name", symbol.name},
                       {"meaning", symbol.meaning},
                       {"unit", symbol.unit},
                       {"recipe", symbol.recipe},
                       {"low", number(symbol.low)},
                       {"high", number(symbol.high)}});
  }
  return {{"target", target_words(record)},
          {"unit", record.unit},
          {"terms", terms},
          {"symbols", symbols},
          {"formula", record.formula},
          {"base_formula", record.base_formula},
          {"code", record.code}};
}

Json data_json(const LoopRecord& record) {
  Json steps = Json::array();
  for (const LoopDataStep& step : record.steps) {
    steps.push_back({{"what", plain_text(record, step.what)}, {"rows", step.rows}});
  }
  Json columns = Json::array();
  for (const LoopSymbol& symbol : record.symbols) {
    if (symbol.name.starts_with("sgn_") || (symbol.column.empty() && !symbol.used)) continue;
    columns.push_back({{"column", symbol.column.empty() ? "computed" : symbol.column},
                       {"meaning", symbol.meaning},
                       {"unit", symbol.unit},
                       {"recipe", symbol.recipe}});
  }
  return {{"steps", steps},
          {"columns", columns},
          {"movements", record.noise.movements},
          {"rows", record.noise.rows},
          {"stretches", record.noise.stretches}};
}

Json details_json(const LoopRecord& record) {
  Json effects = Json::array();
  for (const LoopEffect& effect : record.effects) {
    effects.push_back({{"effect", family_title(record, effect.family)},
                       {"family", effect.family},
                       {"parameters", parameter_words(effect)},
                       {"p", number(effect.adjusted_p)},
                       {"gain", number(effect.gain)},
                       {"gain_error", number(effect.gain_error)},
                       {"notes", fmt::format("{}", fmt::join(effect.notes, "; "))}});
  }
  Json candidates = Json::array();
  for (const LoopCandidate& one : record.candidates) {
    candidates.push_back({{"candidate", family_title(record, one.family)},
                          {"p", number(one.adjusted_p)},
                          {"score", number(one.score)},
                          {"gain", number(one.gain)},
                          {"detectable", number(one.detectable, torque_unit(record).factor)}});
  }
  Json next = Json::array();
  for (const LoopNextMovement& one : record.next_movements) {
    next.push_back({{"kind", plain_text(record, one.kind)},
                    {"velocity", number(one.velocity)},
                    {"from", number(one.from)},
                    {"to", number(one.to)},
                    {"load", number(one.load_factor)},
                    {"between", plain_text(record, one.between)},
                    {"separation", number(one.separation)}});
  }
  return {{"effects", effects},
          {"candidates", candidates},
          {"next", next},
          {"how", plain_text(record, record.error.how)},
          {"closed", closed_share(record.error)},
          {"ceiling_note", plain_text(record, record.error.ceiling_note)},
          {"alpha", number(record.alpha_library)},
          {"seed", record.seed}};
}

}  // namespace

Json loop_page_data(const LoopRecord& record) {
  return {{"title", record.title},
          {"verdict", loop_verdict_name(record.verdict)},
          {"unit", torque_unit(record).name},
          {"words", words_json(loop_words(record))},
          {"pictures", pictures_json(record)},
          {"model", model_json(record)},
          {"data", data_json(record)},
          {"details", details_json(record)}};
}

}  // namespace tribench
