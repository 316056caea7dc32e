// SPDX-License-Identifier: MIT
#include "reports/record/loop_json.hpp"
#include "foundation/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tribench {
namespace {

using Json = nlohmann::ordered_json;

Json bristles_json(const LoopBristles& bristles) {
  return {{"law", bristles.law},
          {"stiffness", json_number(bristles.stiffness)},
          {"lo", json_number(bristles.stiffness_low)},
          {"hi", json_number(bristles.stiffness_high)},
          {"unit", bristles.stiffness_unit},
          {"sliding", json_number(bristles.sliding)},
          {"sliding_unit", bristles.sliding_unit},
          {"damping", json_number(bristles.damping)},
          {"mae_after", json_number(bristles.mae_after)},
          {"formula", bristles.formula}};
}

Json effect_json(const LoopEffect& effect) {
  Json json = {{"family", effect.family},
               {"atom", effect.atom},
               {"order", effect.order},
               {"p_adj", json_number(effect.adjusted_p)},
               {"cv_gain", json_number(effect.gain)},
               {"cv_se", json_number(effect.gain_error)},
               {"params", Json::array()},
               {"rms_contribution", json_number(effect.rms)},
               {"vif", json_number(effect.vif)},
               {"alias", Json::array()},
               {"separate_by", effect.separate_by},
               {"provisional", effect.provisional},
               {"not_physical", effect.objection},
               {"few_movements", effect.few_movements},
               {"told_by_others", effect.told_by_others},
               {"another_shape", effect.another_shape},
               {"chosen_share", json_number(effect.chosen_share)},
               {"notes", effect.notes}};
  for (const LoopParameter& p : effect.parameters) {
    json["params"].push_back({{"name", p.name},
                              {"value", json_number(p.value)},
                              {"lo", json_number(p.low)},
                              {"hi", json_number(p.high)}});
  }
  for (const LoopAlias& alias : effect.aliases) {
    json["alias"].push_back({{"family", alias.family},
                             {"corr", json_number(alias.correlation)},
                             {"gain_diff", json_number(alias.gain_difference)},
                             {"se", json_number(alias.error)},
                             {"exact", alias.exact},
                             {"separate_by", alias.separate_by}});
  }
  if (!effect.bristles.law.empty()) json["bristles"] = bristles_json(effect.bristles);
  return json;
}

Json varying_json(const LoopVarying& varying) {
  if (varying.term.empty()) return nullptr;
  Json movements = Json::array();
  for (const LoopVarying::OfMovement& one : varying.movements) {
    movements.push_back({{"movement", one.movement}, {"torque", json_number(one.torque)}});
  }
  return {{"term", varying.term}, {"share", json_number(varying.share)}, {"movements", movements}};
}

Json leftover_json(const LoopLeftover& leftover) {
  Json curve = Json::array();
  for (const LoopLeftover::Point& point : leftover.curve) {
    curve.push_back({json_number(point.x), json_number(point.y), json_number(point.error)});
  }
  return {{"p", json_number(leftover.p)},
          {"inputs", leftover.inputs},
          {"proxies_removed", leftover.proxies_removed},
          {"chosen_share", json_number(leftover.chosen_share)},
          {"curve", curve},
          {"varying", varying_json(leftover.varying)}};
}

Json error_json(const LoopError& error) {
  Json movements = Json::array();
  for (const LoopMovementError& m : error.movements) {
    movements.push_back({{"movement", m.movement},
                         {"mae_before", json_number(m.before)},
                         {"mae_after", json_number(m.after)},
                         {"rows", m.rows}});
  }
  return {{"test_movements", error.test_movements},
          {"how", error.how},
          {"mae_before", json_number(error.mae_before)},
          {"mae_after", json_number(error.mae_after)},
          {"rmse_before", json_number(error.rmse_before)},
          {"rmse_after", json_number(error.rmse_after)},
          {"max_before", json_number(error.max_before)},
          {"max_after", json_number(error.max_after)},
          {"ci_diff", {json_number(error.difference_low), json_number(error.difference_high)}},
          {"ceiling", json_number(error.ceiling)},
          {"attainable", json_number(error.attainable)},
          {"closed_fraction", json_number(error.closed_fraction)},
          {"closed_fraction_ci", {json_number(error.closed_low), json_number(error.closed_high)}},
          {"closed_fraction_high", json_number(error.closed_fraction_high)},
          {"ceiling_note", error.ceiling_note},
          {"confirmed", error.confirmed},
          {"means_before", json_number(error.means_before)},
          {"means_after", json_number(error.means_after)},
          {"movements", movements}};
}

// Absent where no motion could be simulated.
void add_motion(Json& json, const LoopMotion& motion) {
  if (!std::isfinite(motion.after)) return;
  json["motion"] = {{"before", json_number(motion.before)},
                    {"after", json_number(motion.after)},
                    {"unit", motion.unit},
                    {"horizon_s", json_number(motion.horizon_s)},
                    {"held_out", motion.held_out}};
}

void add_lists(Json& json, const LoopRecord& record) {
  json["untestable"] = Json::array();
  for (const LoopUntestable& one : record.untestable) {
    json["untestable"].push_back({{"family", one.family},
                                  {"reason", one.reason},
                                  {"share", json_number(one.share)},
                                  {"clusters", one.stretches},
                                  {"ask", one.ask}});
  }
  json["shortest_wave"] = {{"length", json_number(record.shortest_wave)},
                           {"unit", record.shortest_wave_unit}};
  json["aliased"] = Json::array();
  for (const LoopCoincidence& pair : record.aliased) {
    json["aliased"].push_back({{"families", {pair.first, pair.second}},
                               {"corr", json_number(pair.correlation)},
                               {"separate_by", pair.separate_by}});
  }
  json["events"] = Json::array();
  for (const LoopBurst& burst : record.bursts) {
    json["events"].push_back({{"movement", burst.movement},
                              {"movement_name", burst.movement_name},
                              {"t0", json_number(burst.begin)},
                              {"t1", json_number(burst.end)},
                              {"peak", json_number(burst.peak)}});
  }
  json["candidates"] = Json::array();
  for (const LoopCandidate& one : record.candidates) {
    json["candidates"].push_back({{"family", one.family},
                                  {"atom", one.atom},
                                  {"p_adj", json_number(one.adjusted_p)},
                                  {"score", json_number(one.score)},
                                  {"cv_gain", json_number(one.gain)},
                                  {"detectable", json_number(one.detectable)}});
  }
  json["needed"] = record.needed;
  json["unused_columns"] = Json::array();
  for (const LoopUnusedColumn& one : record.unused_columns) {
    json["unused_columns"].push_back(
        {{"column", one.column}, {"explains", json_number(one.share)}});
  }
}

void add_extras(Json& json, const LoopRecord& record) {
  json["learned"] = Json::array();
  for (const LoopLearned& one : record.learned) {
    json["learned"].push_back({{"family", one.family},
                               {"formula", one.formula},
                               {"p_adj", json_number(one.p)},
                               {"cv_gain", json_number(one.gain)},
                               {"found_on_movements", one.found_on},
                               {"tested_on_movements", one.tested_on},
                               {"accepted", one.accepted}});
  }
  json["next_movements"] = Json::array();
  for (const LoopNextMovement& one : record.next_movements) {
    Json tones = Json::array();
    for (const LoopNextMovement::Tone& tone : one.tones) {
      tones.push_back({tone.amplitude, tone.frequency});
    }
    json["next_movements"].push_back({{"kind", one.kind},
                                      {"velocity", json_number(one.velocity)},
                                      {"from", json_number(one.from)},
                                      {"to", json_number(one.to)},
                                      {"load_factor", json_number(one.load_factor)},
                                      {"duration_s", json_number(one.duration)},
                                      {"tones", tones},
                                      {"separation", json_number(one.separation)},
                                      {"between", one.between}});
  }
}

Json symbols_json(const LoopRecord& record) {
  Json symbols = Json::array();
  for (const LoopSymbol& symbol : record.symbols) {
    Json json = {{"name", symbol.name},
                 {"column", symbol.column},
                 {"unit", symbol.unit},
                 {"meaning", symbol.meaning},
                 {"used", symbol.used},
                 {"low", json_number(symbol.low)},
                 {"high", json_number(symbol.high)}};
    if (!symbol.recipe.empty()) json["computed_as"] = symbol.recipe;
    if (!symbol.formula.empty()) json["formula"] = symbol.formula;
    symbols.push_back(std::move(json));
  }
  return symbols;
}

Json steps_json(const LoopRecord& record) {
  Json steps = Json::array();
  for (const LoopDataStep& step : record.steps) {
    steps.push_back({{"what", step.what}, {"rows", step.rows}});
    if (!step.not_looked_at.empty()) steps.back()["not_looked_at"] = step.not_looked_at;
  }
  return steps;
}

// Five digits of the largest: more than a picture shows.
Json rounded(const std::vector<double>& values) {
  constexpr double kSteps = 1e5;
  double scale = 0;
  for (const double value : values) {
    if (std::isfinite(value)) scale = std::max(scale, std::abs(value));
  }
  Json array = Json::array();
  for (const double value : values) {
    if (!std::isfinite(value)) {
      array.push_back(nullptr);
    } else if (scale > 0) {
      // Printed short: a rounded double times a scale has all its digits again.
      array.push_back(
          std::stod(fmt::format("{:.6g}", std::round(value / scale * kSteps) / kSteps * scale)));
    } else {
      array.push_back(value);
    }
  }
  return array;
}

Json axis_json(const LoopAxis& axis) {
  return {{"channel", axis.channel},
          {"unit", axis.unit},
          {"magnitude", axis.magnitude},
          {"period", axis.period}};
}

constexpr const char* split_key(LoopSplit split) {
  switch (split) {
    case LoopSplit::all:
      return "all";
    case LoopSplit::forward:
      return "forward";
    case LoopSplit::backward:
      return "backward";
    case LoopSplit::speeding_up:
      return "speeding_up";
    case LoopSplit::slowing_down:
      return "slowing_down";
    case LoopSplit::driving:
      return "driving";
    case LoopSplit::back_driving:
      return "back_driving";
    case LoopSplit::load_level:
      break;
  }
  return "load_level";
}

Json series_json(const std::vector<LoopSeries>& all) {
  Json list = Json::array();
  for (const LoopSeries& one : all) {
    Json json = {
        {"split", split_key(one.split)}, {"level", json_number(one.level)}, {"x", rounded(one.x)}};
    const auto add = [&](const char* key, const std::vector<double>& values) {
      if (!values.empty()) json[key] = rounded(values);
    };
    add("measured", one.measured);
    add("spread", one.spread);
    add("before", one.before);
    add("after", one.after);
    add("band", one.band);
    add("rows", one.rows);
    list.push_back(std::move(json));
  }
  return list;
}

Json maps_json(const LoopPictures& pictures) {
  Json maps = Json::array();
  for (const LoopMapPicture& map : pictures.maps) {
    Json cells = Json::array();
    for (const LoopMapPicture::Cell& c : map.cells) {
      cells.push_back({c.x0, c.x1, c.y0, c.y1, c.value, c.rows});
    }
    maps.push_back({{"x", axis_json(map.x)}, {"y", axis_json(map.y)}, {"cells", cells}});
  }
  return maps;
}

Json residuals_json(const LoopResidualRows& rows) {
  Json effects = Json::array();
  for (const LoopResidualRows::Effect& effect : rows.effects) {
    effects.push_back({{"family", effect.family}, {"y", rounded(effect.y)}});
  }
  Json all = Json::array();
  for (const LoopResidualRows::Channel& channel : rows.channels) {
    all.push_back({{"channel", channel.name},
                   {"unit", channel.unit},
                   {"x", rounded(channel.x)},
                   {"before", rounded(rows.before)},
                   {"after", rounded(rows.after)},
                   {"effect", rounded(rows.effect)},
                   {"effects", effects}});
  }
  return all;
}

}  // namespace

Json loop_json(const LoopRecord& record) {
  Json json;
  json["verdict"] = loop_verdict_name(record.verdict);
  json["confirmed"] = record.error.confirmed;
  json["target"] = {{"name", record.target}, {"unit", record.unit}};
  json["alpha"] = {{"lib", json_number(record.alpha_library)},
                   {"gen", json_number(record.alpha_leftover)},
                   {"flips", record.flips}};
  json["seed"] = record.seed;
  const LoopNoise& noise = record.noise;
  json["noise"] = {{"sw", json_number(noise.within_sd)},
                   {"sb", json_number(noise.between_sd)},
                   {"rho", json_number(noise.rho)},
                   {"n", noise.rows},
                   {"movements", noise.movements},
                   {"clusters", noise.stretches},
                   {"n_eff", json_number(noise.effective_rows)}};
  json["friction_rms"] = json_number(record.friction_rms);
  json["effects"] = Json::array();
  for (const LoopEffect& effect : record.effects) json["effects"].push_back(effect_json(effect));
  json["leftover"] = leftover_json(record.leftover);
  add_lists(json, record);
  json["error"] = error_json(record.error);
  add_motion(json, record.motion);
  json["base"] = record.base;
  json["base_formula"] = record.base_formula;
  json["formula"] = record.formula;
  json["symbols"] = symbols_json(record);
  json["data_steps"] = steps_json(record);
  json["notes"] = record.notes;
  json["warnings"] = record.warnings;
  add_extras(json, record);
  return json;
}

Json loop_pictures_json(const LoopRecord& record) {
  const LoopPictures& pictures = record.pictures;
  Json json;
  json["target"] = record.target;
  json["unit"] = record.unit;
  json["base_formula"] = record.base_formula;
  json["friction"] = {{"x", axis_json(pictures.friction.x)},
                      {"rigid_part_removed", pictures.friction.rigid_part_removed},
                      {"series", series_json(pictures.friction.series)}};
  json["effects"] = Json::array();
  for (const LoopEffectPicture& one : pictures.effects) {
    json["effects"].push_back({{"family", one.family},
                               {"x", axis_json(one.x)},
                               {"against_motion", one.against_motion},
                               {"series", series_json(one.series)},
                               {"marks", rounded(one.marks)}});
  }
  json["inputs"] = Json::array();
  for (const LoopInputPicture& one : pictures.inputs) {
    json["inputs"].push_back(
        {{"x", axis_json(one.x)}, {"leftover", one.leftover}, {"series", series_json(one.series)}});
  }
  json["maps"] = maps_json(pictures);
  json["traces"] = Json::array();
  for (const LoopTrace& one : pictures.traces) {
    json["traces"].push_back({{"movement", one.movement},
                              {"why", one.why},
                              {"held_out", one.held_out},
                              {"has_time", one.has_time},
                              {"x", rounded(one.x)},
                              {"measured", rounded(one.measured)},
                              {"before", rounded(one.before)},
                              {"after", rounded(one.after)}});
  }
  json["movements"] = Json::array();
  for (const LoopMovementPoint& one : pictures.movements) {
    json["movements"].push_back({{"name", one.name},
                                 {"test", one.held_out},
                                 {"mae_before", json_number(one.before)},
                                 {"mae_after", json_number(one.after)}});
  }
  Json correlation = Json::array();
  for (const std::vector<double>& row : pictures.aliases.correlation) {
    correlation.push_back(rounded(row));
  }
  json["alias_map"] = {{"families", pictures.aliases.families}, {"correlation", correlation}};
  return json;
}

std::string write_loop_json(const LoopRecord& record) {
  Json json = loop_json(record);
  json["pictures"] = loop_pictures_json(record);
  json["pictures"]["residuals"] = residuals_json(record.pictures.residuals);
  return write_json(json, 2) + "\n";
}

}  // namespace tribench
