// SPDX-License-Identifier: MIT
#include "algorithms/relay/waves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kScannedRows = 200;
constexpr int kWaveFrequencies = 400;  // a quarter of a wave over the range apart
constexpr std::array<double, 8> kWaveDecays = {-1, -2, -4, -8, -16, 1, 2, 4};  // over the range
constexpr std::size_t kWavesTried = 3;                                         // of the grid's best
constexpr int kWaveTurns = 8;  // of looking for one wave beside the other

using WaveColumn = std::vector<double>;

// A wave exp(decay x) sin(frequency x + phase) times `size`.
struct Wave {
  double decay = 0;
  double frequency = 0;
  double size = 1;
  double phase = 0;
};

// Of cosine times c and sine times s.
void set_size_and_phase(Wave& wave, double c, double s) {
  wave.size = std::sqrt(c * c + s * s);
  wave.phase = phase_of(c, s);
}

class WaveSearch {
 public:
  WaveSearch(const LogRows& rows, int power, Budget& budget)
      : rows_(rows), power_(power), budget_(budget) {
    const std::vector<double>& x = rows.inputs()[0].values;
    const std::vector<double>& y = rows.target().values;
    const auto [low, high] = std::ranges::minmax(x);
    range_ = high - low;
    const std::size_t every = (x.size() + kScannedRows - 1) / kScannedRows;
    for (std::size_t r = 0; r < x.size(); r += every) {
      x_.push_back(x[r]);
      const double size = elementary::pow(std::abs(x[r]), -power);
      before_.push_back(power % 2 != 0 && x[r] < 0 ? -size : size);
      target_.push_back(y[r]);
    }
    for (int k = 1; k <= kWaveFrequencies; ++k) {
      for (WaveColumn& column : columns_of({0, frequency(k)})) waves_.push_back(std::move(column));
    }
  }

  bool is_usable() const {
    const auto is_finite = [](double v) { return std::isfinite(v); };
    return range_ > 0 && std::ranges::all_of(before_, is_finite) &&
           std::ranges::all_of(target_, is_finite);
  }

  std::optional<Expression> one_that_decays() {
    std::vector<Trial> trials;
    const Beside nothing = beside({});
    for (const double decay : kWaveDecays) {
      WaveColumn fading(x_.size());
      for (std::size_t r = 0; r < x_.size(); ++r) {
        fading[r] = elementary::exp(decay / range_ * x_[r]);
      }
      for (int k = 1; k <= kWaveFrequencies; ++k) {
        trials.push_back({nothing.explained(times(cosine(k), fading), times(sine(k), fading)),
                          {decay / range_, frequency(k)}});
      }
    }
    return first_exact(std::move(trials), [](const Wave& wave) { return std::vector{wave}; });
  }

  std::optional<Expression> two() {
    std::vector<Trial> trials;
    const Beside nothing = beside({});
    for (int k = 1; k <= kWaveFrequencies; ++k) {
      trials.push_back({nothing.explained(cosine(k), sine(k)), {0, frequency(k)}});
    }
    return first_exact(std::move(trials), [this](const Wave& wave) {
      std::vector<Wave> both = {wave, best_beside(wave)};
      for (int turn = 0; turn < kWaveTurns; ++turn) {
        const Wave before = both[0];
        both[0] = best_beside(both[1]);
        if (both[0].frequency == before.frequency) break;
        both[1] = best_beside(both[0]);
      }
      return both;
    });
  }

 private:
  struct Trial {
    double explained;
    Wave wave;
  };

  // What some columns leave of the target, and what two more explain of that.
  struct Beside {
    std::vector<WaveColumn> basis;  // orthonormal
    WaveColumn left;

    void take_off(WaveColumn& column) const {
      for (const WaveColumn& one : basis) {
        const double along = dot(one, column);
        for (std::size_t r = 0; r < column.size(); ++r) column[r] -= along * one[r];
      }
    }
    void add(WaveColumn column) {
      take_off(column);
      const double length = std::sqrt(dot(column, column));
      if (!(length > 0)) return;
      for (double& v : column) v /= length;
      basis.push_back(std::move(column));
    }
    double explained(WaveColumn c, WaveColumn s) const {
      constexpr double kDependent = 1e-10;
      take_off(c);
      take_off(s);
      const double cc = dot(c, c);
      const double ss = dot(s, s);
      const double cs = dot(c, s);
      const double determinant = cc * ss - cs * cs;
      if (!(determinant > kDependent * cc * ss)) return 0;
      const double cl = dot(c, left);
      const double sl = dot(s, left);
      return (cl * cl * ss - 2 * cl * sl * cs + sl * sl * cc) / determinant;
    }
  };

  static double dot(const WaveColumn& a, const WaveColumn& b) {
    return columns::dot(a.data(), b.data(), a.size());
  }
  static WaveColumn times(WaveColumn a, const WaveColumn& b) {
    for (std::size_t r = 0; r < a.size(); ++r) a[r] *= b[r];
    return a;
  }

  double frequency(int k) const { return k * std::numbers::pi / 2 / range_; }
  const WaveColumn& cosine(int k) const { return waves_[2 * static_cast<std::size_t>(k) - 2]; }
  const WaveColumn& sine(int k) const { return waves_[2 * static_cast<std::size_t>(k) - 1]; }

  // Cosine and sine of a wave, as they stand in the rows.
  std::array<WaveColumn, 2> columns_of(const Wave& wave) const {
    std::array<WaveColumn, 2> both = {WaveColumn(x_.size()), WaveColumn(x_.size())};
    for (std::size_t r = 0; r < x_.size(); ++r) {
      const double size = before_[r] * elementary::exp(wave.decay * x_[r]);
      both[0][r] = size * elementary::cos(wave.frequency * x_[r]);
      both[1][r] = size * elementary::sin(wave.frequency * x_[r]);
    }
    return both;
  }

  Beside beside(const std::vector<Wave>& waves) const {
    Beside out;
    out.left = target_;
    out.add(before_);
    for (const Wave& wave : waves) {
      for (WaveColumn& column : columns_of(wave)) out.add(std::move(column));
    }
    out.take_off(out.left);
    return out;
  }

  // The wave without decay that tells most beside this one.
  Wave best_beside(const Wave& other) const {
    const Beside rest = beside({other});
    Wave best;
    double most = 0;
    for (int k = 1; k <= kWaveFrequencies; ++k) {
      const double explained = rest.explained(cosine(k), sine(k));
      if (!(explained > most)) continue;
      most = explained;
      best = {0, frequency(k)};
    }
    return best;
  }

  LinearFit solved(const std::vector<Wave>& waves) const {
    std::vector<std::array<WaveColumn, 2>> columns;
    std::vector<const double*> pointers = {before_.data()};
    for (const Wave& wave : waves) columns.push_back(columns_of(wave));
    for (const std::array<WaveColumn, 2>& both : columns) {
      for (const WaveColumn& column : both) pointers.push_back(column.data());
    }
    return solve_least_squares(pointers, target_);
  }

  template <typename Completed>
  std::optional<Expression> first_exact(std::vector<Trial> trials, Completed completed) {
    std::ranges::stable_sort(trials, std::ranges::greater(), &Trial::explained);
    trials.resize(kWavesTried);
    for (const Trial& trial : trials) {
      // Scans of all frequencies: some ten products a row and wave.
      if (!budget_.spend(10 * waves_.size() * x_.size())) return std::nullopt;
      if (auto found = polished(completed(trial.wave))) return found;
    }
    return std::nullopt;
  }

  std::optional<Expression> polished(std::vector<Wave> waves) {
    const LinearFit start = solved(waves);
    Expression formula = constant(start.coefficients[0]);
    for (std::size_t k = 0; k < waves.size(); ++k) {
      Wave& wave = waves[k];
      set_size_and_phase(wave, start.coefficients[1 + 2 * k], start.coefficients[2 + 2 * k]);
      Expression rings =
          constant(wave.size) *
          function(Op::sin, constant(wave.frequency) * input(0) + constant(wave.phase));
      if (wave.decay != 0) rings = rings * function(Op::exp, constant(wave.decay) * input(0));
      formula = formula + rings;
    }
    if (power_ == -1) formula = input(0) * formula;
    if (power_ == 1) formula = formula / input(0);
    if (power_ == 2) formula = formula / (input(0) * input(0));
    const std::vector<double>& x = rows_.inputs()[0].values;
    const double* column = x.data();
    ConstantFitOptions options;
    options.max_iterations = 60;
    options.function_tolerance = 1e-15;
    // Once more from there: the first ends where the error hardly falls any more.
    for (int time = 0; time < 2; ++time) {
      const ConstantFitResult fit = ConstantFitter().fit(formula, {{&column, 1}, x.size()},
                                                         rows_.target().values, {}, options);
      budget_.spend(fit.node_rows);
      if (!explains(formula, rows_)) return std::nullopt;
    }
    return formula;
  }

  const LogRows& rows_;
  int power_;
  Budget& budget_;
  double range_ = 0;
  // Of the rows that are looked at.
  WaveColumn x_;
  WaveColumn before_;  // x^-p, before the sum
  WaveColumn target_;
  std::vector<WaveColumn> waves_;  // cosine and sine of each frequency
};

}  // namespace

double phase_of(double cosine, double sine) {
  if (sine == 0) return std::copysign(std::numbers::pi / 2, cosine);
  return elementary::atan(cosine / sine) + (sine < 0 ? std::numbers::pi : 0);
}

std::optional<Expression> find_waves(const LogRows& rows, const OperatorSet& operators,
                                     Budget& budget) {
  if (rows.rows() < 20 || !operators.allows(Op::mul) || !operators.allows(Op::add) ||
      !operators.allows(Op::sin)) {
    return std::nullopt;
  }
  for (const int power : {0, 1, 2, -1}) {
    if (power > 0 && !operators.allows(Op::div)) continue;
    WaveSearch search(rows, power, budget);
    if (!search.is_usable()) continue;
    auto found = search.two();
    if (!found && operators.allows(Op::exp)) found = search.one_that_decays();
    if (found && operators.admits(*found)) return found;
  }
  return std::nullopt;
}

}  // namespace tribench::relay
