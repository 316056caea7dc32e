// SPDX-License-Identifier: MIT
#include "problems/benchmark/entries.hpp"

#include <fmt/format.h>

#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "foundation/sign.hpp"
#include "problems/reading/csv.hpp"
#include "problems/table.hpp"

namespace tribench::benchmark {
namespace {

constexpr double kFastest = 1.9;     // rad/s
constexpr double kLargestLoad = 60;  // N m
constexpr int kGridPoints = 2001;

struct PeerLaw {
  const char* name;
  const char* formula;
  bool load;
  int rows;
  double noise;
  double (*value)(double v, double s, double g);
};

constexpr PeerLaw kPeerLaws[] = {
    {"friction1d",
     "(3.66*v + 8.52*sgn_v - 0.44)*exp(-0.78*v^2 + 1.26*v*sgn_v + 0.02*v - 0.02*sgn_v)", false, 200,
     0.05,
     [](double v, double s, double) {
       return (3.66 * v + 8.52 * s - 0.44) *
              elementary::exp(-0.78 * v * v + 1.26 * v * s + 0.02 * v - 0.02 * s);
     }},
    {"load4d", "8*sgn_v*(1 + 0.012*g*sgn_g) + 12*v - 3*v^3/3.6 + 0.05*g*sgn_v*sgn_g", true, 5000,
     0.3,
     [](double v, double s, double g) {
       return 8 * s * (1 + 0.012 * std::abs(g)) + 12 * v - 3 * v * v * v / 3.6 +
              0.05 * s * std::abs(g);
     }},
};

void append(const PeerLaw& law, double v, double g, double noise, Table& table) {
  const double s = sign(v);
  table.columns[0].push_back(v);
  table.columns[1].push_back(s);
  if (law.load) {
    table.columns[2].push_back(g);
    table.columns[3].push_back(sign(g));
  }
  table.truth.push_back(law.value(v, s, g));
  table.target.push_back(table.truth.back() + noise);
  table.movement.push_back(static_cast<int>(table.movement.size()));
}

Table empty_table(const PeerLaw& law) {
  Table table;
  table.columns.resize(law.load ? 4 : 2);
  return table;
}

Table noisy_rows(const PeerLaw& law, RandomStream random) {
  Table table = empty_table(law);
  for (int i = 0; i < law.rows; ++i) {
    const double v = law.load ? random.uniform(-kFastest, kFastest)
                              : -kFastest + 2 * kFastest * i / (law.rows - 1);
    const double g = law.load ? random.uniform(-kLargestLoad, kLargestLoad) : 0;
    append(law, v, g, law.noise * random.normal(), table);
  }
  return table;
}

// The others' grid: v equally spaced without its zero, where the sign is 0; g sweeps.
Table test_grid(const PeerLaw& law) {
  constexpr double kTurn = 2 * 3.14159265358979323846;
  Table table = empty_table(law);
  for (int k = 0; k < kGridPoints; ++k) {
    const double v = -kFastest + 2 * kFastest * k / (kGridPoints - 1);
    if (2 * k == kGridPoints - 1) continue;
    append(law, v, kLargestLoad * elementary::sin(kTurn * 37 * k / kGridPoints + 0.3), 0, table);
  }
  return table;
}

Table rows_of_file(const PeerLaw& law, const std::optional<std::filesystem::path>& data) {
  const std::string file = fmt::format("peer_problems/{}_train.csv", law.name);
  if (!data || !std::filesystem::exists(*data / file)) {
    throw_bad_input(fmt::format("the rows of peer_problems/{} are not there", law.name), file,
                    "name the folder that holds peer_problems with --data or TRIBENCH_DATA");
  }
  const Dataset rows = read_csv(*data / file).data;
  const std::vector<double>& v = rows.at("v").values;
  const std::vector<double>& y = rows.at("y").values;
  Table table = empty_table(law);
  for (std::size_t r = 0; r < rows.rows(); ++r) {
    append(law, v[r], law.load ? rows.at("g").values[r] : 0, 0, table);
    table.target.back() = y[r];
  }
  return table;
}

Problem make_peer(const PeerLaw& law, std::string name, Table train) {
  Problem problem;
  problem.name = std::move(name);
  problem.summary = law.formula;
  problem.dataset = std::string("peer");
  problem.load = law.load;
  problem.target = std::string("y");
  problem.target_unit = std::string("N m");
  problem.inputs = {{"v", "rad/s", Role::velocity, -kFastest, kFastest, {}},
                    {"sgn_v", "-", Role::velocity_sign, -1, 1, {}}};
  if (law.load) {
    problem.inputs.push_back({"g", "N m", Role::gravity_torque, -kLargestLoad, kLargestLoad, {}});
    problem.inputs.push_back({"sgn_g", "-", Role::gravity_sign, -1, 1, {}});
  }
  link_signs(problem.inputs);
  Stage stage;
  stage.name = "fit";
  for (std::size_t j = 0; j < problem.inputs.size(); ++j) stage.inputs.push_back(j);
  stage.train = std::move(train);
  stage.law = law.formula;
  problem.stages.push_back(std::move(stage));
  problem.test = test_grid(law);
  return problem;
}

}  // namespace

void add_entries(std::vector<ProblemEntry>& entries,
                 const std::optional<std::filesystem::path>& data) {
  for (const PeerLaw& law : kPeerLaws) {
    const std::string own = fmt::format("peer/{}", law.name);
    const RandomStream random(key_of(own));
    const auto make_own = [&law, own, random](std::uint64_t seed) {
      return make_peer(law, own, noisy_rows(law, random.split(seed)));
    };
    entries.push_back({own, law.formula, make_own, {}});
    const std::string given = fmt::format("peer_problems/{}", law.name);
    const auto make_given = [&law, given, data](std::uint64_t) {
      return make_peer(law, given, rows_of_file(law, data));
    };
    entries.push_back(
        {given, fmt::format("{}, with the rows other programs were given", own), make_given, {}});
  }
}

}  // namespace tribench::benchmark
