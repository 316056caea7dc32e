// SPDX-License-Identifier: MIT
#include "problems/preparation/effort_delay.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/pivoted_qr.hpp"
#include "problems/preparation/rigid_body.hpp"
#include "problems/preparation/segments.hpp"

namespace tribench {
namespace {

constexpr double kLongest = 0.04;  // s
constexpr double kFast = 0.05;     // of the top speed
constexpr double kWay = 0.01;      // of the position's range
constexpr std::size_t kRowsCompared = 20'000;
constexpr std::size_t kFewestSteady = 400;
constexpr std::size_t kParts = 8;  // of the recording, left out in turn

struct SteadyRow {
  std::size_t row = 0;
  double way = 0;  // since it began to move so fast in this direction
};

struct Thinned {
  std::vector<SteadyRow> rows;
  std::size_t stride = 1;
};

// Rows whose neighbours, `reach` either way, are of their piece and as fast in the same direction,
// and before which bristles had a way to slide.
Thinned steady_rows(const Dataset& data, std::span<const RowRange> pieces, std::size_t reach,
                    double way) {
  const std::vector<double>& q = data.find(Role::position)->values;
  const std::vector<double>& v = data.find(Role::velocity)->values;
  const double fast = kFast * top_speed(v);
  std::vector<SteadyRow> rows;
  for (const RowRange& piece : pieces) {
    std::size_t begin = piece.begin;  // of what is as fast
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      if (std::abs(v[i]) < fast || (i > begin && v[i] * v[i - 1] < 0)) begin = i + 1;
      if (i < begin + 2 * reach) continue;
      if (std::abs(q[i - 2 * reach] - q[begin]) <= way) continue;
      rows.push_back({i - reach, std::abs(q[i - reach] - q[begin])});
    }
  }
  Thinned some{{}, rows.size() / kRowsCompared + 1};
  for (std::size_t k = 0; k < rows.size(); k += some.stride) some.rows.push_back(rows[k]);
  return some;
}

// What friction, inertia and gravity may be made of: friction that grows with the load, that
// changes slowly through the recording or that bristles have not given yet after a reversal, what
// a smoother took off the acceleration, and what repeats with the motor's turn.
struct Terms {
  const Dataset& data;
  std::optional<double> gear_ratio;
  std::span<const double> blunting;
  double way = 0;                 // of bristles
  std::optional<RigidBody> body;  // gravity that no column declares

  // part: of the recording, -1 to 1.
  std::vector<double> at(const SteadyRow& steady, double part) const {
    const std::size_t i = steady.row;
    const double v = data.find(Role::velocity)->values[i];
    const double sign = v > 0 ? 1 : -1;
    std::vector<double> terms = {
        1, sign, v, std::abs(v), v * std::abs(v), data.find(Role::acceleration)->values[i]};
    if (!blunting.empty()) terms.push_back(blunting[i]);
    add_slow_change(terms, part, sign, v);
    for (const double length : {way, 3 * way}) {
      const double missing = elementary::exp(-steady.way / length);
      terms.insert(terms.end(), {missing, sign * missing});
    }
    const auto add_load = [&](double g) {
      terms.insert(terms.end(), {g, sign * std::abs(g), v * std::abs(g)});
    };
    if (const Channel* gravity = data.find(Role::gravity_torque)) add_load(gravity->values[i]);
    const Channel& q = *data.find(Role::position);
    if (q.unit != "rad") return terms;
    const double sine = elementary::sin(q.values[i]);
    const double cosine = elementary::cos(q.values[i]);
    if (body) add_load(body->sine * sine + body->cosine * cosine);
    terms.insert(terms.end(), {sine, cosine, sine * cosine, sine * sine});
    if (gear_ratio) add_ripple(terms, *gear_ratio * q.values[i], sign);
    return terms;
  }

  // Temperature, running in, a wandering offset: Chebyshev's polynomials of the time.
  static void add_slow_change(std::vector<double>& terms, double part, double sign, double v) {
    const double square = part * part;
    for (const double slow : {part, 2 * square - 1, part * (4 * square - 3)}) {
      terms.insert(terms.end(), {slow, slow * sign, slow * v});
    }
  }

  static void add_ripple(std::vector<double>& terms, double motor_rad, double sign) {
    for (const double k : {1.0, 2.0, 4.0}) {
      const double sine = elementary::sin(k * motor_rad);
      const double cosine = elementary::cos(k * motor_rad);
      terms.insert(terms.end(), {sine, cosine, sign * sine, sign * cosine});
    }
  }
};

// An orthonormal base of the terms.
Eigen::MatrixXd base_of(const Terms& all, const std::vector<SteadyRow>& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd x(n, static_cast<Eigen::Index>(all.at(rows[0], 0).size()));
  for (Eigen::Index r = 0; r < n; ++r) {
    const double part = (2 * static_cast<double>(r) + 1) / static_cast<double>(n) - 1;
    const std::vector<double> terms = all.at(rows[static_cast<std::size_t>(r)], part);
    x.row(r) = Eigen::Map<const Eigen::RowVectorXd>(terms.data(), x.cols());
  }
  const Eigen::VectorXd scale = x.colwise().norm().cwiseMax(1e-300);
  return PivotedQr(x * scale.cwiseInverse().asDiagonal(), kDependent).basis();
}

// Squares that the terms leave, per shift of the torque (from -reach on) and part of the recording.
Eigen::MatrixXd left_over(const Eigen::MatrixXd& base, const std::vector<double>& torque,
                          const std::vector<SteadyRow>& rows, std::size_t reach) {
  const Eigen::Index n = base.rows();
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(2 * reach + 1), kParts);
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0; k < squares.rows(); ++k) {
    for (Eigen::Index r = 0; r < n; ++r) {
      y(r) = torque[rows[static_cast<std::size_t>(r)].row + static_cast<std::size_t>(k) - reach];
    }
    const Eigen::VectorXd rest = y - base * (base.transpose() * y);
    for (Eigen::Index r = 0; r < n; ++r) {
      squares(k, r * static_cast<Eigen::Index>(kParts) / n) += rest(r) * rest(r);
    }
  }
  return squares;
}

// Means of so many rows: what is thinned keeps the noise of all.
std::vector<double> means_of(const std::vector<double>& values, std::size_t rows_each) {
  std::vector<double> sums = {0};
  for (const double value : values) sums.push_back(sums.back() + value);
  const std::size_t n = values.size();
  std::vector<double> means(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t reach = std::min({rows_each / 2, i, n - 1 - i});
    means[i] = (sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1);
  }
  return means;
}

// Where a parabola through the least entry and its neighbours is least; nothing at the ends.
std::optional<double> place_of_least(const Eigen::VectorXd& squares) {
  Eigen::Index least = 0;
  squares.minCoeff(&least);
  if (least == 0 || least + 1 == squares.size()) return {};
  const double bend = squares(least - 1) - 2 * squares(least) + squares(least + 1);
  const double part = bend > 0 ? 0.5 * (squares(least - 1) - squares(least + 1)) / bend : 0;
  return static_cast<double>(least) + part;
}

}  // namespace

std::optional<EffortDelay> effort_delay(const Dataset& data, std::span<const RowRange> pieces,
                                        std::optional<double> gear_ratio,
                                        std::span<const double> blunting) {
  const Channel* torque = effort_of(data);
  const Channel* t = data.find(Role::time);
  const Channel* v = data.find(Role::velocity);
  if (torque == nullptr || t == nullptr || v == nullptr || !data.find(Role::position) ||
      !data.find(Role::acceleration)) {
    return {};
  }
  const double step = median_step(t->values, data.movement);
  if (!(step > 0)) return {};
  const auto reach = std::max<std::size_t>(2, static_cast<std::size_t>(kLongest / step));
  const auto [low, high] = std::ranges::minmax(data.find(Role::position)->values);
  const double way = kWay * (high - low);
  const Thinned thinned = steady_rows(data, pieces, reach, way);
  if (thinned.rows.size() < kFewestSteady) return {};
  const Terms terms{data, gear_ratio, blunting, way, fit_rigid_body(data)};
  const Eigen::MatrixXd squares = left_over(
      base_of(terms, thinned.rows), means_of(torque->values, thinned.stride), thinned.rows, reach);
  const Eigen::VectorXd all = squares.rowwise().sum();
  const std::optional<double> best = place_of_least(all);
  if (!best) return {};
  double variance = 0;  // the jackknife's
  for (Eigen::Index part = 0; part < squares.cols(); ++part) {
    const std::optional<double> without = place_of_least(all - squares.col(part));
    if (!without) return {};
    constexpr double kShare = static_cast<double>(kParts - 1) / kParts;
    variance += kShare * (*without - *best) * (*without - *best);
  }
  return EffortDelay{step * (*best - static_cast<double>(reach)), step * std::sqrt(variance)};
}

Shifted shifted_by(std::span<const double> time, std::span<const double> values,
                   std::span<const RowRange> pieces, double delay) {
  Shifted out{{values.begin(), values.end()}, std::vector<char>(values.size(), 1)};
  for (const RowRange& piece : pieces) {
    std::size_t k = piece.begin;  // the row at or before the shifted time
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      const double when = time[i] + delay;
      while (k + 1 < piece.end && time[k + 1] <= when) ++k;
      if (when < time[piece.begin] || k + 1 == piece.end) continue;
      const double part = (when - time[k]) / (time[k + 1] - time[k]);
      out.values[i] = values[k] + part * (values[k + 1] - values[k]);
      out.lost[i] = 0;
    }
  }
  return out;
}

}  // namespace tribench
