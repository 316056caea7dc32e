// SPDX-License-Identifier: MIT
#include "algorithms/udsr/prior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"

namespace tribench::udsr {
namespace {

bool has(TokenSet set, int token) { return token >= 0 && (set >> token & 1U) != 0; }

bool is_related(const RelationalConstraint& rule, const Traversal& traversal,
                const TokenLibrary& library) {
  const int parent = traversal.parent();
  switch (rule.relation) {
    case Relation::child:
      return has(rule.effectors, parent);
    case Relation::left_child:
      return has(rule.effectors, parent) && traversal.is_first_child();
    case Relation::right_child:
      return has(rule.effectors, parent) && !traversal.is_first_child();
    case Relation::only_child:
      return has(rule.effectors, parent) && library[static_cast<TokenId>(parent)].children == 1;
    case Relation::sibling:
      return has(rule.effectors, traversal.left_sibling());
    case Relation::descendant:
      return (rule.effectors & traversal.ancestors()) != 0;
  }
  return false;
}

TokenSet tokens_with(const TokenLibrary& library, auto&& predicate) {
  TokenSet set = 0;
  for (std::size_t i = 0; i < library.size(); ++i) {
    const auto id = static_cast<TokenId>(i);
    if (predicate(library[id])) set |= set_of(id);
  }
  return set;
}

TokenSet operations(const TokenLibrary& library, std::initializer_list<Op> ops) {
  return tokens_with(library, [&](const Token& token) {
    return token.kind == TokenKind::operation && std::ranges::find(ops, token.op) != ops.end();
  });
}

}  // namespace

void Traversal::push(TokenId token) {
  const Token& entry = (*library_)[token];
  open_ = open() + entry.children - 1;
  ++length_;
  ++counts_[static_cast<int>(entry.kind)];
  if (!stack_.empty() && stack_.back().filled == 0) stack_.back().first_child = token;
  if (!stack_.empty()) ++stack_.back().filled;
  if (entry.children > 0) {
    stack_.push_back({token, 0, -1, ancestors() | set_of(token)});
    return;
  }
  while (!stack_.empty() && stack_.back().filled == (*library_)[stack_.back().token].children) {
    stack_.pop_back();
  }
}

Prior::Prior(const TokenLibrary& library, const PriorOptions& options, const DataRange& range)
    : library_(&library), options_(options) {
  if (library.size() > kMostTokens) {
    throw_bad_input(fmt::format("uDSR's token library holds at most {} tokens", kMostTokens), {},
                    "use fewer inputs or operations");
  }
  for (std::size_t i = 0; i < library.size(); ++i) {
    const auto id = static_cast<TokenId>(i);
    const Token& token = library[id];
    by_children_[token.children] |= set_of(id);
    by_kind_[static_cast<int>(token.kind)] |= set_of(id);
    const auto alike = static_cast<double>(library.count_with_children(token.children));
    arity_shift_.push_back(options.uniform_arity ? -elementary::log(alike) : 0.0);
  }
  if (options.inverse) {
    const TokenSet exp = operations(library, {Op::exp});
    const TokenSet log = operations(library, {Op::log});
    const TokenSet neg = operations(library, {Op::neg});
    add_constraint({Relation::child, exp, log});
    add_constraint({Relation::child, log, exp});
    add_constraint({Relation::child, neg, neg});
  }
  if (options.trig) {
    const TokenSet trig = operations(library, {Op::sin, Op::cos});
    add_constraint({Relation::descendant, trig, trig});
  }
  const TokenSet constants = by_kind_[static_cast<int>(TokenKind::constant)];
  add_constraint({Relation::only_child, constants, by_children_[1]});
  add_constraint({Relation::sibling, constants, constants});
  // The linear token is found by inverting what stands above it: never below a function that is
  // not one-to-one.
  add_constraint({Relation::descendant, by_kind_[static_cast<int>(TokenKind::linear)],
                  operations(library, {Op::sin, Op::cos, Op::abs})});
  if (options.domain_range) note_ranges(range);
}

void Prior::note_ranges(const DataRange& range) {
  if (range.target_low < 0) forbidden_roots_ |= operations(*library_, {Op::exp, Op::sqrt, Op::abs});
  if (range.target_low < -1 || range.target_high > 1) {
    forbidden_roots_ |= operations(*library_, {Op::sin, Op::cos, Op::tanh});
  }
  below_sqrt_ = tokens_with(*library_, [&](const Token& token) {
    return token.kind == TokenKind::input && range.input_low[token.input] < 0;
  });
  below_log_ = tokens_with(*library_, [&](const Token& token) {
    return token.kind == TokenKind::input && range.input_low[token.input] <= 0;
  });
}

void Prior::add_constraint(const RelationalConstraint& constraint) {
  if (constraint.targets != 0 && constraint.effectors != 0) constraints_.push_back(constraint);
}

TokenSet Prior::breaks_relations(const Traversal& traversal) const {
  TokenSet broken = 0;
  for (const RelationalConstraint& rule : constraints_) {
    if (is_related(rule, traversal, *library_)) broken |= rule.targets;
  }
  return broken;
}

TokenSet Prior::breaks_length(const Traversal& traversal) const {
  TokenSet broken = 0;
  const int length_after = traversal.length() + 1;
  for (int children = 0; children <= 2; ++children) {
    const int open_after = traversal.open() + children - 1;
    if (length_after + open_after > options_.max_length) broken |= by_children_[children];
  }
  // A polynomial is a formula of its own, however short.
  if (traversal.open() == 1 && length_after < options_.min_length) {
    broken |= by_children_[0] & ~by_kind_[static_cast<int>(TokenKind::linear)];
  }
  return broken;
}

// How often constants and the linear token may occur, that they exclude each other, and that a
// formula needs an input.
TokenSet Prior::breaks_counts(const Traversal& traversal) const {
  const TokenSet constants = by_kind_[static_cast<int>(TokenKind::constant)];
  const TokenSet linear = by_kind_[static_cast<int>(TokenKind::linear)];
  const int written = traversal.count(TokenKind::constant);
  TokenSet broken = 0;
  if (written >= options_.max_constants) broken |= constants;
  if (traversal.count(TokenKind::linear) > 0) broken |= constants | linear;
  if (written > 0) broken |= linear;
  if (traversal.open() == 1 && traversal.count(TokenKind::input) == 0) broken |= constants;
  return broken;
}

TokenSet Prior::breaks_domain_range(const Traversal& traversal) const {
  if (traversal.length() == 0) return forbidden_roots_;
  if (traversal.parent() < 0) return 0;
  switch ((*library_)[static_cast<TokenId>(traversal.parent())].op) {
    case Op::sqrt:
      return below_sqrt_;
    case Op::log:
      return below_log_;
    default:
      return 0;
  }
}

TokenSet Prior::forbidden(const Traversal& traversal) const {
  return breaks_relations(traversal) | breaks_length(traversal) | breaks_counts(traversal) |
         breaks_domain_range(traversal);
}

double Prior::soft_length(const Traversal& traversal, int children) const {
  const double distance = traversal.length() - options_.soft_length_location;
  const bool discouraged = distance < 0 ? traversal.open() + children == 1 : children > 0;
  return discouraged ? -distance * distance / (2 * options_.soft_length_scale) : 0.0;
}

void Prior::add_to(const Traversal& traversal, std::span<double> logits) const {
  const TokenSet broken = forbidden(traversal);
  double by_children[3] = {0, 0, 0};
  if (options_.soft_length) {
    for (int children = 0; children <= 2; ++children) {
      by_children[children] = soft_length(traversal, children);
    }
  }
  for (std::size_t i = 0; i < logits.size(); ++i) {
    const Token& token = (*library_)[static_cast<TokenId>(i)];
    if ((broken >> i & 1U) != 0) {
      logits[i] = kForbidden;
      continue;
    }
    logits[i] += arity_shift_[i];
    // A linear token may end a formula at once: that is what it is for.
    if (token.kind != TokenKind::linear) logits[i] += by_children[token.children];
  }
  release_inputs_if_nothing_is_left(logits);
}

void Prior::release_inputs_if_nothing_is_left(std::span<double> logits) const {
  if (std::ranges::any_of(logits, [](double logit) { return logit > kForbidden; })) return;
  for (std::size_t i = 0; i < logits.size(); ++i) {
    if ((*library_)[static_cast<TokenId>(i)].kind == TokenKind::input) logits[i] = 0;
  }
}

bool Prior::allows(std::span<const TokenId> sequence) const {
  Traversal traversal(*library_);
  for (const TokenId token : sequence) {
    if (traversal.complete() || has(forbidden(traversal), token)) return false;
    traversal.push(token);
  }
  return traversal.complete();
}

}  // namespace tribench::udsr
