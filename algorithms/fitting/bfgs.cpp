// SPDX-License-Identifier: MIT
#include "algorithms/fitting/bfgs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace tribench {
namespace {

constexpr double kDecrease = 1e-4;  // c1
constexpr double kCurvature = 0.9;  // c2
constexpr int kMostSteps = 10;      // of bracketing, and of zooming
constexpr double kCubicEdge = 0.2;  // an interpolated step keeps so far from the bracket's ends
constexpr double kQuadraticEdge = 0.1;
constexpr double kStraight = 1000;  // 1 / y's where y's is 0

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// A point along the search direction.
struct Step {
  double length = 0;
  double value = 0;
  double slope = 0;
};

// Minimum of the cubic through two values and a slope at the first and a third value; nothing where
// there is none. SciPy's _cubicmin.
std::optional<double> cubic_minimum(const Step& a, const Step& b, const Step& c) {
  const double db = b.length - a.length;
  const double dc = c.length - a.length;
  const double scale = db * db * dc * dc * (db - dc);
  const double rest_b = b.value - a.value - a.slope * db;
  const double rest_c = c.value - a.value - a.slope * dc;
  const double third = (dc * dc * rest_b - db * db * rest_c) / scale;
  const double second = (-dc * dc * dc * rest_b + db * db * db * rest_c) / scale;
  const double root = second * second - 3 * third * a.slope;
  const double length = a.length + (-second + std::sqrt(root)) / (3 * third);
  if (!std::isfinite(length)) return std::nullopt;
  return length;
}

double quadratic_minimum(const Step& a, const Step& b) {
  const double d = b.length - a.length;
  return a.length - a.slope * d * d / (2 * (b.value - a.value - a.slope * d));
}

class Bfgs {
 public:
  Bfgs(const Objective& objective, std::span<const double> start, const BfgsOptions& options)
      : objective_(objective),
        options_(options),
        n_(start.size()),
        x_(start.begin(), start.end()),
        gradient_(n_),
        direction_(n_),
        trial_(n_),
        trial_gradient_(n_),
        inverse_(n_ * n_) {}

  Minimum run();

 private:
  double evaluate(std::span<const double> x, std::span<double> gradient) {
    ++evaluations_;
    return objective_(x, gradient);
  }
  bool stopped() const { return options_.stop != nullptr && *options_.stop; }
  Step at(double length);
  std::optional<Step> line_search(double first);
  std::optional<Step> zoom(Step low, Step high, const Step& start);
  void update();
  Minimum result(MinimizeStatus status) const { return {x_, value_, status, evaluations_}; }

  const Objective& objective_;
  const BfgsOptions& options_;
  std::size_t n_;
  std::vector<double> x_;
  double value_ = 0;
  std::vector<double> gradient_;
  std::vector<double> direction_;
  std::vector<double> trial_;
  std::vector<double> trial_gradient_;
  std::vector<double> inverse_;  // of the Hessian, approximately
  std::uint64_t evaluations_ = 0;
};

Step Bfgs::at(double length) {
  for (std::size_t i = 0; i < n_; ++i) trial_[i] = x_[i] + length * direction_[i];
  const double value = evaluate(trial_, trial_gradient_);
  return {length, std::isfinite(value) ? value : HUGE_VAL, dot(trial_gradient_, direction_)};
}

// N&W 3.5. The step that is returned is the one evaluated last.
std::optional<Step> Bfgs::line_search(double first) {
  const Step start{0, value_, dot(gradient_, direction_)};
  Step before = start;
  Step step = at(first);
  for (int i = 0; i < kMostSteps && !stopped(); ++i) {
    if (step.value > start.value + kDecrease * step.length * start.slope ||
        (i > 0 && step.value >= before.value)) {
      return zoom(before, step, start);
    }
    if (std::abs(step.slope) <= -kCurvature * start.slope) return step;
    if (step.slope >= 0) return zoom(step, before, start);
    before = step;
    step = at(2 * step.length);
  }
  return std::nullopt;
}

// N&W 3.6 with SciPy's choice of the trial: cubic, else quadratic, else the middle.
std::optional<Step> Bfgs::zoom(Step low, Step high, const Step& start) {
  Step third = start;
  for (int i = 0; i <= kMostSteps && !stopped(); ++i) {
    const double width = high.length - low.length;
    const double from = std::min(low.length, high.length);
    const double to = std::max(low.length, high.length);
    const auto inside = [&](double length, double edge) {
      return length >= from + edge * std::abs(width) && length <= to - edge * std::abs(width);
    };
    std::optional<double> length;
    if (i > 0) length = cubic_minimum(low, high, third);
    if (!length || !inside(*length, kCubicEdge)) {
      length = quadratic_minimum(low, high);
      if (!std::isfinite(*length) || !inside(*length, kQuadraticEdge)) {
        length = low.length + 0.5 * width;
      }
    }
    const Step trial = at(*length);
    if (trial.value > start.value + kDecrease * trial.length * start.slope ||
        trial.value >= low.value) {
      third = high;
      high = trial;
      continue;
    }
    if (std::abs(trial.slope) <= -kCurvature * start.slope) return trial;
    third = low;
    if (trial.slope * width >= 0) {
      third = high;
      high = low;
    }
    low = trial;
  }
  return std::nullopt;
}

// From x to trial: inverse = (I - r s y') inverse (I - r y s') + r s s', r = 1 / y's.
void Bfgs::update() {
  std::vector<double> s(n_);
  std::vector<double> y(n_);
  for (std::size_t i = 0; i < n_; ++i) {
    s[i] = trial_[i] - x_[i];
    y[i] = trial_gradient_[i] - gradient_[i];
  }
  const double along = dot(y, s);
  const double r = along == 0 ? kStraight : 1 / along;
  std::vector<double> hy(n_);
  for (std::size_t i = 0; i < n_; ++i) hy[i] = dot(std::span(inverse_).subspan(i * n_, n_), y);
  const double scale = r * (1 + r * dot(y, hy));
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) {
      inverse_[i * n_ + j] += scale * s[i] * s[j] - r * (hy[i] * s[j] + s[i] * hy[j]);
    }
  }
}

Minimum Bfgs::run() {
  value_ = evaluate(x_, gradient_);
  if (!std::isfinite(value_)) return result(MinimizeStatus::failed);
  for (std::size_t i = 0; i < n_; ++i) inverse_[i * n_ + i] = 1;
  double value_before = value_ + std::sqrt(dot(gradient_, gradient_)) / 2;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    const double steepest =
        std::abs(*std::ranges::max_element(gradient_, {}, [](double g) { return std::abs(g); }));
    if (steepest <= options_.gradient_tolerance) return result(MinimizeStatus::converged);
    if (stopped()) return result(MinimizeStatus::limit);
    for (std::size_t i = 0; i < n_; ++i) {
      direction_[i] = -dot(std::span(inverse_).subspan(i * n_, n_), gradient_);
    }
    const double slope = dot(gradient_, direction_);
    double first = std::min(1.0, 1.01 * 2 * (value_ - value_before) / slope);
    if (!(first > 0)) first = 1;
    const std::optional<Step> step = line_search(first);
    if (!step || !std::isfinite(step->value) || !std::isfinite(step->slope)) {
      return result(stopped() ? MinimizeStatus::limit : MinimizeStatus::failed);
    }
    update();
    value_before = value_;
    value_ = step->value;
    std::swap(x_, trial_);
    std::swap(gradient_, trial_gradient_);
  }
  return result(MinimizeStatus::limit);
}

}  // namespace

Minimum minimize_bfgs(const Objective& objective, std::span<const double> start,
                      const BfgsOptions& options) {
  if (start.empty()) return {};
  return Bfgs(objective, start, options).run();
}

}  // namespace tribench
