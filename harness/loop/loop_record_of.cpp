// SPDX-License-Identifier: MIT
#include "harness/loop/loop_record_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/loop_model/smoothers.hpp"
#include "harness/loop/controller_code.hpp"
#include "harness/loop/loop_series.hpp"

namespace tribench::loop {
namespace {

LoopVerdict verdict_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return LoopVerdict::none;
    case Verdict::effects:
      return LoopVerdict::effects;
    case Verdict::unknown:
      return LoopVerdict::unknown;
    case Verdict::cannot_tell:
      break;
  }
  return LoopVerdict::cannot_tell;
}

LoopEffect effect_of(const EffectFinding& from) {
  LoopEffect to;
  to.family = from.family;
  to.atom = from.atom;
  to.order = from.order;
  to.adjusted_p = from.adjusted_p;
  to.gain = from.gain;
  to.gain_error = from.gain_error;
  for (const ParameterFinding& p : from.parameters) {
    to.parameters.push_back({p.name, p.value, p.low, p.high});
  }
  to.rms = from.rms_contribution;
  to.vif = from.vif;
  for (const AliasFinding& a : from.aliases) {
    to.aliases.push_back(
        {a.family, a.correlation, a.gain_difference, a.error, a.exact, a.separate_by});
  }
  to.separate_by = from.separate_by;
  to.provisional = from.provisional;
  to.objection = from.objection;
  to.few_movements = from.few_movements;
  to.told_by_others = from.told_by_others;
  to.another_shape = from.another_shape;
  to.chosen_share = from.chosen_share;
  to.notes = from.notes;
  return to;
}

LoopJudgedOn judged_on(JudgedOn from) {
  switch (from) {
    case JudgedOn::pieces_of_movements:
      return LoopJudgedOn::pieces_of_movements;
    case JudgedOn::rows_of_the_fit:
      return LoopJudgedOn::rows_of_the_fit;
    case JudgedOn::other_movements:
      break;
  }
  return LoopJudgedOn::other_movements;
}

LoopError error_of(const ErrorFinding& from) {
  LoopError to;
  to.judged_on = judged_on(from.judged_on);
  to.test_movements = from.test_movements;
  to.how = from.how;
  to.mae_before = from.mae_before;
  to.mae_after = from.mae_after;
  to.rmse_before = from.rmse_before;
  to.rmse_after = from.rmse_after;
  to.max_before = from.max_before;
  to.max_after = from.max_after;
  to.difference_low = from.difference_low;
  to.difference_high = from.difference_high;
  to.ceiling = from.ceiling;
  to.attainable = from.attainable;
  to.closed_fraction = from.closed_fraction;
  to.closed_low = from.closed_low;
  to.closed_high = from.closed_high;
  to.closed_fraction_high = from.closed_fraction_high;
  to.ceiling_note = from.ceiling_note;
  to.confirmed = from.confirmed;
  to.means_before = from.means_before;
  to.means_after = from.means_after;
  for (const MovementError& m : from.movements) {
    to.movements.push_back({m.movement, m.before, m.after, m.rows});
  }
  return to;
}

LoopVarying varying_of(const VaryingFinding& from) {
  LoopVarying to{from.term, from.share, {}};
  for (const VaryingFinding::OfMovement& one : from.movements) {
    to.movements.push_back({one.movement_name, one.torque});
  }
  return to;
}

void add_lists(LoopRecord& record, const JudgedDiagnosis& diagnosis) {
  for (const EffectFinding& one : diagnosis.effects) record.effects.push_back(effect_of(one));
  const LeftoverFinding& left = diagnosis.leftover;
  record.leftover = {left.p, left.inputs, left.proxies_removed, left.chosen_share, {}, {}};
  if (left.varying) record.leftover.varying = varying_of(*left.varying);
  for (const CurvePoint& p : left.curve) record.leftover.curve.push_back({p.x, p.y, p.error});
  for (const UntestableFinding& one : diagnosis.untestable) {
    record.untestable.push_back({one.family, one.reason, one.share, one.clusters, one.ask});
  }
  for (const CoincidingFamilies& pair : diagnosis.aliased) {
    record.aliased.push_back({pair.first, pair.second, pair.correlation, pair.separate_by});
  }
  record.shortest_wave = diagnosis.shortest_wave;
  record.shortest_wave_unit = diagnosis.shortest_wave_unit;
  for (const EventFinding& one : diagnosis.events) {
    record.bursts.push_back({one.movement, one.movement_name, one.begin, one.end, one.peak});
  }
  for (const CandidateFinding& one : diagnosis.candidates) {
    record.candidates.push_back(
        {one.family, one.atom, one.adjusted_p, one.score, one.gain, one.detectable});
  }
  record.needed = diagnosis.needed;
  for (const UnusedColumn& one : diagnosis.unused_columns) {
    record.unused_columns.push_back({one.column, one.share});
  }
}

void add_bristles(LoopRecord& record, const JudgedDiagnosis& diagnosis, const Observations& data) {
  if (!diagnosis.bristles) return;
  const Bristles& from = *diagnosis.bristles;
  for (LoopEffect& effect : record.effects) {
    if (effect.family != diagnosis.families[from.family].name) continue;
    LoopBristles& to = effect.bristles;
    to.law = bristle_law_name(from.law);
    to.sliding_unit = data.find("d")->unit;
    to.stiffness_unit = fmt::format("{}/{}", data.target_unit, to.sliding_unit);
    to.stiffness = from.stiffness;
    to.stiffness_low = from.low;
    to.stiffness_high = from.high;
    to.sliding = from.sliding;
    if (from.law == BristleLaw::lugre) to.damping = from.damping;
    to.mae_after = diagnosis.error.mae_state;
    to.formula = print_stateful(formula_of(from, data), data.names());
  }
}

void add_extras(LoopRecord& record, const LoopExtras& extras) {
  for (const LearnedEffect& one : extras.learned) {
    record.learned.push_back(
        {one.family.name, one.formula, one.p, one.gain, one.found_on, one.tested_on, one.accepted});
  }
  for (const ProposedMovement& one : extras.suggestions) {
    LoopNextMovement to{one.kind,     one.velocity, one.from,       one.to,     one.load_factor,
                        one.duration, {},           one.separation, one.between};
    if (one.kind == "two_tone") {
      for (const Tone& tone : one.tones) to.tones.push_back({tone.amplitude, tone.frequency});
    }
    record.next_movements.push_back(std::move(to));
  }
}

std::string spaced(std::string text) {
  std::ranges::replace(text, '_', ' ');
  return text;
}

// "velocity", "sign of velocity", "distance since reversal".
std::string meaning_of(const Observations& data, const Signal& signal) {
  const std::string words = spaced(input_name(data, signal.name));
  if (signal.role == Role::velocity_sign) return "direction of motion (1, 0 or -1)";
  if (signal.role == Role::gravity_sign) return "sign of the gravity torque";
  if (signal.name == "t") return "time through the campaign";
  return words;
}

void add_symbols(LoopRecord& record, const JudgedDiagnosis& diagnosis, const Observations& data) {
  std::vector<char> used(data.signals.size(), 0);
  for (const LoopModel* model : {&diagnosis.before, &diagnosis.after}) {
    const Expression formula = formula_of(*model);
    for (const Node& node : formula.nodes()) {
      if (node.is_variable()) used[node.variable] = 1;
    }
  }
  for (std::size_t j = 0; j < data.signals.size(); ++j) {
    const Signal& signal = data.signals[j];
    const auto [low, high] = std::ranges::minmax(signal.values);
    record.symbols.push_back({signal.name, signal.channel, signal.unit, meaning_of(data, signal),
                              signal.formula.empty() ? signal.recipe : signal.formula, used[j] != 0,
                              low, high, signal.formula});
  }
}

// For reading: like terms and constants folded, four digits.
std::string short_formula(const Expression& formula, const Observations& data) {
  if (formula.empty()) return {};
  Canonicalizer canonicalizer;
  Expression canonical = canonicalizer.canonical(formula);
  for (const std::size_t i : constant_positions(canonical)) {
    set_constant(canonical, i, std::stod(fmt::format("{:.4g}", canonical.node(i).value)));
  }
  return print(canonical, data.names());
}

Expression sum_of(const Expression& sum, double coefficient, const Expression& column) {
  Expression term = Expression::binary(Op::mul, Expression::constant(coefficient), column);
  return sum.empty() ? term : Expression::binary(Op::add, sum, term);
}

void add_terms(LoopRecord& record, const JudgedDiagnosis& diagnosis, const Observations& data) {
  const LoopModel& model = diagnosis.after;
  Expression base = model.base.formula;
  for (std::size_t j = 0; j < model.base.linear_terms.size(); ++j) {
    base =
        sum_of(base, model.coefficients[static_cast<Eigen::Index>(j)], model.base.linear_terms[j]);
  }
  record.terms.push_back({{}, short_formula(base, data)});
  for (const EffectFinding& effect : diagnosis.effects) {
    Expression sum;
    for (std::size_t k = 0; k < model.atoms.size(); ++k) {
      const Atom& atom = model.atoms[k];
      if (diagnosis.families[atom.family].name != effect.family) continue;
      for (std::size_t c = 0; c < atom.columns.size(); ++c) {
        const auto j = static_cast<Eigen::Index>(model.first_column(k) + c);
        sum = sum_of(sum, model.coefficients[j], atom.columns[c]);
      }
    }
    record.terms.push_back({effect.family, short_formula(sum, data)});
  }
}

void add_words(LoopRecord& record, const JudgedDiagnosis& diagnosis) {
  for (const EffectFamily& family : diagnosis.families) {
    record.families.push_back(
        {family.name, family.title.empty() ? spaced(family.name) : family.title, family.phrase});
  }
  for (const char* code : {"R1", "R2", "R3", "R4", "R5", "R6", "R7", "R8", "R9"}) {
    record.experiments.push_back({code, experiment_text(code)});
  }
}

std::string code_of(const JudgedDiagnosis& diagnosis, const Observations& data) {
  const Signal* d = data.find("d");
  std::optional<PathFrom> from;
  if (d != nullptr && !d->recipe.empty()) {
    from = data.find("q") != nullptr ? PathFrom::position : PathFrom::velocity;
  }
  std::map<std::string, std::string> formulas;
  for (const Signal& signal : data.signals) {
    if (!signal.formula.empty()) formulas.emplace(signal.name, signal.formula);
  }
  const NamedFormula read = with_formulas(formula_of(diagnosis.after), data.names(), formulas);
  return controller_code(read.formula, read.names, {}, from);
}

}  // namespace

LoopRecord loop_record_of(const JudgedDiagnosis& diagnosis, const Observations& data,
                          const LoopExtras& extras) {
  LoopRecord record;
  record.title = extras.title;
  record.verdict = verdict_of(diagnosis.verdict);
  record.target = data.target_name;
  record.unit = data.target_unit;
  record.alpha_library = diagnosis.options.alpha_library;
  record.alpha_leftover = diagnosis.options.alpha_leftover;
  record.flips = diagnosis.options.flips;
  record.seed = extras.seed;
  record.noise = {diagnosis.noise.within_sd,     diagnosis.noise.between_sd,
                  diagnosis.noise.rho(),         diagnosis.rows,
                  diagnosis.movements,           diagnosis.stretches,
                  diagnosis.noise.effective_rows};
  add_lists(record, diagnosis);
  add_bristles(record, diagnosis, data);
  record.error = error_of(diagnosis.error);
  record.motion = extras.motion;
  record.base = diagnosis.before.base.name;
  record.base_formula = formula_text(diagnosis.before, data);
  record.formula = formula_text(diagnosis.after, data);
  add_terms(record, diagnosis, data);
  add_symbols(record, diagnosis, data);
  record.code = code_of(diagnosis, data);
  record.notes = diagnosis.notes;
  record.warnings = data.warnings;
  record.steps = extras.steps;
  add_extras(record, extras);
  add_words(record, diagnosis);
  add_series(record, diagnosis, data);
  return record;
}

}  // namespace tribench::loop
