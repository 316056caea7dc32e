// SPDX-License-Identifier: MIT
// The figures that the README states and that a change of the search or of the choice can lose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/text.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/registry.hpp"
#include "algorithms/udsr/pretraining.hpp"
#include "algorithms/udsr/weights.hpp"
#include "problems/catalogue.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"v", "s"};

std::vector<const double*> pointers(const Table& table) {
  std::vector<const double*> columns;
  for (const std::vector<double>& column : table.columns) columns.push_back(column.data());
  return columns;
}

double truth_error(const Expression& formula, const Table& table) {
  const std::vector<const double*> columns = pointers(table);
  std::vector<double> values(table.rows());
  Evaluator().evaluate(formula, {columns, table.rows()}, values);
  double sum = 0;
  for (std::size_t r = 0; r < values.size(); ++r) sum += std::abs(values[r] - table.truth[r]);
  return sum / static_cast<double>(values.size());
}

// Error of the chosen formula against the truth over that of the true law refitted to the same
// rows, for one seed.
double ratio_to_refitted_law(const std::string& name, std::uint64_t seed) {
  const Problem problem = Catalogue().find(name).make(seed);
  const Table& train = problem.stages[0].train;
  const std::vector<const double*> columns = pointers(train);
  const TrainingData data{problem.inputs, columns, train.target, train.movement};
  Budget budget({20'000'000'000, 30});
  FitContext context{data, find_operator_set("paper"), budget, RandomStream(900).split(seed)};
  const FitResult found = Registry().make("udsr", {})->fit(context);
  // The form of the law of the averaged curve (problems/friction/law.hpp).
  Expression law = parse("1*s + 1 + 1*v + 1*v*s + 1*v^4 + 1*v^4*s", kNames);
  ConstantFitter().fit(law, data.table(), train.target);
  return truth_error(found.front[found.chosen], problem.test) / truth_error(law, problem.test);
}

// Of the first `count` seeds, which is even.
double median_of_first(std::vector<double> ratios, std::size_t count) {
  ratios.resize(count);
  std::ranges::sort(ratios);
  return 0.5 * (ratios[count / 2 - 1] + ratios[count / 2]);
}

TEST(UdsrFigures, AveragedDatasetAIsFoundNearlyAsWellAsByTheTrueLawRefitted) {
  for (const char* name : {"A/j2/no_load", "A/j4/no_load"}) {
    std::vector<double> ratios;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      ratios.push_back(ratio_to_refitted_law(name, seed));
    }
    const double of_ten = median_of_first(ratios, 10);
    const double of_twenty = median_of_first(ratios, 20);
    std::printf("%s: median ratio of 10 seeds %.3f, of 20 %.3f\n", name, of_ten, of_twenty);
    EXPECT_LE(of_ten, 1.25) << name;
    EXPECT_LE(of_twenty, 1.25) << name;
  }
}

TEST(Pretraining, MakesTheShippedWeightsBitForBit) {
  const udsr::TokenLibrary library = udsr::pretraining_library();
  const udsr::PretrainingOptions options;
  udsr::Policy made(library, RandomStream(options.seed));
  const udsr::WeightsProvenance provenance = udsr::pretrain(made, nullptr, options, [](double) {});
  const std::string file = udsr::write_weights(made, nullptr, provenance);
  EXPECT_EQ(provenance.command, "tribench pretrain --seed 1 --sequences 20000");
  EXPECT_EQ(file.substr(0, 400), std::string(embedded::udsr_weights().substr(0, 400)));
  EXPECT_TRUE(file == embedded::udsr_weights());
}

}  // namespace
}  // namespace tribench
