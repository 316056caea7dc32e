// SPDX-License-Identifier: MIT
#include "algorithms/expression/canonical.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/expression/bounds.hpp"
#include "algorithms/expression/complexity.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/expression/simplify.hpp"
#include "algorithms/expression/singularity.hpp"
#include "algorithms/expression/text.hpp"
#include "tests/algorithms/expression/proof_formulas.hpp"

namespace tribench::canonical_test {
namespace {

const std::vector<std::string> kNames = {"v", "g", "t"};

Expression formula_of(const std::string& text) { return parse(text, kNames); }
std::string canonical_text(const std::string& text) {
  return print(Canonicalizer().canonical(formula_of(text)), kNames);
}

TEST(Canonical, GivesEqualFormulasOneHash) {
  const std::vector<std::pair<std::string, std::string>> equal = {
      {"v + g", "g + v"},
      {"v*g*t", "t*(g*v)"},
      {"v - v", "0"},
      {"2*v + 3*v", "5*v"},
      {"v*v", "v^2"},
      {"v^2*v", "v^3"},
      {"(v*g)^2", "g^2*v^2"},
      {"-(-v)", "v"},
      {"v - (g - t)", "t - g + v"},
      {"2*(v + 1)", "2 + v*2"},
      {"(v - g)^2", "(g - v)^2"},
      {"(v - g)*(t - v)", "(g - v)*(v - t)"},
      {"sin(-v)", "-sin(v)"},
      {"cos(g - v)", "cos(v - g)"},
      {"abs(-2*v)", "2*abs(v)"},
      {"abs(abs(v))", "abs(v)"},
      {"sgn(v)*sgn(v)*sgn(v)", "sgn(v)"},
      {"v/2", "0.5*v"},
      {"v/g/t", "v/(t*g)"},
      {"1/v^2", "v^-2"},
      {"exp(1 + v)", "exp(v + 1)"},
      {"3*4 + v", "v + 12"},
      {"0*v + g", "g"},
      {"v*(-g)", "-(v*g)"},
      {"exp(-(v - g))", "exp(g - v)"},
      {"1/v + 1/v", "2/v"},
      {"2*v*(3*g)", "6*g*v"},
      {"tanh(2 - v)*tanh(v - 2)", "-tanh(v - 2)^2"},
  };
  for (const auto& [a, b] : equal) {
    EXPECT_EQ(Canonicalizer().hash(formula_of(a)), Canonicalizer().hash(formula_of(b)))
        << a << " -> " << canonical_text(a) << "   " << b << " -> " << canonical_text(b);
  }
}

TEST(Canonical, KeepsWhatMayBeSingular) {
  const std::vector<std::pair<std::string, std::string>> different = {
      {"v/v", "1"},       {"1/v - 1/v", "0"},       {"0/v", "0"},
      {"0*log(v)", "0"},  {"log(v) - log(v)", "0"}, {"log(v)^0", "1"},
      {"v^2/v", "v"},     {"sqrt(v)^2", "v"},       {"exp(log(v))", "v"},
      {"1/(1/v)", "v"},   {"sqrt(v^2)", "v"},       {"exp(v) - exp(v)", "0"},
      {"v - g", "g - v"}, {"v^3", "v^2"},           {"v/g", "g/v"},
      {"1/0", "1"},
  };
  for (const auto& [a, b] : different) {
    EXPECT_NE(Canonicalizer().hash(formula_of(a)).exact, Canonicalizer().hash(formula_of(b)).exact)
        << a << " -> " << canonical_text(a) << "   " << b << " -> " << canonical_text(b);
  }
}

TEST(Canonical, HasAShapeThatForgetsConstants) {
  const auto shape = [](const std::string& text) {
    return Canonicalizer().hash(formula_of(text)).shape;
  };
  EXPECT_EQ(shape("2*v + 3*g"), shape("0.5*g + 7*v"));
  EXPECT_EQ(shape("exp(-3*v) + 1"), shape("exp(2.5*v) - 4"));
  EXPECT_EQ(shape("2*v + 3*v + g"), shape("5*v + g"));
  EXPECT_NE(shape("2*v + 3*g"), shape("2*v*g"));
  EXPECT_NE(shape("v^2"), shape("v^3"));
  EXPECT_NE(shape("2*v"), shape("2*v + 1"));
}

TEST(Canonical, PrintsWhatOneWouldWrite) {
  EXPECT_EQ(canonical_text("v + 2*v - g*3 + 1 - 4"), "3*v - 3*g - 3");
  EXPECT_EQ(canonical_text("v*v*v/g/g"), "v^3/g^2");
  EXPECT_EQ(canonical_text("-(v*g)"), "-(v*g)");
  EXPECT_EQ(canonical_text("1/v"), "1/v");
  EXPECT_EQ(canonical_text("v - v"), "0");
}

// Small whole numbers, so that sums are exact and 0/0 is met where it can be.
TEST(Canonical, NeitherHidesNorMakesASingularityOnAGridOfWholeNumbers) {
  RandomStream random(key_of("canonical grid"));
  Evaluator evaluator;
  Canonicalizer canonicalizer;
  int singular = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression f = testing::random_formula(random, {.inputs = 2, .whole_constants = true});
    const Expression c = canonicalizer.canonical(f);
    for (double v = -2; v <= 2; ++v) {
      for (double g = -1; g <= 2; ++g) {
        const std::vector<double> point = {v, g};
        const bool before = testing::is_finite_throughout(evaluator, f, point);
        const bool after = testing::is_finite_throughout(evaluator, c, point);
        const double a = evaluator.evaluate_at(f, point);
        // Powers of powers overflow in an order of their own.
        if (!before && std::abs(a) > 1e100 && testing::overflows(evaluator, f, point)) continue;
        if (!after && testing::overflows(evaluator, c, point)) continue;
        ASSERT_EQ(before, after) << print(f, kNames) << "\n"
                                 << print(c, kNames) << "\n"
                                 << v << " " << g;
        singular += before ? 0 : 1;
      }
    }
  }
  EXPECT_GT(singular, 1000);
}

TEST(Canonical, ChangesValuesByRoundingOnly) {
  RandomStream random(key_of("canonical values"));
  Evaluator evaluator;
  Canonicalizer canonicalizer;
  int compared = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression f = testing::random_formula(random, {.inputs = 3});
    const Expression c = canonicalizer.canonical(f);
    std::vector<double> point(3);
    std::vector<Interval> box(3);
    for (std::size_t j = 0; j < 3; ++j) {
      point[j] = random.uniform(-3, 3);
      box[j] = {point[j], std::nextafter(point[j], 10)};
    }
    FormulaBounds before(f);
    FormulaBounds after(c);
    if (columns_used(f) == 0 || !before.sharpen(box) || !after.sharpen(box)) continue;
    const double a = evaluator.evaluate_at(f, point);
    const double b = evaluator.evaluate_at(c, point);
    // Folding constants rounds too: allow a few times the evaluations' own error bounds.
    const double allowed = 4 * (before.rounding_error(f.root()) + after.rounding_error(c.root()));
    ASSERT_LE(std::abs(a - b), allowed + 1e-14 * std::abs(a)) << print(f, kNames) << "\n"
                                                              << print(c, kNames);
    ++compared;
  }
  EXPECT_GT(compared, 8000);
}

TEST(Canonical, IsItsOwnCanonicalForm) {
  RandomStream random(key_of("canonical twice"));
  Canonicalizer canonicalizer;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression f = testing::random_formula(random, {.inputs = 3});
    const Expression once = canonicalizer.canonical(f);
    const CanonicalHash hash = canonicalizer.hash(f);
    const bool keeps_zero =
        std::any_of(once.nodes().begin(), once.nodes().end(),
                    [](const Node& n) { return n.is_constant() && n.value == 0; });
    if (keeps_zero && once.size() > 1) continue;  // 0 times what may be singular, in many guises
    ASSERT_EQ(canonicalizer.hash(once).shape, hash.shape)
        << print(f, kNames) << "\n"
        << print(once, kNames) << "\n"
        << print(canonicalizer.canonical(once), kNames);
  }
}

TEST(Canonical, TellsDifferentRandomFormulasApart) {
  RandomStream random(key_of("canonical apart"));
  Canonicalizer canonicalizer;
  std::map<std::uint64_t, std::string> hashes;
  std::set<std::string> texts;
  for (int trial = 0; trial < 20000; ++trial) {
    const Expression f = testing::random_formula(random, {.inputs = 3});
    const std::string text = print(canonicalizer.canonical(f), kNames);
    texts.insert(text);
    EXPECT_EQ(hashes.emplace(canonicalizer.hash(f).exact, text).first->second, text);
  }
  EXPECT_EQ(hashes.size(), texts.size());
}

// What is not finite by itself stays; a gap that x/x leaves in a finite formula is closed.
TEST(Simplify, RemovesWhatTheBoxProvesRemovable) {
  const InputBox away = {{1, 2}, {-60, 60}, {0, 1}};
  const InputBox across = {{-1, 2}, {-60, 60}, {0, 1}};
  const auto text = [](const std::string& formula, const InputBox& box) {
    return print(simplify(formula_of(formula), box), kNames);
  };
  EXPECT_EQ(text("v/v", away), "1");
  EXPECT_EQ(text("v/v", across), "1");
  EXPECT_EQ(text("log(v)/log(v)", across), "log(v)/log(v)");
  EXPECT_EQ(text("g/v", across), "g/v");
  EXPECT_EQ(text("v^3*g/v", away), "v^2*g");
  EXPECT_EQ(text("log(v) - log(v)", away), "0");
  EXPECT_EQ(text("log(v) - log(v)", across), "log(v)*0");
  EXPECT_EQ(text("exp(v) - exp(v) + g", across), "g");
  EXPECT_EQ(text("0/(1 + v^2) + 2*g + g", across), "3*g");
}

// Found on fronts of the three methods, as they were printed.
TEST(Simplify, FindsTheShortForm) {
  const InputBox box = {{0.5, 5}, {0.5, 5}, {0.5, 5}};  // v, g, t
  const std::pair<const char*, const char*> forms[] = {
      {"1*(v*g)", "v*g"},
      {"v/g - 0", "v/g"},
      {"v*g/tanh(3.5e-09*t^2)*31.4", "8971428571.428572*v*g/t^2"},
      {"-2*v/v*(cos(g*t*1)*v*1 - v*1)", "v*(2 - 2*cos(g*t))"},
      {"v*g + v*t", "v*(g + t)"},
      {"2*v + 2*g", "2*(v + g)"},
      {"v/(g*t) + 1/g", "(1 + v/t)/g"},
      {"exp(log(v))", "v"},
      {"exp(v)*exp(g)", "exp(v + g)"},
      {"exp(v + 2)*3", "22.16716829679195*exp(v)"},
      {"log(exp(v*g))", "v*g"},
      {"abs(v)*g", "v*g"},
      {"sqrt(v^2*g)", "v*sqrt(g)"},
      {"sqrt(v)*sqrt(v)", "v"},
      {"v*(g + 1) - v", "v*g"},
      {"sin(1e-8*v)", "1e-08*v"},
      {"cos(1e-8*v) + g", "g + 1"},
      {"exp(1e-14*v)*g", "g"},
      {"v + 1e-15*g", "v"},
      {"tanh(v + 20)*g", "g"},
      {"v^1.5*g^1.5/t^1.5/((v + g)/t + 1)^1.5", "(v*g/(v + g + t))^1.5"},
      {"v^0.3*(g/t)^0.3", "(v*g/t)^0.3"},
      {"g*exp(v - 0.2*t^-8e-14)", "g*exp(v - 0.2)"},
      {"v^2*t/(g^2*3)", "t*(v/g)^2/3"},
      {"t/v^2/g^2", "t/(v*g)^2"},
      {"t + 1/v^2 - g*(2/v - g)", "t + (1/v - g)^2"},
      {"exp(-0.5*v^2/t^2 + g*(v - 0.5*g)/t^2)", "exp(-0.5*((v - g)/t)^2)"},
      {"0.4*exp(-0.5*v^2/t^2 + g*(v - 0.5*g)/t^2)/t", "0.4*exp(-0.5*((v - g)/t)^2)/t"},
      {"sqrt(exp(t) + 1/v^2/g^2 - t*(2/g - v^2*t))", "sqrt(exp(t) + (v*t - 1/(v*g))^2)"},
      {"sqrt(t^2 + 1/v^2/g^2 - t*(2/g - v^2*t))", "sqrt(t^2 + (v*t - 1/(v*g))^2)"},
      {"t*exp(-2*v*(g - 1))*(exp(v*(g - 1)) - 1)^2", "t*(1 - exp(v*(1 - g)))^2"},
      {"g*sqrt(1/v)", "g/sqrt(v)"},
      {"sin(11*v + 1.5707963267948966)", "cos(11*v)"},
      {"sin(11*v + 20.420352248333657)", "cos(11*v)"},
      {"cos(v*g - 1.5707963267948966)", "sin(v*g)"},
      {"g + sin(v - 3.141592653589793)", "g - sin(v)"},
      {"cos(v + 4.71238898038469)", "sin(v)"},
      {"(3/v)^2.5", "15.588457268119896*v^-2.5"},
  };
  for (const auto& [formula, expected] : forms) {
    const Expression given = formula_of(formula);
    const Expression short_form = simplify(given, box);
    EXPECT_LE(paper_complexity(short_form), paper_complexity(formula_of(expected)))
        << formula << " -> " << print(short_form, kNames);
    EXPECT_EQ(simplify(short_form, box), short_form) << formula;
  }
  // Where the box does not prove it, nothing of the kind happens.
  const InputBox across = {{-5, 5}, {-5, 5}, {-5, 5}};
  for (const char* formula : {"abs(v)*g", "sin(v)", "exp(v)", "tanh(g)", "sqrt(v^2)*g + v*t",
                              "v^1.5*g^1.5", "sqrt(1/v)", "v^1e-15", "v^2 + g^2 + 2.0001*v*g"}) {
    EXPECT_GE(paper_complexity(simplify(formula_of(formula), across)),
              paper_complexity(formula_of(formula)) - 1)
        << formula;
  }
}

// As a search printed it: e^-344 and 1e150, of which nothing is left but their product.
TEST(Simplify, TakesTogetherNumbersThatOnlyUndoEachOther) {
  const InputBox box = {{-2, 2}, {-60, 60}, {0, 0, 0}};  // t is the sign of v
  const Expression formula =
      formula_of("(t*2.46e+150 + v*8.69e+149 - 1.77e+149)*exp(v*g - 344.14)");
  const Expression simple = simplify(formula, box);
  EXPECT_LT(paper_complexity(simple), paper_complexity(formula));
  for (const Node& node : simple.nodes()) {
    if (node.is_constant()) EXPECT_LT(std::abs(node.value), 100) << print(simple, kNames);
  }
  Evaluator evaluator;
  for (const double v : {-1.5, -0.2, 0.7}) {
    const std::vector<double> point = {v, 1.3, v < 0 ? -1.0 : 1.0};
    const double before = evaluator.evaluate_at(formula, point);
    EXPECT_NEAR(evaluator.evaluate_at(simple, point), before, 1e-12 * std::abs(before));
  }
  const Expression plain = formula_of("(2*v + 3*g)*exp(v*g)");
  EXPECT_EQ(paper_complexity(simplify(plain, box)), paper_complexity(plain));
  EXPECT_EQ(print(simplify(formula_of("-4*t*(0.5*exp(v) - 0.25)"), box), kNames),
            "t*(-2*exp(v) + 1)");
}

// As udsr printed it: e^-88 hidden behind the square of a sign.
TEST(Simplify, TakesTheSquareOfASignForOneBesideTheSign) {
  const InputBox box = {{-2, 2}, {-60, 60}, {0, 0, 0}};  // t is the sign of v
  const Expression formula = formula_of(
      "1.19e39*t*exp(t*(1.67*v + 0.0069*v^3 - t*(v*(0.85*v - 0.03) + 87.8) - 0.065)) - 0.05");
  const Expression simple = simplify(formula, box);
  EXPECT_LT(paper_complexity(simple), paper_complexity(formula)) << print(simple, kNames);
  for (const Node& node : simple.nodes()) {
    if (node.is_constant()) EXPECT_LT(std::abs(node.value), 1000) << print(simple, kNames);
  }
  Evaluator evaluator;
  for (const double v : {-1.5, -0.2, 0.0, 0.7}) {
    const std::vector<double> point = {v, 1.3, v < 0 ? -1.0 : v > 0 ? 1.0 : 0.0};
    const double before = evaluator.evaluate_at(formula, point);
    EXPECT_NEAR(evaluator.evaluate_at(simple, point), before, 1e-12 * (1 + std::abs(before)));
  }
  // Without the sign in front, its square is 0 at 0.
  const Expression alone = formula_of("exp(t*(v - t*g))");
  EXPECT_EQ(paper_complexity(simplify(alone, box)), paper_complexity(alone));
}

TEST(Simplify, UsesTheSignOfAnInput) {
  const InputBox box = {{-2, 2}, {-60, 60}, {0, 0, 0}};  // t is the sign of v
  const auto text = [&](const char* formula) {
    return print(simplify(formula_of(formula), box), kNames);
  };
  EXPECT_EQ(text("v*t*g"), "g*abs(v)");
  EXPECT_EQ(text("abs(v)*t"), "v");
  EXPECT_EQ(text("t*t*g"), "g*t^2");  // 0 at 0, so no 1
}

// Densities as a search has printed them: a singularity at 0 that only the way of writing has.
TEST(Simplify, ClosesGapsAtTheEdgeOfTheBox) {
  const InputBox box = {{0, 2}, {0, 2}, {0, 2}};
  const std::pair<const char*, const char*> forms[] = {
      {"1/(v/v + 0.5*(exp(v) + exp(-v)))", "1/(1 + 0.5*(exp(v) + exp(-v)))"},
      {"exp(-0.5/exp(v) - v*(0.25/v + 0.5))", "exp(-0.25 - 0.5*(v + exp(-v)))"},
      {"3*v^0.5*sqrt(v*exp(2*(v - exp(v))))/v", "3*exp(v - exp(v))"},
  };
  for (const auto& [formula, expected] : forms) {
    const Expression given = formula_of(formula);
    EXPECT_EQ(prove_free(given, box).verdict, Verdict::refuted) << formula;
    const Expression short_form = simplify(given, box);
    EXPECT_EQ(prove_free(short_form, box).verdict, Verdict::proved_free) << formula;
    EXPECT_LE(paper_complexity(short_form), paper_complexity(formula_of(expected)))
        << formula << " -> " << print(short_form, kNames);
  }
}

TEST(Simplify, KeepsValuesAndGivesItselfOnRandomFormulas) {
  RandomStream random(key_of("simplify values"));
  const InputBox box = {{-2, 2}, {-1, 3}, {0.5, 1}};
  Evaluator evaluator;
  for (int trial = 0; trial < 1000; ++trial) {
    const Expression f = testing::random_formula(random, {.inputs = 3});
    if (prove_free(f, box).verdict != Verdict::proved_free) continue;
    const Expression s = simplify(f, box);
    ASSERT_EQ(simplify(s, box), s) << print(f, kNames);
    FormulaBounds bounds(f);
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> point = {random.uniform(-2, 2), random.uniform(-1, 3),
                                         random.uniform(0.5, 1)};
      const double before = evaluator.evaluate_at(f, point);
      // Cancellation magnifies rounding: by the size of what cancels.
      double largest = 1;
      for (std::size_t node = 0; node < f.size(); ++node) {
        largest = std::max(largest, std::abs(evaluator.evaluate_at(subtree(f, node), point)));
      }
      ASSERT_NEAR(evaluator.evaluate_at(s, point), before, 1e-8 * largest * largest)
          << print(f, kNames) << " -> " << print(s, kNames);
    }
  }
}

TEST(Simplify, AsksBeforeItUsesAnOperation) {
  const InputBox box = {{-2, 2}, {-60, 60}, {0, 0, 0}};
  const OperatorSet& paper = find_operator_set("paper");
  const Expression formula = formula_of("v*t*g");
  EXPECT_EQ(simplify(formula, box, [&](const Expression& f) { return paper.admits(f); }), formula);
}

TEST(Simplify, NeverGrowsAndMakesNoVerdictWorse) {
  RandomStream random(key_of("simplify"));
  const InputBox box = {{-2, 2}, {-1, 3}, {0.5, 1}};
  int smaller = 0;
  int closed = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Expression f = testing::random_formula(random, {.inputs = 3});
    const Expression s = simplify(f, box);
    ASSERT_LE(paper_complexity(s), paper_complexity(f));
    const Verdict before = prove_free(f, box).verdict;
    const Verdict after = prove_free(s, box).verdict;
    ASSERT_TRUE(after == before || after == Verdict::proved_free) << print(f, kNames);
    smaller += s.size() < f.size() ? 1 : 0;
    closed += after == before ? 0 : 1;
  }
  EXPECT_GT(smaller, 100);
  EXPECT_GT(closed, 0);
  EXPECT_LT(closed, 100);
}

}  // namespace
}  // namespace tribench::canonical_test
