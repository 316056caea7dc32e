// SPDX-License-Identifier: MIT
#include "algorithms/pysr/search.hpp"
#include "algorithms/admission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "algorithms/expression/input_box.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/evidence.hpp"
#include "algorithms/pysr/island.hpp"
#include "algorithms/pysr/migration.hpp"
#include "algorithms/pysr/preparation.hpp"
#include "algorithms/pysr/refinement.hpp"
#include "foundation/error.hpp"
#include "foundation/parallel_for.hpp"

namespace tribench::pysr {
namespace {

// Kept back for the polish of the front.
constexpr std::uint64_t kPolishShare = 5;  // a fifth
// A description length that falls by less than this many nats is no headway.
constexpr double kHeadway = 1.0;

// The size that is allowed once `elapsed` of the search is over.
int allowed_size(const Options& options, double elapsed) {
  if (options.warm_up <= 0 || elapsed > options.warm_up) return options.max_size;
  return 3 + static_cast<int>(std::floor((options.max_size - 3) * elapsed / options.warm_up));
}

int automatic_batch(std::size_t rows) {
  if (rows < 5'000) return 128;
  return rows < 50'000 ? 256 : 512;
}

// Options with what depends on the data and the form decided.
Options settled(Options options, const Form& form, std::size_t rows) {
  if (options.batching == Batching::automatic) {
    options.batching = rows > 1000 ? Batching::on : Batching::off;
  }
  if (options.batch_size == 0) options.batch_size = automatic_batch(rows);
  options.max_depth = std::min(options.max_depth, options.max_size);
  if (!form.is_whole()) {
    // Both put something above the whole formula, where the template stands.
    options.linear_scaling = false;
    if (options.weights[index_of(MutationKind::backsolve)] > 0) {
      throw_bad_input("backsolve replaces what a template holds", "mutation_weights",
                      "leave backsolve at 0, or the template empty");
    }
  }
  return options;
}

ScoreRule rule_of(const Options& options, const Form& form, const Rows& rows,
                  const OperatorSet& operators) {
  const bool native = options.profile == Profile::native;
  return {loss_norm(rows, native ? 0.0 : 0.01), options.parsimony,
          options.evidence_cost ? rows.size() : 0,
          operators.allows(Op::pow) && !form.has_fixed_exponent()};
}

class Search {
 public:
  Search(const Options& options, const Form& form, FitContext& context, const Rows& all,
         const Rows& sample)
      : options_(options),
        context_(context),
        all_(all),
        rows_(sample),
        box_(input_box(context.data.inputs)),
        validator_(options, context.operators, context.data.inputs, form),
        libraries_(make_term_libraries(form, rows_, context.operators)),
        shared_{options_, context.operators, validator_,
                rows_,    libraries_,        rule_of(options, form, rows_, context.operators)},
        hall_(options.max_size),
        frequencies_(options.max_size) {}

  FitResult run();

 private:
  void refuse_what_cannot_start() const;
  void start();
  void run_epoch(int epoch);
  void meet(int epoch);
  void offer_guesses();
  void report();
  bool has_converged();
  std::vector<Candidate> polished_front();
  FitResult result_of(const std::vector<Candidate>& front) const;
  std::optional<std::size_t> choice_beyond(std::span<const Expression> front) const;
  template <typename Work>
  void on_all_islands(Work work);

  Options options_;
  FitContext& context_;
  const Rows& all_;
  const Rows& rows_;
  InputBox box_;
  Validator validator_;
  TermLibraries libraries_;
  Shared shared_;
  std::vector<std::unique_ptr<Island>> islands_;
  HallOfFame hall_;
  SizeFrequencies frequencies_;
  std::vector<Member> guesses_;
  double best_reported_ = std::numeric_limits<double>::infinity();
  double best_length_ = std::numeric_limits<double>::infinity();
  int stale_epochs_ = 0;
};

// Every island works on its own share of what is left, so that no one's outcome depends on who
// runs first.
template <typename Work>
void Search::on_all_islands(Work work) {
  const std::uint64_t reserve = context_.budget.remaining() / kPolishShare;
  const std::uint64_t each =
      (context_.budget.remaining() - reserve) / static_cast<std::uint64_t>(islands_.size());
  std::vector<Budget> shares(islands_.size(), context_.budget.share(each));
  parallel_for(islands_.size(), context_.threads,
               [&](std::size_t k) { work(k, *islands_[k], shares[k]); });
  for (const Budget& share : shares) context_.budget.settle(share);
}

// The template with numbers for its parts is the smallest formula there is.
void Search::refuse_what_cannot_start() const {
  const Form& form = validator_.form();
  if (form.is_whole()) return;
  const Expression least = form.assembled([](std::size_t) { return Expression::constant(0); });
  if (validator_.admits(least, options_.max_size)) return;
  throw_bad_input(
      fmt::format("no formula of the template is allowed: alone it has size {} and {} levels",
                  validator_.size(least), depth(least)),
      "template", "raise max_size or max_depth, or look at units and part_sizes");
}

void Search::start() {
  for (int i = 0; i < options_.populations; ++i) {
    islands_.push_back(std::make_unique<Island>(shared_));
  }
  const RandomStream stream = context_.random.split("populate");
  on_all_islands([&](std::size_t i, Island& island, Budget& budget) {
    island.populate(stream.split(i), budget);
  });
  for (const auto& island : islands_) hall_.offer(island->best_seen());
  offer_guesses();
}

void Search::offer_guesses() {
  Scorer scorer(validator_, shared_.rule);
  std::vector<std::string> names;
  for (const Input& input : context_.data.inputs) names.push_back(input.name);
  std::string_view rest = options_.guesses;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    std::optional<Expression> guess = validator_.form().read(parse(rest.substr(0, end), names));
    if (!guess) {
      throw_bad_input(fmt::format("'{}' has not the form that is searched", rest.substr(0, end)),
                      "guesses",
                      "write it as the template with its parts put in, of the inputs selected");
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const auto loss = scorer.fit(*guess, rows_, 30, context_.budget);
    if (!loss || !validator_.admits(*guess, options_.max_size)) continue;
    guesses_.push_back(scorer.member_of(std::move(*guess), *loss));
    hall_.offer(guesses_.back());
  }
}

void Search::run_epoch(int epoch) {
  const double elapsed = static_cast<double>(epoch) / options_.iterations;
  const EpochState state{frequencies_, hall_, allowed_size(options_, elapsed)};
  const RandomStream stream =
      context_.random.split("evolve").split(static_cast<std::uint64_t>(epoch));
  on_all_islands([&](std::size_t i, Island& island, Budget& budget) {
    island.evolve(state, stream.split(i), budget);
  });
}

void Search::meet(int epoch) {
  std::vector<Member> peers;
  for (const auto& island : islands_) {
    for (const Member& member : island->members()) {
      frequencies_.count(member.size);
      hall_.offer(member);
    }
    hall_.offer(island->best_seen());
    const std::vector<Member> best = best_members(island->members(), options_.top_n);
    peers.insert(peers.end(), best.begin(), best.end());
  }
  const std::vector<Member> front = hall_.front();
  const RandomStream stream =
      context_.random.split("migrate").split(static_cast<std::uint64_t>(epoch));
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    RandomStream random = stream.split(i);
    Island& island = *islands_[i];
    migrate(peers, island.members(), options_.replaced_by_peers, island.clock(), random);
    migrate(front, island.members(), options_.replaced_by_front, island.clock(), random);
    migrate(guesses_, island.members(), options_.replaced_by_guesses, island.clock(), random);
  }
  frequencies_.shrink_to(options_.frequency_window);
  frequencies_.normalise();
}

void Search::report() {
  if (context_.progress == nullptr) return;
  const auto best = hall_.best_loss_up_to(options_.max_size);
  if (!best || !(*best < best_reported_)) return;
  best_reported_ = *best;
  context_.progress->improved(*best, context_.budget.spent());
}

bool Search::has_converged() {
  if (options_.patience == 0) return false;
  double shortest = std::numeric_limits<double>::infinity();
  const double zero = zero_loss(rows_);
  for (const Member& member : hall_.front()) {
    shortest =
        std::min(shortest, evidence_against(member.formula, member.loss, zero, rows_.size()));
  }
  stale_epochs_ = shortest < best_length_ - kHeadway ? 0 : stale_epochs_ + 1;
  best_length_ = std::min(best_length_, shortest);
  return stale_epochs_ >= options_.patience;
}

FitResult Search::run() {
  refuse_what_cannot_start();
  start();
  report();
  for (int epoch = 0; epoch < options_.iterations; ++epoch) {
    if (context_.budget.remaining() == 0 || context_.budget.out_of_time()) break;
    const std::uint64_t before = context_.budget.spent();
    run_epoch(epoch);
    meet(epoch);
    report();
    // Nothing could be spent: what is left is the reserve.
    if (context_.budget.spent() == before) break;
    if (has_converged()) break;
  }
  return result_of(polished_front());
}

std::vector<Candidate> Search::polished_front() {
  const Form& form = validator_.form();
  if (&all_ != &rows_) libraries_ = make_term_libraries(form, all_, context_.operators);
  Climber climber(options_, context_.operators, validator_, all_, libraries_, shared_.rule);
  std::function<bool(const Expression&)> admitted;
  if (options_.safe || context_.operators.proved_free_only()) {
    admitted = [&](const Expression& formula) {
      return prove_free(form.columns().written_out(formula), box_).verdict == Verdict::proved_free;
    };
  }
  return refined_front(climber, options_, form, all_, hall_.front(), admitted,
                       context_.random.split("refine"), context_.budget);
}

// The choice where the formula will be used beyond the rows it was found on, which no measure of
// size can speak for; none where it will not. Made even where the search has spent everything: it
// costs a few hundredths of that, and is counted. A template's own constants are fitted along here:
// each fold asks how well the shape continues.
std::optional<std::size_t> Search::choice_beyond(std::span<const Expression> front) const {
  if (!options_.refine || context_.budget.out_of_time()) return {};
  const FiniteRows rows(context_.data);
  if (!reaches_beyond(rows.table(), box_)) return {};
  const CrossValidation validation =
      cross_validate(front, rows.table(), rows.target, rows.movement, box_);
  context_.budget.spend(validation.node_rows);
  return validation.chosen;
}

FitResult Search::result_of(const std::vector<Candidate>& front) const {
  FitResult result;
  result.reason = context_.budget.exhausted() ? StopReason::budget : StopReason::converged;
  std::vector<FrontPoint> points;
  std::vector<std::size_t> places;
  for (const Candidate& candidate : front) {
    places.push_back(result.front.size());
    result.front.push_back(validator_.form().columns().written_out(candidate.formula));
    points.push_back(candidate.point);
  }
  // The formula the method stands for must not be wrong between the training points: the next
  // choice takes the place of one that is refuted.
  std::vector<Expression> left = result.front;
  while (!left.empty()) {
    const std::optional<std::size_t> beyond = choice_beyond(left);
    const std::size_t choice = beyond ? *beyond : select(points, options_.selection);
    result.chosen = places[choice];
    if (!options_.refine || left.size() == 1 ||
        prove_free(left[choice], box_).verdict != Verdict::refuted) {
      break;
    }
    const auto place = static_cast<std::ptrdiff_t>(choice);
    left.erase(left.begin() + place);
    points.erase(points.begin() + place);
    places.erase(places.begin() + place);
  }
  return result;
}

// Without a search: the mean, or the template with nothing in it.
FitResult unsearched(const Form& form, const Rows& rows, std::string note) {
  double mean = 0;
  for (const double value : rows.target) mean += value / static_cast<double>(rows.size());
  if (!form.is_whole()) mean = 0;
  const auto part = [mean](std::size_t) { return Expression::constant(mean); };
  return {{form.columns().written_out(form.assembled(part))},
          0,
          StopReason::budget,
          std::move(note),
          !form.is_whole()};
}

}  // namespace

FitResult search(const Options& given, FitContext& context) {
  Rows complete = complete_rows(context.data);
  if (complete.size() == 0) return FitResult::unsupported("no row has a finite target and inputs");
  std::string note;
  const Form form = prepare_form(given, complete, context, note);
  const std::vector<std::string> names = names_of(context.data.inputs);
  const Rows all = form.columns().extended(std::move(complete), names);
  if (form.is_whole() &&
      std::ranges::adjacent_find(all.target, std::ranges::not_equal_to{}) == all.target.end()) {
    return {{Expression::constant(all.target[0])}, 0, StopReason::converged, "constant target"};
  }
  if (context.budget.remaining() == 0 || context.operators.operators().empty()) {
    return unsearched(form, all, "no budget");
  }
  const Options options = settled(given, form, all.size());
  const auto wanted = static_cast<std::size_t>(options.search_rows);
  FitResult result;
  if (!options.denoise && (wanted == 0 || wanted >= all.size())) {
    result = Search(options, form, context, all, all).run();
  } else {
    const Rows seen = prepare_rows(options, form, all, context, note);
    result = Search(options, form, context, all, seen).run();
  }
  // The clock had run out before anything was scored.
  if (result.front.empty()) return unsearched(form, all, "no budget");
  if (!given.form.empty()) {
    add_to_note(note, parts_text(form, names, result.front[result.chosen]));
  }
  result.note = std::move(note);
  result.keeps_form = !form.is_whole();
  return result;
}

}  // namespace tribench::pysr
