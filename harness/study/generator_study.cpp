// SPDX-License-Identifier: MIT
#include "harness/study/generator_study.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "foundation/elementary.hpp"
#include "foundation/pivoted_qr.hpp"
#include "problems/kuka/campaign.hpp"
#include "problems/kuka/entries.hpp"

namespace tribench {
namespace {

constexpr double kTolerance = 0.10;

struct Expectation {
  const char* name;
  const char* unit;
  std::array<double, 2> synthetic;  // joints 2 and 4
  std::array<const char*, 2> paper;
};

// In the order in which `measure` gives its figures.
constexpr std::array kExpectations = {
    Expectation{"averaged set, symmetric", "N m", {0.764, 0.355}, {"0.737", "0.350"}},
    Expectation{
        "averaged set, asymmetric (linear branches)", "N m", {0.113, 0.089}, {"0.134", "0.093"}},
    Expectation{"averaged set, asymmetric Stribeck form", "N m", {0.037, 0.057}, {"-", "-"}},
    Expectation{
        "averaged set, true form (quartic)", "N m", {0.037, 0.057}, {"0.033-0.041", "0.058-0.074"}},
    Expectation{"fitted symmetric Fc", "N m", {8.663, 6.72}, {"8.629", "-"}},
    Expectation{"fitted symmetric Fv", "N m s/rad", {14.42, 11.16}, {"14.44", "-"}},
    Expectation{"fitted positive branch Fc", "N m", {8.023, 6.43}, {"8.002", "-"}},
    Expectation{"fitted positive branch Fv", "N m s/rad", {14.07, 10.97}, {"14.10", "-"}},
    Expectation{"fitted negative branch Fc", "N m", {9.304, 7.01}, {"misprint", "-"}},
    Expectation{"fitted negative branch Fv", "N m s/rad", {14.78, 11.34}, {"misprint", "-"}},
    Expectation{"raw set with load, symmetric", "N m", {3.80, 0.953}, {"3.663", "0.914"}},
    Expectation{"raw set with load, asymmetric", "N m", {3.79, 0.913}, {"4.073", "1.068"}},
    Expectation{
        "raw set with load, true form", "N m", {1.013, 0.718}, {"1.025 / 1.294", "0.724 / 0.800"}}};

using Figures = std::array<double, kExpectations.size()>;

// Regressors of one row; the table's columns are qd, sgn_qd and, where there is load, g, sgn_g.
using Design = std::function<std::vector<double>(const Table&, std::size_t)>;

Eigen::MatrixXd design_matrix(const Table& table, const Design& design) {
  const std::size_t columns = design(table, 0).size();
  Eigen::MatrixXd matrix(table.rows(), columns);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const std::vector<double> row = design(table, r);
    for (std::size_t j = 0; j < columns; ++j) {
      matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(j)) = row[j];
    }
  }
  return matrix;
}

struct LinearFit {
  Eigen::VectorXd coefficients;
  double squares = 0;  // on the training rows
  double mae_test = 0;
};

LinearFit fit_and_judge(const Table& train, const Table& test, const Design& design) {
  const Eigen::MatrixXd matrix = design_matrix(train, design);
  const Eigen::Map<const Eigen::VectorXd> target(train.target.data(),
                                                 static_cast<Eigen::Index>(train.rows()));
  const Eigen::Map<const Eigen::VectorXd> judged(test.target.data(),
                                                 static_cast<Eigen::Index>(test.rows()));
  LinearFit fit;
  fit.coefficients = PivotedQr(matrix).solve(target);
  fit.squares = (matrix * fit.coefficients - target).squaredNorm();
  fit.mae_test = (design_matrix(test, design) * fit.coefficients - judged).cwiseAbs().mean();
  return fit;
}

std::vector<double> symmetric(const Table& table, std::size_t r) {
  return {table.columns[1][r], table.columns[0][r]};
}

// Regressors of one direction at a time: those of the other are 0.
std::vector<double> by_direction(double sign, std::vector<double> terms) {
  std::vector<double> row(2 * terms.size(), 0.0);
  for (std::size_t j = 0; j < terms.size(); ++j) {
    row[sign > 0 ? j : terms.size() + j] = sign * terms[j];
  }
  return row;
}

std::vector<double> asymmetric(const Table& table, std::size_t r) {
  return by_direction(table.columns[1][r], {1.0, std::abs(table.columns[0][r])});
}

std::vector<double> quartic(const Table& table, std::size_t r) {
  const double speed = std::abs(table.columns[0][r]);
  return by_direction(table.columns[1][r], {1.0, speed, elementary::pow(speed, 4)});
}

std::vector<double> true_form(const Table& table, std::size_t r) {
  std::vector<double> row = quartic(table, r);
  const double g = table.columns[2][r];
  row.push_back(table.columns[1][r] * std::abs(g));
  row.push_back(g);
  row.push_back(elementary::tanh(g / 0.5));
  return row;
}

// Least squares in the linear parameters over a grid of Stribeck velocities and exponents, the
// same for both directions.
double stribeck_error(const Table& table) {
  double least = std::numeric_limits<double>::infinity();
  double mae = 0;
  for (int i = 0; i <= 20; ++i) {
    const double stribeck_velocity = 0.1 * elementary::pow(15.0, i / 20.0);  // 0.1 .. 1.5 rad/s
    for (int j = 1; j <= 18; ++j) {
      const double exponent = 0.5 * j;
      const LinearFit fit = fit_and_judge(table, table, [&](const Table& rows, std::size_t r) {
        const double speed = std::abs(rows.columns[0][r]);
        return by_direction(
            rows.columns[1][r],
            {1.0, speed, elementary::exp(-elementary::pow(speed / stribeck_velocity, exponent))});
      });
      if (fit.squares < least) {
        least = fit.squares;
        mae = fit.mae_test;
      }
    }
  }
  return mae;
}

Table all_movements(const KnownDataset& data, const std::vector<Input>& inputs) {
  const std::vector<char> take(data.data.movement_names.size(), 1);
  return make_table(data, inputs, "tau_f", take);
}

Figures measure(int joint_number, std::uint64_t seed) {
  std::vector<ProblemEntry> entries;
  kuka::add_entries(entries);
  const auto problem_of = [&](const char* kind) {
    const std::string name = "A/j" + std::to_string(joint_number) + kind;
    for (const ProblemEntry& entry : entries) {
      if (entry.name == name) return entry.make(seed);
    }
    return Problem{};
  };
  const Problem loaded = problem_of("/load");
  const Table& train = loaded.stages.front().train;
  const kuka::Joint joint = kuka::make_joint(joint_number, seed);
  const Table averaged =
      all_movements(kuka::make_a_averaged(joint, seed), problem_of("/no_load").inputs);

  const LinearFit line = fit_and_judge(averaged, averaged, symmetric);
  const LinearFit branches = fit_and_judge(averaged, averaged, asymmetric);
  return {line.mae_test,
          branches.mae_test,
          stribeck_error(averaged),
          fit_and_judge(averaged, averaged, quartic).mae_test,
          line.coefficients[0],
          line.coefficients[1],
          branches.coefficients[0],
          branches.coefficients[1],
          branches.coefficients[2],
          branches.coefficients[3],
          fit_and_judge(train, loaded.test, symmetric).mae_test,
          fit_and_judge(train, loaded.test, asymmetric).mae_test,
          fit_and_judge(train, loaded.test, true_form).mae_test};
}

GeneratorFigure summarise(int joint, std::size_t k, const std::vector<Figures>& runs) {
  const Expectation& expectation = kExpectations[k];
  const std::size_t place = joint == 2 ? 0 : 1;
  GeneratorFigure figure{joint, expectation.name, expectation.unit, expectation.synthetic[place],
                         expectation.paper[place]};
  for (const Figures& run : runs) figure.mean += run[k];
  figure.mean /= static_cast<double>(runs.size());
  double squares = 0;
  for (const Figures& run : runs) squares += (run[k] - figure.mean) * (run[k] - figure.mean);
  if (runs.size() > 1) figure.spread = std::sqrt(squares / static_cast<double>(runs.size() - 1));
  figure.within = std::abs(figure.mean - figure.expected) <= kTolerance * figure.expected;
  return figure;
}

}  // namespace

std::vector<GeneratorFigure> run_generator_study(int seeds) {
  std::vector<GeneratorFigure> figures;
  for (const int joint : {2, 4}) {
    std::vector<Figures> runs;
    for (int seed = 1; seed <= seeds; ++seed) {
      runs.push_back(measure(joint, static_cast<std::uint64_t>(seed)));
    }
    for (std::size_t k = 0; k < kExpectations.size(); ++k) {
      figures.push_back(summarise(joint, k, runs));
    }
  }
  return figures;
}

}  // namespace tribench
