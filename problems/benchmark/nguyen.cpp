// SPDX-License-Identifier: MIT
#include "problems/benchmark/nguyen.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/random.hpp"

namespace tribench::benchmark {
namespace {

constexpr int kTrainRows = 20;
constexpr int kTestRows = 100;

struct NguyenLaw {
  const char* formula;
  double low;
  double high;
  std::size_t inputs;
  double (*value)(double x, double y);
};

// Uy et al. 2011, table 1; ranges as in Petersen et al. 2021, table 6.
constexpr std::array<NguyenLaw, 12> kLaws = {{
    {"x^3 + x^2 + x", -1, 1, 1, [](double x, double) { return x * x * x + x * x + x; }},
    {"x^4 + x^3 + x^2 + x", -1, 1, 1,
     [](double x, double) { return (((x + 1) * x + 1) * x + 1) * x; }},
    {"x^5 + x^4 + x^3 + x^2 + x", -1, 1, 1,
     [](double x, double) { return ((((x + 1) * x + 1) * x + 1) * x + 1) * x; }},
    {"x^6 + x^5 + x^4 + x^3 + x^2 + x", -1, 1, 1,
     [](double x, double) { return (((((x + 1) * x + 1) * x + 1) * x + 1) * x + 1) * x; }},
    {"sin(x^2)*cos(x) - 1", -1, 1, 1,
     [](double x, double) { return elementary::sin(x * x) * elementary::cos(x) - 1; }},
    {"sin(x) + sin(x + x^2)", -1, 1, 1,
     [](double x, double) { return elementary::sin(x) + elementary::sin(x + x * x); }},
    {"log(x + 1) + log(x^2 + 1)", 0, 2, 1,
     [](double x, double) { return elementary::log(x + 1) + elementary::log(x * x + 1); }},
    {"sqrt(x)", 0, 4, 1, [](double x, double) { return std::sqrt(x); }},
    {"sin(x) + sin(y^2)", 0, 1, 2,
     [](double x, double y) { return elementary::sin(x) + elementary::sin(y * y); }},
    {"2*sin(x)*cos(y)", 0, 1, 2,
     [](double x, double y) { return 2 * elementary::sin(x) * elementary::cos(y); }},
    {"x^y", 0, 1, 2, [](double x, double y) { return elementary::pow(x, y); }},
    {"x^4 - x^3 + 0.5*y^2 - y", 0, 1, 2,
     [](double x, double y) { return x * x * x * x - x * x * x + 0.5 * y * y - y; }},
}};

Table draw(const NguyenLaw& law, int rows, RandomStream random) {
  Table table;
  table.columns.resize(law.inputs);
  for (int r = 0; r < rows; ++r) {
    double point[2] = {0, 0};
    for (std::size_t j = 0; j < law.inputs; ++j) {
      point[j] = random.uniform(law.low, law.high);
      table.columns[j].push_back(point[j]);
    }
    table.target.push_back(law.value(point[0], point[1]));
    table.movement.push_back(r);
  }
  table.truth = table.target;
  return table;
}

Problem make_nguyen(int number, std::uint64_t seed) {
  const NguyenLaw& law = kLaws[static_cast<std::size_t>(number - 1)];
  const RandomStream random = RandomStream(key_of(fmt::format("nguyen/{}", number))).split(seed);
  Problem problem;
  problem.name = fmt::format("nguyen/{}", number);
  problem.summary = law.formula;
  problem.dataset = "nguyen";
  // Moved in: GCC 12 sees an overlap that is none in assigning a literal (its bug 105329).
  problem.target = std::string("f");
  problem.target_unit = std::string("-");
  for (std::size_t j = 0; j < law.inputs; ++j) {
    problem.inputs.push_back({j == 0 ? "x" : "y", "-", Role::none, law.low, law.high, {}});
  }
  Stage stage;
  stage.name = "fit";
  for (std::size_t j = 0; j < law.inputs; ++j) stage.inputs.push_back(j);
  stage.train = draw(law, kTrainRows, random.split("train"));
  stage.law = law.formula;
  problem.stages.push_back(std::move(stage));
  problem.test = draw(law, kTestRows, random.split("test"));
  return problem;
}

}  // namespace

void add_nguyen_entries(std::vector<ProblemEntry>& entries) {
  for (int number = 1; number <= 12; ++number) {
    entries.push_back({fmt::format("nguyen/{}", number),
                       kLaws[static_cast<std::size_t>(number - 1)].formula,
                       [number](std::uint64_t seed) { return make_nguyen(number, seed); },
                       {}});
  }
}

}  // namespace tribench::benchmark
