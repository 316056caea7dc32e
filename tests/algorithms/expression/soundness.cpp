// SPDX-License-Identifier: MIT
//
// No formula that was proved free may ever be caught: random points, and points chosen to catch it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/containment.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench::testing {
namespace {

const std::vector<std::string> kNames = {"v", "sgn_v", "g"};

double sign_of(double x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

class Points {
 public:
  explicit Points(const InputBox& box) : box_(box), columns_(box.size()) {}

  // A point moved into the box, with its sign set.
  void add(std::vector<double> point) {
    for (std::size_t j = 0; j < box_.size(); ++j) {
      if (!box_[j].sign_of) point[j] = std::clamp(point[j], box_[j].low, box_[j].high);
    }
    for (std::size_t j = 0; j < box_.size(); ++j) {
      columns_[j].push_back(box_[j].sign_of ? sign_of(point[*box_[j].sign_of]) : point[j]);
    }
  }
  std::size_t size() const { return columns_.front().size(); }
  std::vector<const double*> pointers() const {
    std::vector<const double*> all;
    for (const auto& column : columns_) all.push_back(column.data());
    return all;
  }
  std::vector<double> point(std::size_t i) const {
    std::vector<double> at;
    for (const auto& column : columns_) at.push_back(column[i]);
    return at;
  }

 private:
  const InputBox& box_;
  std::vector<std::vector<double>> columns_;
};

std::vector<double> random_point(RandomStream& random, const InputBox& box) {
  std::vector<double> point(box.size());
  for (std::size_t j = 0; j < box.size(); ++j) point[j] = random.uniform(box[j].low, box[j].high);
  return point;
}

// Newton's method on a subformula along one input, from a random start.
std::vector<double> newton(RandomStream& random, const InputBox& box, const Expression& node) {
  Evaluator evaluator;
  std::vector<double> point = random_point(random, box);
  const std::size_t axis = random.chance(0.5) ? 0 : 2;
  for (int step = 0; step < 12; ++step) {
    point[1] = sign_of(point[0]);
    const double at = evaluator.evaluate_at(node, point);
    std::vector<double> beside = point;
    const double h = 1e-7 * (1 + std::abs(point[axis]));
    beside[axis] += h;
    const double slope = (evaluator.evaluate_at(node, beside) - at) / h;
    const double next = point[axis] - at / slope;
    if (!std::isfinite(next) || next < box[axis].low || next > box[axis].high) break;
    point[axis] = next;
  }
  return point;
}

// A few doubles further along each input.
void step_aside(RandomStream& random, std::vector<double>& point) {
  for (double& x : point) {
    for (auto n = random.below(4); n > 0; --n) x = std::nextafter(x, random.sign() * 1e300);
  }
}

// Corners and the doubles beside them, tiny numbers, roots of what is divided by or rooted, and the
// doubles around those.
void add_adversarial(RandomStream& random, const Expression& formula, const InputBox& box,
                     int count, Points& points) {
  std::vector<Expression> critical;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const Op op = formula.node(i).op;
    if (op == Op::div || op == Op::log || op == Op::sqrt)
      critical.push_back(subtree(formula, i - 1));
    if (op == Op::pow) critical.push_back(subtree(formula, formula.left_child(i)));
  }
  constexpr int kNeighbours = 8;
  for (int i = 0; i < count / kNeighbours; ++i) {
    std::vector<double> point = random_point(random, box);
    if (i % 4 == 0) {
      for (std::size_t j = 0; j < box.size(); ++j) {
        point[j] = random.chance(0.5) ? box[j].low : box[j].high;
      }
    } else if (i % 4 == 1 || critical.empty()) {
      const double tiny = random.sign() * std::exp2(random.uniform(-1074, -1));
      point[random.chance(0.5) ? 0 : 2] = random.chance(0.3) ? 0 : tiny;
    } else {
      point = newton(random, box, critical[random.below(critical.size())]);
    }
    for (int neighbour = 0; neighbour < kNeighbours; ++neighbour) {
      points.add(point);
      step_aside(random, point);
    }
  }
}

void expect_finite(const Expression& formula, const Points& points) {
  const auto columns = points.pointers();
  std::vector<double> values(points.size());
  Evaluator evaluator;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (arity(formula.node(i).op) == 0) continue;
    evaluator.evaluate(subtree(formula, i), {columns, points.size()}, values);
    const auto bad =
        std::find_if(values.begin(), values.end(), [](double y) { return !std::isfinite(y); });
    ASSERT_EQ(bad, values.end()) << print(formula, kNames) << " is proved free, but "
                                 << print(subtree(formula, i), kNames) << " is " << *bad
                                 << " at v = "
                                 << print_number(points.point(bad - values.begin())[0])
                                 << ", g = " << print_number(points.point(bad - values.begin())[2]);
  }
}

void expect_witness(const Expression& formula, const Witness& witness) {
  Evaluator evaluator;
  const Expression node = subtree(formula, witness.node);
  const double value = evaluator.evaluate_at(node, witness.point);
  if (witness.neighbour.empty()) {
    ASSERT_FALSE(std::isfinite(value)) << print(formula, kNames);
  } else {
    ASSERT_EQ(sign_of(value) * sign_of(evaluator.evaluate_at(node, witness.neighbour)), -1)
        << print(formula, kNames);
  }
}

}  // namespace

void expect_soundness(std::string_view key, const SoundnessTrials& trials) {
  RandomStream random(key_of(key));
  int proved = 0;
  int refuted = 0;
  int undecided = 0;
  for (int trial = 0; trial < trials.formulas; ++trial) {
    const Expression formula = random_formula(random, {.inputs = 3, .max_operations = 16});
    const double reach = random.uniform(0.5, 3);
    const InputBox box = {
        {-reach, reach}, {-1, 1, 0}, {random.uniform(-5, 1), random.uniform(1, 5)}};
    const SingularityResult result = prove_free(formula, box);
    if (result.verdict == Verdict::refuted) {
      ++refuted;
      ASSERT_NO_FATAL_FAILURE(expect_witness(formula, *result.witness));
    } else if (result.verdict == Verdict::undecided) {
      ++undecided;
    } else {
      ++proved;
      Points points(box);
      for (int i = 0; i < trials.random_points; ++i) points.add(random_point(random, box));
      add_adversarial(random, formula, box, trials.adversarial_points, points);
      ASSERT_NO_FATAL_FAILURE(expect_finite(formula, points));
    }
  }
  ::testing::Test::RecordProperty("proved_free", proved);
  ::testing::Test::RecordProperty("refuted", refuted);
  ::testing::Test::RecordProperty("undecided", undecided);
  std::printf("%d formulas: %d proved free, %d refuted, %d undecided\n", trials.formulas, proved,
              refuted, undecided);
  EXPECT_GT(proved, trials.formulas / 10);
  EXPECT_GT(refuted, trials.formulas / 10);
  EXPECT_LT(undecided, trials.formulas / 50);
}

}  // namespace tribench::testing
