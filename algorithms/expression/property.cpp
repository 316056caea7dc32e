// SPDX-License-Identifier: MIT
#include "algorithms/expression/property.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/canonical.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

using Cell = std::vector<Interval>;

void set_signs(const InputBox& box, std::vector<double>& point) {
  for (std::size_t j = 0; j < box.size(); ++j) {
    if (!box[j].sign_of) continue;
    const double x = point[*box[j].sign_of];
    point[j] = x > 0 ? 1 : (x < 0 ? -1 : 0);
  }
}

// Bounds of the real value at one point.
Interval value_at(FormulaBounds& bounds, const std::vector<double>& point) {
  Cell box(point.size());
  for (std::size_t j = 0; j < point.size(); ++j) box[j] = Interval::point(point[j]);
  return bounds.bound(box) ? bounds.root().range : Interval::entire();
}

// The sign cells of the box with the velocity split at 0 whether the formula looks at its sign or
// not, and closed at 0: what holds on the closure holds on the cell.
std::vector<Cell> closed_cells(const Expression& formula, const InputBox& box,
                               std::size_t velocity) {
  const Expression watched = Expression::binary(
      Op::add, formula, Expression::unary(Op::abs, Expression::variable(velocity)));
  std::vector<Cell> cells = sign_cells(watched, box);
  for (Cell& cell : cells) {
    for (Interval& side : cell) {
      if (side.low == next_up(0)) side.low = 0;
      if (side.high == next_down(0)) side.high = 0;
    }
  }
  return cells;
}

// Branch and bound for properties of a value or a slope.
class PropertyProver {
 public:
  PropertyProver(const Expression& formula, const InputBox& box, const PropertyQuestion& question,
                 const ProofLimits& limits)
      : box_(box), question_(question), limits_(limits), bounds_(formula), points_(formula) {}

  PropertyResult run(std::vector<Cell> cells) {
    result_.verdict = Verdict::proved_free;
    std::erase_if(cells, [this](Cell& cell) { return !restrict_velocity(cell); });
    for (const Cell& cell : cells) {
      if (refutes_at_random(cell)) return std::move(result_);
    }
    for (Cell& cell : cells) {
      if (!branch(std::move(cell))) break;
    }
    return std::move(result_);
  }

 private:
  // False where the property asks nothing of the cell.
  bool restrict_velocity(Cell& cell) const {
    Interval& v = cell[question_.velocity];
    if (question_.property == Property::bounded) return true;
    if (v.low == 0 && v.high == 0) return false;
    if (question_.property == Property::monotone) {
      if (v.low >= 0) v.low = std::max(v.low, question_.from);
      if (v.high <= 0) v.high = std::min(v.high, -question_.from);
    }
    return v.low <= v.high;
  }

  bool branch(Cell start) {
    std::vector<Cell> stack = {std::move(start)};
    while (!stack.empty()) {
      const Cell box = std::move(stack.back());
      stack.pop_back();
      ++result_.boxes;
      spent_ += 7 * bounds_.formula().size();
      const bool is_bounded = bounds_.sharpen(box);
      if (is_bounded && holds(box)) continue;
      if (refutes(box, is_bounded)) return false;
      const std::optional<std::size_t> axis = widest(box, is_bounded);
      if (!axis || spent_ > limits_.node_boxes) {
        result_.verdict = Verdict::undecided;
        result_.undecided_box = box;
        if (!axis) continue;
        return false;
      }
      const double middle = midpoint(box[*axis]);
      stack.push_back(box);
      stack.back()[*axis].low = middle;
      stack.push_back(box);
      stack.back()[*axis].high = middle;
    }
    return true;
  }

  bool holds(const Cell& box) const {
    const Interval& f = bounds_.real_root();
    switch (question_.property) {
      case Property::bounded:
        return f.magnitude() <= question_.limit;
      case Property::monotone:
        return bounds_.derivative(bounds_.formula().root(), question_.velocity).low >= 0;
      default:
        return box[question_.velocity].low >= 0 ? f.low >= 0 : f.high <= 0;
    }
  }

  bool refutes(const Cell& box, bool is_bounded) {
    std::vector<double> point(box.size());
    for (std::size_t j = 0; j < box.size(); ++j) point[j] = midpoint(box[j]);
    set_signs(box_, point);
    if (question_.property == Property::monotone) return is_bounded && falls(box, point);
    for (const double v :
         {point[question_.velocity], box[question_.velocity].low, box[question_.velocity].high}) {
      point[question_.velocity] = v;
      set_signs(box_, point);
      if (violates(point)) return refute({point, {}, bounds_.formula().root()});
    }
    return false;
  }

  // Points inside the cell and on its sides, for a violation that is not thin.
  bool refutes_at_random(const Cell& cell) {
    constexpr int kPoints = 64;
    if (question_.property == Property::monotone) return false;
    std::vector<double> point(cell.size());
    for (int i = 0; i < kPoints; ++i) {
      for (std::size_t j = 0; j < cell.size(); ++j) {
        const std::uint64_t side = random_.below(4);
        const double inside = random_.uniform(cell[j].low, cell[j].high);
        point[j] = side == 0 ? cell[j].low : (side == 1 ? cell[j].high : inside);
      }
      set_signs(box_, point);
      if (violates(point)) return refute({point, {}, bounds_.formula().root()});
    }
    return false;
  }

  bool violates(const std::vector<double>& point) {
    const Interval f = value_at(points_, point);
    if (question_.property == Property::bounded) return f.mignitude() > question_.limit;
    const double v = point[question_.velocity];
    return v > 0 ? f.high < 0 : (v < 0 && f.low > 0);
  }

  // Whether f falls for certain between the two ends of the velocity's side.
  bool falls(const Cell& box, std::vector<double> point) {
    std::vector<double> slow = point;
    std::vector<double> fast = std::move(point);
    const Interval& v = box[question_.velocity];
    slow[question_.velocity] = v.low == 0 ? next_up(0) : v.low;
    fast[question_.velocity] = v.high == 0 ? next_down(0) : v.high;
    set_signs(box_, slow);
    set_signs(box_, fast);
    if (!(value_at(points_, fast).high < value_at(points_, slow).low)) return false;
    return refute({slow, fast, bounds_.formula().root()});
  }

  bool refute(Witness witness) {
    result_.verdict = Verdict::refuted;
    result_.witness = std::move(witness);
    return true;
  }

  std::optional<std::size_t> widest(const Cell& box, bool is_bounded) const {
    std::optional<std::size_t> best;
    double most = -1;
    for (const std::size_t j : bounds_.used_columns()) {
      if (midpoint(box[j]) == box[j].low) continue;
      const double width = box[j].high - box[j].low;
      const double whole = box_[j].high - box_[j].low;
      const bool by_slope = is_bounded && question_.property != Property::monotone;
      const double varied =
          by_slope ? bounds_.derivative(bounds_.formula().root(), j).magnitude() * width
                   : width / whole;
      if (varied > most) {
        most = varied;
        best = j;
      }
    }
    return best;
  }

  const InputBox& box_;
  PropertyQuestion question_;
  ProofLimits limits_;
  FormulaBounds bounds_;
  FormulaBounds points_;
  RandomStream random_{key_of("property")};
  PropertyResult result_;
  std::uint64_t spent_ = 0;
};

// The formula at the mirrored point: v and its sign turned round.
Expression mirrored(const Expression& formula, const InputBox& box, std::size_t velocity) {
  std::vector<Node> tape;
  for (const Node& node : formula.nodes()) {
    tape.push_back(node);
    if (node.is_variable() &&
        (node.variable == velocity || box[node.variable].sign_of == velocity)) {
      tape.push_back({0, 0, 0, Op::neg});
    }
  }
  return Expression(std::move(tape));
}

// Odd where f(v) + f(-v) cancels; refuted where it is certainly not 0 at a point.
PropertyResult prove_odd(const Expression& formula, const InputBox& box, std::size_t velocity) {
  constexpr int kPoints = 500;
  PropertyResult result;
  const Expression sum = Expression::binary(Op::add, formula, mirrored(formula, box, velocity));
  // The formula is proved finite, and so is its mirror image: every term may cancel.
  Canonicalizer canonicalizer({[](const Expression&) { return true; }, {}});
  const Expression rest = canonicalizer.canonical(sum);
  if (rest.size() == 1 && rest.node(0).is_constant() && rest.node(0).value == 0) {
    result.verdict = Verdict::proved_free;
    return result;
  }
  const double reach = std::min(box[velocity].high, -box[velocity].low);
  FormulaBounds bounds(sum);
  RandomStream random(key_of("odd"));
  std::vector<double> point(box.size());
  for (int i = 0; i < kPoints; ++i) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      point[j] = j == velocity ? random.uniform(0, reach) : random.uniform(box[j].low, box[j].high);
    }
    set_signs(box, point);
    ++result.boxes;
    if (value_at(bounds, point).contains(0)) continue;
    std::vector<double> mirror = point;
    mirror[velocity] = -point[velocity];
    set_signs(box, mirror);
    result.verdict = Verdict::refuted;
    result.witness = Witness{point, mirror, formula.root()};
    return result;
  }
  for (const InputRange& range : box) result.undecided_box.push_back({range.low, range.high});
  return result;
}

void check_question(const InputBox& box, const PropertyQuestion& question) {
  if (!(question.from >= 0) || !(question.limit >= 0)) {
    throw_bad_input("the start of a range and a limit are not negative", "property");
  }
  // Asks nothing of a velocity, which a constant has not.
  if (question.property == Property::finite) return;
  if (question.velocity >= box.size() || box[question.velocity].sign_of) {
    throw_bad_input(fmt::format("input {} is no velocity with a range", question.velocity),
                    "velocity", "name an input of the box");
  }
  const InputRange& v = box[question.velocity];
  if (question.property == Property::monotone && !(question.from < std::max(v.high, -v.low))) {
    throw_bad_input(fmt::format("no speed of the box {}:{} lies beyond {}: nothing is asked", v.low,
                                v.high, question.from),
                    "--from", "start below the largest speed");
  }
  if (question.property == Property::odd && !(v.low < 0 && v.high > 0)) {
    throw_bad_input("oddness needs a velocity range with both signs", "--box",
                    "let the velocity's range hold 0 inside");
  }
}

}  // namespace

std::string_view property_name(Property property) {
  switch (property) {
    case Property::finite:
      return "finite";
    case Property::bounded:
      return "bounded";
    case Property::dissipative:
      return "dissipative";
    case Property::monotone:
      return "monotone";
    default:
      return "odd";
  }
}

PropertyResult prove_property(const Expression& formula, const InputBox& box,
                              const PropertyQuestion& question, const ProofLimits& limits) {
  check_box(formula, box);
  check_question(box, question);
  SingularityResult finite = prove_free(formula, box, limits);
  if (finite.verdict != Verdict::proved_free || question.property == Property::finite) {
    return {finite.verdict, std::move(finite.witness), std::move(finite.undecided_box),
            finite.boxes};
  }
  PropertyResult result = question.property == Property::odd
                              ? prove_odd(formula, box, question.velocity)
                              : PropertyProver(formula, box, question, limits)
                                    .run(closed_cells(formula, box, question.velocity));
  result.boxes += finite.boxes;
  return result;
}

}  // namespace tribench
