// SPDX-License-Identifier: MIT
#include "algorithms/relay/relay.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/relay/answer.hpp"
#include "algorithms/relay/structure_search.hpp"

namespace tribench {
namespace {

using relay::Answer;
using relay::StructureSearch;

// In the order in which they run: where time is short, the one that finds most alone comes first.
constexpr std::array kMembers = {"pysr", "udsr", "parfam"};
constexpr double kOfAMember = 0.9;  // of the seconds; the rest is for what is done with its choice
constexpr double kOfShortening = 0.25;  // of the seconds, for a shorter form of what is exact
// Fewer numbers: of the seconds that are left, after the searches for structure (of 100 000 rows a
// member leaves next to none) and after a member.
constexpr double kOfPruningStructure = 0.1;
constexpr double kOfPruning = 0.5;

// What can be left out besides the searches for structure and the members, by their names.
constexpr std::string_view kNothing = "nothing";
constexpr std::string_view kPruning = "pruning";

class Relay : public Regressor {
 public:
  Relay(int round, std::string without, const MakeMethod& other)
      : round_(round), without_(std::move(without)), solver_(other("pysr", 0)) {
    for (const char* name : kMembers) {
      if (without_ != name) members_.push_back({name, other(name, round)});
    }
  }

  FitResult fit(FitContext& context) const override {
    Answer answer(context);
    if (answer.rows().rows() == 0) {
      return FitResult::unsupported("no row has a finite target and inputs");
    }
    StructureSearch structure(context, answer, *solver_, round_, without_);
    structure.search();
    if (prunes()) answer.prune_likeliest(kOfPruningStructure);
    structure.search_long_sum();
    if (answer.is_explained() && !answer.is_short()) structure.search_guesses();
    for (std::size_t k = 0; k < members_.size(); ++k) {
      // The first runs whatever is left; the others where there is something to spend, and to find.
      if ((answer.is_done() || answer.is_late()) && answer.has_formula()) break;
      if (answer.is_explained()) {
        if (!answer.is_short()) shorten(members_[k], context, answer);
        break;
      }
      run(members_[k], context.budget.remaining() / (members_.size() - k), kOfAMember, context,
          answer);
      if (k > 0 || answer.is_done()) continue;
      structure.search_enclosed();
      structure.search_wide_sums();
      structure.search_guesses();
    }
    if (prunes()) answer.prune_likeliest(kOfPruning);
    return std::move(answer).result();
  }

 private:
  struct Member {
    std::string name;
    std::unique_ptr<Regressor> method;
  };

  bool prunes() const { return without_ != kPruning; }

  // A turn of a member on rows that are explained by a long formula.
  void shorten(const Member& member, FitContext& context, Answer& answer) const {
    run(member, std::min(context.budget.remaining() / members_.size(), answer.left_to_look()),
        kOfShortening, context, answer);
  }

  void run(const Member& member, std::uint64_t evaluations, double of_seconds, FitContext& context,
           Answer& answer) const {
    Budget part = context.budget.share(evaluations, of_seconds);
    FitContext turn{context.data,    context.operators, part, context.random.split(member.name),
                    context.threads, context.progress};
    const FitResult result = member.method->fit(turn);
    context.budget.settle(part);
    answer.add(result, member.name);
    if (prunes() && !result.front.empty()) answer.prune(result.front[result.chosen], kOfPruning);
  }

  int round_;
  std::string without_;
  std::unique_ptr<Regressor> solver_;  // of problems in fewer variables
  std::vector<Member> members_;
};

}  // namespace

AlgorithmEntry relay_entry() {
  AlgorithmEntry entry;
  entry.name = "relay";
  entry.summary =
      "structure (products, sums, fewer variables), then pysr, udsr and parfam, on one front";
  std::vector<std::string> choices = {std::string(kNothing)};
  choices.insert(choices.end(), relay::kSearches.begin(), relay::kSearches.end());
  choices.emplace_back(kPruning);
  choices.insert(choices.end(), kMembers.begin(), kMembers.end());
  entry.parameters = {
      {"round", "how wide the members search: 0 as by themselves", std::int64_t{0}, 0, 1000},
      {"without", "a part that is left out, to see what it is worth", std::string(kNothing), 0, 0,
       choices}};
  entry.make = [](const Parameters& parameters,
                  const MakeMethod& other) -> std::unique_ptr<Regressor> {
    return std::make_unique<Relay>(static_cast<int>(parameters.integer("round")),
                                   parameters.text("without"), other);
  };
  entry.widened = [](int round) {
    return std::map<std::string, ParameterValue>{{"round", std::int64_t{round}}};
  };
  return entry;
}

}  // namespace tribench
