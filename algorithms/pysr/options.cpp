// SPDX-License-Identifier: MIT
#include "algorithms/pysr/options.hpp"

namespace tribench::pysr {

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

}  // namespace tribench::pysr
