// SPDX-License-Identifier: MIT
#include "algorithms/udsr/udsr.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "algorithms/admission.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/udsr/choice.hpp"
#include "algorithms/udsr/pruning.hpp"
#include "algorithms/udsr/simplification.hpp"
#include "algorithms/udsr/term_selection.hpp"
#include "algorithms/udsr/training.hpp"
#include "algorithms/udsr/weights.hpp"
#include "foundation/error.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

using udsr::Candidate;
using udsr::Scoreboard;
using udsr::Scorer;
using udsr::ScoringProblem;

// Deeper recursion would search for parts of parts of a smoother's guess.
constexpr int kMaxRecursion = 2;
constexpr std::size_t kFewestConstants = 2;

// Of more rows a search sees a sample, drawn at random; what it finds is fitted and judged on all
// of them. (PySR goes over to batches from 10 000 rows on.)
constexpr std::size_t kMostSearchedRows = 10000;
constexpr std::size_t kSampledRows = 4000;
// A hundredth of the error is not worth hundreds of terms.
constexpr double kAsGood = 1.01;

struct Settings {
  udsr::TokenOptions tokens;
  udsr::PriorOptions prior;
  udsr::TrainingOptions training;
  int degree = 3;
  bool recursion = true;
  std::string weights;       // "shipped", "none" or a file's name
  std::string weights_text;  // the file's contents
  std::optional<udsr::DataEncoder> encoder;
  udsr::Choice choice = udsr::Choice::posterior;
};

std::vector<ParameterSpec> parameter_specs() {
  return {
      {"linear_token", "the linear token", true},
      {"degree", "total degree of the linear token", std::int64_t{3}, 1, 6},
      {"constants", "constants fitted inside formulas", true},
      {"genetic", "genetic programming seeded by the policy", true},
      {"generations", "of genetic programming a step", std::int64_t{20}, 1, 1000},
      {"population", "of genetic programming", std::int64_t{100}, 2, 10000},
      {"recursion", "recursive simplification", true},
      {"weights", "pre-trained policy: shipped, none, or a file", std::string("shipped")},
      {"encoder", "the policy starts from what the weight file's data encoder makes of the rows",
       false},
      {"policy",
       "how the policy learns",
       std::string("risk_seeking"),
       0,
       0,
       {"none", "risk_seeking", "priority_queue", "ppo"}},
      {"baseline",
       "what a kept reward is compared with",
       std::string("quantile"),
       0,
       0,
       {"quantile", "moving_mean", "moving_quantile", "combined"}},
      {"batch", "formulas sampled a step", std::int64_t{500}, 1, 10000},
      {"steps", "most steps of training", std::int64_t{200}, 0, 100000},
      {"patience", "steps without a better formula before stopping", std::int64_t{60}, 1, 100000},
      {"epsilon", "share of a batch that trains the policy", 0.05, 1e-4, 1},
      {"learning_rate", "of Adam", 5e-4, 0, 1},
      {"entropy_weight", "of the policy's entropy in the loss", 0.03, 0, 10},
      {"entropy_gamma", "discount of the entropy by position", 0.7, 0, 1},
      {"choice",
       "the formula of the front: nearest to the posterior mean, least BIC, cross-validation, the "
       "simpler of these two, or least description length",
       std::string("posterior"),
       0,
       0,
       {"posterior", "simpler", "description_length", "cross_validation", "bic"}},
      {"max_length", "tokens of a formula", std::int64_t{30}, 4, 200},
  };
}

udsr::PolicyUpdate policy_update(const std::string& name) {
  if (name == "none") return udsr::PolicyUpdate::none;
  if (name == "priority_queue") return udsr::PolicyUpdate::priority_queue;
  return name == "ppo" ? udsr::PolicyUpdate::ppo : udsr::PolicyUpdate::risk_seeking;
}

udsr::Baseline baseline_of(const std::string& name) {
  if (name == "moving_mean") return udsr::Baseline::moving_mean;
  if (name == "moving_quantile") return udsr::Baseline::moving_quantile;
  return name == "combined" ? udsr::Baseline::combined : udsr::Baseline::quantile;
}

Settings settings_from(const Parameters& parameters) {
  Settings settings;
  settings.tokens = {parameters.flag("constants"), parameters.flag("linear_token")};
  settings.degree = static_cast<int>(parameters.integer("degree"));
  settings.recursion = parameters.flag("recursion");
  settings.prior.max_length = static_cast<int>(parameters.integer("max_length"));
  udsr::TrainingOptions& training = settings.training;
  training.genetic = parameters.flag("genetic");
  training.gp.generations = static_cast<int>(parameters.integer("generations"));
  training.gp.population = static_cast<int>(parameters.integer("population"));
  training.update = policy_update(parameters.text("policy"));
  training.baseline = baseline_of(parameters.text("baseline"));
  training.batch = static_cast<int>(parameters.integer("batch"));
  training.max_steps = static_cast<int>(parameters.integer("steps"));
  training.patience = static_cast<int>(parameters.integer("patience"));
  training.epsilon = parameters.number("epsilon");
  training.learning_rate = parameters.number("learning_rate");
  training.entropy_weight = parameters.number("entropy_weight");
  training.entropy_gamma = parameters.number("entropy_gamma");
  settings.choice = udsr::choice_of(parameters.text("choice"));
  settings.weights = parameters.text("weights");
  if (settings.weights == "shipped") {
    settings.weights_text = embedded::udsr_weights();
  } else if (settings.weights != "none") {
    settings.weights_text = read_file(settings.weights);
  }
  if (parameters.flag("encoder")) {
    settings.encoder = udsr::read_encoder(settings.weights_text, settings.weights);
  }
  return settings;
}

udsr::DataRange range_of(const ScoringProblem& problem) {
  udsr::DataRange range;
  const Inputs inputs = problem.inputs();
  for (const double* column : inputs.columns) {
    range.input_low.push_back(*std::min_element(column, column + inputs.rows));
  }
  const auto [low, high] = std::ranges::minmax(problem.target());
  range.target_low = low;
  range.target_high = high;
  return range;
}

// Everything one search owns: the same for the whole problem and for a part of it.
class Search {
 public:
  Search(const Settings& settings, const TrainingData& data, const OperatorSet& operators,
         Budget& budget, Progress* progress, int threads)
      : settings_(settings),
        library_(operators, data.inputs.size(), settings.tokens),
        problem_(data, library_, settings.degree),
        budget_(budget),
        scorer_(problem_),
        pruner_(problem_),
        progress_(progress),
        threads_(threads),
        admission_(operators, data.inputs),
        wide_terms_(settings.tokens.linear
                        ? udsr::wide_terms(data.inputs, 2 * settings.degree, problem_.rows())
                        : std::vector<udsr::Monomial>()) {}

  std::size_t rows() const { return problem_.rows(); }
  const ScoringProblem& problem() const { return problem_; }
  // Everything that was fitted on the way to the front.
  const std::vector<Candidate>& pool() const { return pool_; }

  // Trains a policy, then offers what it found and sparser versions of the best.
  void run(const RandomStream& random) {
    // A fifth is kept for what makes a formula out of what the search has found.
    Budget searching = budget_.share(budget_.remaining() / 5 * 4, 0.8);
    Scoreboard scoreboard(problem_, searching, progress_, threads_);
    udsr::Policy policy(library_, random.split("policy"));
    if (!settings_.weights_text.empty()) {
      udsr::read_weights(settings_.weights_text, settings_.weights, policy);
    }
    if (settings_.encoder) {
      policy.begin_from(settings_.encoder->encode(
          udsr::DataEncoder::features(problem_.inputs(), problem_.target())));
    }
    const udsr::Prior prior(library_, settings_.prior, range_of(problem_));
    udsr::train(policy, prior, settings_.training, random.split("training"), scoreboard);
    budget_.settle(searching);
    for (const auto& [complexity, entry] : scoreboard.front()) add(entry.formula, entry.nrmse);
    // Of a linear token of hundreds of terms one path takes seconds; the polynomials come after it.
    Budget clock = budget_.share(0, 0.5);
    for (const Scoreboard::Entry& entry : scoreboard.promising()) {
      offer_sparser(entry.sequence, clock);
    }
    offer_polynomials();
  }

  // Fits the constants of a formula that came from elsewhere and adds it.
  void offer(Expression formula) {
    if (!budget_.spend(node_rows(formula, rows()))) return;
    const ConstantFitResult fit = fitter_.fit(formula, problem_.inputs(), problem_.target());
    budget_.spend(fit.node_rows);
    const double error = scorer_.nrmse(formula);
    add(std::move(formula), error);
  }

  // The same, with the constants that it has where there is no time left to fit them.
  void take(Expression formula) {
    const double error = scorer_.nrmse(formula);
    add(formula, error);
    offer(std::move(formula));
  }

  // By increasing complexity, each more accurate than all before it; constants converged.
  std::vector<Expression> front() {
    std::map<int, Candidate> raw;
    raw.swap(candidates_);
    for (auto& [complexity, candidate] : raw) {
      offer(candidate.formula);
      add(std::move(candidate.formula), candidate.nrmse);
    }
    std::vector<Expression> front;
    double best = std::numeric_limits<double>::infinity();
    for (const auto& [complexity, candidate] : candidates_) {
      if (candidate.nrmse >= best) continue;
      best = candidate.nrmse;
      front.push_back(candidate.formula);
    }
    return front;
  }

 private:
  void add(Expression formula, double nrmse) {
    if (!std::isfinite(nrmse)) return;
    pool_.push_back({formula, nrmse});
    const int complexity = paper_complexity(formula);
    const auto found = candidates_.find(complexity);
    if (found != candidates_.end() && !(nrmse < found->second.nrmse)) return;
    if (!is_admitted(formula)) return;
    candidates_[complexity] = {std::move(formula), nrmse};
  }

  // Where the operator set admits only formulas proved free of singularities.
  bool is_admitted(const Expression& formula) const { return admission_.may_be_offered(formula); }

  // With constants before every term, then with ever fewer terms.
  void offer_sparser(const udsr::Sequence& sequence, Budget& clock) {
    if (budget_.exhausted() || clock.out_of_time()) return;
    const udsr::Scored scored = scorer_.score(sequence);
    if (scored.reward <= 0 || !budget_.spend(scoring_cost(problem_, sequence))) return;
    // Without constants a formula has none but those that the linear token was solved for.
    const Expression start =
        settings_.tokens.constants ? udsr::with_constants(scored.formula) : scored.formula;
    for (udsr::Pruner::Step& step : pruner_.path(start, kFewestConstants, budget_, clock)) {
      add(std::move(step.formula), step.nrmse);
    }
  }

  // The linear token by itself. Coefficients are solved for: they stand where there is no time to
  // polish them.
  void offer_polynomials() {
    const std::vector<Expression> polynomials = udsr::select_terms(wide_terms_, problem_, budget_);
    for (const Expression& formula : polynomials) {
      if (budget_.exhausted()) {
        add(formula, scorer_.nrmse(formula));
      } else {
        offer(formula);
      }
    }
  }

  const Settings& settings_;
  udsr::TokenLibrary library_;
  ScoringProblem problem_;
  Budget& budget_;
  Scorer scorer_;
  udsr::Pruner pruner_;
  ConstantFitter fitter_;
  Progress* progress_;
  int threads_;
  Admission admission_;
  std::vector<udsr::Monomial> wide_terms_;
  std::map<int, Candidate> candidates_;
  std::vector<Candidate> pool_;
};

class Udsr : public Regressor {
 public:
  explicit Udsr(Settings settings) : settings_(std::move(settings)) {}

  FitResult fit(FitContext& context) const override {
    const udsr::TokenLibrary tokens(context.operators, context.data.inputs.size(),
                                    settings_.tokens);
    if (tokens.size() > udsr::kMostTokens) {
      return FitResult::unsupported(
          fmt::format("inputs and operations are {} tokens, and uDSR's library holds {}: use fewer",
                      tokens.size(), udsr::kMostTokens));
    }
    Search search(settings_, context.data, context.operators, context.budget, context.progress,
                  context.threads);
    if (search.rows() == 0) return FitResult::unsupported("no training row is finite");
    const std::vector<Expression> front =
        search.rows() > kMostSearchedRows ? solve_sample(search, context)
                                          : solve(search, context, context.data, context.random, 0);
    FitResult result;
    result.reason = context.budget.exhausted() ? StopReason::budget : StopReason::converged;
    if (front.empty()) {
      result.front.push_back(mean_of(search.problem().target()));
      return result;
    }
    result.front = front;
    result.chosen = udsr::choose_sound(settings_.choice, front, search.pool(), search.problem(),
                                       input_box(context.data.inputs), context.budget);
    return result;
  }

 private:
  static Expression mean_of(std::span<const double> target) {
    double mean = 0;
    for (const double y : target) mean += y / static_cast<double>(target.size());
    return Expression::constant(mean);
  }

  // Finds formulas on a sample of the rows and offers them to the search that has them all.
  std::vector<Expression> solve_sample(Search& all, FitContext& context) const {
    const ScoringProblem& problem = all.problem();
    RandomStream random = context.random.split("sample");
    std::vector<std::size_t> rows(problem.rows());
    std::iota(rows.begin(), rows.end(), 0);
    random.shuffle(std::span(rows));
    rows.resize(kSampledRows);
    std::ranges::sort(rows);
    std::vector<std::vector<double>> columns;
    std::vector<const double*> pointers;
    for (const double* column : problem.inputs().columns) {
      columns.push_back(at_rows(std::span(column, problem.rows()), rows));
      pointers.push_back(columns.back().data());
    }
    const std::vector<double> target = at_rows(problem.target(), rows);
    const std::vector<int> movement = at_rows(problem.movement(), rows);
    const TrainingData sample = {context.data.inputs, pointers, target, movement};
    // The rest is for all rows.
    Budget searching = context.budget.share(context.budget.remaining() / 5 * 4, 0.8);
    FitContext part{sample,         context.operators, searching,
                    context.random, context.threads,   context.progress};
    Search search(settings_, sample, context.operators, searching, context.progress,
                  context.threads);
    std::vector<Expression> front = solve(search, part, sample, context.random, 0);
    // All rows, most of which the search has not seen, say how long a formula may be: on all rows
    // whatever the form lacks is significant as hundreds of small terms. What the sample does not
    // support is not looked at on all of them.
    if (!front.empty()) {
      const auto supported =
          udsr::choose(udsr::Choice::bic, front, {}, search.problem(), {}, searching);
      front.resize(1 + supported);
      front.resize(1 + shortest_as_good(front, problem));
    }
    for (Expression& formula : front) all.take(std::move(formula));
    context.budget.settle(searching);
    return all.front();
  }

  // The first formula, of formulas by increasing complexity, whose error on all rows is within a
  // hundredth of the least.
  static std::size_t shortest_as_good(std::span<const Expression> front,
                                      const ScoringProblem& problem) {
    std::vector<double> errors;
    Evaluator evaluator;
    for (const Expression& formula : front) {
      const ErrorSum sum =
          evaluator.sum_squared_errors(formula, problem.inputs(), problem.target());
      errors.push_back(sum.status == ErrorSumStatus::complete
                           ? sum.sum
                           : std::numeric_limits<double>::infinity());
    }
    const double enough = kAsGood * std::ranges::min(errors);
    const auto first = std::ranges::find_if(errors, [=](double e) { return e <= enough; });
    return first == errors.end() ? 0 : static_cast<std::size_t>(first - errors.begin());
  }

  template <typename T>
  static std::vector<T> at_rows(std::span<const T> values, std::span<const std::size_t> rows) {
    std::vector<T> out;
    for (const std::size_t row : rows) out.push_back(values[row]);
    return out;
  }

  // The unreduced search always runs; a reduction only adds formulas.
  std::vector<Expression> solve(Search& search, FitContext& context, const TrainingData& data,
                                const RandomStream& random, int depth) const {
    search.run(random);
    if (settings_.recursion && depth < kMaxRecursion && data.inputs.size() > 1 &&
        !context.budget.exhausted()) {
      reduce(search, context, data, random.split("reduction"), depth);
    }
    return search.front();
  }

  void reduce(Search& search, FitContext& context, const TrainingData& data,
              const RandomStream& random, int depth) const {
    const ScoringProblem& problem = search.problem();
    const TrainingData finite = {data.inputs, problem.inputs().columns, problem.target(),
                                 problem.movement()};
    const udsr::Smoother smoother(finite.table(), finite.target, random.split("smoother"));
    const std::optional<udsr::Reduction> reduction = udsr::find_reduction(
        smoother, finite.inputs, context.operators, random.split("tests"), context.budget);
    if (!reduction) return;
    const std::vector<udsr::Subproblem> parts = udsr::split(*reduction, smoother, finite);
    std::vector<std::vector<Expression>> choices;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      choices.push_back(solve_part(parts[p], context, random.split(p), depth + 1));
      if (choices.back().empty()) return;
    }
    for (const Expression& first : choices.front()) {
      if (parts.size() == 1) {
        search.offer(udsr::recombine(*reduction, parts, std::vector{first}));
        continue;
      }
      for (const Expression& second : choices.back()) {
        search.offer(udsr::recombine(*reduction, parts, std::vector{first, second}));
      }
    }
  }

  // The chosen and the most accurate formula of a part.
  std::vector<Expression> solve_part(const udsr::Subproblem& part, FitContext& context,
                                     const RandomStream& random, int depth) const {
    std::vector<const double*> columns;
    for (const auto& column : part.columns) columns.push_back(column.data());
    // The smoother's values have no movements: each row stands for itself.
    std::vector<int> movement(part.target.size());
    std::iota(movement.begin(), movement.end(), 0);
    const TrainingData data = {part.inputs, columns, part.target, movement};
    // A part's error is not the problem's: it does not enter the trace.
    Search search(settings_, data, context.operators, context.budget, nullptr, context.threads);
    const std::vector<Expression> front = solve(search, context, data, random, depth);
    if (front.empty()) return front;
    const std::size_t chosen =
        udsr::choose(settings_.choice, front, search.pool(), search.problem(), {}, context.budget);
    if (chosen + 1 == front.size()) return {front.back()};
    return {front[chosen], front.back()};
  }

  Settings settings_;
};

// Longer formulas, a linear token of the next degree, larger generations, and more steps before a
// search that finds nothing ends.
std::map<std::string, ParameterValue> widened(int round) {
  return {{"max_length", std::int64_t{std::min(30 + 5 * round, 60)}},
          {"degree", std::int64_t{round < 2 ? 3 : 4}},
          {"population", std::int64_t{std::min(100 + 50 * round, 400)}},
          {"patience", std::int64_t{std::min(60 + 30 * round, 200)}}};
}

}  // namespace

AlgorithmEntry udsr_entry() {
  return {"udsr",
          "unified deep symbolic regression: policy network, genetic programming, linear token, "
          "recursive simplification, pre-training",
          parameter_specs(),
          false,
          [](const Parameters& parameters, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<Udsr>(settings_from(parameters));
          },
          widened};
}

}  // namespace tribench
