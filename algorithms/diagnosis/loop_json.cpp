// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/loop_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithms/diagnosis/loop_pictures.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench::loop {
namespace {

using Json = nlohmann::ordered_json;

// A figure that does not exist is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json parameter_json(const ParameterFinding& p) {
  return {
      {"name", p.name}, {"value", number(p.value)}, {"lo", number(p.low)}, {"hi", number(p.high)}};
}

Json alias_json(const AliasFinding& alias) {
  return {{"family", alias.family},
          {"corr", number(alias.correlation)},
          {"gain_diff", number(alias.gain_difference)},
          {"se", number(alias.error)},
          {"exact", alias.exact},
          {"separate_by", alias.separate_by}};
}

Json effect_json(const EffectFinding& effect) {
  Json json = {{"family", effect.family},
               {"atom", effect.atom},
               {"order", effect.order},
               {"p_adj", number(effect.adjusted_p)},
               {"cv_gain", number(effect.gain)},
               {"cv_se", number(effect.gain_error)},
               {"params", Json::array()},
               {"rms_contribution", number(effect.rms_contribution)},
               {"vif", number(effect.vif)},
               {"alias", Json::array()},
               {"separate_by", effect.separate_by},
               {"provisional", effect.provisional},
               {"not_physical", effect.objection},
               {"few_movements", effect.few_movements},
               {"another_shape", effect.another_shape},
               {"chosen_share", number(effect.chosen_share)},
               {"notes", effect.notes}};
  for (const ParameterFinding& p : effect.parameters) json["params"].push_back(parameter_json(p));
  for (const AliasFinding& alias : effect.aliases) json["alias"].push_back(alias_json(alias));
  return json;
}

Json leftover_json(const LeftoverFinding& leftover) {
  Json curve = Json::array();
  for (const CurvePoint& point : leftover.curve) {
    curve.push_back({number(point.x), number(point.y), number(point.error)});
  }
  return {{"p", number(leftover.p)},
          {"inputs", leftover.inputs},
          {"proxies_removed", leftover.proxies_removed},
          {"curve", curve}};
}

Json error_json(const ErrorFinding& error) {
  Json movements = Json::array();
  for (const MovementError& m : error.movements) {
    movements.push_back({{"movement", m.movement},
                         {"mae_before", number(m.before)},
                         {"mae_after", number(m.after)},
                         {"rows", m.rows}});
  }
  return {{"test_movements", error.test_movements},
          {"how", error.how},
          {"mae_before", number(error.mae_before)},
          {"mae_after", number(error.mae_after)},
          {"rmse_before", number(error.rmse_before)},
          {"rmse_after", number(error.rmse_after)},
          {"max_before", number(error.max_before)},
          {"max_after", number(error.max_after)},
          {"ci_diff", {number(error.difference_low), number(error.difference_high)}},
          {"ceiling", number(error.ceiling)},
          {"attainable", number(error.attainable)},
          {"closed_fraction", number(error.closed_fraction)},
          {"closed_fraction_ci", {number(error.closed_low), number(error.closed_high)}},
          {"closed_fraction_high", number(error.closed_fraction_high)},
          {"ceiling_note", error.ceiling_note},
          {"confirmed", error.confirmed},
          {"means_before", number(error.means_before)},
          {"means_after", number(error.means_after)},
          {"movements", movements}};
}

Json lists_json(const Diagnosis& diagnosis) {
  Json lists;
  lists["untestable"] = Json::array();
  for (const UntestableFinding& one : diagnosis.untestable) {
    lists["untestable"].push_back({{"family", one.family},
                                   {"reason", one.reason},
                                   {"share", number(one.share)},
                                   {"clusters", one.clusters},
                                   {"ask", one.ask}});
  }
  lists["aliased"] = Json::array();
  for (const CoincidingFamilies& pair : diagnosis.aliased) {
    lists["aliased"].push_back({{"families", {pair.first, pair.second}},
                                {"corr", number(pair.correlation)},
                                {"separate_by", pair.separate_by}});
  }
  lists["events"] = Json::array();
  for (const EventFinding& event : diagnosis.events) {
    lists["events"].push_back({{"movement", event.movement},
                               {"movement_name", event.movement_name},
                               {"t0", number(event.begin)},
                               {"t1", number(event.end)},
                               {"peak", number(event.peak)}});
  }
  lists["candidates"] = Json::array();
  for (const CandidateFinding& one : diagnosis.candidates) {
    lists["candidates"].push_back({{"family", one.family},
                                   {"atom", one.atom},
                                   {"p_adj", number(one.adjusted_p)},
                                   {"score", number(one.score)},
                                   {"cv_gain", number(one.gain)},
                                   {"detectable", number(one.detectable)}});
  }
  lists["needed"] = diagnosis.needed;
  return lists;
}

// Amplitude and frequency in Hz; none of a movement at constant speed.
Json tones_json(const ProposedMovement& movement) {
  Json tones = Json::array();
  if (movement.kind != "two_tone") return tones;
  for (const Tone& tone : movement.tones) tones.push_back({tone.amplitude, tone.frequency});
  return tones;
}

void add_extras(Json& json, const LoopExtras& extras) {
  json["learned"] = Json::array();
  for (const LearnedEffect& one : extras.learned) {
    json["learned"].push_back({{"family", one.family.name},
                               {"formula", one.formula},
                               {"p_adj", number(one.p)},
                               {"cv_gain", number(one.gain)},
                               {"found_on_movements", one.found_on},
                               {"tested_on_movements", one.tested_on},
                               {"accepted", one.accepted}});
  }
  json["next_movements"] = Json::array();
  for (const ProposedMovement& one : extras.suggestions) {
    json["next_movements"].push_back({{"kind", one.kind},
                                      {"velocity", number(one.velocity)},
                                      {"from", number(one.from)},
                                      {"to", number(one.to)},
                                      {"load_factor", number(one.load_factor)},
                                      {"duration_s", number(one.duration)},
                                      {"tones", tones_json(one)},
                                      {"separation", number(one.separation)},
                                      {"between", one.between}});
  }
}

Json symbols_json(const Observations& data) {
  Json symbols = Json::array();
  for (const Signal& signal : data.signals) {
    Json symbol = {{"name", signal.name}, {"column", signal.channel}, {"unit", signal.unit}};
    if (!signal.recipe.empty()) symbol["computed_as"] = signal.recipe;
    symbols.push_back(std::move(symbol));
  }
  return symbols;
}

}  // namespace

std::string formula_text(const LoopModel& model, const Observations& data) {
  return print(formula_of(model), data.names());
}

std::string write_loop_json(const Diagnosis& diagnosis, const Observations& data,
                            const LoopExtras& extras) {
  const DiagnosisOptions& options = diagnosis.options;
  Json json;
  json["verdict"] = verdict_name(diagnosis.verdict);
  json["confirmed"] = diagnosis.error.confirmed;
  json["target"] = {{"name", data.target_name}, {"unit", data.target_unit}};
  json["alpha"] = {
      {"lib", options.alpha_library}, {"gen", options.alpha_leftover}, {"flips", options.flips}};
  json["seed"] = diagnosis.seed;
  json["noise"] = {{"sw", number(diagnosis.noise.within_sd)},
                   {"sb", number(diagnosis.noise.between_sd)},
                   {"rho", number(diagnosis.noise.rho)},
                   {"n", diagnosis.rows},
                   {"movements", diagnosis.movements},
                   {"clusters", diagnosis.stretches},
                   {"n_eff", number(diagnosis.noise.effective_rows)}};
  json["effects"] = Json::array();
  for (const EffectFinding& effect : diagnosis.effects) {
    json["effects"].push_back(effect_json(effect));
  }
  json["leftover"] = leftover_json(diagnosis.leftover);
  json.update(lists_json(diagnosis));
  json["error"] = error_json(diagnosis.error);
  json["base"] = diagnosis.before.base.name;
  json["base_formula"] = formula_text(diagnosis.before, data);
  json["formula"] = formula_text(diagnosis.after, data);
  json["symbols"] = symbols_json(data);
  json["notes"] = diagnosis.notes;
  json["warnings"] = data.warnings;
  add_extras(json, extras);
  json["pictures"] = loop_pictures(diagnosis, data);
  return json.dump(2) + "\n";
}

}  // namespace tribench::loop
