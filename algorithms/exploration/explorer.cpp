// SPDX-License-Identifier: MIT
#include "algorithms/exploration/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "algorithms/exploration/movement_choice.hpp"
#include "algorithms/exploration/second_opinion.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

constexpr double kForeseenRate_hz = 3.125;  // of the rows that would be recorded
constexpr double kReferenceRate_hz = 1;
constexpr double kForeseeAgain = 1.3;  // time since it was foreseen
constexpr double kWarmer_k = 2;
constexpr double kLookAgain = 1.05;       // seconds since the last look
constexpr std::size_t kMostRefused = 40;  // one after the other
constexpr std::size_t kFewestMovements = 5;
constexpr std::size_t kVerdictsTold = 5;
constexpr double kRestCounts = 0.25;  // of a second of motion: it is waited for
// Of the level: the rest is for what the weights do not know, a truth that is no explanation.
constexpr double kHindsight = 0.5;

// Rows that pass standstill: the measured velocity hardly says which way friction acts, and nothing
// that is asked for is as slow.
constexpr double kAtStandstill = 0.01;  // of the speed that is allowed

Observations moving_rows(const Dataset& data, const MotionLimits& limits) {
  ObservationOptions moving;
  moving.min_speed = kAtStandstill * limits.speed_rad_s;
  return observe(data, moving);
}

// What is asked for starts from rest: how far back it has turned is known.
Observations executed(const Dataset& data, const MotionLimits& limits) {
  Observations rows = moving_rows(data, limits);
  rows.take_away(kSeenDistance, "movements that are asked for start from rest");
  return rows;
}

// Reversals, without which the distance since the last is not known, and both ways at two speeds,
// each from where the one before it ended, as the way between two movements is driven and not
// recorded; with the loads and the other joint that the limits allow, which cost no second. Then
// the same without them, in place of what was refused.
std::vector<PlannedMovement> opening_movements(const MotionLimits& limits) {
  const double centre = 0.5 * (limits.lowest_rad + limits.highest_rad);
  const double narrow = 0.0625 * (limits.highest_rad - limits.lowest_rad);
  const double speed = limits.speed_rad_s;
  PlannedMovement turns = two_tone_movement(0.6 * speed, centre - narrow, centre + narrow, 1);
  turns.duration *= 0.5;
  std::vector<PlannedMovement> all = {turns};
  const double heavy = limits.greatest_load_factor;
  const double light = limits.least_load_factor;
  for (const auto& [part, reach, load] :
       {std::tuple{1.0, 8.0, heavy}, std::tuple{-1.0, 8.0, light}, std::tuple{0.2, 2.0, light},
        std::tuple{-0.2, 2.0, heavy}}) {
    PlannedMovement straight =
        constant_movement(part * speed, centre, centre + reach * narrow, load);
    if (broken_limit(straight, limits).broken()) straight.load_factor = 1;
    all.push_back(straight);
  }
  all[1].other_velocity = limits.greatest_other_velocity_rad_s;
  all[4].other_velocity = limits.greatest_other_velocity_rad_s;
  for (std::size_t k = 0; k < kFewestMovements; ++k) {
    PlannedMovement plain = all[k];
    plain.load_factor = 1;
    plain.other_velocity = 0;
    all.push_back(plain);
  }
  return all;
}

std::vector<WeighedVerdict> verdicts_of(const Assessment& now, bool alive_only) {
  std::vector<WeighedVerdict> out;
  const auto add = [&](const Explanation& one) {
    const auto known = std::ranges::find(out, one.verdict, &WeighedVerdict::verdict);
    if (known == out.end())
      out.push_back({one.verdict, one.weight});
    else
      known->weight += one.weight;
  };
  if (alive_only) {
    for (const std::size_t i : now.alive) add(now.explanations[i]);
  } else {
    for (const Explanation& one : now.explanations) add(one);
  }
  std::ranges::stable_sort(out, [](const auto& a, const auto& b) { return a.weight > b.weight; });
  return out;
}

// One row in so many is `kept_hz` of `rate_hz`.
std::size_t one_in(double rate_hz, double kept_hz) {
  return static_cast<std::size_t>(std::max(1.0, rate_hz / kept_hz));
}

// counts: how many rows a foreseen one stands for.
std::vector<MovementRows> rows_of(const Observations& foreseen, std::size_t movements,
                                  std::size_t counts) {
  std::vector<MovementRows> rows(movements);
  for (MovementRows& one : rows) one.counts = static_cast<double>(counts);
  for (std::size_t i = 0; i < foreseen.rows(); ++i) {
    RowRange& range = rows[static_cast<std::size_t>(foreseen.movement[i])].rows;
    if (range.size() == 0) range.begin = i;
    range.end = i + 1;
  }
  return rows;
}

// Every so many rows. What remembers the motion needs all rows before it is thinned.
Observations thinned(const Observations& rows, std::size_t every) {
  std::vector<char> kept(rows.rows(), 0);
  for (std::size_t i = every / 2; i < kept.size(); i += every) kept[i] = 1;
  return rows.select(kept);
}

// Gains are those of the last look; what a movement costs changes with where the joint stands.
class RankedMovements {
 public:
  std::optional<NextMovement> best(const ExplorationState& state);

 private:
  Eigen::Index ranked_at_ = -1;  // rows
  std::vector<MovementChoice> choices_;
};

// Beyond the times of the reference campaign nothing but a straight line is known of what lives in
// time: no rest leads there.
bool rests_too_long(const ExplorationState& state, std::size_t candidate, double cost_s) {
  const double rest_s = state.candidates[candidate].rest;
  return rest_s > 0 && state.now.time_s + rest_s + cost_s > state.limits.seconds;
}

// By which the weight of all others has to fall yet. What a movement tells beyond that comes too
// late: a shorter one is as good.
double nats_to_sure(const ExplorationState& state) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  if (!state.disputed.empty()) return kAny;
  const double others = 1 - state.last->weight_of(state.last->best().verdict);
  const double nats = elementary::log(others / (kHindsight * state.options.alpha));
  return nats > 0 ? nats : kAny;
}

std::optional<NextMovement> RankedMovements::best(const ExplorationState& state) {
  std::vector<double> cost_s;
  for (const PlannedMovement& candidate : state.candidates) {
    cost_s.push_back(seconds_of(candidate, state.now.position_rad, state.limits));
  }
  const auto waited_for = [&](std::size_t m) {
    return cost_s[m] + kRestCounts * state.candidates[m].rest;
  };
  if (ranked_at_ != state.last->sums.rows()) {
    choices_ = movement_gains(*state.last, state.foreseen, state.disputed);
    ranked_at_ = state.last->sums.rows();
  }
  const double enough = nats_to_sure(state);
  const MovementChoice* best = nullptr;
  double most = 0;
  for (const MovementChoice& choice : choices_) {
    if (state.refused[choice.movement] != 0) continue;
    if (state.so_far.seconds + cost_s[choice.movement] > state.options.budget_s) continue;
    if (rests_too_long(state, choice.movement, cost_s[choice.movement])) continue;
    const double rate = std::min(choice.gain, enough) / waited_for(choice.movement);
    if (!(rate > most)) continue;
    best = &choice;
    most = rate;
  }
  if (best == nullptr) return std::nullopt;
  return NextMovement{state.candidates[best->movement], best->between, best->gain, best->movement};
}

class Explorer {
 public:
  Explorer(const MotionLimits& limits, const ExecuteMovement& execute,
           const ExplorerOptions& options, const MovementPlan& plan)
      : limits_(limits),
        execute_(execute),
        options_(options),
        plan_(plan),
        candidates_(candidate_movements(limits, options.longest_s)),
        refused_(candidates_.size(), 0) {
    now_.position_rad = options.start_rad;
  }

  Exploration run() {
    if (candidates_.empty()) {
      throw_bad_input("no movement keeps the limits", "the limits",
                      "gravity alone may take more than torque_Nm allows, or the range is too "
                      "short for the speed");
    }
    while (true) {
      if (options_.stop != nullptr && *options_.stop) {
        out_.end = ExplorationEnd::stopped;
        break;
      }
      const ExplorationState state{limits_,     options_,  out_,     last(),    now_,
                                   candidates_, foreseen_, refused_, disputed()};
      const std::optional<NextMovement> next = plan_(state);
      if (!next) {
        out_.end = ExplorationEnd::nothing_tells;
        break;
      }
      const double cost_s = seconds_of(next->movement, now_.position_rad, limits_);
      if (out_.seconds + cost_s > options_.budget_s) {
        out_.end = ExplorationEnd::budget;
        break;
      }
      const bool done = execute(*next, cost_s) || execute_rested(*next, cost_s);
      if (!out_.failure.empty()) {
        out_.end = ExplorationEnd::failed;
        break;
      }
      if (!done) {
        if (next->candidate) refused_[*next->candidate] = 1;
        if (++refused_running_ <= kMostRefused) continue;
        out_.end = ExplorationEnd::nothing_tells;
        break;
      }
      refused_running_ = 0;
      const bool looks = out_.seconds >= kLookAgain * looked_at_s_ && can_look();
      if (looks) try_look();
      if (options_.told) options_.told(out_.steps.back());
      if (!out_.failure.empty()) {
        out_.end = ExplorationEnd::failed;
        break;
      }
      if (looks && sure()) {
        out_.end = ExplorationEnd::sure;
        break;
      }
    }
    if (can_look() && looked_at_s_ < out_.seconds) try_look();
    if (looked_at_s_ > 0) tell_end();
    return std::move(out_);
  }

 private:
  bool execute(const NextMovement& next, double cost_s) {
    Dataset rows;
    const std::size_t first = out_.data.rows();
    try {
      rows = execute_(next.movement);
      append_movement(out_.data, rows);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::bad_input) {
        out_.refused.emplace_back(error.what());
      } else {
        out_.failure = error.what();
      }
      return false;
    }
    now_.time_s += next.movement.rest + cost_s;
    now_.position_rad = end_of(next.movement);
    if (out_.data.rows() > first) {
      if (const Channel* sensor = rows.find(Role::temperature)) {
        now_.temperature_degc = sensor->values.back();
      }
      if (const Channel* clock = rows.find(Role::time)) now_.time_s = clock->values.back();
    }
    out_.seconds += cost_s;
    ExplorationStep step;
    step.movement = next.movement;
    step.cost_s = cost_s;
    step.rows = rows.rows();
    step.why = next.why;
    step.expected = next.expected;
    out_.steps.push_back(std::move(step));
    return true;
  }

  // What was too warm for a movement need not be after a rest.
  bool execute_rested(NextMovement next, double cost_s) {
    if (!out_.failure.empty() || next.movement.rest >= limits_.longest_rest_s) return false;
    next.movement.rest = limits_.longest_rest_s;
    return execute(next, cost_s);
  }

  double log_e_value_of(const std::string& verdict) const {
    const auto found = std::ranges::find(last()->forecast, verdict, &ForecastVerdict::verdict);
    return found == last()->forecast.end() ? 0 : found->log_e_value;
  }

  // What was said before the rows came says so, what they say in hindsight does, and the diagnosis.
  bool sure() {
    const WeighedVerdict leader = verdicts_of(*last(), false).front();
    // Neither holds of what is not a number.
    const bool in_hindsight = leader.weight >= 1 - kHindsight * options_.alpha;
    const bool before = log_e_value_of(leader.verdict) >= -elementary::log(options_.alpha);
    if (!in_hindsight || !before) return false;
    if (diagnosis_agrees()) return true;
    denied_ = leader.verdict;
    return false;
  }

  // Of the rows so far; it knows nothing of weights.
  bool diagnosis_agrees() {
    DiagnosisOptions options;
    if (limits_.gear_ratio > 0) options.gear_ratios = {limits_.gear_ratio};
    const NamedFamilies found = diagnosed_families(executed(out_.data, limits_), options);
    out_.diagnosis = verdict_text(found.names, found.unknown);
    NamedFamilies ours{{}, last()->best().verdict.ends_with(kUnknownVerdict)};
    for (const std::size_t f : last()->best().families) {
      if (!space_->families()[f].unknown) ours.names.push_back(space_->families()[f].name);
    }
    return bears_out(found, ours, space_->families());
  }

  // Until the diagnosis agrees, what it says is a rival: it asks for an effect in several
  // movements.
  std::string disputed() const {
    const bool denied = assessor_ && !denied_.empty() && last()->best().verdict == denied_;
    return denied ? out_.diagnosis : "";
  }

  bool can_look() const { return out_.steps.size() >= kFewestMovements; }
  const Assessment* last() const { return assessor_ ? &assessor_->last() : nullptr; }

  void make_space() {
    const Dataset all = reference_rows(candidates_, out_.data, limits_, limits_.rate_hz);
    const Observations reference =
        thinned(observe_plan(all), one_in(limits_.rate_hz, kReferenceRate_hz));
    std::vector<double> ratios;
    if (limits_.gear_ratio > 0) ratios.push_back(limits_.gear_ratio);
    space_ = std::make_unique<ExplanationSpace>(reference, ratios, options_.smallest_effect);
    out_.untestable = space_->untestable();
    assessor_ = std::make_unique<Assessor>(*space_, options_.alpha);
  }

  // The candidates' rows, where time or warmth have moved on.
  void foresee() {
    const double warm = now_.temperature_degc.value_or(0);
    const bool warmer = std::abs(warm - foreseen_at_.temperature_degc.value_or(0)) > kWarmer_k;
    const bool stale =
        foreseen_.movements.empty() || warmer || now_.time_s > kForeseeAgain * foreseen_at_.time_s;
    if (!stale) return;
    // What was refused may be allowed at another warmth.
    if (warmer) std::ranges::fill(refused_, 0);
    foreseen_at_ = now_;
    const Dataset plan = foreseen_rows(candidates_, out_.data, limits_, now_, limits_.rate_hz);
    const std::size_t every = one_in(limits_.rate_hz, kForeseenRate_hz);
    const Observations all = thinned(observe_plan(plan), every);
    const Observations rows = with_signals_of(space_->reference(), all, plan);
    foreseen_.base = space_->base_columns(rows);
    foreseen_.columns = space_->columns(rows);
    foreseen_.movements = rows_of(rows, candidates_.size(), every);
  }

  // Rows that no diagnosis can read end it as a failure of who executes does.
  void try_look() {
    try {
      look();
    } catch (const Error& error) {
      if (out_.failure.empty()) out_.failure = error.what();
    }
  }

  void look() {
    const bool first = !space_;
    if (first) make_space();
    Observations recorded = moving_rows(out_.data, limits_);
    add_warming(recorded, EarlierMovements::remembered);
    const Observations rows = with_signals_of(space_->reference(), recorded, out_.data);
    std::vector<char> fresh;
    for (const int m : rows.movement) fresh.push_back(std::cmp_less(m, assessed_) ? 0 : 1);
    assessor_->add(rows.select(fresh));
    assessed_ = out_.steps.size();
    // The first look says twice what is noise: before it nothing was known to be missing.
    if (first) assessor_->look();
    assessor_->look();
    foresee();
    looked_at_s_ = out_.seconds;
    ExplorationStep& step = out_.steps.back();
    step.looked = true;
    step.verdicts = verdicts_of(*last(), false);
    step.verdicts.resize(std::min(step.verdicts.size(), kVerdictsTold));
    step.left = verdicts_of(*last(), true).size();
  }

  void tell_end() {
    const std::vector<WeighedVerdict> verdicts = verdicts_of(*last(), false);
    out_.verdict = verdicts.front().verdict;
    out_.weight = verdicts.front().weight;
    out_.log_e_value = log_e_value_of(out_.verdict);
    out_.left = verdicts_of(*last(), true);
    out_.unknown = out_.verdict.ends_with(kUnknownVerdict);
    for (const Explanation& one : last()->explanations) {
      if (one.verdict != out_.verdict) continue;
      for (const std::size_t f : one.families) {
        const ExplainingFamily& family = space_->families()[f];
        if (!family.unknown) {
          out_.families.push_back(family.name);
        } else if (out_.unknown) {
          out_.inputs = family.inputs;
        }
      }
      break;
    }
  }

  const MotionLimits& limits_;
  const ExecuteMovement& execute_;
  const ExplorerOptions& options_;
  const MovementPlan& plan_;
  std::vector<PlannedMovement> candidates_;
  Foreseen foreseen_;
  JointNow foreseen_at_;
  std::vector<char> refused_;
  std::size_t refused_running_ = 0;
  std::unique_ptr<ExplanationSpace> space_;
  std::unique_ptr<Assessor> assessor_;
  std::size_t assessed_ = 0;  // movements
  JointNow now_;
  double looked_at_s_ = 0;
  std::string denied_;  // the verdict that the diagnosis did not share
  Exploration out_;
};

}  // namespace

std::string_view exploration_end_name(ExplorationEnd end) {
  constexpr std::array<std::string_view, 5> kNames = {"sure", "budget", "nothing_tells", "stopped",
                                                      "failed"};
  return kNames[static_cast<std::size_t>(end)];
}

MovementPlan informative_movements() {
  return [ranked = RankedMovements()](
             const ExplorationState& state) mutable -> std::optional<NextMovement> {
    const std::size_t done = state.so_far.steps.size() + state.so_far.refused.size();
    if (state.last == nullptr) {
      const std::vector<PlannedMovement> opening = opening_movements(state.limits);
      if (done < opening.size()) return NextMovement{opening[done], "opening"};
      // Some were refused: what is allowed takes their place.
      for (std::size_t m = 0; m < state.candidates.size(); ++m) {
        if (state.refused[m] == 0) return NextMovement{state.candidates[m], "opening", 0, m};
      }
      return std::nullopt;
    }
    return ranked.best(state);
  };
}

void append_movement(Dataset& data, const Dataset& movement) {
  for (const Channel& channel : data.channels) {
    if (std::ranges::count(movement.channels, channel.name, &Channel::name) > 0) continue;
    throw Error(ErrorKind::failed, fmt::format("the recording has no '{}'", channel.name),
                movement.name, "every movement's recording needs the channels of the first");
  }
  if (data.channels.empty()) {
    data.name = movement.name;
    for (const Channel& channel : movement.channels) {
      data.channels.push_back({channel.name, channel.unit, channel.role, {}});
    }
  }
  const int number = static_cast<int>(data.movement_names.size());
  for (Channel& channel : data.channels) {
    const std::vector<double>& values = movement.at(channel.name).values;
    channel.values.insert(channel.values.end(), values.begin(), values.end());
  }
  data.movement_names.push_back(fmt::format("move {}", number + 1));
  data.movement.insert(data.movement.end(), movement.rows(), number);
}

Exploration explore(const MotionLimits& limits, const ExecuteMovement& execute,
                    const ExplorerOptions& options, const MovementPlan& plan) {
  return Explorer(limits, execute, options, plan).run();
}

}  // namespace tribench::loop
