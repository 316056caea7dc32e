// SPDX-License-Identifier: MIT
#include "algorithms/pysr/mutation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/pysr/tape_edit.hpp"
#include "foundation/elementary.hpp"

namespace tribench::pysr {
namespace {

using Place = std::optional<std::size_t>;
using Child = std::optional<Expression>;

template <typename Predicate>
Place random_place(const Expression& formula, RandomStream& random, Predicate predicate) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (!is_exponent(formula, i) && predicate(i)) places.push_back(i);
  }
  if (places.empty()) return std::nullopt;
  return places[random.below(places.size())];
}

Place random_node(const Expression& formula, RandomStream& random) {
  return random_place(formula, random, [](std::size_t) { return true; });
}

Place random_internal(const Expression& formula, RandomStream& random) {
  return random_place(formula, random,
                      [&](std::size_t i) { return arity(formula.node(i).op) > 0; });
}

bool is_whole_power(const Expression& formula, std::size_t i) {
  return formula.node(i).op == Op::pow && formula.node(i - 1).is_constant();
}

Child mutate_constant(const Expression& parent, const MutationSettings& settings,
                      RandomStream& random) {
  const Place place =
      random_place(parent, random, [&](std::size_t i) { return parent.node(i).is_constant(); });
  if (!place) return std::nullopt;
  Expression child = parent;
  set_constant(child, *place, parent.node(*place).value * constant_factor(settings, random));
  return child;
}

Child mutate_operator(const Expression& parent, const Alphabet& alphabet, RandomStream& random) {
  const Place place = random_internal(parent, random);
  if (!place) return std::nullopt;
  std::vector<Op> same_arity;
  for (const Op op : alphabet.operators.operators()) {
    if (arity(op) == arity(parent.node(*place).op)) same_arity.push_back(op);
  }
  if (same_arity.empty()) return std::nullopt;
  const Op op = same_arity[random.below(same_arity.size())];
  const Children children = children_of(parent, *place);
  if (children.count == 1) {
    return with_replaced(parent, *place, join(op, subtree_nodes(parent, children.place[0])));
  }
  return with_replaced(
      parent, *place,
      join(op, subtree_nodes(parent, children.place[0]), subtree_nodes(parent, children.place[1])));
}

Child mutate_feature(const Expression& parent, const Alphabet& alphabet, RandomStream& random) {
  const Place place =
      random_place(parent, random, [&](std::size_t i) { return parent.node(i).is_variable(); });
  if (!place || alphabet.inputs < 2) return std::nullopt;
  const std::size_t shift = 1 + random.below(alphabet.inputs - 1);
  const Node leaf = Node::input((parent.node(*place).variable + shift) % alphabet.inputs);
  return with_replaced(parent, *place, {&leaf, 1});
}

Child swap_operands(const Expression& parent, RandomStream& random) {
  const Place place = random_place(parent, random, [&](std::size_t i) {
    return arity(parent.node(i).op) == 2 && !is_whole_power(parent, i);
  });
  if (!place) return std::nullopt;
  return with_swapped_children(parent, *place);
}

Child rotate_tree(const Expression& parent, RandomStream& random) {
  const auto is_internal = [&](std::size_t i) { return arity(parent.node(i).op) > 0; };
  const Place node = random_place(parent, random, [&](std::size_t i) {
    const Children children = children_of(parent, i);
    return std::any_of(children.place, children.place + children.count, is_internal);
  });
  if (!node) return std::nullopt;
  const Children children = children_of(parent, *node);
  std::size_t pivots[2];
  std::size_t count = 0;
  for (std::size_t k = 0; k < children.count; ++k) {
    if (is_internal(children.place[k])) pivots[count++] = children.place[k];
  }
  const std::size_t pivot = pivots[random.below(count)];
  const Children grandchildren = children_of(parent, pivot);
  return with_rotation(parent, *node, pivot,
                       grandchildren.place[random.below(grandchildren.count)]);
}

// op over the subtree that ends at `place`, in a random slot, and random leaves.
Child put_operator_above(const Expression& parent, std::size_t place, const Alphabet& alphabet,
                         RandomStream& random) {
  const Op op = random_operator(alphabet, random);
  const std::span<const Node> below = subtree_nodes(parent, place);
  if (arity(op) == 1) return with_replaced(parent, place, join(op, below));
  const Node leaf = random_leaf(alphabet, random);
  const bool left = random.chance(0.5);
  return with_replaced(parent, place,
                       left ? join(op, below, {&leaf, 1}) : join(op, {&leaf, 1}, below));
}

Child insert_node(const Expression& parent, const Alphabet& alphabet, RandomStream& random) {
  const Place place = random_node(parent, random);
  if (!place) return std::nullopt;
  return put_operator_above(parent, *place, alphabet, random);
}

Child add_node(const Expression& parent, const Alphabet& alphabet, RandomStream& random) {
  if (random.chance(0.5)) return append_random_operator(parent, alphabet, random);
  return put_operator_above(parent, parent.root(), alphabet, random);
}

Child delete_node(const Expression& parent, RandomStream& random) {
  const Place place = random_internal(parent, random);
  if (!place) return std::nullopt;
  const Children children = children_of(parent, *place);
  const std::size_t kept =
      is_whole_power(parent, *place) ? 0 : static_cast<std::size_t>(random.below(children.count));
  return with_replaced(parent, *place, subtree_nodes(parent, children.place[kept]));
}

}  // namespace

MutationWeights conditioned(const MutationWeights& weights, const Expression& parent,
                            int parent_size, int max_size, std::size_t inputs) {
  using enum MutationKind;
  MutationWeights result = weights;
  const auto remove = [&](std::initializer_list<MutationKind> kinds) {
    for (const MutationKind kind : kinds) result[index_of(kind)] = 0;
  };
  std::size_t constants = 0;
  std::size_t binaries = 0;
  for (const Node& node : parent.nodes()) {
    constants += node.is_constant() ? 1 : 0;
    binaries += arity(node.op) == 2 ? 1 : 0;
  }
  if (parent.size() == 1) {
    remove({mutate_operator, swap_operands, delete_node, simplify, backsolve, prune});
    if (constants == 1) remove({mutate_feature});
  }
  if (constants == 0) remove({mutate_constant, optimize, prune});
  if (binaries == 0) remove({swap_operands});
  if (inputs <= 1) remove({mutate_feature});
  if (parent_size >= max_size) remove({add_node, insert_node, grow});
  // More constants, more reason to move one; from 8 on the full weight.
  result[index_of(mutate_constant)] *= std::min<double>(8, static_cast<double>(constants)) / 8;
  return result;
}

MutationKind draw_kind(const MutationWeights& weights, RandomStream& random) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(total > 0)) return MutationKind::do_nothing;
  double left = random.uniform() * total;
  std::size_t last = index_of(MutationKind::do_nothing);
  for (std::size_t kind = 0; kind < kMutationKinds; ++kind) {
    if (weights[kind] <= 0) continue;
    last = kind;
    if (left < weights[kind]) break;
    left -= weights[kind];
  }
  return static_cast<MutationKind>(last);
}

double constant_factor(const MutationSettings& settings, RandomStream& random) {
  const double largest = settings.perturbation_factor * settings.temperature + 1.1;
  double factor = elementary::pow(largest, random.uniform());
  if (random.chance(0.5)) factor = 1 / factor;
  // The original compares the other way round and so nearly always flips the sign.
  const bool drawn = random.chance(settings.negate_probability);
  return drawn != settings.compat ? -factor : factor;
}

std::optional<Expression> mutate(MutationKind kind, const Expression& parent,
                                 const Alphabet& alphabet, const MutationSettings& settings,
                                 RandomStream& random) {
  switch (kind) {
    case MutationKind::rotate_tree:
      return rotate_tree(parent, random);
    case MutationKind::add_node:
      return add_node(parent, alphabet, random);
    case MutationKind::delete_node:
      return delete_node(parent, random);
    case MutationKind::mutate_operator:
      return mutate_operator(parent, alphabet, random);
    case MutationKind::do_nothing:
      return parent;
    case MutationKind::swap_operands:
      return swap_operands(parent, random);
    case MutationKind::mutate_feature:
      return mutate_feature(parent, alphabet, random);
    case MutationKind::mutate_constant:
      return mutate_constant(parent, settings, random);
    case MutationKind::insert_node:
      return insert_node(parent, alphabet, random);
    case MutationKind::randomize:
      return random_formula_of_size(
          1 + static_cast<int>(random.below(static_cast<std::uint64_t>(settings.max_size))),
          alphabet, random);
    default:
      return std::nullopt;
  }
}

std::pair<Expression, Expression> cross(const Expression& a, const Expression& b,
                                        RandomStream& random) {
  const std::size_t i = *random_node(a, random);
  const std::size_t j = *random_node(b, random);
  return {with_replaced(a, i, subtree_nodes(b, j)), with_replaced(b, j, subtree_nodes(a, i))};
}

}  // namespace tribench::pysr
