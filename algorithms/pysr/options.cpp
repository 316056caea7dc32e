// SPDX-License-Identifier: MIT
#include "algorithms/pysr/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "algorithms/pysr/text_pieces.hpp"
#include "foundation/error.hpp"

namespace tribench::pysr {
namespace {

// A parameter that is left to the profile.
constexpr double kProfile = -1;

Profile profile_of(const std::string& name) {
  if (name == "v1") return Profile::v1;
  return name == "v2" ? Profile::v2 : Profile::native;
}

Selection selection_of(const std::string& name) {
  if (name == "best") return Selection::best;
  if (name == "accuracy") return Selection::accuracy;
  if (name == "mdl") return Selection::mdl;
  if (name == "evidence") return Selection::evidence;
  return name == "score" ? Selection::score : Selection::posterior;
}

Batching batching_of(const std::string& name, Batching otherwise) {
  if (name == "off") return Batching::off;
  if (name == "on") return Batching::on;
  return name == "auto" ? Batching::automatic : otherwise;
}

Units units_of(const std::string& name) {
  if (name == "soft") return Units::soft;
  return name == "hard" ? Units::hard : Units::off;
}

bool switch_of(const std::string& name, bool otherwise) {
  return name == "profile" ? otherwise : name == "on";
}

// Reads "rotate_tree=4; backsolve=0.1" over the weights there are.
void read_weights(std::string_view text, MutationWeights& weights) {
  const auto refuse = [](std::string_view piece) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < kMutationKinds; ++k) {
      names.emplace_back(mutation_name(static_cast<MutationKind>(k)));
    }
    throw_bad_input(
        fmt::format("'{}' is no weight of a mutation", piece), "mutation_weights",
        fmt::format("write it as in \"backsolve=0.1\" with one of {}", fmt::join(names, " ")));
  };
  for (const std::string_view piece : split(text, ';')) {
    const std::size_t at = piece.find('=');
    if (at == std::string_view::npos) refuse(piece);
    std::size_t kind = 0;
    while (kind < kMutationKinds &&
           mutation_name(static_cast<MutationKind>(kind)) != trimmed(piece.substr(0, at))) {
      ++kind;
    }
    const std::string_view number = trimmed(piece.substr(at + 1));
    double weight = -1;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), weight);
    if (kind == kMutationKinds || read.ec != std::errc() ||
        read.ptr != number.data() + number.size() || !(weight >= 0) || !std::isfinite(weight)) {
      refuse(piece);
    }
    weights[kind] = weight;
  }
}

void set(int& value, const Parameters& parameters, std::string_view name) {
  if (parameters.integer(name) >= 0) value = static_cast<int>(parameters.integer(name));
}

void set(double& value, const Parameters& parameters, std::string_view name) {
  if (parameters.number(name) >= 0) value = parameters.number(name);
}

void set(bool& value, const Parameters& parameters, std::string_view name) {
  value = switch_of(parameters.text(name), value);
}

ParameterSpec whole(std::string name, std::string summary, double high) {
  return {std::move(name), summary + "; -1: as the profile has it", std::int64_t{-1}, -1, high};
}
ParameterSpec share(std::string name, std::string summary, double high = 1) {
  return {std::move(name), summary + "; -1: as the profile has it", kProfile, -1, high};
}
ParameterSpec on_off(std::string name, std::string summary) {
  return {std::move(name),         std::move(summary), std::string("profile"), 0, 0,
          {"profile", "on", "off"}};
}

}  // namespace

std::string_view mutation_name(MutationKind kind) {
  static constexpr std::string_view kNames[kMutationKinds] = {
      "rotate_tree", "add_node",      "delete_node",    "mutate_operator",
      "do_nothing",  "swap_operands", "mutate_feature", "mutate_constant",
      "insert_node", "simplify",      "randomize",      "optimize",
      "backsolve",   "grow",          "prune"};
  return kNames[index_of(kind)];
}

MutationWeights published_weights(Profile profile) {
  using enum MutationKind;
  MutationWeights weights{};
  const auto set_weight = [&](MutationKind kind, double weight) {
    weights[index_of(kind)] = weight;
  };
  set_weight(rotate_tree, 4.26);
  set_weight(add_node, 2.47);
  set_weight(delete_node, 0.870);
  set_weight(mutate_operator, 0.293);
  set_weight(do_nothing, 0.273);
  set_weight(swap_operands, 0.198);
  set_weight(mutate_feature, profile == Profile::v1 ? 0 : 0.1);
  set_weight(mutate_constant, 0.0346);
  set_weight(insert_node, 0.0112);
  set_weight(simplify, 0.00209);
  set_weight(randomize, 0.000502);
  return weights;
}

Options profile_options(Profile profile) {
  Options options;
  options.profile = profile;
  options.weights = published_weights(profile);
  if (profile != Profile::native) {
    options.selection = Selection::best;
    options.fit_children = options.novelty = options.linear_scaling = options.refine =
        options.evidence_cost = false;
    options.constructions = options.climbs = 0;
    if (profile == Profile::v1) {
      options.crossover_probability = 0.0259;
      options.annealing = false;
      options.batching = Batching::off;
    } else {
      options.adaptive_weights = true;
    }
    return options;
  }
  using enum MutationKind;
  options.iterations = 40;
  options.populations = 4;
  options.cycles = 20;
  options.patience = 2;
  options.max_size = 40;
  options.adaptive_parsimony = 20;
  options.replaced_by_peers = 0.02;
  options.replaced_by_front = 0.15;
  options.batching = Batching::off;
  options.search_rows = 400;
  options.optimize_probability = 0;
  const auto set_weight = [&](MutationKind kind, double weight) {
    options.weights[index_of(kind)] = weight;
  };
  set_weight(grow, 8);
  set_weight(prune, 2);
  set_weight(do_nothing, 0);
  set_weight(mutate_constant, 0.1);
  set_weight(rotate_tree, 1.5);
  set_weight(swap_operands, 0);
  set_weight(randomize, 0.05);
  return options;
}

std::vector<ParameterSpec> parameter_specs() {
  return {
      {"profile",
       "defaults: native (ours), v1 or v2 (the original's)",
       std::string("native"),
       0,
       0,
       {"native", "v1", "v2"}},
      whole("iterations", "epochs", 1e6),
      whole("populations", "islands", 1000),
      whole("population_size", "members of an island", 10'000),
      whole("cycles", "tournament rounds of an island in an epoch", 1e6),
      whole("patience", "epochs without headway before it stops; 0: never", 1e6),
      whole("max_size", "largest number of nodes", 500),
      whole("max_depth", "deepest nesting", 500),
      share("warm_up", "share of the epochs over which max_size grows from 3"),
      whole("tournament_size", "members in a tournament", 10'000),
      share("tournament_probability", "chance that a tournament's best wins"),
      share("parsimony", "cost of a node", 1e6),
      share("adaptive_parsimony", "how hard frequent sizes are held down in tournaments", 1e6),
      share("crossover_probability", "share of crossovers"),
      {"mutation_weights", "weights that differ from the profile's, as in 'backsolve=0.1; grow=4'",
       std::string()},
      {"mutation_burst", "try a refused mutation up to four times more, and change some twice",
       false},
      on_off("annealing", "accept worse children by temperature"),
      {"compat", "flip the sign of a mutated constant as often as the original does", false},
      share("replaced_by_peers", "share of members replaced from other islands in an epoch"),
      share("replaced_by_front", "share of members replaced from the hall of fame in an epoch"),
      share("replaced_by_guesses", "share of members replaced from the guesses in an epoch"),
      share("optimize_probability", "chance that a member's constants are fitted after an epoch"),
      {"batching",
       "score children on a random batch of rows",
       std::string("profile"),
       0,
       0,
       {"profile", "off", "on", "auto"}},
      whole("batch_size", "rows of a batch; 0: by the number of rows", 1e6),
      whole("search_rows", "rows of a fixed sample that the search sees; 0: all", 1e7),
      {"select_features",
       "inputs that the search sees, those that matter most to a random forest; 0: all",
       std::int64_t{0}, 0, 1000},
      {"denoise",
       "let the search see the target smoothed by a Gaussian process; polish, choice and errors "
       "are "
       "of the measured rows",
       false},
      {"template",
       "outer form of every formula, as in 'sgn_v*f(abs(v)) + g(load)': f and g are searched for, "
       "p() "
       "is a number to be fitted",
       std::string()},
      {"part_sizes", "largest size of a part of the template, as in 'f=9; g=15'", std::string()},
      {"argument_limits", "largest size of an operator's arguments, as in '^:-1,3; exp:9'",
       std::string()},
      {"nested_limits", "how often an operator may stand below another, as in 'exp>exp=0'",
       std::string()},
      {"operator_sizes", "what an operator counts in the size, as in 'exp=2; ^=3'", std::string()},
      share("constant_size", "what a constant counts in the size", 100),
      share("variable_size", "what a variable counts in the size", 100),
      {"units",
       "dimensional analysis: off, soft (a penalty) or hard (refused)",
       std::string("off"),
       0,
       0,
       {"off", "soft", "hard"}},
      {"target_unit", "unit of the target, as in 'N m'; empty: any", std::string()},
      share("unit_penalty", "added to the loss of inconsistent units", 1e12),
      {"guesses", "formulas to start from, separated by ';'", std::string()},
      {"selection",
       "choice from the front; profile: posterior for native, best for v1 and v2",
       std::string("profile"),
       0,
       0,
       {"profile", "posterior", "evidence", "mdl", "best", "accuracy", "score"}},
      on_off("fit_children", "fit the constants of every child"),
      on_off("novelty", "fit no structure twice on an island"),
      on_off("linear_scaling", "give a child the scale and offset it lacks"),
      whole("constructions", "greedy starts of an island; 0: random members", 10'000),
      whole("climbs", "of them, those brought to where no exchange helps", 10'000),
      on_off("evidence_cost", "charge constants and nodes as the evidence does"),
      {"safe", "only formulas proved free of singularities on the input box enter the front",
       false},
      on_off("refine", "grow and prune the front by description length at the end"),
  };
}

Options options_from(const Parameters& parameters) {
  Options options = profile_options(profile_of(parameters.text("profile")));
  set(options.iterations, parameters, "iterations");
  set(options.populations, parameters, "populations");
  set(options.population_size, parameters, "population_size");
  set(options.cycles, parameters, "cycles");
  set(options.patience, parameters, "patience");
  set(options.max_size, parameters, "max_size");
  options.max_depth = options.max_size;
  set(options.max_depth, parameters, "max_depth");
  set(options.warm_up, parameters, "warm_up");
  set(options.tournament_size, parameters, "tournament_size");
  set(options.tournament_probability, parameters, "tournament_probability");
  set(options.parsimony, parameters, "parsimony");
  set(options.adaptive_parsimony, parameters, "adaptive_parsimony");
  set(options.crossover_probability, parameters, "crossover_probability");
  read_weights(parameters.text("mutation_weights"), options.weights);
  options.mutation_burst = parameters.flag("mutation_burst");
  set(options.annealing, parameters, "annealing");
  options.compat = parameters.flag("compat");
  set(options.replaced_by_peers, parameters, "replaced_by_peers");
  set(options.replaced_by_front, parameters, "replaced_by_front");
  set(options.replaced_by_guesses, parameters, "replaced_by_guesses");
  set(options.optimize_probability, parameters, "optimize_probability");
  options.batching = batching_of(parameters.text("batching"), options.batching);
  set(options.batch_size, parameters, "batch_size");
  set(options.search_rows, parameters, "search_rows");
  options.select_features = static_cast<int>(parameters.integer("select_features"));
  options.denoise = parameters.flag("denoise");
  options.form = parameters.text("template");
  options.part_sizes = parameters.text("part_sizes");
  if (!options.form.empty() && options.select_features > 0) {
    throw_bad_input("a template says itself which inputs its parts see", "select_features",
                    "leave out select_features or the template");
  }
  options.argument_limits = parameters.text("argument_limits");
  options.nested_limits = parameters.text("nested_limits");
  options.operator_sizes = parameters.text("operator_sizes");
  set(options.constant_size, parameters, "constant_size");
  set(options.variable_size, parameters, "variable_size");
  options.units = units_of(parameters.text("units"));
  options.target_unit = parameters.text("target_unit");
  set(options.unit_penalty, parameters, "unit_penalty");
  options.guesses = parameters.text("guesses");
  if (parameters.text("selection") != "profile") {
    options.selection = selection_of(parameters.text("selection"));
  }
  set(options.fit_children, parameters, "fit_children");
  set(options.novelty, parameters, "novelty");
  set(options.linear_scaling, parameters, "linear_scaling");
  set(options.constructions, parameters, "constructions");
  set(options.climbs, parameters, "climbs");
  set(options.evidence_cost, parameters, "evidence_cost");
  options.safe = parameters.flag("safe");
  set(options.refine, parameters, "refine");
  return options;
}

}  // namespace tribench::pysr
