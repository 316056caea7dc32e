// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "algorithms/campaign/worth.hpp"
#include "algorithms/diagnosis/candidates.hpp"
#include "algorithms/diagnosis/plausibility.hpp"
#include "algorithms/diagnosis/shaking.hpp"
#include "algorithms/inference/whitening.hpp"
#include "algorithms/leftover/leftover.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kMostAtoms = 2;  // of a family: more is a sign of something else
// Of the target: what the base leaves is rounding.
constexpr double kNothingLeft = 1e-9;
constexpr double kMostOfIt = 0.5;  // of what is left over

bool leaves_nothing(const FittedModel& base, const Campaign& campaign) {
  return !(base.raw_residual.norm() > kNothingLeft * target_vector(campaign.data).norm());
}

bool was_given_up(const Atom& atom, const SearchState& state) {
  return std::ranges::count(state.given_up, atom.label) > 0;
}

// Adds the candidate and fits everything anew. False where the family has had its share already, or
// cannot be what it is called: the next best may still be needed.
bool add(SearchState& state, const Candidate& winner, const Round& round,
         const Campaign& campaign) {
  const std::size_t known = state.model.model.atoms_of(winner.family);
  if (known >= kMostAtoms && campaign.options.has("most_columns")) {
    state.asked_more.push_back(winner.family);
    return false;
  }
  if (was_given_up(campaign.library.atoms[winner.atom], state)) return false;
  LoopModel model = state.model.model;
  model.add(campaign.library.atoms[winner.atom]);
  FittedModel extended = fit_in_its_noise(std::move(model), campaign, FitScope::everything);
  // One fold alone can tell of it: that it holds elsewhere too is beyond these data.
  if (!extended.losses.allFinite()) return false;
  // What its gain alone admits has to have it still once its shapes are fitted.
  if (winner.rescued || !(winner.gain.nats > winner.gain.error)) {
    const Gain fitted = gain_of({winner.family}, extended, campaign);
    const bool has_it = winner.rescued ? is_more_than_error(fitted) : fitted.nats > fitted.error;
    if (!has_it) return false;
  }
  if (stands_for_another_cause(extended.model, campaign)) return false;
  if (goes_with_shaking(extended, winner.family, campaign)) return false;
  if (known == 0) {
    const bool few = winner.rescued || round.counted_alike[winner.family] != 0;
    state.found.push_back({winner.family, round.family_p[winner.family], winner.gain, few,
                           aliases_of(winner, extended, round, state.model, campaign)});
  }
  state.model = std::move(extended);
  return true;
}

bool add_best(SearchState& state, const Round& round, const Campaign& campaign) {
  if (state.found.size() >= campaign.options.max_effects) return false;
  const double least =
      least_worth(worths(state.model.model, state.families(), campaign), campaign.options);
  for (const Candidate& winner : admitted(round, state.model, campaign)) {
    if (std::ranges::count(state.left_out, winner.family) > 0) continue;
    // At the grid's shapes it is worth less than it will be.
    const Eigen::MatrixXd columns =
        campaign.library.block_of(campaign.library.columns, winner.atom);
    if (worth_of(columns, state.model.model, campaign) < least / 2) continue;
    if (add(state, winner, round, campaign)) return true;
  }
  return false;
}

// Gives a family that was taken other atoms in place of its own, where they tell it better. What
// has been given up does not come back. False where none changes.
bool choose_anew(SearchState& state, const Round& round, const Campaign& campaign) {
  for (const Found& one : state.found) {
    const std::vector<std::size_t> atoms = better_atoms(one.family, round, state.model, campaign);
    const bool is_old = std::ranges::any_of(
        atoms, [&](std::size_t atom) { return was_given_up(campaign.library.atoms[atom], state); });
    if (atoms.empty() || is_old) continue;
    LoopModel model = state.model.model.without(one.family);
    for (const std::size_t atom : atoms) model.add(campaign.library.atoms[atom]);
    FittedModel chosen = fit_in_its_noise(std::move(model), campaign, FitScope::everything);
    if (!chosen.losses.allFinite() || stands_for_another_cause(chosen.model, campaign)) continue;
    if (goes_with_shaking(chosen, one.family, campaign)) continue;
    for (const Atom& atom : state.model.model.atoms) {
      if (atom.family != one.family) continue;
      const bool stays = std::ranges::count(chosen.model.atoms, atom.label, &Atom::label) > 0;
      if (!stays) state.given_up.push_back(atom.label);
    }
    state.model = std::move(chosen);
    return true;
  }
  return false;
}

// Leaves out the effect that is worth least, where that is next to nothing beside the others and
// the rest, fitted anew, can be what it is called. False where there is none.
bool leave_out_slight(SearchState& state, const Campaign& campaign) {
  if (state.found.size() < 2) return false;
  const std::vector<double> worth = worths(state.model.model, state.families(), campaign);
  const double least = least_worth(worth, campaign.options);
  std::vector<std::size_t> order(worth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return worth[k]; });
  for (const std::size_t k : order) {
    if (worth[k] >= least) return false;
    const std::size_t family = state.found[k].family;
    FittedModel rest =
        fit_in_its_noise(state.model.model.without(family), campaign, FitScope::everything);
    if (stands_for_another_cause(rest.model, campaign)) continue;
    state.note(
        fmt::format("'{}' is worth {:.1f} % of what is left, next to nothing beside the others: "
                    "left out",
                    campaign.families[family].name, 100 * worth[k]));
    state.left_out.push_back(family);
    state.found.erase(state.found.begin() + static_cast<std::ptrdiff_t>(k));
    state.model = std::move(rest);
    return true;
  }
  return false;
}

// The rest is fitted anew.
void take_out(SearchState& state, const std::vector<std::size_t>& families,
              const Campaign& campaign) {
  LoopModel model = state.model.model;
  for (const std::size_t family : families) model = model.without(family);
  std::erase_if(state.found,
                [&](const Found& one) { return std::ranges::count(families, one.family) > 0; });
  state.model = fit_in_its_noise(std::move(model), campaign, FitScope::everything);
}

// What is not to be named takes part in the search, where others stand beside it, and goes then.
void take_out_unnamed(SearchState& state, const Campaign& campaign) {
  std::vector<std::size_t> unnamed = state.families();
  std::erase_if(unnamed, [&](std::size_t family) {
    return std::ranges::count(campaign.options.unnamed, campaign.families[family].name) == 0;
  });
  if (!unnamed.empty()) take_out(state, unnamed, campaign);
}

// The searches that begin with the base.
class Searches {
 public:
  Searches(const BaseModel& base, const Campaign& campaign, RandomStream random, KnownSearch& known)
      : campaign_(campaign), smoothers_(random.split("smoothers")), known_(known) {
    if (!known_.start) begin(base);
  }

  const SearchResult& start() const { return *known_.start; }
  // With what was taken, but for what is not to be named.
  SearchResult end_of(const SearchStart& how);
  // What is left over beside what such an end has.
  void look_for_leftover(SearchResult& end, const SearchStart& how);

 private:
  void begin(const BaseModel& base);
  const Round& round_at_base();
  SearchResult named(SearchResult end) const;

  const Campaign& campaign_;
  RandomStream smoothers_;
  KnownSearch& known_;
  std::optional<Round> round_;
};

void Searches::begin(const BaseModel& base) {
  known_.start = SearchResult();
  SearchResult& start = *known_.start;
  LoopModel model;
  model.base = base;
  model.coefficients.setZero(static_cast<Eigen::Index>(base.linear_terms.size()));
  start.base = fit_in_its_noise(std::move(model), campaign_, FitScope::everything);
  start.state.model = start.base;
  if (leaves_nothing(start.base, campaign_)) return;
  start.first = first_look(round_at_base(), start.base, campaign_);
}

const Round& Searches::round_at_base() {
  if (!round_) round_ = test_library(start().base, campaign_);
  return *round_;
}

// In and out until neither changes anything. A second column of a family is no addition.
void take_effects(SearchState& state, Round round, const Campaign& campaign) {
  while (choose_anew(state, round, campaign) || add_best(state, round, campaign) ||
         leave_out_slight(state, campaign)) {
    round = test_library(state.model, campaign);
  }
}

SearchResult Searches::end_of(const SearchStart& how) {
  auto known = known_.ends.find(how);
  if (known == known_.ends.end()) {
    SearchResult end = start();
    if (how.goes_on) {
      end = known_.ends.at({});
      take_out(end.state, how.last_resort, campaign_);
    }
    end.state.left_out = how.left_out;
    if (!how.last_resort.empty()) {
      const Campaign further = campaign_.with_last_resort(how.last_resort);
      take_effects(end.state, test_library(end.state.model, further), further);
    } else {
      take_effects(end.state, round_at_base(), campaign_);
    }
    known = known_.ends.emplace(how, std::move(end)).first;
  }
  return named(known->second);
}

void Searches::look_for_leftover(SearchResult& end, const SearchStart& how) {
  const auto key = std::pair(how, end.taken);
  const auto known = known_.leftovers.find(key);
  if (known != known_.leftovers.end()) {
    end = known->second;
    return;
  }
  end.leftover = find_leftover(end.state, campaign_, smoothers_);
  known_.leftovers.emplace(key, end);
}

SearchResult Searches::named(SearchResult out) const {
  const std::vector<std::size_t> found = out.state.families();
  out.tried.insert(found.begin(), found.end());
  take_out_unnamed(out.state, campaign_);
  out.taken = out.state.families();
  out.whole = out.state.model;
  return out;
}

// The families of a search's end that the others together can tell as well.
std::vector<std::size_t> told_by_others(const SearchResult& end, const Campaign& campaign) {
  std::vector<std::size_t> all = end.taken;
  std::erase_if(
      all, [&](std::size_t family) { return !is_told_by_others(family, end.whole, campaign); });
  return all;
}

std::size_t fitted_parameters(const LoopModel& model) {
  std::size_t count = 0;
  for (const Atom& atom : model.atoms) {
    count += atom.columns.size();
    count += static_cast<std::size_t>(std::ranges::count_if(atom.shapes, &Shape::refined));
  }
  return count;
}

// The effect that is taken first stands for what others share with it, and the right ones may find
// too little left. Where something is left over in the end, the search begins again without it:
// what then predicts better and leaves nothing over is taken. So it does where effects can tell
// each other: fewer that cannot, and predict no worse, are the simpler story.
SearchResult begin_otherwise(SearchResult one, Searches& searches, const Campaign& campaign) {
  if (one.taken.empty()) return one;
  const bool leaves_something = !one.leftover.inputs.empty();
  const std::vector<std::size_t> cancelling = told_by_others(one, campaign);
  if (!leaves_something && cancelling.empty()) return one;
  SearchStart how;
  how.left_out = leaves_something ? std::vector{one.taken.front()} : cancelling;
  SearchResult other = searches.end_of(how);
  one.tried.insert(other.tried.begin(), other.tried.end());
  const auto is_better = [&](const FittedModel& model) {
    const Gain lead = lead_over(one.whole, model, campaign);
    const bool is_simpler =
        !leaves_something && fitted_parameters(model.model) < fitted_parameters(one.whole.model);
    return lead.nats > (is_simpler ? -lead.error : 0);
  };
  // What gives way to its leftover makes it no better: most need not be asked for that.
  if (!is_better(other.whole)) return one;
  searches.look_for_leftover(other, how);
  if (!other.leftover.inputs.empty() || other.state.found.empty()) return one;
  if (!is_better(other.state.model)) return one;
  if (!leaves_something && !told_by_others(other, campaign).empty()) return one;
  other.tried = one.tried;
  return other;
}

// Whether an atom of last resort reads a signal in which something is left over, and beside what
// was found tells most of it: the true one tells all, whatever stands in for it. Gravity is a
// function of the place, and may stand for it.
bool tells_the_leftover(const Atom& atom, const SearchResult& one, const Campaign& campaign) {
  const FittedModel& model = one.state.model;
  const auto is_left = [&](const std::string& signal) {
    return std::ranges::count(one.leftover.signals, signal) > 0;
  };
  LoopModel alone;
  alone.add(atom);
  const auto read = signals_read(alone, atom.family, campaign.data);
  const bool reads_it = std::ranges::any_of(read, [&](const Signal* signal) {
    return is_left(signal->name) || (signal->name == "q" && is_left("g"));
  });
  if (!reads_it) return false;
  const Eigen::MatrixXd z =
      whitened(evaluate_columns(atom.columns, campaign.data), campaign.clusters, model.noise);
  const Gain gain = paired_gain(model.losses, losses_beside(model, z, campaign));
  return gain.nats > gain.error && gain.nats > kMostOfIt * one.leftover.gain;
}

// With the families of which an atom of last resort tells what is left over. Atoms that stand
// beside others of their family have had nothing but that family stand in for them: the search goes
// on with those where no other tells it.
SearchStart with_last_resorts(const SearchResult& one, const Campaign& campaign) {
  const std::vector<double> ratios = gear_ratios_for(campaign.data, campaign.options.gear_ratios);
  const std::vector<std::size_t> found = one.state.families();
  SearchStart alone;
  SearchStart beside_found = {.left_out = {}, .last_resort = {}, .goes_on = true};
  for (std::size_t f = 0; f < campaign.families.size(); ++f) {
    if (std::ranges::none_of(campaign.families[f].atoms, &AtomTemplate::last_resort)) continue;
    std::vector<std::string> missing;
    const std::vector<Atom> atoms =
        instantiate(campaign.families[f], f, campaign.data, ratios, missing);
    const auto tells = [&](bool beside_another) {
      return std::ranges::any_of(atoms, [&](const Atom& atom) {
        return atom.last_resort && atom.beside_another == beside_another &&
               tells_the_leftover(atom, one, campaign);
      });
    };
    if (tells(false)) {
      alone.last_resort.push_back(f);
    } else if (std::ranges::count(found, f) > 0 && tells(true)) {
      beside_found.last_resort.push_back(f);
    }
  }
  return alone.last_resort.empty() ? beside_found : alone;
}

// Rare effects are looked for where one of them tells what the usual ones leave over, from the
// start: what stood in for them leaves them too little. What then predicts better and leaves
// something over in fewer inputs is taken, but for a torque that the usual ones tell as well: load
// friction whose curve is not quite the library's is no rare effect.
SearchResult go_further(SearchResult one, Searches& searches, const Campaign& campaign) {
  if (!campaign.options.has("last_resort")) return one;
  if (one.leftover.inputs.empty()) return one;
  const SearchStart how = with_last_resorts(one, campaign);
  if (how.last_resort.empty()) return one;
  SearchResult other = searches.end_of(how);
  one.tried.insert(other.tried.begin(), other.tried.end());
  const LoopModel& model = other.state.model.model;
  const bool is_other = std::ranges::any_of(model.atoms, [&](const Atom& atom) {
    return atom.last_resort &&
           !is_told_by_another_name(atom.family, model, one.state.model, campaign);
  });
  if (!is_other) return one;
  searches.look_for_leftover(other, how);
  const std::vector<std::string>& inputs = other.leftover.inputs;
  const bool leaves_less = inputs.size() < one.leftover.inputs.size() &&
                           std::ranges::all_of(inputs, [&](const std::string& input) {
                             return std::ranges::count(one.leftover.inputs, input) > 0;
                           });
  if (!leaves_less || !(lead_over(one.state.model, other.state.model, campaign).nats > 0)) {
    return one;
  }
  other.tried = one.tried;
  return other;
}

}  // namespace

SearchResult search(const BaseModel& base, const Campaign& campaign, RandomStream random,
                    KnownSearch& known) {
  Searches searches(base, campaign, random, known);
  if (leaves_nothing(searches.start().base, campaign)) {
    SearchResult out = searches.start();
    out.state.note("the base model leaves no residual");
    out.first.untestable = campaign.library.missing;
    out.leftover.tested = true;
    return out;
  }
  SearchResult out = searches.end_of({});
  searches.look_for_leftover(out, {});
  out = begin_otherwise(std::move(out), searches, campaign);
  out = go_further(std::move(out), searches, campaign);
  // As they stand beside each other, whatever way the search has come.
  for (Found& one : out.state.found) {
    one.gain = gain_of({one.family}, out.state.model, campaign);
  }
  // What its gain has rescued was testable after all.
  for (const Found& one : out.state.found) {
    std::erase_if(out.first.untestable, [&](const UntestableFinding& finding) {
      return finding.family == campaign.families[one.family].name;
    });
  }
  return out;
}

}  // namespace tribench::loop
