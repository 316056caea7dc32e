// SPDX-License-Identifier: MIT
#include "harness/loop/noise_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/inference/bootstrap.hpp"
#include "algorithms/inference/score_test.hpp"
#include "algorithms/loop_model/smoothers.hpp"

namespace tribench::loop {
namespace {

constexpr int kFolds = 5;
constexpr std::size_t kFewestTriples = 100;
// Of the mean square of a column; the first makes the correction next to nothing.
constexpr std::array<double, 5> kPenalties = {10, 1, 0.1, 0.01, 0.001};

// Smooth features of every single input, of unit rms.
Eigen::MatrixXd features_of(const Observations& data, RandomStream random) {
  std::vector<Smoother> single = make_smoothers(data, random);
  std::erase_if(single, [](const Smoother& s) { return s.signals.size() != 1; });
  Eigen::MatrixXd all(static_cast<Eigen::Index>(data.rows()), 0);
  for (const Smoother& s : single) all = beside(all, with_direction(s, data));
  const double rows = std::sqrt(static_cast<double>(data.rows()));
  for (Eigen::Index j = 0; j < all.cols(); ++j) {
    const double norm = all.col(j).norm();
    if (norm > 0) all.col(j) *= rows / norm;
  }
  return all;
}

// Normal equations of the training rows of one fold.
struct Normal {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right;
  double squares = 0;
  double rows = 0;
};

Normal normal_of(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                 const std::vector<Eigen::Index>& rows) {
  const Eigen::MatrixXd part = x(rows, Eigen::all);
  const Eigen::VectorXd target = y(rows);
  Normal out{Eigen::MatrixXd::Zero(x.cols(), x.cols()), part.transpose() * target,
             target.squaredNorm(), static_cast<double>(rows.size())};
  out.gram.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
  out.gram = Eigen::MatrixXd(out.gram.selfadjointView<Eigen::Lower>());
  return out;
}

Eigen::VectorXd solve(const Normal& normal, double penalty) {
  Eigen::MatrixXd gram = normal.gram;
  gram.diagonal().array() += penalty * std::max(1.0, normal.rows);
  return solve_symmetric(gram, normal.right);
}

// Rows by fold: whole movements in turn.
std::vector<std::vector<Eigen::Index>> folds_of(const Observations& data,
                                                const std::vector<char>& train) {
  std::vector<std::vector<Eigen::Index>> folds(kFolds);
  std::size_t fold = 0;
  int movement = -1;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (train[i] == 0) continue;
    if (data.movement[i] != movement) {
      if (movement != -1) fold = (fold + 1) % kFolds;
      movement = data.movement[i];
    }
    folds[fold].push_back(static_cast<Eigen::Index>(i));
  }
  return folds;
}

// The penalty with the least squared error on folds left out; infinite where the best is none.
double best_penalty(const std::vector<Normal>& folds, const Normal& whole) {
  double best = whole.squares;
  double chosen = INFINITY;
  for (const double penalty : kPenalties) {
    double squares = 0;
    for (const Normal& fold : folds) {
      Normal rest = whole;
      rest.gram -= fold.gram;
      rest.right -= fold.right;
      rest.rows -= fold.rows;
      const Eigen::VectorXd beta = solve(rest, penalty);
      squares += fold.squares - 2 * beta.dot(fold.right) + beta.dot(fold.gram * beta);
    }
    if (squares >= best) continue;
    best = squares;
    chosen = penalty;
  }
  return chosen;
}

// Mean |second difference| / sqrt(6) of neighbouring rows, evenly spaced, of one movement.
double noise_floor(const Observations& data, const Eigen::VectorXd& residual) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < data.rows(); ++i) {
    if (data.movement[i - 1] != data.movement[i + 1]) continue;
    const double before = data.time[i] - data.time[i - 1];
    const double after = data.time[i + 1] - data.time[i];
    if (std::abs(after - before) > 0.5 * std::max(before, after)) continue;  // rows were left out
    const auto at = static_cast<Eigen::Index>(i);
    sum += std::abs(residual[at - 1] - 2 * residual[at] + residual[at + 1]);
    ++count;
  }
  return count < kFewestTriples ? std::nan("") : sum / static_cast<double>(count) / std::sqrt(6.0);
}

// Sums of absolute errors of a unit.
struct UnitErrors {
  double before = 0;
  double after = 0;
  double rows = 0;
};

std::vector<UnitErrors> unit_errors(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                    std::span<const int> unit) {
  std::vector<UnitErrors> all;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (i == 0 || unit[i] != unit[i - 1]) all.emplace_back();
    const auto at = static_cast<Eigen::Index>(i);
    all.back().before += std::abs(before[at]);
    all.back().after += std::abs(after[at]);
    all.back().rows += 1;
  }
  return all;
}

}  // namespace

Eigen::VectorXd smooth_correction(const Observations& data, const std::vector<char>& train,
                                  const Eigen::VectorXd& residual, RandomStream random) {
  const Eigen::MatrixXd x = features_of(data, random);
  Normal whole{Eigen::MatrixXd::Zero(x.cols(), x.cols()), Eigen::VectorXd::Zero(x.cols())};
  std::vector<Normal> folds;
  for (const std::vector<Eigen::Index>& rows : folds_of(data, train)) {
    if (rows.empty()) continue;
    folds.push_back(normal_of(x, residual, rows));
    whole.gram += folds.back().gram;
    whole.right += folds.back().right;
    whole.squares += folds.back().squares;
    whole.rows += folds.back().rows;
  }
  if (folds.size() < 2) return Eigen::VectorXd::Zero(residual.size());
  const double penalty = best_penalty(folds, whole);
  if (std::isinf(penalty)) return Eigen::VectorXd::Zero(residual.size());
  return x * solve(whole, penalty);
}

void bound_noise(ErrorFinding& error, const Observations& judged, const Eigen::VectorXd& before,
                 const Eigen::VectorXd& after, const Eigen::VectorXd& corrected,
                 std::span<const int> unit, RandomStream random) {
  error.attainable = std::min(corrected.cwiseAbs().mean(), error.mae_after);
  const double floor = noise_floor(judged, corrected);
  if (std::isnan(floor)) {
    error.ceiling_note = "too few neighbouring rows to tell the noise from what varies";
    return;
  }
  error.ceiling = std::min(floor, error.attainable);
  if (!(error.mae_before - error.attainable > 0)) {
    error.ceiling_note =
        "no smooth model of these inputs does better than the base: there is no gap";
    return;
  }
  const auto closed = [](double from, double to, double best) {
    return std::min(1.0, (from - to) / (from - best));
  };
  // An error that grew makes the larger gap the smaller loss.
  std::tie(error.closed_fraction, error.closed_fraction_high) =
      std::minmax({closed(error.mae_before, error.mae_after, error.ceiling),
                   closed(error.mae_before, error.mae_after, error.attainable)});
  const std::vector<UnitErrors> units = unit_errors(before, after, unit);
  std::tie(error.closed_low, error.closed_high) =
      bootstrap_interval(units.size(), random, [&](const std::vector<std::size_t>& drawn) {
        UnitErrors sum;
        for (const std::size_t k : drawn) {
          sum.before += units[k].before;
          sum.after += units[k].after;
          sum.rows += units[k].rows;
        }
        return closed(sum.before / sum.rows, sum.after / sum.rows, error.ceiling);
      });
}

}  // namespace tribench::loop
