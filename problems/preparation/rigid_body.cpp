// SPDX-License-Identifier: MIT
#include "problems/preparation/rigid_body.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/pivoted_qr.hpp"
#include "problems/preparation/derived_channels.hpp"
#include "problems/preparation/segments.hpp"

namespace tribench {
namespace {

constexpr std::size_t kRows = 20'000;  // that take part in a fit
constexpr std::size_t kFewestFitRows = 100;
constexpr double kLeastRange = 0.3;  // rad: less does not tell gravity from an offset
constexpr int kRounds = 4;
constexpr double kCreeping = 0.02;  // of the top speed

struct Fit {
  Eigen::VectorXd coefficients;
  Eigen::VectorXd errors;
  double squares = 0;
  bool determined = true;  // no column follows from the others
};

Fit least_squares(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  Fit fit;
  const Eigen::VectorXd scale = x.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = x * scale.cwiseInverse().asDiagonal();
  const PivotedQr qr(scaled, kDependent);
  fit.determined = qr.rank() == scaled.cols();
  fit.coefficients = qr.solve(y).cwiseQuotient(scale);
  fit.squares = (y - x * fit.coefficients).squaredNorm();
  const auto free = static_cast<double>(std::max<Eigen::Index>(x.rows() - x.cols(), 1));
  const Eigen::MatrixXd gram = scaled.transpose() * scaled;
  const Eigen::MatrixXd ridge = gram + 1e-12 * Eigen::MatrixXd::Identity(gram.rows(), gram.cols());
  const Eigen::VectorXd variance = ridge.inverse().diagonal() * fit.squares / free;
  fit.errors = (kRowsThatAgree * variance).cwiseMax(0).cwiseSqrt().cwiseQuotient(scale);
  return fit;
}

constexpr Eigen::Index kVelocityColumn = 1;
constexpr Eigen::Index kAccelerationColumn = 4;

// sgn v, v, 1, |v| and, where there is one, the acceleration; then `more` columns left free.
struct Rows {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  Eigen::Index base = 0;  // columns before `more`
  std::vector<std::size_t> places;
  double speed = 0;  // typical
};

// Whether friction that is as late as the library knows has followed the last reversal.
std::vector<char> settled_rows(const Dataset& data) {
  constexpr double kLatest = loop::kLags_ms.back() / 1000.0;  // s
  const std::vector<double>& t = data.find(Role::time)->values;
  const std::vector<double>& v = data.find(Role::velocity)->values;
  std::vector<char> settled(data.rows(), 0);
  std::size_t turned = 0;
  for (std::size_t i = 0; i < settled.size(); ++i) {
    if (i > 0 && (v[i] * v[i - 1] <= 0 || data.movement[i] != data.movement[i - 1])) turned = i;
    settled[i] = t[i] - t[turned] > kLatest ? 1 : 0;
  }
  return settled;
}

// Rows slower than `slowest` take no part, nor do those that are not in `only`, if it is not empty;
// at most so many, evenly spaced.
Rows rows_of(const Dataset& data, const Channel& torque, Eigen::Index more, double slowest = 0,
             const std::vector<char>& only = {}, std::size_t most = kRows) {
  const std::vector<double>& v = data.find(Role::velocity)->values;
  const Channel* a = data.find(Role::acceleration);
  const std::size_t step = std::max<std::size_t>(1, data.rows() / most);
  Rows rows;
  for (std::size_t i = 0; i < data.rows(); i += step) {
    if (std::abs(v[i]) > slowest && (only.empty() || only[i] != 0)) rows.places.push_back(i);
  }
  const auto n = static_cast<Eigen::Index>(rows.places.size());
  rows.base = a != nullptr ? 5 : 4;
  rows.x.resize(n, rows.base + more);
  rows.y.resize(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const std::size_t i = rows.places[static_cast<std::size_t>(r)];
    rows.x(r, 0) = v[i] > 0 ? 1 : -1;
    rows.x(r, kVelocityColumn) = v[i];
    rows.x(r, 2) = 1;
    rows.x(r, 3) = std::abs(v[i]);
    if (a != nullptr) rows.x(r, kAccelerationColumn) = a->values[i];
    rows.y(r) = torque.values[i];
    rows.speed += std::abs(v[i]) / static_cast<double>(n);
  }
  return rows;
}

bool turns(const Dataset& data) {
  const Channel* q = data.find(Role::position);
  return q != nullptr && q->unit == "rad";
}

// Declared gravity, sin and cos of an angle: as many columns as there are of those.
Eigen::Index load_columns(const Dataset& data) {
  return (data.find(Role::gravity_torque) != nullptr ? 1 : 0) + (turns(data) ? 2 : 0);
}

void fill_load_columns(const Dataset& data, Rows& rows, Eigen::Index first) {
  const Channel* gravity = data.find(Role::gravity_torque);
  const Channel* q = data.find(Role::position);
  for (Eigen::Index r = 0; r < rows.x.rows(); ++r) {
    const std::size_t i = rows.places[static_cast<std::size_t>(r)];
    Eigen::Index column = first;
    if (gravity != nullptr) rows.x(r, column++) = gravity->values[i];
    if (!turns(data)) continue;
    rows.x(r, column++) = elementary::sin(q->values[i]);
    rows.x(r, column) = elementary::cos(q->values[i]);
  }
}

}  // namespace

const Channel* effort_of(const Dataset& data) {
  const Channel* torque = data.find(Role::motor_torque);
  return torque != nullptr ? torque : data.find(Role::motor_current);
}

std::optional<RigidBody> fit_rigid_body(const Dataset& data) {
  const Channel* torque = effort_of(data);
  const Channel* q = data.find(Role::position);
  if (torque == nullptr || q == nullptr || q->unit != "rad" || !data.find(Role::velocity)) {
    return {};
  }
  const auto [low, high] = std::ranges::minmax(q->values);
  if (high - low < kLeastRange) return {};
  Rows rows = rows_of(data, *torque, 3);
  if (rows.places.size() < kFewestFitRows) return {};
  const Eigen::Index n = rows.x.rows();
  for (Eigen::Index r = 0; r < n; ++r) {
    const double angle = q->values[rows.places[static_cast<std::size_t>(r)]];
    rows.x(r, rows.base) = elementary::sin(angle);
    rows.x(r, rows.base + 1) = elementary::cos(angle);
  }
  const Fit without = least_squares(rows.x.leftCols(rows.base), rows.y);
  Fit with = least_squares(rows.x.leftCols(rows.base + 2), rows.y);
  if (!with.determined) return {};
  // Friction that grows with the load leans on gravity: it is fitted beside it, the load taken
  // from the fit before. In one direction, under a load of one sign, the two are the same.
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd load =
        rows.x.middleCols(rows.base, 2) * with.coefficients.segment(rows.base, 2);
    rows.x.col(rows.base + 2) = rows.x.col(0).cwiseProduct(load.cwiseAbs());
    Fit next = least_squares(rows.x, rows.y);
    if (!next.determined) break;
    with = std::move(next);
  }
  RigidBody body;
  body.sine = with.coefficients(rows.base);
  body.cosine = with.coefficients(rows.base + 1);
  body.explained = without.squares > 0 ? 1 - with.squares / without.squares : 0;
  const auto length = [](double a, double b) { return std::sqrt(a * a + b * b); };
  body.certainty =
      length(body.sine, body.cosine) / length(with.errors(rows.base), with.errors(rows.base + 1));
  body.friction = with.coefficients(0) + with.coefficients(1) * rows.speed;
  body.friction_error = with.errors(0) + with.errors(1) * rows.speed;
  return body;
}

std::optional<Blunting> acceleration_blunting(const Dataset& data, std::span<const double> change) {
  constexpr Eigen::Index kAcceleration = 4;
  const Channel* torque = effort_of(data);
  if (torque == nullptr || !data.find(Role::velocity) || !data.find(Role::acceleration)) return {};
  Rows rows = rows_of(data, *torque, 1 + load_columns(data));
  if (rows.places.size() < kFewestFitRows) return {};
  for (Eigen::Index r = 0; r < rows.x.rows(); ++r) {
    rows.x(r, rows.base) = change[rows.places[static_cast<std::size_t>(r)]];
  }
  fill_load_columns(data, rows, rows.base + 1);
  const Fit fit = least_squares(rows.x, rows.y);
  const double inertia = fit.coefficients(kAcceleration);
  if (!(inertia > 0)) return {};
  return Blunting{fit.coefficients(rows.base) / inertia, fit.errors(rows.base) / inertia};
}

namespace {

// The noise in means of so many rows, from their second differences, which slow motion hardly
// enters.
double noise_of_means(const Eigen::Ref<const Eigen::VectorXd>& torque, Eigen::Index rows_each) {
  std::vector<double> means;
  for (Eigen::Index i = 0; i + rows_each <= torque.size(); i += rows_each) {
    means.push_back(torque.segment(i, rows_each).mean());
  }
  std::vector<double> bends;
  for (std::size_t i = 2; i < means.size(); ++i) {
    bends.push_back(means[i] - 2 * means[i - 1] + means[i - 2]);
  }
  return kMadToSd * upper_median_magnitude(std::move(bends)) / std::sqrt(6.0);
}

Rows moving_rows(const Dataset& data, const Channel& torque, const std::vector<char>& only,
                 std::size_t most) {
  const double slowest = kCreeping * top_speed(data.find(Role::velocity)->values);
  Rows rows = rows_of(data, torque, load_columns(data), slowest, only, most);
  fill_load_columns(data, rows, rows.base);
  return rows;
}

// The change of a column that the torque would show: its noise over the column's coefficient.
// Friction that comes late goes against the acceleration after every reversal: where an inertia
// comes out negative by it, the rows that it has left behind are asked.
std::optional<double> visible_change(const Dataset& data, const Channel* torque,
                                     Eigen::Index column) {
  constexpr double kSurely = 5;         // standard errors
  constexpr std::size_t kMeans = 6000;  // that a diagnosis averages a recording to
  if (torque == nullptr || !data.find(Role::velocity)) return {};
  Rows rows = moving_rows(data, *torque, {}, kRows);
  if (rows.places.size() < kFewestFitRows) return {};
  Fit fit = least_squares(rows.x, rows.y);
  if (fit.coefficients(column) < 0 && data.find(Role::time)) {
    rows = moving_rows(data, *torque, settled_rows(data), kRows);
    if (rows.places.size() < kFewestFitRows) return {};
    fit = least_squares(rows.x, rows.y);
  }
  if (!(fit.coefficients(column) > kSurely * fit.errors(column))) return {};
  const auto rows_each = static_cast<Eigen::Index>(std::max<std::size_t>(1, data.rows() / kMeans));
  const Eigen::Map<const Eigen::VectorXd> whole(torque->values.data(),
                                                static_cast<Eigen::Index>(torque->values.size()));
  double noise = noise_of_means(whole, rows_each);
  if (rows_each > 1) {
    // From one mean to the next the motion changes the torque, too: where the joint never rests,
    // by more than the noise does. What the fit leaves has less of it.
    const Rows all = moving_rows(data, *torque, {}, data.rows());
    const Eigen::VectorXd left = all.y - all.x * fit.coefficients;
    noise = std::min(noise, noise_of_means(left, rows_each));
  }
  return noise / fit.coefficients(column);
}

}  // namespace

std::optional<double> visible_acceleration(const Dataset& data) {
  if (!data.find(Role::acceleration)) return {};
  return visible_change(data, effort_of(data), kAccelerationColumn);
}

std::optional<double> visible_velocity(const Dataset& data) {
  return visible_change(data, data.find(Role::friction_torque), kVelocityColumn);
}

namespace {

// The standard error of a column's coefficient as the parts of the rows agree on it. Infinite where
// a part alone tells it.
double jackknife_error(const Rows& rows, Eigen::Index column) {
  constexpr Eigen::Index kParts = 8;
  const Eigen::Index n = rows.x.rows();
  Eigen::VectorXd without(kParts);
  for (Eigen::Index part = 0; part < kParts; ++part) {
    const Eigen::Index begin = part * n / kParts;
    const Eigen::Index behind = n - (part + 1) * n / kParts;
    Eigen::MatrixXd x(begin + behind, rows.x.cols());
    Eigen::VectorXd y(begin + behind);
    x << rows.x.topRows(begin), rows.x.bottomRows(behind);
    y << rows.y.head(begin), rows.y.tail(behind);
    const Fit fit = least_squares(x, y);
    if (!fit.determined) return std::numeric_limits<double>::infinity();
    without(part) = fit.coefficients(column);
  }
  const double squares = (without.array() - without.mean()).square().sum();
  return std::sqrt(squares * (kParts - 1) / kParts);
}

}  // namespace

std::optional<GravityFactor> gravity_factor(const Dataset& data) {
  const Channel* torque = effort_of(data);
  const Channel* gravity = data.find(Role::gravity_torque);
  const Channel* v = data.find(Role::velocity);
  if (torque == nullptr || gravity == nullptr || v == nullptr) return {};
  constexpr double kMoving = 0.1;  // of the top speed: beyond the noise of a joint that rests
  Rows rows = rows_of(data, *torque, 1, kMoving * top_speed(v->values));
  if (rows.places.size() < kFewestFitRows) return {};
  for (Eigen::Index r = 0; r < rows.x.rows(); ++r) {
    rows.x(r, rows.base) = gravity->values[rows.places[static_cast<std::size_t>(r)]];
  }
  const Fit fit = least_squares(rows.x, rows.y);
  const Fit without = least_squares(rows.x.leftCols(rows.base), rows.y);
  GravityFactor factor;
  factor.value = fit.coefficients(rows.base);
  factor.error = std::max(fit.errors(rows.base), jackknife_error(rows, rows.base));
  factor.explained = without.squares > 0 ? 1 - fit.squares / without.squares : 0;
  return factor;
}

std::optional<double> torque_prefers(const Dataset& data, std::span<const double> velocity,
                                     std::span<const double> acceleration) {
  constexpr Eigen::Index kParts = 8;
  const Channel* effort = effort_of(data);
  const Channel* friction = data.find(Role::friction_torque);
  const Channel* v = data.find(Role::velocity);
  if ((effort == nullptr && friction == nullptr) || v == nullptr) return {};
  const Eigen::Index loads = load_columns(data);
  Rows rows = rows_of(data, friction != nullptr ? *friction : *effort, loads + 2,
                      kCreeping * top_speed(v->values));
  if (rows.places.size() < kFewestFitRows) return {};
  fill_load_columns(data, rows, rows.base);
  const Eigen::Index n = rows.x.rows();
  const auto left_with = [&](std::span<const double> speed) {
    for (Eigen::Index r = 0; r < n; ++r) {
      const std::size_t i = rows.places[static_cast<std::size_t>(r)];
      rows.x(r, kVelocityColumn) = speed[i];
      rows.x(r, 3) = std::abs(speed[i]);
      rows.x(r, rows.base + loads) = speed[i] * std::abs(speed[i]);
      rows.x(r, rows.base + loads + 1) = friction != nullptr ? 0 : acceleration[i];
    }
    const Eigen::VectorXd rest = rows.y - rows.x * least_squares(rows.x, rows.y).coefficients;
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(kParts);
    for (Eigen::Index r = 0; r < n; ++r) squares(r * kParts / n) += rest(r) * rest(r);
    return squares;
  };
  const Eigen::VectorXd gain = left_with(v->values) - left_with(velocity);
  const double mean = gain.mean();
  const double error = std::sqrt((gain.array() - mean).square().sum() / (kParts * (kParts - 1)));
  if (!(error > 0)) return {};
  return mean / error;
}

}  // namespace tribench
