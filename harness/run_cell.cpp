// SPDX-License-Identifier: MIT
#include "harness/run_cell.hpp"
#include "harness/catalogue.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <fstream>
#include <new>
#include <optional>

#include "algorithms/admission.hpp"
#include "algorithms/external/external_method.hpp"
#include "algorithms/fitting/held_out_choice.hpp"
#include "algorithms/missing_role.hpp"
#include "algorithms/scaled_data.hpp"
#include "foundation/child_process.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "harness/category_fit.hpp"
#include "harness/finished_front.hpp"
#include "harness/instruction_counter.hpp"
#include "harness/judge.hpp"
#include "harness/restarts.hpp"
#include "harness/searches_anew.hpp"
#include "harness/stateful_problem.hpp"
#include "harness/table_evaluator.hpp"

namespace tribench {
namespace {

// The anytime trace on a logarithmic grid of evaluations: of the improvements that fall between
// two of its points only the last is kept, so a trace has some tens of lines at most.
class Trace : public Progress {
 public:
  explicit Trace(std::string cell) : cell_(std::move(cell)), cpu_start_(process_cpu_seconds()) {}

  void improved(double train_error, std::uint64_t evaluations) override {
    if (!records_.empty() && !(train_error < records_.back().train_error)) return;
    const TraceRecord record{cell_, before_ + evaluations, process_cpu_seconds() - cpu_start_,
                             train_error};
    const int bucket = bucket_of(record.evaluations);
    if (!records_.empty() && bucket == bucket_of(records_.back().evaluations)) {
      records_.back() = record;
    } else {
      records_.push_back(record);
    }
  }
  // A stage has a target of its own: the trace kept is the last stage's.
  void start_stage(std::uint64_t evaluations_so_far) {
    before_ = evaluations_so_far;
    records_.clear();
  }
  const std::vector<TraceRecord>& records() const { return records_; }

 private:
  static int bucket_of(std::uint64_t evaluations) {
    constexpr double kPointsPerDecade = 10;
    return static_cast<int>(kPointsPerDecade *
                            elementary::log10(1.0 + static_cast<double>(evaluations)));
  }

  std::string cell_;
  double cpu_start_;
  std::uint64_t before_ = 0;
  std::vector<TraceRecord> records_;
};

// CPU seconds of this process and of the programs it has waited for.
double cpu_seconds_with_children() {
  rusage use{};
  getrusage(RUSAGE_CHILDREN, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return process_cpu_seconds() + seconds(use.ru_utime) + seconds(use.ru_stime);
}

// Linux: writing 5 resets the high-water mark of the resident set (proc(5)).
void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5";
  reset_peak_memory_of_children();
}

// The inputs that the stage may use and that vary in its rows. One that does not (the sign of a
// load that never changed) has nothing to tell, and a coefficient fitted to it would be anything:
// the formula is judged where that input takes other values.
std::vector<std::size_t> telling_inputs(const Stage& stage) {
  std::vector<std::size_t> places;
  for (const std::size_t place : stage.inputs) {
    const std::vector<double>& column = stage.train.columns[place];
    if (std::ranges::adjacent_find(column, std::ranges::not_equal_to{}) != column.end()) {
      places.push_back(place);
    }
  }
  return places.empty() ? stage.inputs : places;
}

// What one stage's method sees: its own inputs, and the target less what is already explained.
class StageView {
 public:
  StageView(const Problem& problem, const Stage& stage, const Expression& so_far)
      : places_(telling_inputs(stage)), target_(stage.train.target), train_(stage.train) {
    for (const std::size_t place : places_) {
      inputs_.push_back(problem.inputs[place]);
      columns_.push_back(stage.train.columns[place].data());
      if (train_.trail != nullptr) trail_.push_back(train_.trail->columns[place].data());
    }
    relink_signs(problem);
    if (!so_far.empty()) subtract(stage.train, so_far);
  }

  TrainingData data() const {
    TrainingData data{inputs_, columns_, target_, train_.movement};
    if (train_.trail == nullptr) return data;
    data.motion = {trail_, train_.trail->time, train_.trail->starts};
    data.motion_row = train_.trail_row;
    return data;
  }

  // A formula of the method's, and its states, over the problem's inputs; the states' columns begin
  // at `first_state` there.
  Expression over_problem(const Expression& formula, std::size_t first_state) const;
  std::vector<StateDeclaration> over_problem(std::vector<StateDeclaration> states) const {
    for (StateDeclaration& state : states) {
      for (std::size_t& drive : state.drives) drive = places_[drive];
    }
    return states;
  }

 private:
  // Places among the problem's inputs become places among the stage's.
  void relink_signs(const Problem& problem) {
    for (std::size_t j = 0; j < inputs_.size(); ++j) {
      const std::optional<std::size_t> whole = problem.inputs[places_[j]].sign_of;
      inputs_[j].sign_of.reset();
      for (std::size_t k = 0; whole && k < places_.size(); ++k) {
        if (places_[k] == *whole) inputs_[j].sign_of = k;
      }
    }
  }

  void subtract(const Table& table, const Expression& so_far) {
    TableEvaluator evaluator;
    const std::span<const double> values = evaluator.evaluate(so_far, table);
    for (std::size_t r = 0; r < target_.size(); ++r) target_[r] -= values[r];
  }

  std::vector<std::size_t> places_;
  std::vector<Input> inputs_;
  std::vector<const double*> columns_;
  std::vector<const double*> trail_;
  std::vector<double> target_;
  const Table& train_;
};

Expression StageView::over_problem(const Expression& formula, std::size_t first_state) const {
  std::vector<Node> nodes(formula.nodes().begin(), formula.nodes().end());
  for (Node& node : nodes) {
    if (!node.is_variable()) continue;
    const std::size_t place = node.variable;
    node = Node::input(place < places_.size() ? places_[place]
                                              : first_state + (place - places_.size()));
  }
  return Expression(std::move(nodes));
}

// What the stages have come to together.
struct StagesResult {
  StagedFormula chosen;
  std::vector<Expression> front;  // of the last stage, added to what the first explain
  std::size_t chosen_place = 0;
  FailureReason failure;  // none where every stage gave a formula
  std::string note;
  bool keeps_form = false;
  std::optional<Problem> extended;  // by the formulas' states, where they have any
};

FailureReason why_no_formula(const FitResult& result, const CellLimits& limits) {
  if (result.reason == StopReason::unsupported) {
    return {FailureKind::unsupported, with_mend_of_role(result.note)};
  }
  std::string why = result.note;
  if (why.empty() && result.reason == StopReason::budget) {
    why = fmt::format("the budget of {} evaluations and {} CPU seconds ended before a first one",
                      limits.evaluations, limits.seconds);
  } else if (why.empty()) {
    why = "the method returned an empty front";
  }
  return {FailureKind::error, "no formula: " + why};
}

// Some parameters can be judged only beside the data (a template names the stage's inputs): what a
// method refuses there it does not support, like any other data that it cannot use.
FitResult fit_or_refuse(const Regressor& method, FitContext& context) {
  try {
    return method.fit(context);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    return FitResult::unsupported(error.what());
  }
}

bool has_finite_constants(const Expression& formula) {
  return std::ranges::all_of(formula.nodes(), [](const Node& node) {
    return !node.is_constant() || std::isfinite(node.value);
  });
}

// What no method may hand in: a formula with a constant that is no number (it says nothing, and
// cannot be read back), and one beyond a declared prior. The next simpler one stands in for a
// choice that goes, else the simplest.
void keep_usable_formulas(FitResult& fit, std::span<const Input> inputs) {
  const auto is_usable = [inputs](const Expression& formula) {
    return has_finite_constants(formula) && keeps_priors(formula, inputs);
  };
  if (std::ranges::all_of(fit.front, is_usable)) return;
  std::vector<Expression> kept;
  std::size_t chosen = 0;
  for (std::size_t k = 0; k < fit.front.size(); ++k) {
    if (!is_usable(fit.front[k])) continue;
    if (k <= fit.chosen) chosen = kept.size();
    kept.push_back(std::move(fit.front[k]));
  }
  fit.front = std::move(kept);
  fit.chosen = chosen;
  if (fit.front.empty()) {
    fit.note = "every formula has constants that are not finite, or is beyond a prior";
  }
}

// The fits of one stage: the first and, where seconds are to be spent, further ones in one front.
class StageFits {
 public:
  StageFits(const TrainingData& data, const CellTask& task, Budget& budget)
      : data_(data), scaled_(data), task_(task), budget_(budget) {}

  FitResult fit(const Regressor& method, const RandomStream& random, std::size_t stage,
                const WidenedMethod& widened, Trace& trace) {
    const BudgetLimits before = left();
    if (!task_.limits.spend) return once(method, random.split(stage), &trace);
    FitResult first = once(method, random.split(stage), &trace, share_of_first());
    std::optional<Bearable> bearable;
    if (data_.rows() <= kFewRows && is_enough_for_searches_anew(before, left())) {
      const auto search = [&](const TrainingData& rows, RandomStream anew, Budget& part) {
        return StageFits(rows, task_, part).once(method, anew, nullptr);
      };
      bearable =
          bearable_search(first, search, data_, budget_, random.split("held out").split(stage));
    }
    if (bearable) keep_bearable(*bearable, data_, first);
    if (bearable && !bearable->is_more_worth_it) return first;
    const FitResult judged = first;
    // The trace is the first round's: a later one starts from nothing.
    const auto again = [&](RandomStream stream, int round) {
      return widened ? once(*widened(round), stream, nullptr) : once(method, stream, nullptr);
    };
    FitResult result = fit_until_spent(std::move(first), again, widened != nullptr, data_, budget_,
                                       random.split("again").split(stage));
    // What wider searches make of few rows under noise, no row held out has judged.
    return bearable && !holds_exact(result, data_) ? judged : result;
  }

 private:
  BudgetLimits left() const { return {budget_.remaining(), budget_.remaining_seconds()}; }

  // What a program chooses stands (FitResult::keeps_choice): no look at it needs seconds.
  bool keeps_choice() const { return task_.method.is_external(); }
  // Of few rows the search leaves seconds to be made again, where it has enough of them by itself.
  double share_of_first() const {
    const bool leaves = !keeps_choice() && data_.rows() <= kFewRows &&
                        kShareBesideSearchesAnew * budget_.remaining_seconds() >= kSecondsOfSearch;
    return leaves ? kShareBesideSearchesAnew : 1;
  }
  // share: of the seconds.
  FitResult once(const Regressor& method, RandomStream stream, Progress* progress,
                 double share = 1) {
    const TrainingData seen = scaled_.data();
    Budget part = search_part(share);
    FitContext context{seen, task_.operators, part, stream, task_.threads, progress};
    FitResult result = fit_or_refuse(method, context);
    settle(part);
    for (Expression& formula : result.front) formula = scaled_.unscaled(formula);
    keep_usable_formulas(result, data_.inputs);
    finish_front(data_, task_.operators, budget_, result);
    return result;
  }
  // The whole budget but for its seconds: what has been refused to one is refused to the other.
  Budget search_part(double share) const {
    if (!keeps_choice() && data_.target.size() <= kFewRows) share *= kSearchShareOfFewRows;
    Budget part = budget_.share(budget_.remaining(), share);
    if (budget_.exhausted()) part.spend(part.remaining() + 1);
    return part;
  }
  void settle(const Budget& part) {
    budget_.settle(part);
    if (part.exhausted() && !part.out_of_time()) budget_.spend(budget_.remaining() + 1);
  }

  const TrainingData& data_;
  ScaledData scaled_;
  const CellTask& task_;
  Budget& budget_;
};

void add_note(StagesResult& result, const FitResult& fit, const Stage& stage) {
  if (fit.note.empty()) return;
  if (!result.note.empty()) result.note += "; ";
  if (fit.reason == StopReason::unsupported) result.note += fmt::format("no {}: ", stage.name);
  result.note += fit.note;
}

StagesResult fit_stages(const Problem& given, const Regressor& method, const CellTask& task,
                        const WidenedMethod& widened, Budget& budget, Trace& trace) {
  StagesResult result;
  Expression so_far;
  const RandomStream random(key_of(task.cell.key()));
  for (std::size_t s = 0; s < given.stages.size(); ++s) {
    const Problem& problem = result.extended ? *result.extended : given;
    const Stage& stage = problem.stages[s];
    const StageView view(problem, stage, so_far);
    const TrainingData data = view.data();
    // What is left is shared equally among the stages to come.
    Budget part = budget.share(budget.remaining() / (problem.stages.size() - s));
    trace.start_stage(budget.spent());
    const FitResult fit = StageFits(data, task, part).fit(method, random, s, widened, trace);
    budget.settle(part);
    add_note(result, fit, stage);
    if (fit.front.empty()) {
      // A baseline that cannot fit what is left stands as it was, as in the paper's tables.
      if (s > 0 && fit.reason == StopReason::unsupported) continue;
      result.failure = why_no_formula(fit, task.limits);
      return result;
    }
    result.front.clear();
    const std::size_t first_state = problem.inputs.size();
    if (s > 0) result.chosen.adaptation = view.over_problem(fit.front.at(fit.chosen), first_state);
    for (const Expression& formula : fit.front) {
      const Expression whole = view.over_problem(formula, first_state);
      result.front.push_back(so_far.empty() ? whole : Expression::binary(Op::add, so_far, whole));
    }
    result.chosen_place = fit.chosen;
    result.keeps_form = fit.keeps_form;
    so_far = result.front.at(fit.chosen);
    // Last: the view looks at the problem that this takes the place of.
    if (!fit.states.empty()) result.extended = with_states(problem, view.over_problem(fit.states));
  }
  result.chosen.formula = so_far;
  return result;
}

void name_problem(const Problem& problem, Record& record) {
  record.dataset = problem.dataset;
  record.joint = problem.joint;
  record.load = problem.load;
}

void set_yardsticks(const Yardsticks& yardsticks, Record& record) {
  record.mae_ceiling = yardsticks.ceiling;
  record.mae_law = yardsticks.law;
  record.mae_refitted = yardsticks.refitted;
  record.mae_truth_refitted = yardsticks.truth_refitted;
}

}  // namespace

double peak_memory_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("VmHWM:")) continue;
    const double own_mib = std::strtod(line.c_str() + 6, nullptr) / 1024.0;
    return std::max(own_mib, peak_memory_of_children_mib());
  }
  return kMissing;
}

CellResult fit_and_judge(const Problem& problem, const Regressor& method, const CellTask& task,
                         const WidenedMethod& widened) {
  CellResult result;
  Record& record = result.record;
  record = empty_record(task.cell);
  name_problem(problem, record);
  Trace trace(record.cell);
  reset_peak_memory();
  const auto wall_start = std::chrono::steady_clock::now();
  const double cpu_start = cpu_seconds_with_children();
  const InstructionCounter instructions;
  Budget budget({task.limits.evaluations, task.limits.seconds, task.stop});
  StagesResult fit;
  try {
    fit = fit_stages(problem, method, task, widened, budget, trace);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::environment) throw;
    fit.failure = {FailureKind::error, error.what()};
  } catch (const std::exception& error) {
    fit.failure = {FailureKind::error, error.what()};
  }
  record.fit_cpu_s = cpu_seconds_with_children() - cpu_start;
  // Threads that were there before are not seen by the counter.
  if (task.threads <= 1) record.fit_instructions = instructions.count();
  record.fit_wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  record.peak_memory_mib = peak_memory_mib();
  record.evaluations = budget.spent();
  record.note = fit.note;
  note_overspending(record, task.limits.seconds, task.limits.evaluations);
  result.trace = trace.records();
  if (fit.failure.kind != FailureKind::none) {
    mark_failed(record, fit.failure.kind, std::move(fit.failure.detail));
    return result;
  }
  const Problem& judged = fit.extended ? *fit.extended : problem;
  judge_formula(judged, fit.chosen, record);
  result.front = judge_front(judged, fit.front, fit.chosen_place, record);
  result.keeps_form = fit.keeps_form;
  if (budget.was_cut_by_clock()) note_end_by_clock(record);
  return result;
}

namespace {

Problem make_problem(const CellTask& task) {
  if (!task.own) return full_catalogue_of(task.data).find(task.cell.problem).make(task.cell.seed);
  try {
    user::require_unchanged(*task.own);
  } catch (const Error& error) {
    // It was there when the run began: no fault of the cell, which can be run another time.
    throw Error(ErrorKind::environment, error.what());
  }
  return full_catalogue_of(task.data, {&*task.own, 1}).find(task.cell.problem).make(task.cell.seed);
}

bool has_category(const CellTask& task) { return task.own && !task.own->category.empty(); }

CellResult run_by_category(Problem problem, const Regressor& method, const CellTask& task,
                           const WidenedMethod& widened) {
  const CategoryColumn column = take_last_input(problem);
  return fit_and_judge_by_category(problem, column, method, task, widened);
}

}  // namespace

const CellRunner::Measured& CellRunner::problem(const CellTask& task) {
  constexpr std::size_t kKept = 16;
  // A worker runs one grid, whose prior is the same in all its tasks.
  const std::string key =
      fmt::format("{}@{}|{}|{}", task.cell.problem, task.cell.data, task.cell.seed, task.data);
  const auto found = std::ranges::find(problems_, key, &std::pair<std::string, Measured>::first);
  if (found != problems_.end()) {
    problems_.splice(problems_.begin(), problems_, found);
  } else {
    Problem made = make_problem(task);
    apply_prior(task.prior, made);
    const Yardsticks yardsticks = measure_yardsticks(made);
    problems_.emplace_front(key, Measured{std::move(made), yardsticks});
    if (problems_.size() > kKept) problems_.pop_back();
  }
  return problems_.front().second;
}

CellResult CellRunner::run(const CellTask& task,
                           const std::function<void(const Record&)>& on_problem) {
  CellResult failed;
  failed.record = empty_record(task.cell);
  try {
    const Measured& data = problem(task);
    name_problem(data.problem, failed.record);
    set_yardsticks(data.yardsticks, failed.record);
    on_problem(failed.record);
    const auto in_round = [&](int round) {
      return task.method.is_external()
                 ? make_external_method(task.method.command, task.method.parameters)
                 : registry_.make(task.method.algorithm, task.method.parameters, round);
    };
    const bool widens =
        !task.method.is_external() && registry_.find(task.method.algorithm).widened != nullptr;
    const WidenedMethod wider = widens ? in_round : WidenedMethod();
    CellResult result = has_category(task)
                            ? run_by_category(data.problem, *in_round(0), task, wider)
                            : fit_and_judge(data.problem, *in_round(0), task, wider);
    set_yardsticks(data.yardsticks, result.record);
    return result;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::environment) throw;
    mark_failed(failed.record, FailureKind::error, error.what());
  }
  return failed;
}

}  // namespace tribench
