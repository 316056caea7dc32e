// SPDX-License-Identifier: MIT
#include "harness/study/smoother_study.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/elementary.hpp"
#include "foundation/pivoted_qr.hpp"
#include "problems/joint_simulation/controlled_run.hpp"
#include "problems/preparation/motion_smoother.hpp"

namespace tribench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kEdge_s = 0.5;  // at either end, where every smoother is poor

struct EncodedRun {
  std::vector<double> time;
  std::vector<double> position;  // as the encoder has it
  std::vector<double> velocity;  // true
  std::vector<double> acceleration;
  std::vector<std::size_t> judged;  // rows in motion
  double step = 0;
};

EncodedRun encoded_run(const SmootherStudyOptions& options, int bits, double rate_hz, int run) {
  simulation::ControlledRunPlan plan;
  plan.rate_hz = rate_hz;
  plan.seconds = options.seconds;
  const simulation::ControlledRun truth =
      simulation::run_under_control(plan, options.first_seed + static_cast<std::uint64_t>(run));
  EncodedRun out;
  out.time = truth.data.find(Role::time)->values;
  out.velocity = truth.data.find(Role::velocity)->values;
  out.acceleration = truth.data.find(Role::acceleration)->values;
  out.step = 1 / rate_hz;
  const double count = kTurn / static_cast<double>(1ULL << bits);
  for (const double q : truth.data.find(Role::position)->values) {
    out.position.push_back((std::floor(q / count) + 0.5) * count);
  }
  const auto edge = static_cast<std::size_t>(kEdge_s * rate_hz);
  for (std::size_t i = edge; i + edge < out.time.size(); ++i) {
    if (truth.move[i] >= 0) out.judged.push_back(i);
  }
  return out;
}

// Sums of squares, so that several runs make one error.
struct Squares {
  double velocity = 0;
  double acceleration = 0;
  double rows = 0;

  void add(const EncodedRun& run, const std::vector<double>& derived_velocity,
           const std::vector<double>& derived_acceleration) {
    for (const std::size_t i : run.judged) {
      const double dv = derived_velocity[i] - run.velocity[i];
      const double da = derived_acceleration[i] - run.acceleration[i];
      velocity += dv * dv;
      acceleration += da * da;
    }
    rows += static_cast<double>(run.judged.size());
  }
  DerivativeErrors errors() const {
    return {std::sqrt(velocity / rows), std::sqrt(acceleration / rows)};
  }
};

struct Derivatives {
  std::vector<double> velocity;
  std::vector<double> acceleration;
};

// A cubic through 2 half + 1 neighbours, its slope and bend in the middle.
Derivatives savitzky_golay(const EncodedRun& run, int half) {
  Eigen::MatrixXd powers(2 * half + 1, 4);
  for (int k = -half; k <= half; ++k) {
    const double x = static_cast<double>(k) / half;
    powers.row(k + half) << 1, x, x * x, x * x * x;
  }
  const Eigen::MatrixXd weights =
      PivotedQr(powers).solve_each(Eigen::MatrixXd::Identity(2 * half + 1, 2 * half + 1));
  const double span = half * run.step;
  const std::size_t n = run.position.size();
  Derivatives out{std::vector<double>(n, 0), std::vector<double>(n, 0)};
  const auto width = static_cast<std::size_t>(half);
  for (std::size_t i = width; i + width < n; ++i) {
    const Eigen::Map<const Eigen::VectorXd> rows(&run.position[i - width], 2 * half + 1);
    out.velocity[i] = weights.row(1).dot(rows) / span;
    out.acceleration[i] = 2 * weights.row(2).dot(rows) / (span * span);
  }
  return out;
}

// The penalty's matrix: third differences, squared.
Eigen::SparseMatrix<double> roughness(Eigen::Index n) {
  constexpr std::array kThird = {-1.0, 3.0, -3.0, 1.0};
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i + 3 < n; ++i) {
    for (Eigen::Index k = 0; k < 4; ++k) {
      entries.emplace_back(i, i + k, kThird[static_cast<std::size_t>(k)]);
    }
  }
  Eigen::SparseMatrix<double> differences(n - 3, n);
  differences.setFromTriplets(entries.begin(), entries.end());
  return differences.transpose() * differences;
}

struct Spline {
  Derivatives derivatives;
  double score = 0;  // of generalised cross-validation
};

Spline smoothing_spline(const EncodedRun& run, const Eigen::SparseMatrix<double>& penalty,
                        double weight) {
  const Eigen::Index n = penalty.rows();
  const Eigen::Map<const Eigen::VectorXd> measured(run.position.data(), n);
  Eigen::SparseMatrix<double> system = weight * penalty;
  for (Eigen::Index i = 0; i < n; ++i) system.coeffRef(i, i) += 1;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  const Eigen::VectorXd smooth = solver.solve(measured);
  Spline out;
  out.derivatives = {std::vector<double>(run.position.size(), 0),
                     std::vector<double>(run.position.size(), 0)};
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    out.derivatives.velocity[row] = (smooth(i + 1) - smooth(i - 1)) / (2 * run.step);
    out.derivatives.acceleration[row] =
        (smooth(i + 1) - 2 * smooth(i) + smooth(i - 1)) / (run.step * run.step);
  }
  // The degrees of freedom, from the penalty's eigenvalues on a ring.
  double freedom = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double wave =
        2 - 2 * elementary::cos(std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
    freedom += 1 / (1 + weight * wave * wave * wave);
  }
  const double left = 1 - freedom / static_cast<double>(n);
  out.score = (smooth - measured).squaredNorm() / (left * left);
  return out;
}

void keep_best(DerivativeErrors& best, const DerivativeErrors& errors) {
  best.velocity = std::min(best.velocity, errors.velocity);
  best.acceleration = std::min(best.acceleration, errors.acceleration);
}

constexpr double kNone = std::numeric_limits<double>::infinity();

DerivativeErrors best_savitzky_golay(const std::vector<EncodedRun>& runs) {
  DerivativeErrors best{kNone, kNone};
  const auto widest = static_cast<int>(0.2 / runs.front().step);
  for (int half = 2; half <= widest; half = half * 13 / 10 + 1) {
    Squares squares;
    for (const EncodedRun& run : runs) {
      const Derivatives found = savitzky_golay(run, half);
      squares.add(run, found.velocity, found.acceleration);
    }
    keep_best(best, squares.errors());
  }
  return best;
}

void judge_splines(const std::vector<EncodedRun>& runs, SmootherFigure& figure) {
  figure.spline = {kNone, kNone};
  std::vector<Eigen::SparseMatrix<double>> penalties;
  for (const EncodedRun& run : runs) {
    penalties.push_back(roughness(static_cast<Eigen::Index>(run.position.size())));
  }
  double least = kNone;
  for (int power = 0; power <= 26; ++power) {  // half decades
    const double weight = elementary::exp(0.5 * power * std::numbers::ln10);
    Squares squares;
    double score = 0;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Spline spline = smoothing_spline(runs[r], penalties[r], weight);
      squares.add(runs[r], spline.derivatives.velocity, spline.derivatives.acceleration);
      score += spline.score;
    }
    keep_best(figure.spline, squares.errors());
    if (score >= least) continue;
    least = score;
    figure.validated_spline = squares.errors();
  }
}

DerivativeErrors kalman_errors(const std::vector<EncodedRun>& runs) {
  Squares squares;
  for (const EncodedRun& run : runs) {
    const std::vector<RowRange> whole = {{0, run.time.size()}};
    const Motion motion = MotionSmoother(run.time, run.position, whole).smoothed();
    squares.add(run, motion.velocity, motion.acceleration);
  }
  return squares.errors();
}

}  // namespace

std::vector<SmootherFigure> run_smoother_study(const SmootherStudyOptions& options) {
  std::vector<SmootherFigure> figures;
  for (const double rate_hz : options.rates_hz) {
    for (const int bits : options.bits) {
      std::vector<EncodedRun> runs;
      for (int run = 0; run < options.runs; ++run) {
        runs.push_back(encoded_run(options, bits, rate_hz, run));
      }
      SmootherFigure& figure = figures.emplace_back();
      figure.bits = bits;
      figure.rate_hz = rate_hz;
      figure.kalman = kalman_errors(runs);
      figure.savitzky_golay = best_savitzky_golay(runs);
      judge_splines(runs, figure);
    }
  }
  return figures;
}

}  // namespace tribench
