// SPDX-License-Identifier: MIT
#include "algorithms/relay/wave_sum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/constant_fit.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"
#include "algorithms/relay/golden_section.hpp"
#include "algorithms/relay/target_forms.hpp"
#include "algorithms/relay/waves.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kMostWaveInputs = 4;
constexpr std::size_t kRowsOfAScan = 160;
constexpr int kGridFrequencies = 400;  // a quarter of a wave over the range apart
constexpr std::size_t kGridTried = 3;  // of the grid's best
constexpr int kSections = 60;          // of the frequency, to rounding
constexpr double kNearlyExact = 1e-6;  // of the target's size, root mean square
constexpr double kNoTerm = 1e-9;       // of the target's size, that a term explains

class WaveSumSearch {
 public:
  WaveSumSearch(const LogRows& rows, std::size_t waved, Budget& budget)
      : rows_(rows), waved_(waved), budget_(budget) {
    const auto [low, high] = std::ranges::minmax(rows.inputs()[waved].values);
    range_ = high - low;
    const std::size_t count = std::min(kRowsOfAScan, rows.rows());
    for (std::size_t i = 0; i < count; ++i) scanned_.push_back(i * rows.rows() / count);
    for (std::size_t r = 0; r < rows.rows(); ++r) all_.push_back(r);
  }

  std::optional<Expression> run() {
    if (!(range_ > 0)) return std::nullopt;
    std::vector<std::pair<double, double>> trials;  // what is left, frequency
    for (int k = 1; k <= kGridFrequencies; ++k) {
      const double frequency = k * step();
      const std::size_t p = 3 * rows_.inputs().size() + 1;
      if (!budget_.spend(p * p / 4 * scanned_.size())) return std::nullopt;
      trials.emplace_back(regression(frequency, scanned_).sum_squares, frequency);
    }
    std::ranges::stable_sort(trials);
    trials.resize(kGridTried);
    for (const auto& [left, frequency] : trials) {
      if (auto found = exact(refined(frequency))) return found;
    }
    return std::nullopt;
  }

 private:
  double step() const { return std::numbers::pi / 2 / range_; }

  // 1 and the inputs, then 1 and the other inputs times the sine, and times the cosine.
  LinearFit regression(double frequency, const std::vector<std::size_t>& of) const {
    const std::vector<std::vector<double>> columns = columns_at(frequency, of);
    std::vector<double> target;
    for (const std::size_t r : of) target.push_back(rows_.target().values[r]);
    std::vector<const double*> pointers;
    for (const auto& column : columns) pointers.push_back(column.data());
    return solve_least_squares(pointers, target);
  }

  std::vector<std::vector<double>> columns_at(double frequency,
                                              const std::vector<std::size_t>& of) const {
    std::vector<std::vector<double>> columns;
    for (const Term& term : terms()) {
      std::vector<double>& column = columns.emplace_back();
      for (const std::size_t r : of) {
        const double turn = frequency * rows_.inputs()[waved_].values[r];
        const double wave = term.wave == Wave::none   ? 1
                            : term.wave == Wave::sine ? elementary::sin(turn)
                                                      : elementary::cos(turn);
        column.push_back(wave * (term.input ? rows_.inputs()[*term.input].values[r] : 1));
      }
    }
    return columns;
  }

  enum class Wave { none, sine, cosine };
  struct Term {
    std::optional<std::size_t> input;  // 1 where there is none
    Wave wave;
  };
  std::vector<Term> terms() const {
    std::vector<Term> list;
    for (const Wave wave : {Wave::none, Wave::sine, Wave::cosine}) {
      list.push_back({std::nullopt, wave});
      for (std::size_t k = 0; k < rows_.inputs().size(); ++k) {
        if (wave == Wave::none || k != waved_) list.push_back({k, wave});
      }
    }
    return list;
  }

  double refined(double frequency) const {
    const auto left_at = [&](double f) { return regression(f, scanned_).sum_squares; };
    return least_by_golden_sections(left_at, frequency - step(), frequency + step(), kSections);
  }

  std::optional<Expression> exact(double frequency) const {
    double size = 0;
    for (const double y : rows_.target().values) size += y * y;
    const LinearFit fit = regression(frequency, all_);
    if (!(fit.sum_squares <= kNearlyExact * kNearlyExact * size)) return std::nullopt;
    Expression formula = written(frequency, fit.coefficients, std::sqrt(size));
    if (formula.empty()) return std::nullopt;
    std::vector<const double*> pointers;
    for (const Factor& input : rows_.inputs()) pointers.push_back(input.values.data());
    ConstantFitOptions options;
    options.function_tolerance = 1e-15;
    options.step_tolerance = 1e-15;
    const ConstantFitResult result =
        ConstantFitter().fit(formula, {pointers, rows_.rows()}, rows_.target().values, {}, options);
    budget_.spend(result.node_rows);
    if (!explains(formula, rows_)) return std::nullopt;
    return formula;
  }

  // Without the terms that explain nothing; sine and cosine of one size as one wave.
  Expression written(double frequency, const std::vector<double>& coefficients,
                     double target_size) const {
    const std::vector<Term> list = terms();
    const std::vector<std::vector<double>> columns = columns_at(frequency, all_);
    const auto coefficient_of = [&](const std::optional<std::size_t>& input, Wave wave) {
      for (std::size_t k = 0; k < list.size(); ++k) {
        if (list[k].input != input || list[k].wave != wave) continue;
        double square = 0;
        for (const double x : columns[k]) square += x * x;
        const double c = coefficients[k];
        return std::abs(c) * std::sqrt(square) > kNoTerm * target_size ? c : 0.0;
      }
      return 0.0;
    };
    const auto times = [&](double c, const std::optional<std::size_t>& input) {
      return input ? constant(c) * build::input(*input) : constant(c);
    };
    Expression formula;
    for (const Term& term : list) {
      const double plain = coefficient_of(term.input, Wave::none);
      if (term.wave == Wave::none && plain != 0) {
        formula = sum_of(formula, times(plain, term.input));
      }
      const double sine = coefficient_of(term.input, Wave::sine);
      const double cosine = coefficient_of(term.input, Wave::cosine);
      if (term.wave != Wave::sine || (sine == 0 && cosine == 0)) continue;
      const Expression turn = constant(frequency) * build::input(waved_);
      const Expression wave = sine == 0 ? times(cosine, term.input) * function(Op::cos, turn)
                              : cosine == 0
                                  ? times(sine, term.input) * function(Op::sin, turn)
                                  : times(std::sqrt(sine * sine + cosine * cosine), term.input) *
                                        function(Op::sin, turn + constant(phase_of(cosine, sine)));
      formula = sum_of(formula, wave);
    }
    return formula;
  }

  const LogRows& rows_;
  std::size_t waved_;
  Budget& budget_;
  double range_ = 0;
  std::vector<std::size_t> scanned_;
  std::vector<std::size_t> all_;
};

}  // namespace

std::optional<Expression> find_wave_sum(const LogRows& rows, const OperatorSet& operators,
                                        Budget& budget) {
  const std::size_t inputs = rows.inputs().size();
  if (inputs < 2 || inputs > kMostWaveInputs || rows.rows() < 12 * inputs) return std::nullopt;
  if (!operators.allows(Op::sin) || !operators.allows(Op::cos) || !operators.allows(Op::mul)) {
    return std::nullopt;
  }
  for (std::size_t j = 0; j < inputs; ++j) {
    auto found = WaveSumSearch(rows, j, budget).run();
    if (found && operators.admits(*found)) return found;
  }
  return std::nullopt;
}

}  // namespace tribench::relay
