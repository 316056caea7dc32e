// SPDX-License-Identifier: MIT
#include "algorithms/states/dissipation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

using namespace build;

// What a formula adds up, and with which sign.
void add_terms(const Expression& formula, std::size_t node, bool minus,
               std::vector<std::pair<bool, Expression>>& terms) {
  switch (formula.node(node).op) {
    case Op::add:
    case Op::sub:
      add_terms(formula, formula.left_child(node), minus, terms);
      add_terms(formula, formula.last_child(node), minus != (formula.node(node).op == Op::sub),
                terms);
      return;
    case Op::neg:
      add_terms(formula, formula.last_child(node), !minus, terms);
      return;
    default:
      terms.emplace_back(minus, subtree(formula, node));
  }
}

// A term that a state alone makes: coefficient times z, or times |z|.
struct Spring {
  std::size_t column = 0;
  double coefficient = 0;
  bool is_absolute = false;
};

std::optional<Spring> spring_of(const Expression& term) {
  Spring spring{0, 1, false};
  Expression part = term;
  if (term.node(term.root()).op == Op::mul) {
    const Expression left = subtree(term, term.left_child(term.root()));
    const Expression right = subtree(term, term.last_child(term.root()));
    const bool is_left = left.node(left.root()).is_constant();
    if (!is_left && !right.node(right.root()).is_constant()) return std::nullopt;
    spring.coefficient = (is_left ? left : right).node(0).value;
    part = is_left ? right : left;
  }
  if (part.node(part.root()).op == Op::abs) {
    spring.is_absolute = true;
    part = subtree(part, part.last_child(part.root()));
  }
  if (!part.node(part.root()).is_variable()) return std::nullopt;
  spring.column = part.node(part.root()).variable;
  return spring;
}

// The springs of each state, and what else the formula adds up.
struct Storage {
  std::vector<double> stiffness;  // by state; 0: it stores nothing that we know
  std::vector<double> skew;       // of |z|
  Expression rest;
};

bool can_store(const StateDeclaration& state, std::size_t velocity) {
  const bool is_bristle =
      state.law == StateLaw::dahl || state.law == StateLaw::lugre || state.law == StateLaw::slip;
  return is_bristle && state.drives[0] == velocity;
}

Storage storage_of(const StatefulFormula& formula, std::size_t velocity) {
  std::vector<std::pair<bool, Expression>> terms;
  add_terms(formula.formula, formula.formula.root(), false, terms);
  const std::size_t count = formula.states.size();
  Storage storage{std::vector<double>(count, 0), std::vector<double>(count, 0), {}};
  const auto state_of = [&](const Expression& term) -> std::optional<std::size_t> {
    const auto spring = spring_of(term);
    if (!spring || spring->column < formula.first_state) return std::nullopt;
    const std::size_t state = spring->column - formula.first_state;
    if (state >= count || !can_store(formula.states[state], velocity)) return std::nullopt;
    return state;
  };
  for (const auto& [minus, term] : terms) {
    const auto state = state_of(term);
    if (!state) continue;
    const Spring spring = *spring_of(term);
    (spring.is_absolute ? storage.skew : storage.stiffness)[*state] +=
        minus ? -spring.coefficient : spring.coefficient;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_stored = std::abs(storage.skew[i]) <= storage.stiffness[i];
    if (!is_stored) storage.stiffness[i] = storage.skew[i] = 0;
  }
  for (const auto& [minus, term] : terms) {
    const auto state = state_of(term);
    if (state && storage.stiffness[*state] > 0) continue;
    storage.rest = sum_of(storage.rest, minus ? -term : term);
  }
  if (storage.rest.empty()) storage.rest = constant(0);
  return storage;
}

// The rest with what bristles that slide take besides: sgn v (k z^2 + d z |z|) / g(v).
Expression with_sliding(const StatefulFormula& formula, const Storage& storage,
                        std::size_t velocity) {
  const Expression v = input(velocity);
  Expression sum = storage.rest;
  for (std::size_t i = 0; i < formula.states.size(); ++i) {
    const std::vector<double>& p = formula.states[i].parameters;
    if (storage.stiffness[i] == 0 || formula.states[i].law == StateLaw::slip) continue;
    const Expression z = input(formula.first_state + i);
    Expression taken = constant(storage.stiffness[i]) * power(z, 2);
    if (storage.skew[i] != 0) {
      taken = taken + constant(storage.skew[i]) * (z * function(Op::abs, z));
    }
    Expression curve = constant(p[0]);
    if (formula.states[i].law == StateLaw::lugre) {
      curve = curve + constant(p[1] - p[0]) * function(Op::exp, -power(v / constant(p[2]), 2));
    }
    sum = sum + function(Op::sgn, v) * (taken / curve);
  }
  return sum;
}

// Motions that come back to where they were: is energy won in one?
class CycleSearch {
 public:
  CycleSearch(const StatefulFormula& formula, const InputBox& box, std::size_t velocity)
      : formula_(formula), box_(box), velocity_(velocity), point_(box.size()) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      if (!box[j].sign_of) point_[j] = 0.5 * (box[j].low + box[j].high);
    }
  }

  void run(DissipationResult& result) {
    const std::vector<double> all = speeds();
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double first = all[i];
        const double second = all[j];
        for (const double longer : {0.3, 1.0, 4.0}) {
          for (const double shorter : {0.3, 1.0, 4.0}) {
            try_cycle({{first, longer * seconds_at(first)}, {second, shorter * seconds_at(second)}},
                      result);
          }
        }
      }
    }
    if (result.verdict != Verdict::refuted) refine(result);
  }

 private:
  static constexpr double kCreep = 0.2;  // of the Stribeck velocity

  // From the cycle that loses the least of what it moves: speeds and times longer or shorter, one
  // at a time, in steps that shrink.
  void refine(DissipationResult& result) {
    if (best_.empty()) return;
    const InputRange& range = box_[velocity_];
    for (const double factor : {2.0, 2.0, 1.4, 1.4, 1.2, 1.2}) {
      for (std::size_t leg = 0; leg < best_.size(); ++leg) {
        for (const double by : {factor, 1 / factor}) {
          std::vector<WorkLeg> faster = best_;
          faster[leg].velocity = std::clamp(by * faster[leg].velocity, range.low, range.high);
          faster[leg].seconds /= by;  // the same way
          if (faster[leg].velocity != 0) try_cycle(faster, result);
          std::vector<WorkLeg> longer = best_;
          longer[leg].seconds *= by;
          try_cycle(longer, result);
        }
      }
    }
  }

  std::vector<double> speeds() const {
    const InputRange& range = box_[velocity_];
    std::vector<double> speeds;
    const auto add = [&](double v) {
      if (v != 0 && v >= range.low && v <= range.high) speeds.push_back(v);
    };
    for (const double share : {1.0, 0.3, 0.1, 0.03, 0.01, 0.001}) {
      add(share * range.low);
      add(share * range.high);
    }
    // Bristles on a Stribeck curve are bent furthest where the joint creeps.
    for (const StateDeclaration& state : formula_.states) {
      if (state.law != StateLaw::lugre && state.law != StateLaw::gms) continue;
      add(-kCreep * state.parameters[2]);
      add(kCreep * state.parameters[2]);
    }
    return speeds;
  }

  // What the states need to change: bristles a way, lags a time.
  double seconds_at(double v) const {
    double seconds = 0;
    for (const StateDeclaration& state : formula_.states) {
      const bool is_lag = state.law == StateLaw::lag || state.law == StateLaw::warmth;
      const double scale = is_lag || state.parameters.size() < 2
                               ? state.parameters[0]
                               : std::max(state.parameters[0], state.parameters[1]);
      seconds = std::max(seconds, is_lag ? scale : scale / std::abs(v));
    }
    return seconds;
  }

  void set_velocity(double v) {
    point_[velocity_] = v;
    for (std::size_t j = 0; j < box_.size(); ++j) {
      if (!box_[j].sign_of) continue;
      const double x = point_[*box_[j].sign_of];
      point_[j] = x > 0 ? 1 : x < 0 ? -1 : 0;
    }
  }

  StateDrive drive_of(const StateDeclaration& state) const {
    return {point_[state.drives[0]], state.drives.size() > 1 ? point_[state.drives[1]] : 1.0};
  }

  double force() {
    for (std::size_t i = 0; i < formula_.states.size(); ++i) {
      point_[formula_.first_state + i] = memories_[i].z;
    }
    return evaluator_.evaluate_at(formula_.formula, point_);
  }

  // Work over one leg, its size added to `size`.
  double run_leg(const WorkLeg& leg, double& size) {
    constexpr int kSteps = 48;
    set_velocity(leg.velocity);
    const double dt = leg.seconds / kSteps;
    double work = 0;
    double before = force();
    for (int k = 0; k < kSteps; ++k) {
      for (std::size_t i = 0; i < formula_.states.size(); ++i) {
        const StateDeclaration& state = formula_.states[i];
        const StateDrive drive = drive_of(state);
        advance(state.law, std::span<const double>(state.parameters), memories_[i], drive, drive,
                dt);
      }
      const double after = force();
      work += 0.5 * (before + after) * leg.velocity * dt;
      size += 0.5 * (std::abs(before) + std::abs(after)) * std::abs(leg.velocity) * dt;
      before = after;
    }
    return work;
  }

  bool has_returned(const std::vector<double>& start) const {
    for (std::size_t i = 0; i < memories_.size(); ++i) {
      const InputRange& range = box_[formula_.first_state + i];
      if (std::abs(memories_[i].z - start[i]) > 1e-6 * (range.high - range.low)) return false;
    }
    return true;
  }

  void try_cycle(const std::vector<WorkLeg>& legs, DissipationResult& result) {
    constexpr int kSettle = 40;
    constexpr double kMargin = 0.02;  // of all work: far above what 48 steps a leg leave out
    memories_.assign(formula_.states.size(), {});
    for (std::size_t i = 0; i < memories_.size(); ++i) {
      memories_[i] = state_at_rest(formula_.states[i].law, drive_of(formula_.states[i]));
    }
    double work = 0;
    double size = 0;
    std::vector<double> start;
    for (int k = 0; k <= kSettle; ++k) {
      work = size = 0;
      start.clear();
      for (const StateMemory& memory : memories_) start.push_back(memory.z);
      for (const WorkLeg& leg : legs) work += run_leg(leg, size);
      if (has_returned(start)) break;
    }
    if (!has_returned(start)) return;
    if (size > 0 && work / size < least_) {
      least_ = work / size;
      best_ = legs;
    }
    if (!(work < -kMargin * size) || !(work < result.work)) return;
    result.verdict = Verdict::refuted;
    result.cycle = legs;
    result.work = work;
  }

  const StatefulFormula& formula_;
  const InputBox& box_;
  std::size_t velocity_;
  std::vector<double> point_;
  std::vector<StateMemory> memories_;
  Evaluator evaluator_;
  std::vector<WorkLeg> best_;  // that has returned, by its work over all that it moved
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace

DissipationResult prove_dissipation(const StatefulFormula& formula, const InputBox& box,
                                    std::size_t velocity, const ProofLimits& limits) {
  const Storage storage = storage_of(formula, velocity);
  DissipationResult result;
  PropertyQuestion question;
  question.property = Property::dissipative;
  question.velocity = velocity;
  for (const Expression& claim : {storage.rest, with_sliding(formula, storage, velocity)}) {
    const PropertyResult proof = prove_property(claim, box, question, limits);
    result.boxes += proof.boxes;
    result.undecided_box = proof.undecided_box;
    if (proof.verdict != Verdict::proved_free) continue;
    result.verdict = Verdict::proved_free;
    return result;
  }
  CycleSearch(formula, box, velocity).run(result);
  return result;
}

std::string work_cycle_json(const DissipationResult& result, const std::string& velocity) {
  std::string legs;
  for (const WorkLeg& leg : result.cycle) {
    legs += fmt::format("{}{{\"{}\":{},\"seconds\":{}}}", legs.empty() ? "" : ",", velocity,
                        print_number(leg.velocity), print_number(leg.seconds));
  }
  return fmt::format("{{\"cycle\":[{}],\"work\":{}}}", legs, print_number(result.work));
}

}  // namespace tribench
