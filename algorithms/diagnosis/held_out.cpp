// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/fitting/symmetric_system.hpp"
#include "problems/preparation/canonical.hpp"

namespace tribench::loop {
namespace {

constexpr int kBootstraps = 2000;

// The strata of the split: movements in one direction or in both, by speed.
struct Kind {
  int movement;
  bool one_way;
  double speed;
};

std::vector<Kind> kinds(const Observations& data) {
  const Signal* v = data.find("v");
  std::vector<Kind> all;
  std::size_t i = 0;
  for (const int m : data.movements()) {
    double sum = 0;
    double magnitude = 0;
    const std::size_t begin = i;
    for (; i < data.rows() && data.movement[i] == m; ++i) {
      sum += v == nullptr ? 0 : v->values[i];
      magnitude += v == nullptr ? 0 : std::abs(v->values[i]);
    }
    const bool one_way = std::abs(sum) > 0.9 * magnitude;
    all.push_back({m, one_way, magnitude / static_cast<double>(i - begin)});
  }
  return all;
}

// Mean errors of runs of rows with equal numbers.
std::vector<MovementError> mean_errors(std::span<const int> run, const Eigen::VectorXd& before,
                                       const Eigen::VectorXd& after) {
  std::vector<MovementError> all;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i == 0 || run[i] != run[i - 1]) all.push_back({.movement = run[i]});
    const double one = before[static_cast<Eigen::Index>(i)];
    const double other = after[static_cast<Eigen::Index>(i)];
    all.back().before += std::abs(one);
    all.back().after += std::abs(other);
    all.back().mean_before += one;
    all.back().mean_after += other;
    ++all.back().rows;
  }
  for (MovementError& one : all) {
    const auto rows = static_cast<double>(one.rows);
    one.before /= rows;
    one.after /= rows;
    one.mean_before /= rows;
    one.mean_after /= rows;
  }
  return all;
}

double root_mean_square(const std::vector<MovementError>& all, double MovementError::*error) {
  double sum = 0;
  for (const MovementError& one : all) sum += one.*error * (one.*error);
  return std::sqrt(sum / static_cast<double>(all.size()));
}

}  // namespace

std::vector<int> choose_test_movements(const Observations& data, double share) {
  std::vector<Kind> all = kinds(canonical(data).data);
  const auto wanted =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(all.size())));
  if (share <= 0 || all.size() < 2) return {};
  std::ranges::stable_sort(all, [](const Kind& a, const Kind& b) {
    return a.one_way != b.one_way ? b.one_way
                                  : static_cast<float>(a.speed) < static_cast<float>(b.speed);
  });
  // The middle one of every run of neighbours, so that every speed is held out alike.
  const std::size_t count = std::max<std::size_t>(1, wanted);
  std::vector<int> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = all.size() * k / count;
    const std::size_t end = all.size() * (k + 1) / count;
    chosen.push_back(all[(begin + end) / 2].movement);
  }
  std::ranges::sort(chosen);
  return chosen;
}

Eigen::VectorXd rich_residual(const Observations& data, const std::vector<char>& train_rows,
                              const BaseModel& base, const std::vector<EffectFamily>& families,
                              const DiagnosisOptions& options) {
  constexpr double kRidge = 1e-4;
  constexpr std::size_t kAtomsOfRichModel = 4;
  std::vector<Expression> formulas = base.linear_terms;
  const std::vector<double> ratios =
      options.gear_ratios.empty() ? std::vector<double>{} : options.gear_ratios;
  for (std::size_t f = 0; f < families.size(); ++f) {
    std::vector<std::string> missing;
    std::vector<Atom> atoms = instantiate(families[f], f, data, ratios, missing);
    std::erase_if(atoms, [](const Atom& atom) { return atom.beside_another; });
    // Neighbours on a grid of shapes say nearly the same: some of them will do.
    const std::size_t step = (atoms.size() + kAtomsOfRichModel - 1) / kAtomsOfRichModel;
    for (std::size_t k = 0; k < atoms.size(); k += std::max<std::size_t>(1, step)) {
      formulas.insert(formulas.end(), atoms[k].columns.begin(), atoms[k].columns.end());
    }
  }
  Eigen::VectorXd y = target_vector(data);
  if (!base.formula.empty()) {
    LoopModel model;
    model.base.formula = base.formula;
    y -= predict(model, data);
  }
  Eigen::MatrixXd x = evaluate_columns(formulas, data);
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const double norm = x.col(j).norm();
    x.col(j) = norm > 0 && std::isfinite(norm) ? Eigen::VectorXd(x.col(j) / norm)
                                               : Eigen::VectorXd::Zero(x.rows());
  }
  std::vector<Eigen::Index> train;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (train_rows[i] != 0) train.push_back(static_cast<Eigen::Index>(i));
  }
  const Eigen::MatrixXd rows = x(train, Eigen::all);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  normal.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  Eigen::VectorXd right = rows.transpose() * y(train);
  const auto residual_of = [&] {
    Eigen::MatrixXd loaded = normal;
    loaded.diagonal().array() += kRidge * normal.trace() / static_cast<double>(normal.rows());
    return Eigen::VectorXd(y - x * solve_symmetric(loaded, right));
  };
  const Eigen::VectorXd residual = residual_of();
  // Huber's weights keep bursts from bending the model; few rows have one below 1.
  const double sd =
      std::sqrt(residual(train).squaredNorm() / std::max(1.0, static_cast<double>(train.size())));
  std::vector<Eigen::Index> wild;
  for (const Eigen::Index i : train) {
    if (std::abs(residual[i]) > 2 * sd) wild.push_back(i);
  }
  if (wild.empty()) return residual;
  const Eigen::VectorXd lost = 1 - 2 * sd / residual(wild).array().abs();
  const Eigen::MatrixXd wild_rows = lost.cwiseSqrt().asDiagonal() * x(wild, Eigen::all);
  normal.selfadjointView<Eigen::Lower>().rankUpdate(wild_rows.transpose(), -1.0);
  right -= wild_rows.transpose() * lost.cwiseSqrt().cwiseProduct(y(wild));
  return residual_of();
}

ErrorFinding judge(const Observations& data, const Eigen::VectorXd& before,
                   const Eigen::VectorXd& after, std::span<const int> unit, RandomStream random) {
  ErrorFinding out;
  if (data.rows() == 0) return out;
  const Eigen::VectorXd error_before = target_vector(data) - before;
  const Eigen::VectorXd error_after = target_vector(data) - after;
  const auto n = static_cast<double>(data.rows());
  out.mae_before = error_before.cwiseAbs().mean();
  out.mae_after = error_after.cwiseAbs().mean();
  out.rmse_before = error_before.norm() / std::sqrt(n);
  out.rmse_after = error_after.norm() / std::sqrt(n);
  out.max_before = error_before.cwiseAbs().maxCoeff();
  out.max_after = error_after.cwiseAbs().maxCoeff();
  out.movements = mean_errors(data.movement, error_before, error_after);
  out.test_movements = out.movements.size();
  out.means_before = root_mean_square(out.movements, &MovementError::mean_before);
  out.means_after = root_mean_square(out.movements, &MovementError::mean_after);
  const std::vector<MovementError> units = mean_errors(unit, error_before, error_after);
  std::vector<double> means;
  for (int b = 0; b < kBootstraps; ++b) {
    double sum = 0;
    for (std::size_t k = 0; k < units.size(); ++k) {
      const MovementError& drawn = units[random.below(units.size())];
      sum += drawn.before - drawn.after;
    }
    means.push_back(sum / static_cast<double>(units.size()));
  }
  std::ranges::sort(means);
  out.difference_low = means[kBootstraps / 40];
  out.difference_high = means[kBootstraps - 1 - kBootstraps / 40];
  return out;
}

}  // namespace tribench::loop
