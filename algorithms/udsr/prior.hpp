// SPDX-License-Identifier: MIT
//
// Priors and constraints in situ: what is added to the policy's logits before the next token is
// drawn. A constraint is minus infinity (the token cannot be drawn), a prior a finite shift.
//
// Source: Petersen et al. 2021, section 3.4, and the public code's prior.py: length, repeat,
// inverse, trig, const, no-inputs, uniform-arity, soft-length, domain-range, relational, and the
// rules for the linear token. The same constraints repair the children of genetic programming.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "algorithms/udsr/token.hpp"

namespace tribench::udsr {

inline constexpr double kForbidden = -std::numeric_limits<double>::infinity();

// A set of tokens, a bit each (checked by Prior).
using TokenSet = std::uint64_t;
inline constexpr std::size_t kMostTokens = 64;

inline TokenSet set_of(TokenId token) { return TokenSet{1} << token; }

// A pre-order sequence under construction: everything the priors and the policy's input need.
class Traversal {
 public:
  explicit Traversal(const TokenLibrary& library) : library_(&library) {}

  void push(TokenId token);
  bool complete() const { return length_ > 0 && open_ == 0; }

  int length() const { return length_; }
  int open() const { return length_ == 0 ? 1 : open_; }  // places that still need a token
  // Of the place to be filled next; -1 for none.
  int parent() const { return stack_.empty() ? -1 : stack_.back().token; }
  int left_sibling() const { return stack_.empty() ? -1 : stack_.back().first_child; }
  bool is_first_child() const { return !stack_.empty() && stack_.back().filled == 0; }
  // The tokens above the next place.
  TokenSet ancestors() const { return stack_.empty() ? 0 : stack_.back().above; }
  int count(TokenKind kind) const { return counts_[static_cast<int>(kind)]; }

 private:
  struct Level {
    TokenId token = 0;
    int filled = 0;
    int first_child = -1;
    TokenSet above = 0;  // this token and those above it
  };

  const TokenLibrary* library_;
  std::vector<Level> stack_;
  int length_ = 0;
  int open_ = 0;
  int counts_[4] = {0, 0, 0, 0};
};

// How a target token may not stand to an effector token.
enum class Relation { child, left_child, right_child, only_child, descendant, sibling };

struct RelationalConstraint {
  Relation relation = Relation::child;
  TokenSet targets = 0;
  TokenSet effectors = 0;
};

struct PriorOptions {
  int min_length = 4;
  int max_length = 30;  // the published 64 gives formulas too long to read
  int max_constants = 3;
  bool uniform_arity = true;
  bool soft_length = true;
  double soft_length_location = 10;
  double soft_length_scale = 5;
  bool trig = true;
  bool inverse = true;
  bool domain_range = true;
};

// Ranges of the data, for the domain-range constraint.
struct DataRange {
  std::vector<double> input_low;
  double target_low = 0;
  double target_high = 0;
};

class Prior {
 public:
  Prior(const TokenLibrary& library, const PriorOptions& options, const DataRange& range);

  // logits[t] += the prior of token t at the next place. At least one token stays possible.
  void add_to(const Traversal& traversal, std::span<double> logits) const;
  // Whether a complete sequence breaks none of the constraints.
  bool allows(std::span<const TokenId> sequence) const;

  void add_constraint(const RelationalConstraint& constraint);
  const PriorOptions& options() const { return options_; }

 private:
  void note_ranges(const DataRange& range);
  TokenSet forbidden(const Traversal& traversal) const;
  TokenSet breaks_relations(const Traversal& traversal) const;
  TokenSet breaks_length(const Traversal& traversal) const;
  TokenSet breaks_counts(const Traversal& traversal) const;
  TokenSet breaks_domain_range(const Traversal& traversal) const;
  // The constraints can contradict each other (an input below sqrt whose data are negative, and no
  // place for anything else): then an input is drawn, and the formula is judged as it is.
  void release_inputs_if_nothing_is_left(std::span<double> logits) const;
  double soft_length(const Traversal& traversal, int children) const;

  const TokenLibrary* library_;
  PriorOptions options_;
  std::vector<RelationalConstraint> constraints_;
  std::vector<double> arity_shift_;
  // Tokens by number of children and by kind, and those that the data's ranges forbid.
  TokenSet by_children_[3] = {0, 0, 0};
  TokenSet by_kind_[4] = {0, 0, 0, 0};
  TokenSet forbidden_roots_ = 0;
  TokenSet below_sqrt_ = 0;
  TokenSet below_log_ = 0;
};

}  // namespace tribench::udsr
