// SPDX-License-Identifier: MIT
#include "problems/preparation/observation_rows.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/pivoted_qr.hpp"
#include "foundation/sign.hpp"
#include "problems/friction_sign.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench::loop {
namespace {

// 99 % quantile of the magnitudes.
double top_speed(std::vector<double> v) {
  for (double& x : v) x = std::abs(x);
  const auto at = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(v.size() - 1));
  std::ranges::nth_element(v, v.begin() + at);
  return v[static_cast<std::size_t>(at)];
}

}  // namespace

void drop_constant_signals(Observations& data) {
  for (const std::string& name : data.names()) {
    const Signal& signal = *data.find(name);
    if (signal.values.empty()) continue;
    const auto [low, high] = std::ranges::minmax(signal.values);
    const double scale = std::max(std::abs(low), std::abs(high));
    if (high - low > 1e-12 * scale) continue;
    const bool sign = name.starts_with("sgn_");  // of a channel that was named already
    if (signal.recipe.empty() && !sign) {
      data.warnings.push_back(
          fmt::format("the channel '{}' is constant ({}) and left out", signal.channel, low));
    }
    if (name != "sgn_v" && name != "v") data.take_away(name, "it is constant");
  }
}

void drop_negligible_load(Observations& data) {
  const Signal* g = data.find("g");
  if (g == nullptr || g->unit != data.target_unit) return;
  double largest = 0;
  for (const double x : g->values) largest = std::max(largest, std::abs(x));
  double mean = 0;
  double squares = 0;
  const auto rows = static_cast<double>(data.rows());
  for (const double y : data.target) mean += y / rows;
  for (const double y : data.target) squares += (y - mean) * (y - mean) / rows;
  if (largest * largest > squares / rows) return;
  data.warnings.push_back(
      fmt::format("the load '{}' never exceeds {:.2g} {}, less than these rows can show: left out",
                  g->channel, largest, g->unit));
  for (const char* name : {"g", "sgn_g"}) data.take_away(name, "the load is next to nothing");
}

void drop_rows_not_finite(Observations& data) {
  std::vector<char> keep(data.rows(), 1);
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    bool finite = std::isfinite(data.target[i]);
    for (const Signal& signal : data.signals) finite = finite && std::isfinite(signal.values[i]);
    keep[i] = finite ? 1 : 0;
    if (!finite) ++dropped;
  }
  if (dropped == 0) return;
  data = data.select(keep);
  data.warnings.push_back(fmt::format("{} rows hold a value that is not finite: dropped", dropped));
}

void drop_slow_rows(Observations& data, double min_speed) {
  const std::vector<double>& v = data.find("v")->values;
  std::vector<char> keep(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i) keep[i] = std::abs(v[i]) >= min_speed ? 1 : 0;
  const std::size_t all = data.rows();
  data = data.select(keep);
  if (data.rows() == 0) {
    throw_bad_input(fmt::format("no row is faster than {}", min_speed), "--min-speed");
  }
  data.warnings.push_back(
      fmt::format("{} of {} rows are slower than {}: left out", all - data.rows(), all, min_speed));
}

void drop_rows_at_rest(Observations& data) {
  constexpr double kGettingAnywhere = 0.01;  // of the top speed
  constexpr double kEnoughRows = 0.05;       // of all: fewer do not bend a fit
  const std::vector<double>& v = data.find("v")->values;
  const double top = top_speed(v);
  std::vector<double> resting;
  for (std::size_t begin = 0; begin < v.size();) {
    std::size_t end = begin + 1;
    double fastest = std::abs(v[begin]);
    const auto goes_on = [&](std::size_t i) {
      return data.movement[i] == data.movement[begin] && sign(v[i]) == sign(v[begin]);
    };
    for (; end < v.size() && goes_on(end); ++end) fastest = std::max(fastest, std::abs(v[end]));
    if (fastest < kGettingAnywhere * top) {
      for (std::size_t i = begin; i < end; ++i) resting.push_back(std::abs(v[i]));
    }
    begin = end;
  }
  const auto all = static_cast<double>(data.rows());
  if (resting.size() < 2 || static_cast<double>(resting.size()) < kEnoughRows * all) return;
  const auto at = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(resting.size() - 1));
  std::ranges::nth_element(resting, resting.begin() + at);
  const double speed = resting[static_cast<std::size_t>(at)];
  std::vector<char> keep(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i) keep[i] = std::abs(v[i]) > speed ? 1 : 0;
  Observations moving = data.select(keep);
  if (moving.rows() == 0) return;  // nothing ever moves: other checks say so
  moving.warnings.push_back(fmt::format(
      "the axis stands still in {:.0f} % of the rows, where the direction of friction is not "
      "known: {:.0f} % of the rows, {}, are left out (--min-speed 0 keeps them)",
      100 * static_cast<double>(resting.size()) / all,
      100 * (1 - static_cast<double>(moving.rows()) / all),
      speed > 0 ? fmt::format("slower than {:.2g} {}", speed, data.find("v")->unit)
                : std::string("at rest")));
  data = std::move(moving);
}

void settle_directions(Observations& data) {
  constexpr std::size_t kFewestRows = 30;
  const std::vector<double>& v = data.find("v")->values;
  const auto forward =
      static_cast<std::size_t>(std::ranges::count_if(v, [](double x) { return x > 0; }));
  const auto backward =
      static_cast<std::size_t>(std::ranges::count_if(v, [](double x) { return x < 0; }));
  const std::size_t fewer = std::min(forward, backward);
  if (fewer >= std::max(kFewestRows, (forward + backward) / 100)) return;
  std::vector<char> keep(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i)
    keep[i] = (forward > backward ? v[i] > 0 : v[i] < 0) ? 1 : 0;
  data = data.select(keep);
  data.warnings.push_back(fmt::format(
      "all movement is in one direction{}: direction asymmetry and whatever needs both directions "
      "cannot be told from the base",
      fewer == 0 ? "" : fmt::format(" ({} rows the other way are left out)", fewer)));
}

Observations steady_means(const Observations& data) {
  std::vector<std::size_t> part(data.rows());
  std::vector<char> first(data.rows(), 0);
  std::size_t parts = 0;
  for (std::size_t begin = 0; begin < data.rows();) {
    std::size_t end = begin;
    while (end < data.rows() && data.movement[end] == data.movement[begin]) ++end;
    const std::size_t count = std::min(kRowsOfSteadyMovement, end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t k = (i - begin) * count / (end - begin);
      first[i] = i == begin || parts + k != part[i - 1] ? 1 : 0;
      part[i] = parts + k;
    }
    parts += count;
    begin = end;
  }
  Observations out = data.select(first);
  const auto average = [&](const std::vector<double>& values, std::vector<double>& means) {
    means.assign(parts, 0.0);
    std::vector<double> rows(parts, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      means[part[i]] += values[i];
      ++rows[part[i]];
    }
    for (std::size_t k = 0; k < parts; ++k) means[k] /= rows[k];
  };
  average(data.target, out.target);
  for (std::size_t j = 0; j < data.signals.size(); ++j) {
    average(data.signals[j].values, out.signals[j].values);
    const std::string& name = out.signals[j].name;
    if (!name.starts_with("sgn_") || LateChannel::of(name)) continue;
    average(data.find(name.substr(4))->values, out.signals[j].values);
    for (double& x : out.signals[j].values) x = sign(x);
  }
  for (std::size_t j = 0; j < data.unused.size(); ++j) {
    average(data.unused[j].values, out.unused[j].values);
  }
  average(data.time, out.time);
  const std::vector<double>& v = out.find("v")->values;
  for (std::size_t k = 1; k < parts; ++k) {
    if (out.movement[k] != out.movement[k - 1] || v[k] * v[k - 1] > 0) continue;
    throw_bad_input(fmt::format("movement '{}' changes its direction: it holds no one speed",
                                out.movement_names[static_cast<std::size_t>(out.movement[k])]),
                    "--steady", "leave --steady out, or name a movement for each speed (--roles)");
  }
  out.warnings.push_back(
      fmt::format("each movement is averaged to {} rows (--steady)", kRowsOfSteadyMovement));
  return out;
}

void check_varying(const Observations& data) {
  if (data.rows() == 0) return;
  const auto [low, high] = std::ranges::minmax(data.target);
  if (low < high) return;
  throw_bad_input(fmt::format("the value is {} in every row: nothing was measured", low),
                  data.target_name, "name the column that holds the torque with --roles");
}

void check_moving(const Observations& data) {
  constexpr double kMostBackward = 0.1;  // of what is travelled: less is the position's noise
  const Signal& v = *data.find("v");
  const auto [low, high] = std::ranges::minmax(v.values);
  if (low < high) return;
  constexpr const char* kMend = "name the column that holds the velocity with --roles";
  if (high == 0) {
    throw_bad_input("the velocity is 0 in every row: an axis at rest shows no friction", v.channel,
                    kMend);
  }
  const Signal* q = data.find("q");
  if (q == nullptr) return;
  double travelled = 0;
  double against = 0;
  for (std::size_t begin = 0; begin < data.rows();) {
    double farthest = sign(high) * q->values[begin];
    double nearest = farthest;
    double back = 0;
    std::size_t i = begin;
    for (; i < data.rows() && data.movement[i] == data.movement[begin]; ++i) {
      const double place = sign(high) * q->values[i];
      farthest = std::max(farthest, place);
      nearest = std::min(nearest, place);
      back = std::max(back, farthest - place);
    }
    travelled += farthest - nearest;
    against += back;
    begin = i;
  }
  if (against <= kMostBackward * travelled) return;
  throw_bad_input(
      fmt::format("the velocity is {} in every row, while '{}' moves against it", high, q->channel),
      v.channel, kMend);
}

namespace {

// What 1, sin q and cos q leave of `values`.
std::vector<double> without_place(const std::vector<double>& values, const std::vector<double>& q) {
  const auto n = static_cast<Eigen::Index>(values.size());
  Eigen::MatrixXd x(n, 3);
  for (Eigen::Index r = 0; r < n; ++r) {
    const double angle = q[static_cast<std::size_t>(r)];
    x.row(r) << 1, elementary::sin(angle), elementary::cos(angle);
  }
  const Eigen::Map<const Eigen::VectorXd> y(values.data(), n);
  const Eigen::VectorXd rest = y - x * PivotedQr(x).solve(y);
  return {rest.begin(), rest.end()};
}

}  // namespace

void check_sign(const Observations& data, bool torques_flipped) {
  if (!data.rigid.empty()) return;  // inertia and gravity may dominate: no sign to be expected
  const Signal& v = *data.find("v");
  const Signal* q = data.find("q");
  // A motor's torque may hold a gravity that nobody declared: turned it would pass for friction.
  const bool holds_gravity = q != nullptr && q->unit == "rad" &&
                             friction_agreement(without_place(data.target, q->values),
                                                without_place(v.values, q->values)) > 0;
  refuse_opposing_friction(
      data.target, data.target_name, v.values, v.channel, data.target_name,
      holds_gravity ? "at the same place it goes with it, so that it holds gravity: declare that "
                      "with --roles COLUMN=gravity_torque[N m], or give --gravity fit"
                    : mend_of_sign(torques_flipped));
}

}  // namespace tribench::loop
