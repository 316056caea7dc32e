// SPDX-License-Identifier: MIT
#include "harness/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "algorithms/admission.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/grid_check.hpp"
#include "algorithms/expression/property.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/states/dissipation.hpp"
#include "algorithms/states/state_text.hpp"
#include "harness/metrics.hpp"
#include "harness/motion/motion_trial.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"

namespace tribench {
namespace {

// The rows that the judged formula was fitted to: the last stage's.
const Table& fitted_rows(const Problem& problem) { return problem.stages.back().train; }

// Shortest of a few rounds, each long enough for the clock: the time without disturbances.
double measure_ns_per_row(const Expression& formula, const Table& table) {
  using Clock = std::chrono::steady_clock;
  constexpr int kRounds = 5;
  constexpr double kRoundSeconds = 2e-4;
  if (table.rows() == 0) return kMissing;
  TableEvaluator evaluator;
  double best = kMissing;
  for (int round = 0; round < kRounds; ++round) {
    const Clock::time_point start = Clock::now();
    double elapsed = 0;
    int repetitions = 0;
    while (elapsed < kRoundSeconds) {
      evaluator.evaluate(formula, table);
      ++repetitions;
      elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    }
    const double ns = 1e9 * elapsed / repetitions / static_cast<double>(table.rows());
    best = std::isnan(best) ? ns : std::min(best, ns);
  }
  return best;
}

// For a formula of the front that is not the cell's own: a tenth of the default effort.
constexpr ProofLimits kFrontProof{200'000, 0};

// Physics is asked of finite formulas alone, and beyond the Stribeck range for the slope.
constexpr ProofLimits kPhysicsProof{200'000, 0};
constexpr double kStribeckShare = 0.25;  // of the largest speed

Singularity singularity_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::proved_free:
      return Singularity::proved_free;
    case Verdict::refuted:
      return Singularity::refuted;
    case Verdict::undecided:
      break;
  }
  return Singularity::undecided;
}

PhysicsProof physics_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::proved_free:
      return PhysicsProof::proved;
    case Verdict::refuted:
      return PhysicsProof::refuted;
    case Verdict::undecided:
      break;
  }
  return PhysicsProof::undecided;
}

std::optional<PhysicsProof> physics_on(Property property, const Expression& formula,
                                       const InputBox& box, std::size_t velocity) {
  const double fastest = std::max(std::abs(box[velocity].low), std::abs(box[velocity].high));
  const bool both_ways = box[velocity].low < 0 && box[velocity].high > 0;
  if (property == Property::odd && !both_ways) return std::nullopt;
  PropertyQuestion question;
  question.property = property;
  question.velocity = velocity;
  question.from = kStribeckShare * fastest;
  return physics_of(prove_property(formula, box, question, kPhysicsProof).verdict);
}

// The states of a formula, whose inputs stand behind all others; empty where it has none.
StatefulFormula stateful(const Problem& problem, const Expression& formula) {
  StatefulFormula result{{}, problem.inputs.size(), formula};
  std::vector<std::string> names;
  for (const Input& input : problem.inputs) {
    if (input.law.empty()) {
      names.push_back(input.name);
      continue;
    }
    result.first_state = std::min(result.first_state, names.size());
    result.states.push_back(parse_state_law(input.name, input.law, names));
  }
  return result;
}

// With memory, what is asked is whether the formula can only take energy; the other questions are
// about the value at a point, which it does not have.
void judge_memory(const StatefulFormula& formula, const InputBox& box, std::size_t velocity,
                  Record& record) {
  record.dissipative = physics_of(prove_dissipation(formula, box, velocity, kPhysicsProof).verdict);
}

void judge_singularity(const Problem& problem, const Expression& formula, Record& record) {
  const InputBox box = input_box(problem.inputs);
  const SingularityResult proof = prove_free(formula, box);
  record.singularity = singularity_of(proof.verdict);
  if (proof.witness) record.witness = witness_json(*proof.witness, problem.input_names());
  if (proof.verdict == Verdict::refuted) {
    record.grid_check = is_finite_on_grid(formula, box) ? GridCheck::missed : GridCheck::seen;
  }
  if (proof.verdict != Verdict::proved_free) return;
  for (std::size_t j = 0; j < problem.inputs.size(); ++j) {
    if (problem.inputs[j].role != Role::velocity) continue;
    const StatefulFormula memory = stateful(problem, formula);
    if (!memory.states.empty()) return judge_memory(memory, box, j, record);
    record.dissipative = physics_on(Property::dissipative, formula, box, j);
    record.monotone = physics_on(Property::monotone, formula, box, j);
    record.odd = physics_on(Property::odd, formula, box, j);
    return;
  }
}

// What a place on the front is for.
double front_error(const FrontRecord& entry) {
  return std::isnan(entry.weighted_rms) ? entry.mae_train : entry.weighted_rms;
}

bool dominates(const FrontRecord& a, const FrontRecord& b) {
  const double error = front_error(a);
  const double other = front_error(b);
  if (std::isnan(error)) return false;
  if (std::isnan(other)) return true;
  return error <= other && a.complexity <= b.complexity &&
         (error < other || a.complexity < b.complexity);
}

double weighted_rms_of(std::span<const double> values, std::span<const double> target,
                       std::span<const double> weights) {
  double whole = 0;
  double sum = 0;
  for (std::size_t r = 0; r < target.size(); ++r) {
    whole += weights[r];
    sum += weights[r] * (values[r] - target[r]) * (values[r] - target[r]);
  }
  return std::isfinite(sum) && whole > 0 ? std::sqrt(sum / whole) : kMissing;
}

}  // namespace

void judge_predictions(const Problem& problem, std::span<const double> train,
                       std::span<const double> test, Record& record) {
  const ErrorFigures on_train = compute_errors(train, fitted_rows(problem).target);
  record.mae_train = on_train.mae;
  record.relative_error_train = on_train.relative;
  const ErrorFigures on_test = compute_errors(test, problem.test.target);
  record.mae_test = on_test.mae;
  record.rmse_test = on_test.rmse;
  record.max_error_test = on_test.max_error;
  record.r2_test = on_test.r2;
  record.relative_error_test = on_test.relative;
  if (!problem.test.truth.empty()) {
    record.mae_truth = compute_errors(test, problem.test.truth).mae;
  }
  record.status = CellStatus::ok;
  if (on_test.not_finite > 0) {
    mark_failed(record, FailureKind::error,
                fmt::format("the formula has no finite value at {} of {} test rows",
                            on_test.not_finite, on_test.rows));
  }
}

void judge_formula(const Problem& problem, const StagedFormula& staged, Record& record) {
  const Expression& formula = staged.formula;
  TableEvaluator on_train;
  TableEvaluator on_test;
  judge_predictions(problem, on_train.evaluate(formula, fitted_rows(problem)),
                    on_test.evaluate(formula, problem.test), record);
  record.complexity = paper_complexity(formula);
  record.nodes = node_count(formula);
  if (!staged.adaptation.empty()) {
    record.complexity_adaptation = paper_complexity(staged.adaptation);
  }
  judge_singularity(problem, formula, record);
  if (problem.motion) record.motion_error = motion_error_of(problem, formula);
  record.eval_ns_per_row = measure_ns_per_row(formula, problem.test);
  record.formula = formula_text(problem, formula);
}

std::vector<FrontRecord> judge_front(const Problem& problem, const std::vector<Expression>& front,
                                     std::size_t chosen, const Record& judged,
                                     std::span<const double> weights) {
  TableEvaluator evaluator;
  std::vector<FrontRecord> all;
  for (std::size_t i = 0; i < front.size(); ++i) {
    FrontRecord entry;
    entry.cell = judged.cell;
    entry.complexity = paper_complexity(front[i]);
    entry.nodes = node_count(front[i]);
    const Table& train = fitted_rows(problem);
    const std::span<const double> fitted = evaluator.evaluate(front[i], train);
    entry.mae_train = compute_errors(fitted, train.target).mae;
    if (!weights.empty()) entry.weighted_rms = weighted_rms_of(fitted, train.target, weights);
    entry.mae_test =
        compute_errors(evaluator.evaluate(front[i], problem.test), problem.test.target).mae;
    entry.chosen = i == chosen;
    entry.formula = formula_text(problem, front[i]);
    all.push_back(std::move(entry));
  }
  std::vector<FrontRecord> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool beaten = std::ranges::any_of(all, [&](const FrontRecord& other) {
      const bool is_told = other.formula == all[i].formula && (other.chosen || &other < &all[i]);
      return is_told || dominates(other, all[i]);
    });
    if (beaten && !all[i].chosen) continue;
    all[i].singularity =
        all[i].chosen
            ? judged.singularity
            : singularity_of(prove_free(front[i], input_box(problem.inputs), kFrontProof).verdict);
    kept.push_back(all[i]);
  }
  std::ranges::stable_sort(kept, {}, &FrontRecord::complexity);
  return kept;
}

}  // namespace tribench
