// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "algorithms/campaign/rich_model.hpp"
#include "algorithms/diagnosis/findings.hpp"
#include "algorithms/diagnosis/search.hpp"
#include "algorithms/inference/bursts.hpp"
#include "algorithms/leftover/unknown_ripple.hpp"
#include "algorithms/leftover/varying_terms.hpp"
#include "foundation/error.hpp"
#include "foundation/suggestion.hpp"
#include "problems/preparation/canonical.hpp"

namespace tribench::loop {
namespace {

std::vector<EffectFamily> chosen_families(const DiagnosisOptions& options) {
  std::vector<EffectFamily> all = builtin_effects();
  for (const EffectFamily& family : options.learned) {
    if (std::ranges::count(all, family.name, &EffectFamily::name) > 0) {
      throw_bad_input(fmt::format("there are two effects named '{}'", family.name), "--learned",
                      "give the one in the file another name");
    }
    all.push_back(family);
  }
  if (options.families.empty()) return all;
  std::vector<std::string> names;
  for (const EffectFamily& family : all) names.push_back(family.name);
  std::vector<EffectFamily> chosen;
  for (const std::string& wanted : options.families) {
    const auto found = std::ranges::find(all, wanted, &EffectFamily::name);
    if (found == all.end()) {
      throw_bad_input(fmt::format("there is no effect '{}'", wanted), {},
                      did_you_mean(wanted, names, "see: tribench list effects"));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

void check_enough(const Observations& train, const BaseModel& base) {
  if (train.rows() == 0) {
    throw_bad_input(
        fmt::format("no movement has the {} rows it takes to tell noise from effects",
                    kFewestRowsOfMovement),
        train.target_name,
        "give the recorded rows, not a mean a movement, and keep enough of them (--rows); "
        "without a 'movement' column a file is one movement");
  }
  const std::size_t parameters = base.linear_terms.size() + fitted_constants(base).size();
  if (train.rows() >= 3 * parameters + 10) return;
  throw_bad_input(fmt::format("{} rows are too few to fit {} parameters of the base model",
                              train.rows(), parameters),
                  train.target_name, "record more movements (R9: at least 30)");
}

}  // namespace

std::vector<char> usable_rows(const Observations& data, const std::vector<int>& movements,
                              bool in_them, const std::vector<char>& masked) {
  std::vector<char> keep(data.rows(), 0);
  std::vector<std::size_t> counts(data.movement_names.size() + 1, 0);
  for (const int m : data.movement) {
    const auto at = static_cast<std::size_t>(m);
    if (at >= counts.size()) counts.resize(at + 1, 0);
    ++counts[at];
  }
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool is_in = std::ranges::binary_search(movements, data.movement[i]);
    const bool long_enough =
        counts[static_cast<std::size_t>(data.movement[i])] >= kFewestRowsOfMovement;
    keep[i] = is_in == in_them && long_enough && (masked.empty() || masked[i] == 0) ? 1 : 0;
  }
  return keep;
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "NONE";
    case Verdict::effects:
      return "EFFECTS";
    case Verdict::unknown:
      return "UNKNOWN";
    case Verdict::cannot_tell:
      return "CANNOT_TELL";
  }
  return "NONE";
}

namespace {

// The bursts of the first `end` rows.
std::vector<Burst> bursts_until(std::size_t end, const Observations& data,
                                const Eigen::VectorXd& residual, RandomStream random) {
  std::vector<double> speed;
  if (const Signal* v = data.find("v")) {
    for (std::size_t i = 0; i < end; ++i) speed.push_back(std::abs(v->values[i]));
  }
  return find_bursts(std::span(data.movement).first(end), speed,
                     residual.head(static_cast<Eigen::Index>(end)), random);
}

// Bursts are events: listed by movement and time, their rows left out of every fit. Those of the
// rows to fit to are what stands out of them alone; those of the rows from `first_held` on, what
// stands out of the whole recording.
void find_events(FirstNoise& out, const Observations& data, std::size_t first_held,
                 RandomStream random) {
  std::vector<Burst> bursts = bursts_until(first_held, data, out.residual, random);
  if (first_held < data.rows()) {
    for (const Burst& burst : bursts_until(data.rows(), data, out.residual, random)) {
      if (burst.begin >= first_held) bursts.push_back(burst);
    }
  }
  for (const Burst& burst : bursts) {
    const int movement = data.movement[burst.begin];
    out.events.push_back({movement, data.name_of(movement), data.time[burst.begin],
                          data.time[burst.end - 1], burst.peak});
  }
  out.masked = rows_about(bursts, data.movement);
}

// train_rows: those to fit to, bursts and all.
FirstNoise first_noise(const Observations& data, const std::vector<char>& train_rows,
                       const BaseModel& base, const Diagnosis& asked, RandomStream random) {
  FirstNoise out;
  out.residual = rich_residual(data, train_rows, base, asked.families, asked.options);
  out.masked.assign(data.rows(), 0);
  if (!asked.options.has("bursts")) return out;
  const auto held = [&](int movement) {
    return std::ranges::binary_search(asked.held_out, movement);
  };
  const auto first_held =
      static_cast<std::size_t>(std::ranges::find_if(data.movement, held) - data.movement.begin());
  find_events(out, data, first_held, random);
  return out;
}

// data: the movements held out stand last.
Diagnosis diagnose_canonical(const Observations& data, const std::vector<int>& held_out,
                             const BaseMaker& make_base, const DiagnosisOptions& options,
                             KnownSearch& known) {
  const RandomStream random(key_of("diagnosis"));
  Diagnosis out;
  out.options = options;
  out.families = chosen_families(options);
  out.held_out = held_out;
  const std::vector<char> train_rows = usable_rows(data, held_out, false, {});
  if (std::ranges::count(train_rows, 1) == 0) check_enough(data.select(train_rows), {});
  const BaseModel base = make_base(data.select(train_rows));
  if (!known.noise) known.noise = first_noise(data, train_rows, base, out, random.split("events"));
  out.events = known.noise->events;
  out.masked = known.noise->masked;
  const std::vector<char> kept = usable_rows(data, held_out, false, out.masked);
  const Observations train = data.select(kept);
  check_enough(train, base);
  Eigen::VectorXd train_rich(static_cast<Eigen::Index>(train.rows()));
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (kept[i] != 0) train_rich[next++] = known.noise->residual[static_cast<Eigen::Index>(i)];
  }
  const Clusters uncut = make_clusters(train.movement, 1);
  out.correlation_rows = correlation_time(train_rich, uncut.movements);
  Clusters clusters = make_clusters(train.movement, out.correlation_rows);
  if (options.has("weights")) clusters.weight = movement_weights(train_rich, clusters);
  out.rows = train.rows();
  out.stretches = clusters.stretches.size();
  out.movements = clusters.movements.size();
  const RandomStream own = random.split("search");
  const Campaign campaign(train, out.families, options, clusters, own.split("flips"));
  SearchResult found = search(base, campaign, own, known);
  find_varying_term(found.state, found.leftover, train_rich, campaign, own.split("random slopes"));
  write_findings(out, found, campaign);
  return out;
}

// The mean square of the gear's ripple that was found; 0 where none was.
double named_ripple(const Diagnosis& diagnosis) {
  double largest = 0;
  for (const EffectFinding& effect : diagnosis.effects) {
    const auto family = std::ranges::find(diagnosis.families, effect.family, &EffectFamily::name);
    if (!repeats_with_the_gear(*family)) continue;
    largest = std::max(largest, effect.rms_contribution * effect.rms_contribution);
  }
  return largest;
}

// Whole numbers of waves a turn of the joint up to the fourth harmonic of those that the library
// has; a tenth of a wave more or less over the travel is none.
constexpr double kMostWavesATurn = 4 * kMostWavesOfOutput;
constexpr double kWaveMore = 0.1;

// A ripple found at a whole number of waves a turn of the joint, whose bearings and teeth have such
// ones, may be the joint's as well as the motor's.
void tell_of_the_joint(Diagnosis& out, double wavenumber, const Signal& position) {
  const auto [low, high] = std::ranges::minmax(position.values);
  const double turns = (high - low) / (2 * std::numbers::pi);
  const double whole = std::round(wavenumber);
  const bool is_of_a_turn = position.unit == "rad" && whole >= 1 && whole <= kMostWavesATurn &&
                            std::abs(wavenumber - whole) * turns <= kWaveMore;
  if (!is_of_a_turn) return;
  for (EffectFinding& effect : out.effects) {
    const auto family = std::ranges::find(out.families, effect.family, &EffectFamily::name);
    if (!repeats_with_the_gear(*family)) continue;
    effect.aliases.push_back({fmt::format("output_ripple ({:.0f} a turn)", whole), 1, 0, 0, true,
                              "tell the gear's ratio (--gear-ratio)"});
  }
}

// The same once more, what repeats taken for a turn of the motor. As it was where that names no
// ripple, where something still lives in the position or where what else repeats is nearly as
// large: a notch has a spectrum, too.
Diagnosis knowing_the_ripple(Diagnosis first, const Observations& data, const BaseMaker& base,
                             KnownSearch& known) {
  constexpr double kNearlyAsLarge = 0.5;
  const RepeatingFinding& ripple = *first.leftover.repeating;
  DiagnosisOptions options = first.options;
  options.gear_ratios = {ripple.wavenumber};
  // Another may be left over once something has been taken out.
  if (known.gear_ratios != options.gear_ratios) known = {options.gear_ratios, {}, {}, {}, {}};
  Diagnosis again = diagnose_canonical(data, first.held_out, base, options, known);
  const auto& more = again.leftover.repeating;
  const bool explains_it = named_ripple(again) > 0 &&
                           std::ranges::count(again.leftover.signals, "q") == 0 &&
                           (!more || more->mean_square < kNearlyAsLarge * ripple.mean_square);
  if (!explains_it) return first;
  tell_of_the_joint(again, ripple.wavenumber, *data.find("q"));
  again.notes.push_back(fmt::format(
      "the ripple's period, {:.4g} {}, was found in these data: whether it is a turn of "
      "the motor, a tooth or a bearing they do not say",
      2 * std::numbers::pi / ripple.wavenumber, data.find("q")->unit));
  return again;
}

}  // namespace

Diagnosis diagnose(const Observations& data, const BaseMaker& base, const DiagnosisOptions& options,
                   const std::vector<int>& held_out, SearchMemory* memory) {
  SearchMemory own;
  SearchMemory& known = memory != nullptr ? *memory : own;
  if (!known) known = std::make_shared<KnownSearches>();
  const Canonical told = canonical(data, held_out);
  Diagnosis out = diagnose_canonical(told.data, held_out, base, options, known->plain);
  // What repeats more than a ripple at a usual ratio is the ripple; one at the ratio told stays.
  const double named = named_ripple(out);
  const auto& more = out.leftover.repeating;
  if (more && (named == 0 || (options.gear_ratios.empty() && more->mean_square > named))) {
    out = knowing_the_ripple(std::move(out), told.data, base, known->with_ripple);
  }
  out.masked = told.as_told(out.masked);
  return out;
}

}  // namespace tribench::loop
