// SPDX-License-Identifier: MIT
//
// Everything that can be set in `pysr`: the three profiles of defaults and the parameters that
// override them (parameters.cpp).
//
// `v1` and `v2` are the defaults of PySR 1.x and 2.x (Cranmer 2023; PySR 2.0.0 beta,
// pysr/sr.py and src/Options.jl); `native` is ours. A parameter left at -1 or "profile" takes the
// profile's value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/regressor.hpp"

namespace tribench::pysr {

enum class Profile { native, v1, v2 };
enum class Selection { posterior, evidence, mdl, best, accuracy, score };
enum class Batching { off, on, automatic };
enum class Units { off, soft, hard };

// In the order of the published table of weights; ours are the last two.
enum class MutationKind : std::uint8_t {
  rotate_tree,
  add_node,
  delete_node,
  mutate_operator,
  do_nothing,
  swap_operands,
  mutate_feature,
  mutate_constant,
  insert_node,
  simplify,
  randomize,
  optimize,
  backsolve,
  grow,   // the best of many terms, by its projection on the residual
  prune,  // the constant whose loss costs least is removed
};
inline constexpr std::size_t kMutationKinds = 15;
using MutationWeights = std::array<double, kMutationKinds>;

constexpr std::size_t index_of(MutationKind kind) { return static_cast<std::size_t>(kind); }

// "rotate_tree", "add_node", ...
std::string_view mutation_name(MutationKind kind);

// The published weights; 0 for ours. v1 has no mutate_feature.
MutationWeights published_weights(Profile profile);

struct Options {
  Profile profile = Profile::native;

  // Effort.
  int iterations = 100;      // epochs: each island runs `cycles` of them between migrations
  int populations = 31;      // islands
  int population_size = 27;  // members of an island
  int cycles = 380;  // per epoch; one cycle is ceil(population_size / tournament_size) events
  int patience = 0;  // epochs without a better description length before it stops; 0: never

  // Size.
  int max_size = 30;
  int max_depth = 30;
  double warm_up = 0;         // share of the epochs over which max_size grows from 3
  int initial_operators = 3;  // operators appended to a constant to make a first member

  // Selection pressure.
  int tournament_size = 15;
  double tournament_probability = 0.982;
  double parsimony = 0;
  double adaptive_parsimony = 1040;
  bool use_frequency = true;
  bool use_frequency_in_tournament = true;
  double frequency_window = 100'000;

  // Variation.
  MutationWeights weights{};
  double crossover_probability = 0.2;
  bool annealing = true;
  double alpha = 3.17;
  double perturbation_factor = 0.129;
  double negate_probability = 0.00743;
  bool compat = false;  // the sign flip as the original has it: with probability 1 - 0.00743
  int attempts = 10;
  bool skip_failures = true;
  bool adaptive_weights = false;
  // PySR 2's bursts, off there too: a mutation that is not accepted is tried again, and a child may
  // be changed twice.
  bool mutation_burst = false;

  // Migration.
  double replaced_by_peers = 0.00036;
  double replaced_by_front = 0.0614;
  double replaced_by_guesses = 0.001;
  int top_n = 12;

  // Constants.
  double optimize_probability = 0.14;
  int optimize_iterations = 8;
  int optimize_restarts = 2;

  // Data.
  Batching batching = Batching::automatic;
  int batch_size = 0;       // 0: 128 below 5 000 rows, 256 below 50 000, 512 above
  int search_rows = 0;      // a fixed sample that the search sees; 0: all
  int select_features = 0;  // inputs that the search sees, the most important; 0: all
  bool denoise = false;     // the search sees a smoothed target; the polish sees the measured one

  // The outer form, empty for none; see form.hpp.
  std::string form;
  std::string part_sizes;

  // Constraints, as texts; see constraints.hpp.
  std::string argument_limits;
  std::string nested_limits;
  std::string operator_sizes;
  double constant_size = 1;
  double variable_size = 1;
  Units units = Units::off;
  std::string target_unit;
  double unit_penalty = 1000;

  // Start and choice.
  std::string guesses;  // formulas, separated by ';'
  Selection selection = Selection::posterior;

  // Ours.
  bool fit_children = true;    // every child's constants are fitted before it is judged
  bool novelty = true;         // no structure is fitted twice on an island
  bool linear_scaling = true;  // a + b f where that is what a child lacks
  int constructions = 40;      // an island's greedy starts, instead of random members
  int climbs = 6;              // of them, the best, brought to where no exchange helps
  bool evidence_cost = true;   // a cost charges constants and nodes as the evidence does
  bool safe = false;           // only formulas proved free of singularities enter the front
  bool refine = true;          // the front is grown and pruned by description length at the end
};

std::vector<ParameterSpec> parameter_specs();
// The profile's defaults with what the grid gave. Throws Error (bad_input) as Parameters does.
Options options_from(const Parameters& parameters);
// The defaults of a profile.
Options profile_options(Profile profile);

}  // namespace tribench::pysr
