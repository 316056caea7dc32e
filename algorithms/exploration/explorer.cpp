// SPDX-License-Identifier: MIT
#include "algorithms/exploration/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/exploration/movement_choice.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

constexpr double kForeseenRate = 0.5;  // foreseen rows for a recorded one
constexpr double kReferenceRate_hz = 2;
constexpr double kLookAgain = 1.05;  // seconds since the last look
constexpr std::size_t kMostRefused = 40;
constexpr std::size_t kFewestMovements = 5;
constexpr std::size_t kVerdictsTold = 5;
constexpr int kSureLooks = 3;  // running

// Both ways at two speeds, and reversals: without one nobody knows how far back the last one lies.
std::vector<PlannedMovement> opening_movements(const MotionLimits& limits) {
  const double centre = 0.5 * (limits.lowest_rad + limits.highest_rad);
  const double narrow = 0.0625 * (limits.highest_rad - limits.lowest_rad);
  const double speed = limits.speed_rad_s;
  PlannedMovement turns = two_tone_movement(0.6 * speed, centre - narrow, centre + narrow, 1);
  turns.duration *= 0.5;
  std::vector<PlannedMovement> all = {turns};
  for (const auto& [part, reach] : {std::pair{0.5, 3.0}, std::pair{0.2, 1.0}}) {
    for (const double direction : {1.0, -1.0}) {
      all.push_back(constant_movement(direction * part * speed, centre - reach * narrow,
                                      centre + reach * narrow, 1));
    }
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

std::vector<MovementRows> rows_of(const Observations& foreseen, std::size_t movements) {
  std::vector<MovementRows> rows(movements);
  for (std::size_t i = 0; i < foreseen.rows(); ++i) {
    RowRange& range = rows[static_cast<std::size_t>(foreseen.movement[i])].rows;
    if (range.size() == 0) range.begin = i;
    range.end = i + 1;
  }
  return rows;
}

std::optional<NextMovement> informative(const ExplorationState& state) {
  std::vector<MovementRows> rows(state.foreseen.begin(), state.foreseen.end());
  for (std::size_t m = 0; m < rows.size(); ++m) {
    rows[m].cost_s = seconds_of(state.candidates[m], state.now.position_rad, state.limits);
    rows[m].counts = 1 / kForeseenRate;
  }
  for (const MovementChoice& choice : rank_movements(*state.last, state.options.alpha, rows)) {
    if (state.refused[choice.movement] != 0) continue;
    if (state.so_far.seconds + rows[choice.movement].cost_s > state.options.budget_s) continue;
    return NextMovement{state.candidates[choice.movement], choice.between, choice.gain,
                        choice.movement};
  }
  return std::nullopt;
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
    while (true) {
      if (options_.stop != nullptr && *options_.stop) {
        out_.end = ExplorationEnd::stopped;
        break;
      }
      const ExplorationState state{limits_, options_,    out_,      last_.get(),
                                   now_,    candidates_, foreseen_, refused_};
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
      if (!execute(*next, cost_s)) {
        if (out_.refused.size() > kMostRefused) break;
        continue;
      }
      const bool looks = out_.seconds >= kLookAgain * looked_at_s_ && can_look();
      if (looks) look();
      if (options_.told) options_.told(out_.steps.back());
      if (looks && sure()) {
        out_.end = ExplorationEnd::sure;
        break;
      }
    }
    if (can_look() && looked_at_s_ < out_.seconds) look();
    if (last_) tell_end();
    return std::move(out_);
  }

 private:
  bool execute(const NextMovement& next, double cost_s) {
    Dataset rows;
    try {
      rows = execute_(next.movement);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
      out_.refused.emplace_back(error.what());
      if (next.candidate) refused_[*next.candidate] = 1;
      return false;
    }
    now_.time_s += next.movement.rest + cost_s;
    now_.position_rad = end_of(next.movement);
    if (const Channel* sensor = rows.find(Role::temperature)) {
      now_.temperature_degc = sensor->values.back();
    }
    if (const Channel* clock = rows.find(Role::time)) now_.time_s = clock->values.back();
    out_.seconds += cost_s;
    ExplorationStep step;
    step.movement = next.movement;
    step.cost_s = cost_s;
    step.rows = rows.rows();
    step.why = next.why;
    step.expected = next.expected;
    out_.steps.push_back(std::move(step));
    append_movement(out_.data, rows);
    return true;
  }

  // Once could be luck of a few rows, whose noise nobody knows yet.
  bool sure() {
    const std::vector<WeighedVerdict> verdicts = verdicts_of(*last_, false);
    const bool again = verdicts.front().verdict == sure_of_;
    const bool now = verdicts.front().weight >= 1 - options_.alpha;
    sure_looks_ = now ? (again ? sure_looks_ + 1 : 1) : 0;
    sure_of_ = verdicts.front().verdict;
    return sure_looks_ >= kSureLooks && diagnosis_agrees();
  }

  // The loop's own diagnosis of the rows so far, which knows nothing of weights, names the same
  // families, and finds something of no library left over just where the verdict does.
  bool diagnosis_agrees() const {
    DiagnosisOptions options;
    options.test_share = 0;
    if (limits_.gear_ratio > 0) options.gear_ratios = {limits_.gear_ratio};
    const Diagnosis found = diagnose(observe(out_.data), coulomb_viscous_base, options, 1);
    const Explanation& best = last_->best();
    const auto has = [&](const std::string& name) {
      return std::ranges::any_of(best.families,
                                 [&](std::size_t f) { return space_->families()[f].name == name; });
    };
    const bool unknown = best.verdict.ends_with(kUnknownVerdict);
    const auto known = std::ranges::count_if(
        best.families, [&](std::size_t f) { return !space_->families()[f].unknown; });
    return (found.verdict == Verdict::unknown) == unknown &&
           std::cmp_equal(found.effects.size(), known) &&
           std::ranges::all_of(found.effects,
                               [&](const EffectFinding& effect) { return has(effect.family); });
  }

  bool can_look() const { return out_.steps.size() >= kFewestMovements; }

  void look() {
    if (!space_) {
      const Dataset reference = reference_rows(candidates_, out_.data, limits_, kReferenceRate_hz);
      std::vector<double> ratios;
      if (limits_.gear_ratio > 0) ratios.push_back(limits_.gear_ratio);
      space_ = std::make_unique<ExplanationSpace>(observe_plan(reference), ratios);
      out_.untestable = space_->untestable();
    }
    const Observations rows = with_signals_of(space_->reference(), observe(out_.data), out_.data);
    const Dataset plan =
        foreseen_rows(candidates_, out_.data, limits_, now_, kForeseenRate * limits_.rate_hz);
    const Observations foreseen = with_signals_of(space_->reference(), observe_plan(plan), plan);
    foreseen_ = rows_of(foreseen, candidates_.size());
    // The first look says twice what is noise: before it nothing was known to be missing.
    const auto again = [&](const Explanation& before) {
      last_ = std::make_unique<Assessment>(assess(*space_, rows, foreseen, options_.alpha, before));
    };
    if (!last_) again({});
    again(Explanation(last_->best()));
    looked_at_s_ = out_.seconds;
    ExplorationStep& step = out_.steps.back();
    step.looked = true;
    step.verdicts = verdicts_of(*last_, false);
    step.verdicts.resize(std::min(step.verdicts.size(), kVerdictsTold));
    step.left = verdicts_of(*last_, true).size();
  }

  void tell_end() {
    const std::vector<WeighedVerdict> verdicts = verdicts_of(*last_, false);
    out_.verdict = verdicts.front().verdict;
    out_.weight = verdicts.front().weight;
    out_.left = verdicts_of(*last_, true);
    for (const Explanation& one : last_->explanations) {
      if (one.verdict != out_.verdict) continue;
      for (const std::size_t f : one.families) {
        const ExplainingFamily& family = space_->families()[f];
        if (family.unknown) {
          out_.unknown = true;
          out_.inputs = family.inputs;
        } else {
          out_.families.push_back(family.name);
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
  std::vector<MovementRows> foreseen_;
  std::vector<char> refused_;
  std::unique_ptr<ExplanationSpace> space_;
  std::unique_ptr<Assessment> last_;
  JointNow now_;
  double looked_at_s_ = 0;
  std::string sure_of_;
  int sure_looks_ = 0;
  Exploration out_;
};

}  // namespace

std::string_view exploration_end_name(ExplorationEnd end) {
  constexpr std::array<std::string_view, 4> kNames = {"sure", "budget", "nothing_tells", "stopped"};
  return kNames[static_cast<std::size_t>(end)];
}

MovementPlan informative_movements() {
  return [](const ExplorationState& state) -> std::optional<NextMovement> {
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
    return informative(state);
  };
}

void append_movement(Dataset& data, const Dataset& movement) {
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
