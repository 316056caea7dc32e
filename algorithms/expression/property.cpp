// SPDX-License-Identifier: MIT
#include "algorithms/expression/property.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/canonical.hpp"
#include "algorithms/expression/oddness.hpp"
#include "algorithms/expression/singularity.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"

namespace tribench {
namespace {

using Cell = std::vector<Interval>;

// The formula with every sgn(X) of an input X written as the column sgn_X, which the box is given
// where it has none: on a cell closed at 0 the sign is then one number, the limit's.
struct Signed {
  Expression formula;
  InputBox box;
};
Signed with_sign_columns(const Expression& formula, InputBox box) {
  const auto sign_column = [&box](std::size_t of) {
    for (std::size_t j = 0; j < box.size(); ++j) {
      if (box[j].sign_of == of) return j;
    }
    box.push_back({-1, 1, of});
    return box.size() - 1;
  };
  std::vector<Node> tape;
  for (const Node& node : formula.nodes()) {
    if (node.op == Op::sgn && tape.back().is_variable()) {
      const std::size_t of = tape.back().variable;
      if (!box[of].sign_of) tape.back() = Node::input(sign_column(of));
    } else {
      tape.push_back(node);
    }
  }
  return {Expression(std::move(tape)), std::move(box)};
}

// The sign cells of the box with the velocity split at 0 whether the formula looks at its sign or
// not, and closed at 0: what holds on the closure holds on the cell. Empty where there are too
// many.
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

// Branch and bound for properties of a value or a slope, cell by cell.
class PropertyProver {
 public:
  PropertyProver(const Expression& formula, const InputBox& box, const PropertyQuestion& question,
                 const ProofLimits& limits)
      : box_(box), question_(question), limits_(limits), bounds_(formula), points_(formula) {}

  PropertyResult run(std::vector<Cell> cells) {
    if (cells.empty()) {  // a bound on the whole holds on every cell; what else is asked has signs
      const Cell whole = whole_box(box_);
      const bool is_shown =
          question_.property == Property::bounded && bounds_.sharpen(whole) && holds(whole);
      if (is_shown) result_.verdict = Verdict::proved_free;
      if (!is_shown) result_.undecided_box = whole;
      return std::move(result_);
    }
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

// Where one part of the velocities that monotony is asked of ends or the next begins; its sign is
// that of the part, so that 0 with a sign is the limit at 0.
struct PartEnd {
  double velocity = 0;
  double sign = 0;
};

// v < 0, 0 and v > 0 as far as they are asked of: each part's end next to the other parts.
std::vector<PartEnd> part_ends(const InputRange& v, double from) {
  std::vector<PartEnd> ends;
  if (v.low < 0 && v.low <= -from) ends.push_back({-from, -1});
  if (from == 0 && v.low <= 0 && v.high >= 0) ends.push_back({0, 0});
  if (v.high > 0 && v.high >= from) ends.push_back({from, 1});
  return ends;
}

// That a formula does not fall: by its slope on each part, and by its steps from part to part.
class MonotoneProver {
 public:
  MonotoneProver(const Expression& formula, const InputBox& box, const PropertyQuestion& question,
                 const ProofLimits& limits)
      : formula_(formula), box_(box), question_(question), limits_(limits), points_(formula) {}

  PropertyResult run() {
    PropertyResult result = PropertyProver(formula_, box_, question_, limits_)
                                .run(closed_cells(formula_, box_, question_.velocity));
    const auto ends = part_ends(box_[question_.velocity], question_.from);
    for (std::size_t k = 1; k < ends.size() && result.verdict != Verdict::refuted; ++k) {
      PropertyResult step = prove_step(ends[k - 1], ends[k]);
      step.boxes += result.boxes;
      if (step.verdict == Verdict::proved_free) {
        result.boxes = step.boxes;
      } else {
        result = std::move(step);
      }
    }
    return result;
  }

 private:
  // The step is a formula in the other inputs; the velocity's place is 1, so that "dissipative"
  // asks whether the step is below 0 anywhere.
  PropertyResult prove_step(const PartEnd& slow, const PartEnd& fast) {
    const Expression step = Expression::binary(Op::sub, at(fast), at(slow));
    InputBox others = box_;
    others[question_.velocity] = {1, 1};
    PropertyResult result;
    const std::vector<Cell> cells = closed_cells(formula_, others, question_.velocity);
    result.undecided_box = cells.empty() ? whole_box(others) : cells.front();
    const SingularityResult finite = prove_free(step, others, limits_);
    result.boxes = finite.boxes;
    if (finite.verdict == Verdict::proved_free) {
      Canonicalizer canonicalizer({[](const Expression&) { return true; }, {}});
      if (is_zero(canonicalizer.canonical(step))) {
        result.verdict = Verdict::proved_free;
        return result;
      }
      const PropertyQuestion is_up{Property::dissipative, question_.velocity};
      result = PropertyProver(step, others, is_up, limits_)
                   .run(closed_cells(step, others, question_.velocity));
      result.boxes += finite.boxes;
    }
    if (result.verdict == Verdict::refuted) confirm(slow, fast, result);
    if (result.verdict == Verdict::undecided) {
      result.undecided_box[question_.velocity] = {slow.velocity, fast.velocity};
    }
    return result;
  }

  Expression at(const PartEnd& end) const {
    std::vector<Node> tape(formula_.nodes().begin(), formula_.nodes().end());
    for (Node& node : tape) {
      if (!node.is_variable()) continue;
      if (node.variable == question_.velocity) {
        node = Node::constant(end.velocity);
      } else if (box_[node.variable].sign_of == question_.velocity) {
        node = Node::constant(end.sign);
      }
    }
    return Expression(std::move(tape));
  }

  // A step down at limits is one between two points, and the farther apart they are the easier to
  // read; undecided where none is far enough for our arithmetic.
  void confirm(const PartEnd& slow, const PartEnd& fast, PropertyResult& result) {
    const InputRange& v = box_[question_.velocity];
    std::vector<double> before = result.witness->point;
    std::vector<double> after = before;
    const double least = std::max(question_.from, next_up(0));
    double speed = std::min(slow.sign < 0 ? -v.low : kInfinity, fast.sign > 0 ? v.high : kInfinity);
    for (;; speed = std::max(speed / 4, least)) {
      before[question_.velocity] = slow.sign * speed;
      after[question_.velocity] = fast.sign * speed;
      set_signs(box_, before);
      set_signs(box_, after);
      if (value_at(points_, after).high < value_at(points_, before).low) {
        result.witness = {before, after, formula_.root()};
        return;
      }
      if (speed == least) break;
    }
    result.verdict = Verdict::undecided;
    result.undecided_box.clear();
    for (const double x : result.witness->point) result.undecided_box.push_back(Interval::point(x));
    result.witness.reset();
  }

  const Expression& formula_;
  const InputBox& box_;
  PropertyQuestion question_;
  ProofLimits limits_;
  FormulaBounds points_;
};

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
  // A single speed on either side has nothing beside it to rise or fall to.
  const bool has_speeds =
      std::max(v.low, question.from) < v.high || v.low < std::min(v.high, -question.from);
  if (question.property == Property::monotone && !has_speeds) {
    throw_bad_input(fmt::format("the box {}:{} has no two speeds beyond {}: nothing is asked",
                                v.low, v.high, question.from),
                    question.from > 0 ? "--from" : "--box",
                    "give a range, and start below its largest speed");
  }
  if (question.property == Property::odd && !(v.low < 0 && v.high > 0)) {
    throw_bad_input("oddness needs a velocity range with both signs", "--box",
                    "let the velocity's range hold 0 inside");
  }
}

// The box, or the parts of it in which |v| >= from.
std::vector<InputBox> parts_asked(const InputBox& box, const PropertyQuestion& question) {
  if (question.property != Property::monotone || question.from == 0) return {box};
  std::vector<InputBox> parts;
  const InputRange& v = box[question.velocity];
  if (v.low <= -question.from) {
    parts.push_back(box);
    parts.back()[question.velocity].high = std::min(v.high, -question.from);
  }
  if (v.high >= question.from) {
    parts.push_back(box);
    parts.back()[question.velocity].low = std::max(v.low, question.from);
  }
  return parts;
}

PropertyResult prove_of_finite(const Expression& formula, const InputBox& box,
                               const PropertyQuestion& question, const ProofLimits& limits) {
  switch (question.property) {
    case Property::odd:
      return prove_odd(formula, box, question.velocity);
    case Property::monotone:
      return MonotoneProver(formula, box, question, limits).run();
    default:
      return PropertyProver(formula, box, question, limits)
          .run(closed_cells(formula, box, question.velocity));
  }
}

// Without the sign columns that the question did not have.
void trim(Witness& witness, std::size_t inputs) {
  witness.point.resize(inputs);
  if (!witness.neighbour.empty()) witness.neighbour.resize(inputs);
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
  PropertyResult result;
  for (const InputBox& part : parts_asked(box, question)) {
    SingularityResult finite = prove_free(formula, part, limits);
    result.boxes += finite.boxes;
    if (finite.verdict != Verdict::proved_free) {
      return {finite.verdict, std::move(finite.witness), std::move(finite.undecided_box),
              result.boxes};
    }
  }
  const std::size_t boxes = result.boxes;
  result.verdict = Verdict::proved_free;
  if (question.property != Property::finite) {
    const Signed sure = with_sign_columns(formula, box);
    result = prove_of_finite(sure.formula, sure.box, question, limits);
    result.boxes += boxes;
    if (result.witness) trim(*result.witness, box.size());
    if (!result.undecided_box.empty()) result.undecided_box.resize(box.size());
  }
  return result;
}

}  // namespace tribench
