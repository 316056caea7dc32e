// SPDX-License-Identifier: MIT
#include "algorithms/udsr/simplification.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "algorithms/expression/build.hpp"
#include "foundation/order_statistics.hpp"

namespace tribench::udsr {
namespace {

// A reduction may cost twice the smoother's own held-out error (one for each use of it).
constexpr double kErrorFactor = 2.0;
constexpr int kPermutations = 39;
// Rows near a zero say nothing about a product (Udrescu & Tegmark 2020, section 2.7).
constexpr double kLeastProduct = 0.2;

using Group = std::vector<std::size_t>;  // an input and, where there is one, its sign

std::vector<Group> groups_of(std::span<const Input> inputs) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i].sign_of) continue;
    Group group = {i};
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      if (inputs[j].sign_of == i) group.push_back(j);
    }
    groups.push_back(group);
  }
  return groups;
}

// The row in the middle of the data: where the other part is held. A row, not a vector of
// medians, so that an input and its sign agree.
Eigen::VectorXd reference_point(const Smoother& smoother) {
  const std::size_t n = smoother.rows();
  Eigen::VectorXd medians = smoother.point(0);
  for (Eigen::Index j = 0; j < medians.size(); ++j) {
    std::vector<double> column;
    for (std::size_t r = 0; r < n; ++r) column.push_back(smoother.point(r)[j]);
    medians[j] = upper_median(std::move(column));
  }
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < n; ++r) {
    const double distance = (smoother.point(r) - medians).cwiseAbs().sum();
    if (distance < least) {
      least = distance;
      nearest = r;
    }
  }
  return smoother.point(nearest);
}

// `point` with everything outside `part` taken from `reference`.
Eigen::VectorXd held(const Eigen::VectorXd& point, const Eigen::VectorXd& reference,
                     const std::vector<std::size_t>& part) {
  Eigen::VectorXd mixed = reference;
  for (const std::size_t j : part) {
    mixed[static_cast<Eigen::Index>(j)] = point[static_cast<Eigen::Index>(j)];
  }
  return mixed;
}

std::vector<std::size_t> complement(const std::vector<std::size_t>& part, std::size_t inputs) {
  std::vector<std::size_t> rest;
  for (std::size_t j = 0; j < inputs; ++j) {
    if (std::ranges::find(part, j) == part.end()) rest.push_back(j);
  }
  return rest;
}

// Where a symmetry says the value is unchanged.
Eigen::VectorXd shifted(const Eigen::VectorXd& point, const Reduction& reduction, double shift) {
  constexpr double kFactor = 1.2;
  Eigen::VectorXd moved = point;
  double& first = moved[static_cast<Eigen::Index>(reduction.first)];
  double& second = moved[static_cast<Eigen::Index>(reduction.second)];
  switch (reduction.kind) {
    case ReductionKind::difference:
      first += shift;
      second += shift;
      break;
    case ReductionKind::sum:
      first += shift;
      second -= shift;
      break;
    case ReductionKind::ratio:
      first *= kFactor;
      second *= kFactor;
      break;
    default:
      first *= kFactor;
      second /= kFactor;
      break;
  }
  return moved;
}

double spread_of(const Smoother& smoother, std::size_t input) {
  double mean = 0;
  double square = 0;
  const auto n = static_cast<double>(smoother.rows());
  for (std::size_t r = 0; r < smoother.rows(); ++r) {
    const double x = smoother.point(r)[static_cast<Eigen::Index>(input)];
    mean += x / n;
    square += x * x / n;
  }
  return std::sqrt(std::max(0.0, square - mean * mean));
}

// Absolute errors of the reduced function at the smoother's rows. The second factor or term is
// taken at row order[r], so that a permutation destroys what it has to say about row r.
using Errors = std::vector<double>;

// Outside the data the smoother knows nothing.
bool is_inside(const Smoother& smoother, const Eigen::VectorXd& point) {
  return (point.array() >= smoother.low().array()).all() &&
         (point.array() <= smoother.high().array()).all();
}

Errors symmetry_errors(const Smoother& smoother, const Reduction& reduction,
                       std::span<const std::size_t> order) {
  const double shift =
      0.5 * std::min(spread_of(smoother, reduction.first), spread_of(smoother, reduction.second));
  Errors errors;
  for (std::size_t r = 0; r < smoother.rows(); ++r) {
    Eigen::VectorXd point = smoother.point(r);
    // The permuted control moves the second input to another row's value instead.
    const auto second = static_cast<Eigen::Index>(reduction.second);
    point[second] = smoother.point(order[r])[second];
    const Eigen::VectorXd moved = shifted(point, reduction, shift);
    if (!is_inside(smoother, moved)) continue;
    errors.push_back(std::abs(smoother.target(r) - smoother.predict(moved)));
  }
  return errors;
}

struct Parts {
  std::vector<double> first;   // S free, rest at the reference
  std::vector<double> second;  // rest free, S at the reference
  double both = 0;             // all at the reference
};

Parts part_values(const Smoother& smoother, const std::vector<std::size_t>& part,
                  std::size_t inputs) {
  const Eigen::VectorXd reference = reference_point(smoother);
  const std::vector<std::size_t> rest = complement(part, inputs);
  Parts parts;
  parts.both = smoother.predict(reference);
  for (std::size_t r = 0; r < smoother.rows(); ++r) {
    parts.first.push_back(smoother.predict(held(smoother.point(r), reference, part)));
    parts.second.push_back(smoother.predict(held(smoother.point(r), reference, rest)));
  }
  return parts;
}

Errors separability_errors(const Smoother& smoother, const Reduction& reduction, const Parts& parts,
                           std::span<const std::size_t> order) {
  double largest = 0;
  for (std::size_t r = 0; r < smoother.rows(); ++r) {
    largest = std::max(largest, std::abs(smoother.target(r)));
  }
  Errors errors;
  for (std::size_t r = 0; r < smoother.rows(); ++r) {
    const double second = parts.second[order[r]];
    const double y = smoother.target(r);
    if (reduction.kind == ReductionKind::additive) {
      errors.push_back(std::abs(y - (parts.first[r] + second - parts.both)));
    } else if (std::abs(y) >= kLeastProduct * largest && parts.both != 0) {
      errors.push_back(std::abs(y - parts.first[r] * second / parts.both));
    }
  }
  return errors;
}

// Sets the error; true where it is small and the permuted controls are all worse, as far as there
// is time to see.
bool is_accepted(const Smoother& smoother, Reduction& reduction, RandomStream& random,
                 Budget& budget,
                 const std::function<Errors(std::span<const std::size_t>)>& errors) {
  if (!budget.in_time()) return false;
  std::vector<std::size_t> order(smoother.rows());
  for (std::size_t r = 0; r < order.size(); ++r) order[r] = r;
  Errors own = errors(order);
  if (own.size() < smoother.rows() / 4) return false;
  reduction.error = upper_median(std::move(own));
  if (!(reduction.error <= kErrorFactor * smoother.held_out_error())) return false;
  for (int p = 0; p < kPermutations; ++p) {
    random.shuffle(std::span(order));
    if (!budget.in_time()) return false;
    if (upper_median(errors(order)) <= reduction.error) return false;
  }
  return true;
}

std::vector<Reduction> separabilities(const std::vector<Group>& groups,
                                      const OperatorSet& allowed) {
  std::vector<Reduction> candidates;
  if (groups.size() < 2 || groups.size() > 8) return candidates;
  // Every split into two non-empty parts once: the last group always stays in the rest.
  for (std::uint32_t mask = 1; mask < (1U << (groups.size() - 1)); ++mask) {
    Reduction reduction;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if ((mask >> g & 1U) == 0) continue;
      reduction.part.insert(reduction.part.end(), groups[g].begin(), groups[g].end());
    }
    for (const auto& [kind, op] : {std::pair{ReductionKind::additive, Op::add},
                                   std::pair{ReductionKind::multiplicative, Op::mul}}) {
      if (!allowed.allows(op)) continue;
      reduction.kind = kind;
      candidates.push_back(reduction);
    }
  }
  return candidates;
}

std::vector<Reduction> symmetries(const std::vector<Group>& groups, const OperatorSet& allowed) {
  std::vector<Reduction> candidates;
  for (std::size_t a = 0; a < groups.size(); ++a) {
    for (std::size_t b = a + 1; b < groups.size(); ++b) {
      if (groups[a].size() > 1 || groups[b].size() > 1) continue;
      for (const auto& [kind, op] :
           {std::pair{ReductionKind::difference, Op::sub}, std::pair{ReductionKind::sum, Op::add},
            std::pair{ReductionKind::ratio, Op::div}, std::pair{ReductionKind::product, Op::mul}}) {
        if (allowed.allows(op)) candidates.push_back({kind, 0, groups[a][0], groups[b][0], {}});
      }
    }
  }
  return candidates;
}

Op operation_of(ReductionKind kind) {
  switch (kind) {
    case ReductionKind::difference:
      return Op::sub;
    case ReductionKind::ratio:
      return Op::div;
    case ReductionKind::product:
    case ReductionKind::multiplicative:
      return Op::mul;
    default:
      return Op::add;
  }
}

bool is_symmetry(ReductionKind kind) {
  return kind != ReductionKind::additive && kind != ReductionKind::multiplicative;
}

double combined(Op op, double a, double b) {
  switch (op) {
    case Op::sub:
      return a - b;
    case Op::div:
      return a / b;
    case Op::mul:
      return a * b;
    default:
      return a + b;
  }
}

// One variable, first op second, takes the place of two; the target stays the measured one.
Subproblem symmetric_subproblem(const Reduction& reduction, const TrainingData& data) {
  const Op op = operation_of(reduction.kind);
  Subproblem sub;
  sub.target.assign(data.target.begin(), data.target.end());
  std::vector<double> joint;
  for (std::size_t r = 0; r < data.rows(); ++r) {
    joint.push_back(
        combined(op, data.columns[reduction.first][r], data.columns[reduction.second][r]));
  }
  const auto [low, high] = std::ranges::minmax(joint);
  sub.inputs.push_back({"z", "-", Role::none, low, high, std::nullopt});
  sub.columns.push_back(std::move(joint));
  sub.substitutes.push_back(Expression::binary(op, Expression::variable(reduction.first),
                                               Expression::variable(reduction.second)));
  for (std::size_t j = 0; j < data.inputs.size(); ++j) {
    if (j == reduction.first || j == reduction.second) continue;
    sub.inputs.push_back(data.inputs[j]);
    sub.inputs.back().sign_of = std::nullopt;
    sub.columns.emplace_back(data.columns[j], data.columns[j] + data.rows());
    sub.substitutes.push_back(Expression::variable(j));
  }
  return sub;
}

Subproblem separable_subproblem(const std::vector<std::size_t>& part, std::vector<double> target,
                                const Smoother& smoother, const TrainingData& data) {
  Subproblem sub;
  sub.target = std::move(target);
  for (const std::size_t j : part) {
    Input input = data.inputs[j];
    if (input.sign_of) {
      const auto place = std::ranges::find(part, *input.sign_of);
      input.sign_of = static_cast<std::size_t>(place - part.begin());
    }
    sub.inputs.push_back(input);
    std::vector<double> column;
    for (std::size_t r = 0; r < smoother.rows(); ++r) {
      column.push_back(smoother.point(r)[static_cast<Eigen::Index>(j)]);
    }
    sub.columns.push_back(std::move(column));
    sub.substitutes.push_back(Expression::variable(j));
  }
  return sub;
}

}  // namespace

std::optional<Reduction> find_reduction(const Smoother& smoother, std::span<const Input> inputs,
                                        const OperatorSet& allowed, RandomStream random,
                                        Budget& budget) {
  const std::vector<Group> groups = groups_of(inputs);
  std::optional<Reduction> best;
  const auto consider = [&best](const Reduction& reduction) {
    if (!best || reduction.error < best->error) best = reduction;
  };
  for (Reduction& reduction : symmetries(groups, allowed)) {
    if (is_accepted(smoother, reduction, random, budget, [&](std::span<const std::size_t> order) {
          return symmetry_errors(smoother, reduction, order);
        })) {
      consider(reduction);
    }
  }
  for (Reduction& reduction : separabilities(groups, allowed)) {
    if (!budget.in_time()) return std::nullopt;
    const Parts parts = part_values(smoother, reduction.part, inputs.size());
    if (is_accepted(smoother, reduction, random, budget, [&](std::span<const std::size_t> order) {
          return separability_errors(smoother, reduction, parts, order);
        })) {
      consider(reduction);
    }
  }
  return budget.in_time() ? best : std::nullopt;
}

std::vector<Subproblem> split(const Reduction& reduction, const Smoother& smoother,
                              const TrainingData& data) {
  if (is_symmetry(reduction.kind)) return {symmetric_subproblem(reduction, data)};
  Parts parts = part_values(smoother, reduction.part, data.inputs.size());
  // The reference value is counted once: by the first part of a sum, by the second of a product.
  for (double& value : parts.second) {
    if (reduction.kind == ReductionKind::additive) {
      value -= parts.both;
    } else {
      value /= parts.both;
    }
  }
  return {separable_subproblem(reduction.part, std::move(parts.first), smoother, data),
          separable_subproblem(complement(reduction.part, data.inputs.size()),
                               std::move(parts.second), smoother, data)};
}

Expression recombine(const Reduction& reduction, std::span<const Subproblem> parts,
                     std::span<const Expression> formulas) {
  if (is_symmetry(reduction.kind)) return build::substituted(formulas[0], parts[0].substitutes);
  return Expression::binary(operation_of(reduction.kind),
                            build::substituted(formulas[0], parts[0].substitutes),
                            build::substituted(formulas[1], parts[1].substitutes));
}

}  // namespace tribench::udsr
