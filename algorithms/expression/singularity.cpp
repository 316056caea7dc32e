// SPDX-License-Identifier: MIT
#include "algorithms/expression/singularity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/expression/witness.hpp"
#include "foundation/sign.hpp"

namespace tribench {
namespace {

using Cell = std::vector<Interval>;

// Inputs whose sign the formula looks at.
std::vector<bool> signed_inputs(const Expression& formula, const InputBox& box) {
  std::vector<bool> is_signed(box.size(), false);
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Node& node = formula.node(i);
    if (node.is_variable() && box[node.variable].sign_of) {
      is_signed[*box[node.variable].sign_of] = true;
    }
    if (node.op != Op::sgn && node.op != Op::abs) continue;
    const Node& operand = formula.node(i - 1);
    if (operand.is_variable() && !box[operand.variable].sign_of) is_signed[operand.variable] = true;
  }
  return is_signed;
}

// The parts of a range on which the sign is one number.
std::vector<Interval> sign_parts(double low, double high) {
  std::vector<Interval> parts;
  if (low < 0) parts.push_back({low, std::min(high, next_down(0))});
  if (low <= 0 && high >= 0) parts.push_back({0, 0});
  if (high > 0) parts.push_back({std::max(low, next_up(0)), high});
  return parts;
}

// Branch and bound over one formula; boxes are kept on one stack, ranges side by side.
class Prover {
 public:
  Prover(const Expression& formula, const ProofLimits& limits)
      : formula_(formula), limits_(limits), bounds_(formula), search_(formula) {}

  SingularityResult run(const std::vector<Cell>& cells) {
    std::vector<const Cell*> open;
    for (const Cell& cell : cells) {
      if (!passes_naturally(cell)) open.push_back(&cell);
    }
    for (const Cell* cell : open) {
      search_.enter(*cell);
      if (found(search_.probe_corners(*cell)) || found(search_.probe_random(*cell, kFirstProbes))) {
        return std::move(result_);
      }
    }
    result_.verdict = Verdict::proved_free;
    for (const Cell* cell : open) {
      if (!branch(*cell)) return std::move(result_);
    }
    return std::move(result_);
  }

 private:
  static constexpr int kFirstProbes = 24;
  static constexpr int kDescents = 32;

  struct Split {
    std::size_t axis = 0;
    double at = 0;
  };

  bool passes_naturally(std::span<const Interval> box) {
    ++result_.boxes;
    spent_ += formula_.size();
    return bounds_.bound(box);
  }

  bool passes(std::span<const Interval> box) {
    if (passes_naturally(box)) return true;
    spent_ += 6 * formula_.size();
    return bounds_.sharpen(box);
  }

  bool found(std::optional<Witness> witness) {
    if (!witness) return false;
    result_.verdict = Verdict::refuted;
    result_.witness = std::move(witness);
    result_.undecided_box.clear();
    return true;
  }

  bool is_exhausted() const {
    if (spent_ > limits_.node_boxes) return true;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    return limits_.seconds > 0 && elapsed.count() > limits_.seconds;
  }

  void leave_undecided(const Cell& box) {
    result_.verdict = Verdict::undecided;
    const auto size = [](const Cell& cell) {
      double widest = 0;
      for (const Interval& side : cell) {
        widest = std::max(widest, (side.high - side.low) / (1e-9 + side.magnitude()));
      }
      return widest;
    };
    if (result_.undecided_box.empty() || size(box) < size(result_.undecided_box)) {
      result_.undecided_box = box;
    }
  }

  // False where the search is over: refuted, or out of its budget.
  bool branch(const Cell& cell) {
    search_.enter(cell);
    descents_ = kDescents;
    stack_.assign(1, {cell, 0});
    while (!stack_.empty()) {
      const auto [box, depth] = std::move(stack_.back());
      stack_.pop_back();
      if (passes(box)) continue;
      if (is_exhausted()) {
        leave_undecided(box);
        return false;
      }
      const std::size_t failed = bounds_.failed_node();
      const std::optional<Split> split = choose_split(box, failed);
      if (found(look_for_witness(box, depth, failed, !split))) return false;
      if (split) {
        push_halves(box, depth, *split, failed);
      } else if (!passes_at_corners(box, failed)) {
        leave_undecided(box);
      }
    }
    return true;
  }

  // A box without doubles inside, on which a sign jumps: its corners are all the doubles there
  // are, and the search has evaluated them.
  bool passes_at_corners(const Cell& box, std::size_t failed) const {
    if (bounds_.at(culprit_of(formula_, failed)).decoration != Decoration::defined) return false;
    std::size_t active = 0;
    for (const std::size_t j : bounds_.used_columns()) active += box[j].is_point() ? 0 : 1;
    return active <= WitnessSearch::kMaxCornerInputs;
  }

  std::optional<Witness> look_for_witness(const Cell& box, int depth, std::size_t failed,
                                          bool is_last) {
    if (is_last) return search_.probe_corners(box);
    if (depth % 8 == 4 && descents_-- > 0) {
      if (auto witness = search_.descend(box, failed)) return witness;
    }
    std::vector<double>& middle = middle_;
    middle.resize(box.size());
    for (std::size_t j = 0; j < box.size(); ++j) middle[j] = midpoint(box[j]);
    if (auto witness = search_.probe(middle)) return witness;
    return search_.probe_random(box, depth >= 24 ? 4 : 1);
  }

  // How much the node varies over the box along an input, as far as its derivative tells.
  double variation(const Cell& box, std::size_t axis, std::size_t failed) const {
    const std::size_t culprit = culprit_of(formula_, failed);
    const double width = box[axis].high - box[axis].low;
    const auto along = [&](std::size_t node) {
      return bounds_.derivative(node, axis).magnitude() * width;
    };
    if (culprit < failed) return along(culprit);
    double most = 0;
    for (int c = 0; c < arity(formula_.node(failed).op); ++c) {
      most = std::max(most, along(c == 0 ? failed - 1 : formula_.left_child(failed)));
    }
    return most;
  }

  // The input along which the failing node varies most, by its width where derivatives do not tell.
  std::optional<Split> choose_split(const Cell& box, std::size_t failed) const {
    std::optional<Split> best;
    double best_variation = -1;
    double best_width = -1;
    for (const std::size_t j : bounds_.used_columns()) {
      const double middle = split_point(box[j]);
      if (box[j].is_point() || middle == box[j].low) continue;
      const double varied = variation(box, j, failed);
      const double width = (box[j].high - box[j].low) / (1e-300 + box[j].magnitude());
      if (varied > best_variation || (varied == best_variation && width > best_width)) {
        best = {j, middle};
        best_variation = varied;
        best_width = width;
      }
    }
    return best;
  }

  void push_halves(const Cell& box, int depth, const Split& split, std::size_t failed) {
    Cell low = box;
    Cell high = box;
    low[split.axis].high = split.at;
    high[split.axis].low = split.at;
    const double at_low = distance_in(low, failed);
    const double at_high = distance_in(high, failed);
    const bool is_low_first = at_low < at_high;  // the last pushed is the first searched
    stack_.push_back({is_low_first ? high : low, depth + 1});
    stack_.push_back({is_low_first ? low : high, depth + 1});
  }

  double distance_in(const Cell& box, std::size_t failed) {
    for (std::size_t j = 0; j < box.size(); ++j) middle_[j] = midpoint(box[j]);
    return search_.distance_at(middle_, failed);
  }

  const Expression& formula_;
  ProofLimits limits_;
  FormulaBounds bounds_;
  WitnessSearch search_;
  SingularityResult result_;
  std::vector<std::pair<Cell, int>> stack_;
  std::vector<double> middle_;
  std::uint64_t spent_ = 0;
  int descents_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A sign that may be any beside an input that may be any: more than the box holds, so that what is
// finite there is finite in the box, and what is not tells nothing.
SingularityResult bound_whole(const Expression& formula, const InputBox& box) {
  const Cell whole = whole_box(box);
  FormulaBounds bounds(formula);
  SingularityResult result;
  result.boxes = 1;
  if (bounds.bound(whole)) {
    result.verdict = Verdict::proved_free;
  } else {
    result.undecided_box = whole;
  }
  return result;
}

std::string point_json(std::span<const double> point, std::span<const std::string> names) {
  std::string text = "{";
  for (std::size_t j = 0; j < point.size(); ++j) {
    text += fmt::format("{}\"{}\": {}", j == 0 ? "" : ", ", names[j], print_number(point[j]));
  }
  return text + "}";
}

// Equal in every input or the next double; two points of another kind refute a property.
bool are_neighbours(const Witness& witness) {
  for (std::size_t j = 0; j < witness.point.size(); ++j) {
    const double a = witness.point[j];
    if (witness.neighbour[j] != a && witness.neighbour[j] != next_up(a)) return false;
  }
  return true;
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::proved_free:
      return "proved_free";
    case Verdict::refuted:
      return "refuted";
    default:
      return "undecided";
  }
}

std::string witness_json(const Witness& witness, std::span<const std::string> names) {
  if (witness.neighbour.empty()) return point_json(witness.point, names);
  return fmt::format("{{\"{}\": [{}, {}]}}", are_neighbours(witness) ? "between" : "points",
                     point_json(witness.point, names), point_json(witness.neighbour, names));
}

std::vector<Interval> whole_box(const InputBox& box) {
  Cell whole;
  for (const InputRange& range : box) {
    whole.push_back(range.sign_of ? Interval{-1, 1} : Interval{range.low, range.high});
  }
  return whole;
}

std::vector<std::vector<Interval>> sign_cells(const Expression& formula, const InputBox& box) {
  check_box(formula, box);
  const std::vector<bool> is_signed = signed_inputs(formula, box);
  std::vector<std::vector<std::size_t>> signs_of(box.size());
  for (std::size_t s = 0; s < box.size(); ++s) {
    if (box[s].sign_of) signs_of[*box[s].sign_of].push_back(s);
  }
  Cell whole = whole_box(box);
  for (std::size_t s = 0; s < box.size(); ++s) {
    if (box[s].sign_of) whole[s] = {};  // that of its cell, or of no one
  }
  std::vector<Cell> cells = {whole};
  for (std::size_t j = 0; j < box.size(); ++j) {
    if (!is_signed[j]) continue;
    const std::vector<Interval> parts = sign_parts(box[j].low, box[j].high);
    if (cells.size() * parts.size() * box.size() > kMostSides) return {};
    std::vector<Cell> finer;
    for (const Cell& cell : cells) {
      for (const Interval& part : parts) {
        finer.push_back(cell);
        finer.back()[j] = part;
        for (const std::size_t s : signs_of[j]) {
          finer.back()[s] = Interval::point(sign(part.high + part.low));
        }
      }
    }
    cells = std::move(finer);
  }
  return cells;
}

SingularityResult prove_free(const Expression& formula, const InputBox& box,
                             const ProofLimits& limits) {
  const std::vector<Cell> cells = sign_cells(formula, box);
  if (cells.empty()) return bound_whole(formula, box);
  SingularityResult result = Prover(formula, limits).run(cells);
  if (result.witness) {
    set_signs(box, result.witness->point);
    if (!result.witness->neighbour.empty()) set_signs(box, result.witness->neighbour);
  }
  return result;
}

}  // namespace tribench
