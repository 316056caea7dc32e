// SPDX-License-Identifier: MIT
//
// What the proof engine says of a formula over a box is true: bounds hold the sampled values of
// every node, a formula proved free is finite at every sample, a certificate that is written is
// accepted, a limit that is proved is kept.
#include <cmath>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/certificate.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/property.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/fuzz/box_samples.hpp"
#include "tests/fuzz/formula_bytes.hpp"

namespace {

using namespace tribench;

constexpr std::size_t kSamples = 48;
constexpr std::size_t kMaxPieces = 200;
constexpr ProofLimits kLimits{20'000, 0};

struct Case {
  Expression formula;
  NamedBox box;
  std::vector<std::vector<double>> points;

  std::string text() const { return print(formula, box.names) + " over " + print_box(box); }
};

NamedBox box_from(fuzz::Decisions& decisions) {
  NamedBox box{{"x", "y", "z"}, {}};
  for (std::size_t j = 0; j < fuzz::kFormulaInputs; ++j) {
    const double a = decisions.finite_number();
    const double b = decisions.finite_number();
    box.ranges.push_back({std::min(a, b), std::max(a, b)});
  }
  return box;
}

// Every subformula's values lie in the bounds of its node.
// True where all nodes have bounds.
bool expect_bounds_hold(const Case& one, FormulaBounds& bounds, bool sharp) {
  std::vector<Interval> ranges;
  for (const InputRange& range : one.box.ranges) ranges.push_back({range.low, range.high});
  const bool all = sharp ? bounds.sharpen(ranges) : bounds.bound(ranges);
  const std::size_t valid = all ? one.formula.size() : bounds.failed_node();
  Evaluator evaluator;
  for (std::size_t i = 0; i < valid; ++i) {
    const Expression node = subtree(one.formula, i);
    for (const std::vector<double>& point : one.points) {
      const double value = evaluator.evaluate_at(node, point);
      fuzz::expect(bounds.at(i).range.contains(value), [&] {
        return std::string(sharp ? "sharpened" : "plain") + " bounds of node " + std::to_string(i) +
               " do not hold a value of " + one.text();
      });
    }
  }
  return all;
}

void expect_verdict_is_true(const Case& one) {
  const SingularityResult result = prove_free(one.formula, one.box.ranges, kLimits);
  if (result.verdict == Verdict::proved_free) {
    Evaluator evaluator;
    for (const std::vector<double>& point : one.points) {
      fuzz::expect(std::isfinite(evaluator.evaluate_at(one.formula, point)),
                   [&] { return "proved free, and is not: " + one.text(); });
    }
    const auto certificate = write_certificate(one.formula, one.box, kMaxPieces);
    if (certificate) {
      const CertificateCheck check = check_certificate(*certificate);
      fuzz::expect(check.accepted, [&] {
        return "its own certificate is rejected (" + check.reason + "): " + one.text();
      });
    }
  } else if (result.verdict == Verdict::refuted) {
    fuzz::expect(result.witness.has_value(),
                 [&] { return "refuted without a witness: " + one.text(); });
    const std::vector<double>& point = result.witness->point;
    for (std::size_t j = 0; j < point.size(); ++j) {
      fuzz::expect(one.box.ranges[j].low <= point[j] && point[j] <= one.box.ranges[j].high,
                   [&] { return "a witness outside the box: " + one.text(); });
    }
    if (result.witness->neighbour.empty()) {
      const Expression node = subtree(one.formula, result.witness->node);
      fuzz::expect(!std::isfinite(Evaluator().evaluate_at(node, point)),
                   [&] { return "a witness at which nothing is wrong: " + one.text(); });
    }
  }
}

// The claim is about the real value, which the computed one misses by the rounding error at most.
void expect_limit_is_kept(const Case& one, const FormulaBounds& bounds, double limit) {
  const PropertyQuestion question{Property::bounded, 0, limit, 0};
  const PropertyResult result = prove_property(one.formula, one.box.ranges, question, kLimits);
  if (result.verdict != Verdict::proved_free) return;
  const double rounding = bounds.rounding_error(one.formula.root());
  Evaluator evaluator;
  for (const std::vector<double>& point : one.points) {
    fuzz::expect(std::abs(evaluator.evaluate_at(one.formula, point)) <= limit + rounding, [&] {
      return "proved within " + print_number(limit) + ", and is not: " + one.text();
    });
  }
}

}  // namespace

TRIBENCH_FUZZ_TARGET(prove) {
  fuzz::Decisions decisions(input);
  Case one;
  one.box = box_from(decisions);
  const double limit = std::abs(decisions.finite_number());
  one.formula = fuzz::formula_from(decisions);
  one.points = fuzz::samples_of(one.box.ranges, kSamples);
  FormulaBounds bounds(one.formula);
  expect_bounds_hold(one, bounds, false);
  const bool is_sharp = expect_bounds_hold(one, bounds, true);
  expect_verdict_is_true(one);
  if (is_sharp) expect_limit_is_kept(one, bounds, limit);
}
