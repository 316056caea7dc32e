// SPDX-License-Identifier: MIT
#include "problems/preparation/motion_smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/elementary.hpp"

namespace tribench {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
// Rows that the bandwidth is chosen by: enough for two digits of it.
constexpr std::size_t kRowsOfTrial = 20'000;
constexpr double kLowestBandwidth = 0.3;  // Hz: slower than any motion of a joint
constexpr double kTakenAsTheyAre = 2;     // steps of time: from there on it follows every position
constexpr double kTrialStep = 1.6;
constexpr double kUnknown = 1e4;  // variance of the first state, in the filter's own units
constexpr double kNothingNew = std::numeric_limits<double>::infinity();  // of a variance
constexpr std::size_t kSlowest = 10;  // rows a count: an encoder's own error is not less
// The likelihood looks one row ahead; derivatives are best with a little less (docs/first_log.md).
constexpr double kCaution = 0.7;
constexpr int kRounds = 2;            // of learning where the jerk is
constexpr double kLeastShape = 0.05;  // of its mean: what a recording says of its jerk is little
constexpr double kSettled = 3;        // time constants from the ends of a piece
constexpr double kStill = 0.01;       // s: a count that stays for so long says where the motion is

// Symmetric 3x3: 00 01 02 11 12 22.
using Covariance = std::array<double, 6>;
using State = std::array<double, 3>;

struct Step {
  State predicted;
  Covariance predicted_covariance;
  State filtered;
  Covariance filtered_covariance;
};

// F P F' + Q for a step of dt, F the motion at constant acceleration, Q of white jerk.
Covariance predict(const Covariance& p, double dt, double jerk) {
  const double h = 0.5 * dt * dt;
  // A = F P, rows of F: (1, dt, h), (0, 1, dt), (0, 0, 1).
  const double a00 = p[0] + dt * p[1] + h * p[2];
  const double a01 = p[1] + dt * p[3] + h * p[4];
  const double a02 = p[2] + dt * p[4] + h * p[5];
  const double a11 = p[3] + dt * p[4];
  const double a12 = p[4] + dt * p[5];
  const double d2 = dt * dt;
  const double d3 = d2 * dt;
  return {a00 + dt * a01 + h * a02 + jerk * d3 * d2 / 20,
          a01 + dt * a02 + jerk * d2 * d2 / 8,
          a02 + jerk * d3 / 6,
          a11 + dt * a12 + jerk * d3 / 3,
          a12 + jerk * d2 / 2,
          p[5] + jerk * dt};
}

State move(const State& x, double dt) {
  return {x[0] + dt * x[1] + 0.5 * dt * dt * x[2], x[1] + dt * x[2], x[2]};
}

struct Likelihood {
  double squares = 0;  // of the innovations over their variance
  double log_variance = 0;
  double rows = 0;
};

// What the filter takes for granted, row by row.
struct Belief {
  Unstaired data;
  std::vector<double> shape;  // of the jerk's density through the recording; mean about 1
};

// jerk: spectral density in units of the position's variance, times the shape.
Likelihood run_forward(std::span<const double> time, const Belief& belief, const RowRange& piece,
                       double jerk, std::vector<Step>* steps) {
  const Unstaired& data = belief.data;
  Likelihood sum;
  const std::size_t n = piece.end - piece.begin;
  const double span = time[piece.end - 1] - time[piece.begin];
  const double typical = std::max(span / static_cast<double>(n), 1e-9);
  // Nothing is known of the first velocity and acceleration but that the filter can follow.
  const double square = elementary::pow(jerk / typical, 1.0 / 3);  // of the bandwidth in rad/s
  State x = {data.position[piece.begin], 0, 0};
  Covariance p = {kUnknown, 0, 0, kUnknown * square, 0, kUnknown * square * square};
  if (steps != nullptr) steps->resize(n);
  for (std::size_t i = piece.begin; i < piece.end; ++i) {
    if (i > piece.begin) {
      const double dt = time[i] - time[i - 1];
      x = move(x, dt);
      p = predict(p, dt, jerk * belief.shape[i]);
    }
    if (steps != nullptr) {
      (*steps)[i - piece.begin].predicted = x;
      (*steps)[i - piece.begin].predicted_covariance = p;
    }
    if (data.variance[i] == kNothingNew) {
      if (steps != nullptr) {
        (*steps)[i - piece.begin].filtered = x;
        (*steps)[i - piece.begin].filtered_covariance = p;
      }
      continue;
    }
    const double s = p[0] + data.variance[i];
    const double e = data.position[i] - x[0];
    // The first rows find the state: they say nothing of the bandwidth.
    if (i >= piece.begin + 10) {
      sum.squares += e * e / s;
      sum.log_variance += elementary::log(s);
      ++sum.rows;
    }
    const double k0 = p[0] / s;
    const double k1 = p[1] / s;
    const double k2 = p[2] / s;
    x = {x[0] + k0 * e, x[1] + k1 * e, x[2] + k2 * e};
    p = {p[0] - k0 * p[0], p[1] - k0 * p[1], p[2] - k0 * p[2],
         p[3] - k1 * p[1], p[4] - k1 * p[2], p[5] - k2 * p[2]};
    if (steps != nullptr) {
      (*steps)[i - piece.begin].filtered = x;
      (*steps)[i - piece.begin].filtered_covariance = p;
    }
  }
  return sum;
}

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix full(const Covariance& p) {
  return {{{p[0], p[1], p[2]}, {p[1], p[3], p[4]}, {p[2], p[4], p[5]}}};
}

// Inverse of a symmetric positive definite matrix by its adjugate, rows and columns scaled to 1.
Matrix inverse(const Covariance& p) {
  const State scale = {1 / std::sqrt(p[0]), 1 / std::sqrt(p[3]), 1 / std::sqrt(p[5])};
  const double a = p[1] * scale[0] * scale[1];
  const double b = p[2] * scale[0] * scale[2];
  const double c = p[4] * scale[1] * scale[2];
  const double det = std::max(1 + 2 * a * b * c - a * a - b * b - c * c, 1e-12);
  Matrix m = {{{1 - c * c, b * c - a, a * c - b},
               {b * c - a, 1 - b * b, a * b - c},
               {a * c - b, a * b - c, 1 - a * a}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) m[i][k] *= scale[i] * scale[k] / det;
  }
  return m;
}

// C = P_filtered F' P_predicted^-1.
Matrix gain(const Covariance& filtered, const Covariance& predicted, double dt) {
  const Matrix p = full(filtered);
  const double h = 0.5 * dt * dt;
  Matrix pf;
  for (std::size_t i = 0; i < 3; ++i) {
    pf[i] = {p[i][0] + dt * p[i][1] + h * p[i][2], p[i][1] + dt * p[i][2], p[i][2]};
  }
  const Matrix inv = inverse(predicted);
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += pf[i][k] * inv[k][j];
    }
  }
  return c;
}

// Variances of velocity and acceleration, summed over rows (in units of the position's).
struct Variances {
  double velocity = 0;
  double acceleration = 0;
  double rows = 0;
};

// Fills the motion's rows of a piece; adds the variances of those that are `margin` seconds from
// its ends: closer to them the motion is known far worse, and it is cut there.
void run_backward(std::span<const double> time, const RowRange& piece,
                  const std::vector<Step>& steps, double margin, Motion& out, Variances& sum) {
  const std::size_t n = steps.size();
  State x = steps.back().filtered;
  Matrix p = full(steps.back().filtered_covariance);
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) {
      const double dt = time[piece.begin + i + 1] - time[piece.begin + i];
      const Step& now = steps[i];
      const Step& next = steps[i + 1];
      const Matrix c = gain(now.filtered_covariance, next.predicted_covariance, dt);
      const State d = {x[0] - next.predicted[0], x[1] - next.predicted[1],
                       x[2] - next.predicted[2]};
      Matrix change = p;
      const Matrix pred = full(next.predicted_covariance);
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t k = 0; k < 3; ++k) change[r][k] -= pred[r][k];
      }
      p = full(now.filtered_covariance);
      for (std::size_t r = 0; r < 3; ++r) {
        x[r] = now.filtered[r] + c[r][0] * d[0] + c[r][1] * d[1] + c[r][2] * d[2];
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t l = 0; l < 3; ++l) {
            for (std::size_t m = 0; m < 3; ++m) p[r][k] += c[r][l] * change[l][m] * c[k][m];
          }
        }
      }
    }
    out.position[piece.begin + i] = x[0];
    out.velocity[piece.begin + i] = x[1];
    out.acceleration[piece.begin + i] = x[2];
    const double now = time[piece.begin + i];
    if (now - time[piece.begin] < margin || time[piece.end - 1] - now < margin) continue;
    sum.velocity += p[1][1];
    sum.acceleration += p[2][2];
    ++sum.rows;
  }
}

double typical_step(std::span<const double> time, std::span<const RowRange> pieces) {
  std::vector<double> steps;
  for (const RowRange& piece : pieces) {
    for (std::size_t i = piece.begin + 1; i < piece.end; ++i) {
      steps.push_back(time[i] - time[i - 1]);
    }
  }
  if (steps.empty()) return 1;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

// The spectral density of jerk at which the filter's bandwidth is `hertz`, the position's variance
// being 1 a row.
double jerk_of(double hertz, double dt) {
  const double square = kTwoPi * hertz * kTwoPi * hertz;
  return square * square * square * dt;
}

// Pieces for a trial: spread over the recording, about kRowsOfTrial rows in all.
std::vector<RowRange> trial_pieces(std::span<const RowRange> pieces) {
  std::size_t rows = 0;
  for (const RowRange& piece : pieces) rows += piece.end - piece.begin;
  constexpr std::size_t kLength = 2000;
  const std::size_t every = std::max<std::size_t>(1, rows / kRowsOfTrial);
  std::vector<RowRange> some;
  std::size_t number = 0;
  for (const RowRange& piece : pieces) {
    for (std::size_t begin = piece.begin; begin < piece.end; begin += kLength) {
      const std::size_t end = std::min(begin + kLength, piece.end);
      if (number++ % every == 0 && end - begin > 20) some.push_back({begin, end});
    }
  }
  return some.empty() ? std::vector<RowRange>(pieces.begin(), pieces.end()) : some;
}

double likelihood_of(std::span<const double> time, const Belief& data,
                     std::span<const RowRange> pieces, double jerk) {
  Likelihood sum;
  for (const RowRange& piece : pieces) {
    const Likelihood one = run_forward(time, data, piece, jerk, nullptr);
    sum.squares += one.squares;
    sum.log_variance += one.log_variance;
    sum.rows += one.rows;
  }
  if (sum.rows == 0) return 0;
  return -sum.rows * elementary::log(sum.squares / sum.rows) - sum.log_variance;
}

struct Choice {
  double bandwidth = kLowestBandwidth;  // Hz
  double likelihood = 0;
};

Choice choose_bandwidth(std::span<const double> time, const Belief& data,
                        std::span<const RowRange> pieces, double dt) {
  const std::vector<RowRange> some = trial_pieces(pieces);
  Choice best;
  bool first = true;
  for (double hertz = kLowestBandwidth; hertz * dt <= kTakenAsTheyAre; hertz *= kTrialStep) {
    const double one = likelihood_of(time, data, some, jerk_of(hertz, dt));
    if (first || one > best.likelihood) best = {hertz, one};
    first = false;
  }
  return best;
}

}  // namespace

double resolution_of(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] > sorted[i - 1]) steps.push_back(sorted[i] - sorted[i - 1]);
  }
  if (steps.size() < 3) return 0;
  const auto low = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 10);
  std::nth_element(steps.begin(), low, steps.end());
  const double step = *low;
  // On a grid every step is a whole multiple of the least.
  std::size_t whole = 0;
  for (const double one : steps) {
    const double counts = one / step;
    whole += std::abs(counts - std::round(counts)) < 0.1 ? 1 : 0;
  }
  return static_cast<double>(whole) > 0.9 * static_cast<double>(steps.size()) ? step : 0;
}

Unstaired without_stairs(std::span<const double> time, std::span<const double> position,
                         double resolution) {
  const std::size_t n = position.size();
  Unstaired out{{position.begin(), position.end()}, std::vector<double>(n, 1.0)};
  if (resolution <= 0) return out;
  // Between two changes of the count the position goes from the one's edge to the other's. A row
  // that repeats its count says nothing new: its error is that of the rows before it.
  std::ranges::fill(out.variance, kNothingNew);
  out.variance.front() = 1;
  std::size_t before = 0;  // the row after the last change
  std::size_t rows_before = 1;
  double edge_time = time.front();
  double edge = position.front();
  for (std::size_t i = 1; i <= n; ++i) {
    if (i < n && std::abs(position[i] - position[i - 1]) < 0.5 * resolution) continue;
    const double t = i < n ? 0.5 * (time[i] + time[i - 1]) : time[n - 1];
    const double q = i < n ? 0.5 * (position[i] + position[i - 1]) : edge;
    const std::size_t rows = i - before;
    double next = time[before] + kStill;
    for (std::size_t k = before; k < i && rows > 1; ++k) {
      out.position[k] = edge + (time[k] - edge_time) / (t - edge_time) * (q - edge);
      if (time[k] < next) continue;
      out.variance[k] = 1;
      next = time[k] + kStill;
    }
    // How far the motion goes within a row, in counts: as the faster side of the change has it.
    const std::size_t slow = std::min({rows, before == 0 ? rows : rows_before, kSlowest});
    const double share = 1 / static_cast<double>(slow);
    out.variance[before] = share * share;
    rows_before = rows;
    before = i;
    edge_time = t;
    edge = q;
  }
  return out;
}

namespace {

Belief read_counts(std::span<const double> time, std::span<const double> position,
                   std::span<const RowRange> pieces) {
  const double resolution = resolution_of(position);
  const std::size_t n = position.size();
  Belief belief{{{position.begin(), position.end()}, std::vector<double>(n, 1.0)},
                std::vector<double>(n, 1.0)};
  for (const RowRange& piece : pieces) {
    const std::size_t length = piece.end - piece.begin;
    const Unstaired one = without_stairs(time.subspan(piece.begin, length),
                                         position.subspan(piece.begin, length), resolution);
    const auto begin = static_cast<std::ptrdiff_t>(piece.begin);
    std::ranges::copy(one.position, belief.data.position.begin() + begin);
    std::ranges::copy(one.variance, belief.data.variance.begin() + begin);
  }
  return belief;
}

Motion smooth(std::span<const double> time, const Belief& belief, std::span<const RowRange> pieces,
              double bandwidth, double dt) {
  const std::size_t n = time.size();
  Motion out{belief.data.position, std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  out.bandwidth = bandwidth;
  const double jerk = jerk_of(bandwidth, dt);
  Likelihood sum;
  Variances inside;
  double longest = 0;
  for (const RowRange& piece : pieces) {
    longest = std::max(longest, time[piece.end - 1] - time[piece.begin]);
  }
  const double margin = std::min(kSettled / (kTwoPi * bandwidth), longest / 4);
  std::vector<Step> steps;
  for (const RowRange& piece : pieces) {
    if (piece.end - piece.begin < 2) continue;
    const Likelihood one = run_forward(time, belief, piece, jerk, &steps);
    sum.squares += one.squares;
    sum.rows += one.rows;
    run_backward(time, piece, steps, margin, out, inside);
  }
  const double scale = sum.rows > 0 ? sum.squares / sum.rows / std::max(inside.rows, 1.0) : 0;
  out.velocity_noise = std::sqrt(inside.velocity * scale);
  out.acceleration_noise = std::sqrt(inside.acceleration * scale);
  return out;
}

// How the jerk's density goes through the recording, from a motion that was smoothed with less
// knowledge of it: ramps begin and end, between them there is none. Mean 1.
std::vector<double> shape_of(std::span<const double> time, const Motion& motion,
                             std::span<const RowRange> pieces, double dt) {
  std::vector<double> shape(time.size(), 1.0);
  const auto reach = static_cast<std::size_t>(std::max(1.0, 1 / (kTwoPi * motion.bandwidth * dt)));
  double sum = 0;
  double rows = 0;
  for (const RowRange& piece : pieces) {
    const std::size_t n = piece.end - piece.begin;
    std::vector<double> until(n + 1, 0.0);  // sums of the jerk's squares
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = piece.begin + k;
      const double jerk =
          k == 0 ? 0
                 : (motion.acceleration[i] - motion.acceleration[i - 1]) / (time[i] - time[i - 1]);
      until[k + 1] = until[k] + jerk * jerk;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t low = k > reach ? k - reach : 0;
      const std::size_t high = std::min(n, k + reach + 1);
      shape[piece.begin + k] = (until[high] - until[low]) / static_cast<double>(high - low);
      sum += shape[piece.begin + k];
      ++rows;
    }
  }
  const double mean = rows > 0 ? sum / rows : 0;
  for (double& one : shape) one = mean > 0 ? kLeastShape + (1 - kLeastShape) * one / mean : 1;
  return shape;
}

}  // namespace

double motion_likelihood(std::span<const double> time, std::span<const double> position,
                         std::span<const RowRange> pieces) {
  const Belief belief = read_counts(time, position, pieces);
  // -2 log of a normal law, the variance at its best.
  return 0.5 * choose_bandwidth(time, belief, pieces, typical_step(time, pieces)).likelihood;
}

MotionSmoother::MotionSmoother(std::span<const double> time, std::span<const double> position,
                               std::span<const RowRange> pieces)
    : time_(time), pieces_(pieces.begin(), pieces.end()), step_(typical_step(time, pieces)) {
  Belief belief = read_counts(time, position, pieces);
  Choice best = choose_bandwidth(time, belief, pieces, step_);
  for (int round = 0; round < kRounds; ++round) {
    const Motion motion = smooth(time, belief, pieces, best.bandwidth, step_);
    Belief next{belief.data, shape_of(time, motion, pieces, step_)};
    const Choice choice = choose_bandwidth(time, next, pieces, step_);
    if (choice.likelihood <= best.likelihood) break;
    belief = std::move(next);
    best = choice;
  }
  positions_ = std::move(belief.data);
  shape_ = std::move(belief.shape);
  bandwidth_ = kCaution * best.bandwidth;
}

Motion MotionSmoother::smoothed(double share) const {
  const Belief belief{positions_, shape_};
  return smooth(time_, belief, pieces_, share * bandwidth_, step_);
}

}  // namespace tribench
