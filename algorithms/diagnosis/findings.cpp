// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>

#include "algorithms/diagnosis/plausibility.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/column_products.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/inference/whitening.hpp"
#include "algorithms/leftover/unknown_ripple.hpp"
#include "algorithms/loop_model/smoothers.hpp"

namespace tribench::loop {
namespace {

constexpr double kNormalQuantile = 1.959964;
constexpr std::size_t kEnoughMovements = 20;

// Sandwich covariance of the tangent's parameters, clusters being the movements where there are
// enough of them, else the stretches.
struct Covariance {
  Eigen::MatrixXd robust;
  Eigen::VectorXd vif;
};

Covariance covariance_of(const FittedModel& fit, const Clusters& clusters) {
  const Eigen::VectorXd norms = fit.x.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd x = fit.x * norms.cwiseInverse().asDiagonal();
  Eigen::MatrixXd normal = gram_of(x);
  normal.diagonal().array() += 1e-10;
  const Eigen::MatrixXd inverse = inverse_symmetric(normal);
  const bool by_movement = clusters.movements.size() >= kEnoughMovements;
  const std::vector<RowRange>& groups = by_movement ? clusters.movements : clusters.stretches;
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  for (const RowRange& range : groups) {
    const auto begin = static_cast<Eigen::Index>(range.begin);
    const auto size = static_cast<Eigen::Index>(range.size());
    const Eigen::VectorXd sum =
        x.middleRows(begin, size).transpose() * fit.residual.segment(begin, size);
    meat += sum * sum.transpose();
  }
  const auto count = static_cast<double>(groups.size());
  const auto parameters = static_cast<double>(x.cols());
  const double correction = count / std::max(1.0, count - parameters);
  const Eigen::MatrixXd back = norms.cwiseInverse().asDiagonal();
  // Columns have unit length: the inverse's diagonal is 1 / (1 - R^2).
  return {correction * back * inverse * meat * inverse * back, inverse.diagonal()};
}

ParameterFinding parameter(std::string name, double value, double variance) {
  const double half = kNormalQuantile * std::sqrt(std::max(0.0, variance));
  return {std::move(name), value, value - half, value + half};
}

// Where the shapes of an atom stand in the tangent: after the linear columns, in atoms' order.
std::size_t first_shape_column(const LoopModel& model, std::size_t atom, std::size_t columns) {
  std::size_t after = 0;
  for (std::size_t k = atom; k < model.atoms.size(); ++k) {
    for (const Shape& shape : model.atoms[k].shapes) after += shape.refined() ? 1 : 0;
  }
  return columns - after;
}

void add_parameters(EffectFinding& finding, const FittedModel& fit, const Covariance& covariance,
                    std::size_t atom) {
  const LoopModel& model = fit.model;
  const Atom& a = model.atoms[atom];
  const std::size_t first = model.first_column(atom);
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const auto j = static_cast<Eigen::Index>(first + c);
    finding.parameters.push_back(
        parameter(a.coefficients[c], model.coefficients[j], covariance.robust(j, j)));
    finding.vif = std::max(finding.vif, covariance.vif[j]);
  }
  auto j = static_cast<Eigen::Index>(
      first_shape_column(model, atom, static_cast<std::size_t>(fit.x.cols())));
  for (const Shape& shape : a.shapes) {
    if (shape.refined()) {
      ParameterFinding found = parameter(shape.name, shape.value, covariance.robust(j, j));
      found.low = std::max(found.low, shape.low);
      found.high = std::min(found.high, shape.high);
      finding.parameters.push_back(found);
      const double margin = 1e-3 * (shape.high - shape.low);
      if (shape.value < shape.low + margin || shape.value > shape.high - margin) {
        finding.notes.push_back(
            fmt::format("{} has come to the end of the range that is looked at: it may lie beyond",
                        shape.name));
      }
      ++j;
    } else {
      finding.parameters.push_back({shape.name, shape.value, shape.value, shape.value});
    }
  }
}

std::vector<std::string> notes_of(const EffectFinding& finding) {
  std::vector<std::string> notes;
  if (finding.vif > kLargeVif) {
    notes.emplace_back("its parameters trade off against others': quote them together only");
  }
  if (finding.another_shape) {
    notes.emplace_back(
        "of another shape than the library has: what is left over follows its own inputs");
  }
  if (finding.few_movements) {
    notes.emplace_back("carried by few movements: record more of them (R5, R7)");
  }
  return notes;
}

// An effect's torque without what the base can do as well: how the two share that is no news, and
// with shapes that are nearly the base's own they may each be far too large, of opposite signs.
Eigen::VectorXd beyond_base(std::size_t family, const FittedModel& fit, const Campaign& campaign) {
  const auto base = static_cast<Eigen::Index>(fit.model.first_column(0));
  return project_off(contribution(fit.model, family, campaign.data),
                     orthonormal_basis(fit.raw_tangent.leftCols(base)));
}

EffectFinding effect_finding(const Found& found, std::span<const Found> later,
                             const FittedModel& fit, const Covariance& covariance,
                             const Campaign& campaign) {
  const EffectFamily& family = campaign.families[found.family];
  EffectFinding finding;
  finding.family = family.name;
  finding.phrase = family.phrase;
  finding.adjusted_p = found.p;
  finding.gain = found.gain.nats;
  finding.gain_error = found.gain.error;
  // What was found after it shows beside it; what it could not be told from when it was found may
  // be all of it.
  std::ranges::copy_if(found.aliases, std::back_inserter(finding.aliases),
                       [&](const AliasFinding& alias) {
                         return std::ranges::none_of(later, [&](const Found& other) {
                           return campaign.families[other.family].name == alias.family;
                         });
                       });
  finding.few_movements = found.few;
  finding.another_shape = found.another_shape;
  finding.separate_by = family.separate_by;
  finding.told_by_others = is_told_by_others(found.family, fit, campaign);
  for (std::size_t k = 0; k < fit.model.atoms.size(); ++k) {
    const Atom& atom = fit.model.atoms[k];
    if (atom.family != found.family) continue;
    finding.atom += (finding.atom.empty() ? "" : ", ") + atom.label;
    add_parameters(finding, fit, covariance, k);
  }
  const Eigen::VectorXd own = beyond_base(found.family, fit, campaign);
  finding.rms_contribution = own.norm() / std::sqrt(static_cast<double>(own.size()));
  for (std::string& note : notes_of(finding)) finding.notes.push_back(std::move(note));
  return finding;
}

// The residual over the leftover's one input: means of bins with their standard errors.
std::vector<CurvePoint> leftover_curve(const SearchResult& result, const Observations& train) {
  constexpr std::size_t kBins = 40;
  if (result.leftover.signals.size() != 1) return {};
  const Signal* signal = train.find(result.leftover.signals[0]);
  const Eigen::VectorXd& residual = result.state.model.raw_residual;
  const auto [low, high] = std::ranges::minmax(signal->values);
  struct Bin {
    double sum = 0;
    double squares = 0;
    double count = 0;
  };
  std::array<Bin, kBins> bins{};
  for (std::size_t i = 0; i < train.rows(); ++i) {
    const double place = (signal->values[i] - low) / (high - low) * kBins;
    Bin& bin = bins[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))];
    const double r = residual[static_cast<Eigen::Index>(i)];
    bin.sum += r;
    bin.squares += r * r;
    bin.count += 1;
  }
  std::vector<CurvePoint> curve;
  const double inflation = result.state.model.noise.inflation();
  for (std::size_t b = 0; b < kBins; ++b) {
    const Bin& bin = bins[b];
    if (bin.count < 2) continue;
    const double mean = bin.sum / bin.count;
    const double variance = std::max(0.0, bin.squares / bin.count - mean * mean);
    curve.push_back({low + (high - low) * (static_cast<double>(b) + 0.5) / kBins, mean,
                     std::sqrt(variance * std::min(inflation, bin.count) / bin.count)});
  }
  return curve;
}

// The role names of what a family reads, signs left out.
std::vector<std::string> roles_read(std::size_t family, const LoopModel& model,
                                    const Observations& data) {
  std::vector<std::string> names;
  for (const Signal* signal : signals_read(model, family, data)) {
    const bool sign = signal->role == Role::velocity_sign || signal->role == Role::gravity_sign;
    const std::string name = input_name(data, signal->name);
    if (!sign && std::ranges::count(names, name) == 0) names.push_back(name);
  }
  return names;
}

// What reads a signal in which something else is left over may be a part of that.
bool shares_a_signal(std::size_t family, const LoopModel& model, const LeftoverFinding& leftover,
                     const Observations& data) {
  return std::ranges::any_of(signals_read(model, family, data), [&](const Signal* signal) {
    return std::ranges::count(leftover.signals, signal->name) > 0;
  });
}

// A finding that is not physical is no finding: the verdict becomes UNKNOWN in its inputs.
void veto(Diagnosis& out, EffectFinding& finding, std::size_t family, const Campaign& campaign) {
  finding.objection = physical_objection(finding, campaign.families[family]);
  if (finding.objection.empty()) return;
  finding.provisional = true;
  out.notes.push_back(fmt::format("'{}' fits but is not physical ({}): something else is missing",
                                  finding.family, finding.objection));
  if (!out.leftover.inputs.empty()) return;
  out.leftover.inputs = roles_read(family, out.after, campaign.data);
  if (out.leftover.inputs.empty()) out.leftover.inputs = {"velocity"};
}

void tell_offsets(Diagnosis& out, const std::string& unit) {
  if (!out.noise.is_mostly_between()) return;
  out.notes.push_back(
      fmt::format("the offsets of the movements differ by {:.2g} {} (standard deviation), rows "
                  "of one movement by {:.2g}: a load, a temperature or a sensor's zero that no "
                  "column tells",
                  out.noise.between_sd, unit, out.noise.within_sd));
}

void doubt_stand_ins(Diagnosis& out) {
  for (EffectFinding& effect : out.effects) {
    if (!effect.stands_in) continue;
    effect.provisional = true;
    effect.notes.push_back(
        fmt::format("shows between movements only: may stand for '{}', which seems to differ from "
                    "one to the next",
                    out.leftover.varying->term));
  }
}

Verdict verdict_of(const Diagnosis& diagnosis) {
  if (!diagnosis.leftover.inputs.empty()) return Verdict::unknown;
  if (!std::ranges::all_of(diagnosis.effects, &EffectFinding::stands_in)) return Verdict::effects;
  if (diagnosis.leftover.is_in_doubt()) return Verdict::cannot_tell;
  const bool tested = diagnosis.leftover.tested || !diagnosis.candidates.empty();
  return tested ? Verdict::none : Verdict::cannot_tell;
}

// What would make the data tell.
std::vector<std::string> needed_to_tell(const Diagnosis& diagnosis) {
  std::vector<std::string> needed;
  if (const auto& varying = diagnosis.leftover.varying) {
    needed.push_back(
        fmt::format("more movements: '{}' seems to differ from one to the next ({:.2g} % of what "
                    "is left), which {} cannot tell; or a column that says what was changed",
                    varying->term, 100 * varying->share, diagnosis.movements));
    return needed;
  }
  needed.push_back(fmt::format(
      "{} stretches of movement that say something of their own: here are {}, since the residual "
      "keeps its sign for {:.0f} rows; record {} times as much",
      kFewestClusters, diagnosis.stretches, diagnosis.correlation_rows,
      (2 * kFewestClusters - 1) / std::max<std::size_t>(1, diagnosis.stretches)));
  needed.emplace_back(
      "the rigid body, where the torque holds it: declare gravity or the computed torque "
      "(--roles COLUMN=gravity_torque), or name what is to be fitted (--rigid)");
  return needed;
}

}  // namespace

void write_findings(Diagnosis& out, const SearchResult& result, const Campaign& campaign) {
  const SearchState& state = result.state;
  out.noise = state.model.noise;
  out.before = result.base.model;
  out.after = state.model.model;
  out.leftover = result.leftover;
  out.leftover.curve = leftover_curve(result, campaign.data);
  out.untestable = result.first.untestable;
  out.aliased = result.first.coinciding;
  out.alias_map = result.first.alias_map;
  out.candidates = result.first.candidates;
  if (const std::optional<WaveRange> range = ripples_looked_for(campaign)) {
    out.shortest_wave = 2 * std::numbers::pi / range->high;
    out.shortest_wave_unit = campaign.data.find("q")->unit;
  }
  out.notes = state.notes;
  for (const std::size_t family : result.tried) out.tried.push_back(campaign.families[family].name);
  const Covariance covariance = covariance_of(state.model, campaign.clusters);
  for (std::size_t k = 0; k < state.found.size(); ++k) {
    const Found& one = state.found[k];
    const auto later = std::span(state.found).subspan(k + 1);
    EffectFinding& finding =
        out.effects.emplace_back(effect_finding(one, later, state.model, covariance, campaign));
    finding.order = static_cast<int>(out.effects.size());
    finding.stands_in = one.stands_in;
    finding.provisional = finding.told_by_others ||
                          shares_a_signal(one.family, out.after, out.leftover, campaign.data);
  }
  for (std::size_t k = 0; k < state.found.size() && campaign.options.physical_vetoes; ++k) {
    veto(out, out.effects[k], state.found[k].family, campaign);
  }
  doubt_stand_ins(out);
  tell_offsets(out, campaign.data.target_unit);
  out.verdict = verdict_of(out);
  if (out.verdict == Verdict::cannot_tell) out.needed = needed_to_tell(out);
}

}  // namespace tribench::loop
