// SPDX-License-Identifier: MIT
#include "problems/preparation/effort_delay.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

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
constexpr std::ptrdiff_t kCoarse = 5;

// A first-order filter of what is straight between its rows.
class FirstOrder {
 public:
  FirstOrder(double seconds, double step)
      : keeps_(elementary::exp(-step / seconds)), bends_((1 - keeps_) * seconds / step) {}

  // State and input of the row before, input now.
  double next(double state, double before, double now) const {
    return now + keeps_ * (state - before) - bends_ * (now - before);
  }

 private:
  double keeps_;
  double bends_;
};

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
  double top = 1;                 // speed
  bool changes_slowly = true;     // friction, through the recording
  std::optional<RigidBody> body;  // gravity that no column declares

  // The motion so many rows later, of which the steady row's neighbours are as fast.
  SteadyRow moved(const SteadyRow& steady, std::ptrdiff_t rows) const {
    const std::vector<double>& q = data.find(Role::position)->values;
    const auto row = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(steady.row) + rows);
    const double further = std::abs(q[row] - q[steady.row]);
    return {row, steady.way + (rows < 0 ? -further : further)};
  }

  double way_between(std::size_t begin, std::size_t row) const {
    const std::vector<double>& q = data.find(Role::position)->values;
    return std::abs(q[row] - q[begin]);
  }

  bool turns(std::size_t row) const {
    const std::vector<double>& v = data.find(Role::velocity)->values;
    return v[row] * v[row - 1] <= 0;
  }

  // part: of the recording, -1 to 1.
  std::vector<double> at(const SteadyRow& steady, double part) const {
    const std::size_t i = steady.row;
    const double v = data.find(Role::velocity)->values[i];
    const double sign = v > 0 ? 1 : -1;
    std::vector<double> terms = {
        1, sign, v, std::abs(v), v * std::abs(v), data.find(Role::acceleration)->values[i]};
    if (!blunting.empty()) terms.push_back(blunting[i]);
    if (changes_slowly) add_slow_change(terms, part, sign, v);
    for (const double share : {0.1, 0.3}) {  // friction that falls with the speed
      terms.push_back(sign * elementary::exp(-std::abs(v) / (share * top)));
    }
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
  static constexpr double kSlowTerms = 9;
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

// What is left of the torque: of all rows, and of those without a part of the recording.
using Squares = Eigen::Array<double, kParts + 1, 1>;

// The torque beside the terms of a motion before: the same rows of it whatever the delay, else the
// noise of the rows that come and go is more than what a delay of milliseconds explains.
class LateTerms {
 public:
  LateTerms(const Terms& terms, const Thinned& thinned, const std::vector<double>& torque)
      : terms_(terms),
        rows_(thinned.rows),
        independent_(static_cast<double>(rows_.size() * thinned.stride) / kRowsThatAgree),
        x_(static_cast<Eigen::Index>(rows_.size()),
           static_cast<Eigen::Index>(terms.at(rows_[0], 0).size()) + 1) {
    const std::vector<double> means = means_of(torque, thinned.stride);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      x_(static_cast<Eigen::Index>(r), x_.cols() - 1) = means[rows_[r].row];
    }
  }

  // The terms of so many rows before, which are neighbours of the steady rows: late and around
  // together are not more than their reach.
  const Squares& left_by_shift(std::ptrdiff_t late) {
    const auto known = by_shift_.find(late);
    if (known != by_shift_.end()) return known->second;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      put(r, terms_.at(terms_.moved(rows_[r], -late), part_of(r)));
    }
    return by_shift_.emplace(late, left()).first->second;
  }

  // The same, as means over so many rows around.
  double left_by_means(std::ptrdiff_t late, std::ptrdiff_t around) {
    std::vector<double> sum;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      sum.assign(static_cast<std::size_t>(x_.cols()) - 1, 0);
      for (std::ptrdiff_t offset = -around; offset <= around; ++offset) {
        add(sum, terms_.at(terms_.moved(rows_[r], offset - late), part_of(r)));
      }
      put(r, sum);
    }
    return left()(kParts);
  }

  // The terms through a first-order filter, from each piece's begin.
  Squares left_by_filter(const FirstOrder& filter, std::span<const RowRange> pieces) {
    std::size_t r = 0;
    for (const RowRange& piece : pieces) {
      std::size_t begin = piece.begin;
      std::vector<double> state;
      std::vector<double> before;
      for (std::size_t i = piece.begin; i < piece.end && r < rows_.size(); ++i) {
        if (i > piece.begin && terms_.turns(i)) begin = i;
        std::vector<double> now = terms_.at({i, terms_.way_between(begin, i)}, part_of(r));
        if (state.empty()) state = before = now;
        for (std::size_t k = 0; k < now.size(); ++k) {
          state[k] = filter.next(state[k], before[k], now[k]);
        }
        before = std::move(now);
        if (rows_[r].row == i) put(r++, state);
      }
    }
    return left();
  }

  double independent_rows() const { return independent_; }

 private:
  static void add(std::vector<double>& sum, const std::vector<double>& terms) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += terms[k];
  }

  double part_of(std::size_t r) const {
    return (2 * static_cast<double>(r) + 1) / static_cast<double>(rows_.size()) - 1;
  }

  void put(std::size_t r, const std::vector<double>& terms) {
    x_.row(static_cast<Eigen::Index>(r)).head(x_.cols() - 1) =
        Eigen::Map<const Eigen::RowVectorXd>(terms.data(), x_.cols() - 1);
  }

  Squares left() const {
    std::array<Eigen::MatrixXd, kParts> grams;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(x_.cols(), x_.cols());
    for (std::size_t part = 0; part < kParts; ++part) {
      const auto begin = static_cast<Eigen::Index>(rows_.size() * part / kParts);
      const auto end = static_cast<Eigen::Index>(rows_.size() * (part + 1) / kParts);
      const auto some = x_.middleRows(begin, end - begin);
      grams[part] = some.transpose() * some;
      all += grams[part];
    }
    Squares squares;
    for (std::size_t part = 0; part < kParts; ++part) {
      squares(static_cast<Eigen::Index>(part)) = left_of(all - grams[part]);
    }
    squares(kParts) = left_of(all);
    return squares;
  }

  // Of the last column beside the others, by least squares.
  static double left_of(const Eigen::MatrixXd& gram) {
    const Eigen::Index p = gram.cols() - 1;
    const Eigen::VectorXd scale =
        gram.diagonal().head(p).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd a = scale.asDiagonal() * gram.topLeftCorner(p, p) * scale.asDiagonal();
    a.diagonal().array() += kDependent * kDependent;
    const Eigen::VectorXd b = scale.cwiseProduct(gram.col(p).head(p));
    return gram(p, p) - b.dot(a.ldlt().solve(b));
  }

  const Terms& terms_;
  const std::vector<SteadyRow>& rows_;
  double independent_;
  Eigen::MatrixXd x_;  // the terms, and the torque
  std::map<std::ptrdiff_t, Squares> by_shift_;
};

// Where the squares are least, and the variance of that.
struct Place {
  double value = 0;
  double variance = 0;
};

// Where the parabola is least that fits the squares at `first`, `first` + `step` ... best; nothing
// where it has no least place.
std::optional<Place> least_of(std::span<const Squares> squares, double first, double step,
                              double independent_rows) {
  const double middle = 0.5 * static_cast<double>(squares.size() - 1);
  Squares slope = Squares::Zero();
  Squares bend = Squares::Zero();
  double lengths = 0;  // of the parabola's polynomials
  double bends = 0;
  double mean_square = 0;
  for (std::size_t k = 0; k < squares.size(); ++k) {
    const double at = static_cast<double>(k) - middle;
    mean_square += at * at / static_cast<double>(squares.size());
  }
  for (std::size_t k = 0; k < squares.size(); ++k) {
    const double at = static_cast<double>(k) - middle;
    const double curved = at * at - mean_square;
    slope += at * squares[k];
    bend += curved * squares[k];
    lengths += at * at;
    bends += curved * curved;
  }
  slope /= lengths;
  bend /= bends;
  if (!(bend.minCoeff() > 0)) return {};
  const Squares place = first + step * (middle - 0.5 * slope / bend);
  constexpr double kShare = static_cast<double>(kParts - 1) / kParts;
  const double by_parts = kShare * (place - place(kParts)).square().sum();  // the jackknife's
  // A flat valley has a least place, too, and the same one without any part.
  const double by_bend =
      step * step * squares[squares.size() / 2](kParts) / (bend(kParts) * independent_rows);
  return Place{place(kParts), std::max(by_parts, by_bend)};
}

std::optional<Place> place_of_least(LateTerms& terms, std::ptrdiff_t longest) {
  const std::ptrdiff_t coarse = std::max<std::ptrdiff_t>(1, longest / kCoarse);
  std::ptrdiff_t best = -longest;
  const auto try_out = [&](std::ptrdiff_t late) {
    if (std::abs(late) <= longest &&
        terms.left_by_shift(late)(kParts) < terms.left_by_shift(best)(kParts)) {
      best = late;
    }
  };
  for (std::ptrdiff_t late = -longest; late <= longest; late += coarse) try_out(late);
  for (std::ptrdiff_t finer = coarse / 2; finer >= 1; finer /= 2) {
    const std::ptrdiff_t middle = best;
    try_out(middle - finer);
    try_out(middle + finer);
  }
  if (std::abs(best) == longest) return {};
  const std::ptrdiff_t beside = std::min(coarse, longest - std::abs(best));
  std::vector<Squares> around;
  for (std::ptrdiff_t late = best - beside; late <= best + beside; ++late) {
    around.push_back(terms.left_by_shift(late));
  }
  return least_of(around, static_cast<double>(best - beside), 1, terms.independent_rows());
}

struct Estimate {
  EffortDelay delay;
  double left = 0;  // squares
};

// The time constant of a first-order filter, where that leaves less than the delay does. The terms
// of the delay are means over as long: a filter takes the noise of the motion, too.
std::optional<Estimate> filter_of(LateTerms& terms, const Estimate& late, double step,
                                  std::span<const RowRange> pieces) {
  constexpr std::array kTimes = {0.85, 1.05, 1.25,
                                 1.45, 1.65, 1.85};  // a filter's passes for a shorter delay
  std::array<Squares, kTimes.size()> left;
  std::size_t best = 0;
  for (std::size_t k = 0; k < kTimes.size(); ++k) {
    left[k] = terms.left_by_filter(FirstOrder(kTimes[k] * late.delay.value, step), pieces);
    if (left[k](kParts) < left[best](kParts)) best = k;
  }
  if (late.left <= left[best](kParts) || best == 0 || best + 1 == kTimes.size()) return {};
  const std::optional<Place> place =
      least_of(std::span(left).subspan(best - 1, 3), kTimes[best - 1], kTimes[1] - kTimes[0],
               terms.independent_rows());
  if (!place) return {};
  const EffortDelay filter{late.delay.value * place->value,
                           late.delay.value * std::sqrt(place->variance), true};
  if (!is_surely_late(filter)) return {};
  return Estimate{filter, left[best](kParts)};
}

std::optional<Estimate> estimate(LateTerms& terms, double step, std::ptrdiff_t longest,
                                 std::span<const RowRange> pieces) {
  const std::optional<Place> place = place_of_least(terms, longest);
  if (!place || !(std::abs(place->value) < static_cast<double>(longest))) return {};
  const auto rows = static_cast<std::ptrdiff_t>(std::lround(place->value));
  Estimate late{{step * place->value, step * std::sqrt(place->variance)}, 0};
  if (!is_surely_late(late.delay)) return late;
  late.left = terms.left_by_means(rows, std::min(rows / 2, longest - std::abs(rows)));
  return filter_of(terms, late, step, pieces).value_or(late);
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
  const auto longest = static_cast<std::ptrdiff_t>(reach);
  const Terms all{data, gear_ratio,          blunting, way, top_speed(v->values),
                  true, fit_rigid_body(data)};
  LateTerms beside_all(all, thinned, torque->values);
  const std::optional<Estimate> late = estimate(beside_all, step, longest, pieces);
  // A motion that changes through the recording, as a sweep of frequencies, tells no delay beside a
  // friction that does. The delay alone is believed where that friction, which has more terms, does
  // not explain more than they cost (Schwarz 1978).
  Terms steady = all;
  steady.changes_slowly = false;
  LateTerms beside_steady(steady, thinned, torque->values);
  const std::optional<Estimate> alone = estimate(beside_steady, step, longest, pieces);
  if (alone && is_surely_late(alone->delay)) {
    const double changing =
        late && is_surely_late(late->delay)
            ? late->left
            : beside_all.left_by_means(
                  0,
                  std::min<std::ptrdiff_t>(longest, std::lround(0.5 * alone->delay.value / step)));
    const double rows = beside_all.independent_rows();
    const double terms = Terms::kSlowTerms * elementary::log(rows) / rows;
    if (elementary::log(alone->left / changing) <= terms) return alone->delay;
  }
  if (!late) return {};
  return late->delay;
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

Shifted filtered_by(std::span<const double> time, std::span<const double> values,
                    std::span<const RowRange> pieces, double seconds) {
  Shifted out{{values.begin(), values.end()}, std::vector<char>(values.size(), 1)};
  for (const RowRange& piece : pieces) {
    for (std::size_t i = piece.begin + 1; i < piece.end; ++i) {
      const FirstOrder filter(seconds, time[i] - time[i - 1]);
      out.values[i] = filter.next(out.values[i - 1], values[i - 1], values[i]);
      if (time[i] - time[piece.begin] > kFilterSettles * seconds) out.lost[i] = 0;
    }
  }
  return out;
}

}  // namespace tribench
