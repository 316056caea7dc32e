// SPDX-License-Identifier: MIT
//
// The parameters of `pysr`, each once: what a grid may say, and what it sets.
#include <fmt/format.h>

#include <functional>
#include <optional>
#include <utility>

#include "algorithms/pysr/options.hpp"
#include "algorithms/pysr/text_pieces.hpp"
#include "algorithms/pysr/units.hpp"
#include "foundation/error.hpp"
#include "foundation/number_text.hpp"

namespace tribench::pysr {
namespace {

// Left to the profile: as a text, and as the number -1.
constexpr const char* kProfile = "profile";

struct Setting {
  ParameterSpec spec;
  std::function<void(const Parameters&, Options&)> apply;
};

// A parameter that a profile gives a value of its own unless the grid does.
ParameterSpec of_profile(const std::string& name, const std::string& summary, ParameterValue left,
                         double low, double high) {
  return {name, summary + "; -1: as the profile has it", std::move(left), low, high, {}, -1};
}

Setting whole(const std::string& name, int Options::*option, const std::string& summary, double low,
              double high) {
  return {of_profile(name, summary, std::int64_t{-1}, low, high),
          [name, option](const Parameters& given, Options& options) {
            const std::int64_t value = given.integer(name);
            if (value >= 0) options.*option = static_cast<int>(value);
          }};
}

Setting number(const std::string& name, double Options::*option, const std::string& summary,
               double high) {
  return {of_profile(name, summary, -1.0, 0, high),
          [name, option](const Parameters& given, Options& options) {
            const double value = given.number(name);
            if (value >= 0) options.*option = value;
          }};
}

Setting share(const std::string& name, double Options::*option, const std::string& summary) {
  return number(name, option, summary, 1);
}

Setting text(std::string name, std::string Options::*option, std::string summary) {
  return {{name, std::move(summary), std::string()},
          [name, option](const Parameters& given, Options& options) {
            options.*option = given.text(name);
          }};
}

// Off in every profile.
Setting flag(std::string name, bool Options::*option, std::string summary) {
  return {{name, std::move(summary), false},
          [name, option](const Parameters& given, Options& options) {
            options.*option = given.flag(name);
          }};
}

template <typename Value>
using Named = std::vector<std::pair<std::string, Value>>;

// `otherwise` leaves the option as it is, or is one of the values.
template <typename Value>
Setting choice(const std::string& name, Value Options::*option, std::string summary,
               const std::string& otherwise, Named<Value> values) {
  ParameterSpec spec{name, std::move(summary), otherwise, 0, 0, {}};
  if (otherwise == kProfile) spec.choices.push_back(otherwise);
  for (const auto& [word, value] : values) spec.choices.push_back(word);
  return {std::move(spec),
          [name, option, values = std::move(values)](const Parameters& given, Options& options) {
            for (const auto& [word, value] : values) {
              if (word == given.text(name)) options.*option = value;
            }
          }};
}

Setting on_off(const std::string& name, bool Options::*option, std::string summary) {
  return choice<bool>(name, option, std::move(summary), kProfile, {{"on", true}, {"off", false}});
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
    const std::optional<double> weight = read_number<double>(number);
    if (kind == kMutationKinds || !weight || *weight < 0) refuse(piece);
    weights[kind] = *weight;
  }
}

Setting weights() {
  constexpr const char* kName = "mutation_weights";
  return {{kName, "weights that differ from the profile's, as in 'backsolve=0.1; grow=4'",
           std::string()},
          [](const Parameters& given, Options& options) {
            read_weights(given.text(kName), options.weights);
          }};
}

// As deep as it is large, unless something else is said.
Setting depth() {
  Setting setting = whole("max_depth", &Options::max_depth, "deepest nesting", 1, 500);
  setting.apply = [set = std::move(setting.apply)](const Parameters& given, Options& options) {
    options.max_depth = options.max_size;
    set(given, options);
  };
  return setting;
}

// Of the whole search: defaults, epochs, islands, sizes.
std::vector<Setting> size_settings() {
  using O = Options;
  return {
      choice<Profile>("profile", &O::profile, "defaults: native (ours), v1 or v2 (the original's)",
                      "native",
                      {{"native", Profile::native}, {"v1", Profile::v1}, {"v2", Profile::v2}}),
      whole("iterations", &O::iterations, "epochs", 1, 1e6),
      whole("populations", &O::populations, "islands", 1, 1000),
      whole("population_size", &O::population_size, "members of an island", 1, 10'000),
      whole("cycles", &O::cycles, "tournament rounds of an island in an epoch", 1, 1e6),
      whole("patience", &O::patience, "epochs without headway before it stops; 0: never", 0, 1e6),
      whole("max_size", &O::max_size, "largest number of nodes", 1, 500),
      depth(),
      share("warm_up", &O::warm_up, "share of the epochs over which max_size grows from 3"),
      whole("initial_operators", &O::initial_operators, "operators of a random first member", 0,
            100),
  };
}

// Who becomes a parent, and what a child is made of.
std::vector<Setting> tournament_settings() {
  using O = Options;
  return {
      whole("tournament_size", &O::tournament_size, "members in a tournament", 1, 10'000),
      share("tournament_probability", &O::tournament_probability,
            "chance that a tournament's best wins"),
      number("parsimony", &O::parsimony, "cost of a node", 1e6),
      number("adaptive_parsimony", &O::adaptive_parsimony,
             "how hard frequent sizes are held down in tournaments", 1e6),
      on_off("use_frequency", &O::use_frequency, "accept children of frequent sizes less often"),
      on_off("use_frequency_in_tournament", &O::use_frequency_in_tournament,
             "hold frequent sizes down in tournaments"),
      share("crossover_probability", &O::crossover_probability, "share of crossovers"),
      weights(),
      flag("mutation_burst", &O::mutation_burst,
           "try a refused mutation up to four times more, and change some twice"),
      on_off("skip_failures", &O::skip_failures,
             "leave the population as it is where no child is accepted"),
      on_off("adaptive_weights", &O::adaptive_weights,
             "draw mutations more often that have succeeded more often"),
      on_off("annealing", &O::annealing, "accept worse children by temperature"),
      number("alpha", &O::alpha, "scale of the temperature", 1e6),
      number("perturbation_factor", &O::perturbation_factor,
             "how far a mutated constant moves while it is hot", 1e3),
      share("negate_probability", &O::negate_probability,
            "chance that a mutated constant changes its sign"),
      flag("compat", &O::compat,
           "flip the sign of a mutated constant as often as the original does"),
  };
}

// What islands hand on to each other.
std::vector<Setting> migration_settings() {
  using O = Options;
  return {
      share("replaced_by_peers", &O::replaced_by_peers,
            "share of members replaced from other islands in an epoch"),
      share("replaced_by_front", &O::replaced_by_front,
            "share of members replaced from the hall of fame in an epoch"),
      share("replaced_by_guesses", &O::replaced_by_guesses,
            "share of members replaced from the guesses in an epoch"),
      whole("top_n", &O::top_n, "best members of an island that others may take over", 0, 10'000),
  };
}

// How constants are fitted, and which rows and inputs the search sees.
std::vector<Setting> row_settings() {
  using O = Options;
  return {
      share("optimize_probability", &O::optimize_probability,
            "chance that a member's constants are fitted after an epoch"),
      whole("optimize_iterations", &O::optimize_iterations, "steps of such a fit", 0, 10'000),
      whole("optimize_restarts", &O::optimize_restarts, "further starts of such a fit", 0, 1000),
      choice<Batching>(
          "batching", &O::batching, "score children on a random batch of rows", kProfile,
          {{"off", Batching::off}, {"on", Batching::on}, {"auto", Batching::automatic}}),
      whole("batch_size", &O::batch_size, "rows of a batch; 0: by the number of rows", 0, 1e6),
      whole("search_rows", &O::search_rows, "rows of a fixed sample that the search sees; 0: all",
            0, 1e7),
      whole("select_features", &O::select_features,
            "inputs that the search sees, those that matter most to a random forest; 0: all", 0,
            1000),
      flag("denoise", &O::denoise,
           "let the search see the target smoothed by a Gaussian process; polish, choice and "
           "errors are of the measured rows"),
  };
}

// What a formula may look like.
std::vector<Setting> form_settings() {
  using O = Options;
  return {
      text("template", &O::form,
           "outer form of every formula, as in 'sgn_v*f(abs(v)) + g(load)': f and g are searched "
           "for, p() is a number to be fitted"),
      text("part_sizes", &O::part_sizes,
           "largest size of a part of the template, as in 'f=9; g=15'"),
      text("argument_limits", &O::argument_limits,
           "largest size of an operator's arguments, as in '^:-1,3; exp:9'"),
      text("nested_limits", &O::nested_limits,
           "how often an operator may stand below another, as in 'exp>exp=0'"),
      text("operator_sizes", &O::operator_sizes,
           "what an operator counts in the size, as in 'exp=2; ^=3'"),
      number("constant_size", &O::constant_size, "what a constant counts in the size", 100),
      number("variable_size", &O::variable_size, "what a variable counts in the size", 100),
      choice<Units>("units", &O::units,
                    "dimensional analysis: off, soft (a penalty) or hard (refused)", "off",
                    {{"off", Units::off}, {"soft", Units::soft}, {"hard", Units::hard}}),
      text("target_unit", &O::target_unit, "unit of the target, as in 'N m'; empty: any"),
      number("unit_penalty", &O::unit_penalty, "added to the loss of inconsistent units", 1e12),
  };
}

// Where it starts from, what it does beyond the original, and how it chooses.
std::vector<Setting> finish_settings() {
  using O = Options;
  return {
      text("guesses", &O::guesses, "formulas to start from, separated by ';'"),
      choice<Selection>("selection", &O::selection,
                        "choice from the front; profile: posterior for native, best for v1 and v2",
                        kProfile,
                        {{"posterior", Selection::posterior},
                         {"evidence", Selection::evidence},
                         {"mdl", Selection::mdl},
                         {"best", Selection::best},
                         {"accuracy", Selection::accuracy},
                         {"score", Selection::score}}),
      on_off("fit_children", &O::fit_children, "fit the constants of every child"),
      on_off("novelty", &O::novelty, "fit no structure twice on an island"),
      on_off("linear_scaling", &O::linear_scaling, "give a child the scale and offset it lacks"),
      whole("constructions", &O::constructions, "greedy starts of an island; 0: random members", 0,
            10'000),
      whole("climbs", &O::climbs, "of them, those brought to where no exchange helps", 0, 10'000),
      on_off("evidence_cost", &O::evidence_cost, "charge constants and nodes as the evidence does"),
      flag("safe", &O::safe,
           "only formulas proved free of singularities on the input box enter the front"),
      on_off("refine", &O::refine, "grow and prune the front by description length at the end"),
  };
}

// In the order in which they are applied: a profile first, the depth after the size.
std::vector<Setting> make_settings() {
  std::vector<Setting> all;
  for (const auto group : {size_settings, tournament_settings, migration_settings, row_settings,
                           form_settings, finish_settings}) {
    for (Setting& setting : group()) all.push_back(std::move(setting));
  }
  return all;
}

const std::vector<Setting>& settings() {
  static const std::vector<Setting> kSettings = make_settings();
  return kSettings;
}

}  // namespace

std::vector<ParameterSpec> parameter_specs() {
  std::vector<ParameterSpec> specs;
  for (const Setting& setting : settings()) specs.push_back(setting.spec);
  return specs;
}

Options options_from(const Parameters& parameters) {
  Options options;
  settings().front().apply(parameters, options);
  options = profile_options(options.profile);
  for (const Setting& setting : settings()) setting.apply(parameters, options);
  parse_unit(options.target_unit);  // throws, whether it is looked at or not
  if (!options.form.empty() && options.select_features > 0) {
    throw_bad_input("a template says itself which inputs its parts see", "select_features",
                    "leave out select_features or the template");
  }
  return options;
}

}  // namespace tribench::pysr
