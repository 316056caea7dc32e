// SPDX-License-Identifier: MIT
#include "algorithms/model_based/bam_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/finite_rows.hpp"
#include "algorithms/fitting/levenberg_marquardt.hpp"
#include "algorithms/missing_role.hpp"
#include "algorithms/model_based/friction_inputs.hpp"

namespace tribench {
namespace {

using namespace build;

enum Place : std::size_t {
  kInertia,
  kGravity,
  kOffset,
  kViscous,
  kCoulomb,
  kStribeck,
  kVelocity,
  kExponent,
  kMotor,
  kExternal,
  kMotorStribeck,
  kExternalStribeck,
  kMotorQuadratic,
  kExternalQuadratic,
  kPlaces
};
using Values = std::array<double, kPlaces>;

constexpr double kLargestShare = 0.45;  // of the motor torque: the friction that it makes exists

// What the models have of the data and of each other.
struct BamShape {
  int model = 1;
  std::size_t velocity = 0;
  Expression sign;
  std::optional<std::size_t> acceleration;
  std::optional<std::size_t> gravity;
  bool offset = true;

  bool has_stribeck() const { return model == 2 || model >= 4; }
  bool has_load() const { return model >= 3; }
};

// c e, nothing where c is 0.
Expression times(double c, const Expression& e) { return c == 0 ? Expression() : constant(c) * e; }

Expression product(const Expression& a, const Expression& b) {
  return a.empty() || b.empty() ? Expression() : a * b;
}

// (1 + sgn x) / 2: 1 where x > 0.
Expression is_positive(const Expression& x) {
  return constant(0.5) + constant(0.5) * function(Op::sgn, x);
}

Expression decay_of(const BamShape& shape, const Values& p) {
  const Expression ratio = function(Op::abs, input(shape.velocity) / constant(p[kVelocity]));
  return function(Op::exp, -power(ratio, p[kExponent]));
}

// Friction as if the motor torque made none, and what of the rest changes with it.
Expression formula_of(const BamShape& shape, const Values& p) {
  const Expression v = input(shape.velocity);
  const Expression decay = shape.has_stribeck() ? decay_of(shape, p) : Expression();
  Expression friction = sum_of(times(p[kViscous], function(Op::abs, v)),
                               p[kCoulomb] == 0 ? Expression() : constant(p[kCoulomb]));
  if (shape.has_stribeck()) friction = sum_of(friction, times(p[kStribeck], decay));
  Expression feedback;  // of F on itself, through the motor torque
  if (shape.has_load()) {
    const Expression g = input(*shape.gravity);
    Expression held = g;
    if (shape.acceleration) held = sum_of(times(p[kInertia], input(*shape.acceleration)), g);
    const Expression motor =
        friction.empty() ? held : held + shape.sign * friction;  // without load
    const auto add_load = [&](double by_motor, double by_load, const Expression& share) {
      const auto mix = [&](const Expression& torque) {
        return sum_of(times(by_motor, torque), times(by_load, g));
      };
      const Expression loaded = mix(motor);
      if (loaded.empty()) return;
      const Expression side = function(Op::sgn, loaded);
      const Expression scaled = share.empty() ? side : share * side;
      friction = sum_of(friction, scaled * mix(held));
      if (by_motor != 0) feedback = sum_of(feedback, times(by_motor, scaled));
    };
    add_load(p[kMotor], p[kExternal], {});
    if (shape.has_stribeck()) add_load(p[kMotorStribeck], p[kExternalStribeck], decay);
    if (shape.model == 6) {
      const Expression drives = is_positive(function(Op::abs, motor) - function(Op::abs, g));
      const Expression square =
          sum_of(product(times(p[kExternalQuadratic], power(g, 2)), drives),
                 product(times(p[kMotorQuadratic], power(motor, 2)), constant(1) - drives));
      friction = sum_of(friction, product(product(is_positive(g * motor), decay), square));
    }
  }
  if (!feedback.empty()) friction = friction / (constant(1) - shape.sign * feedback);
  Expression sum = friction.empty() ? Expression() : shape.sign * friction;
  if (shape.acceleration) sum = sum_of(sum, times(p[kInertia], input(*shape.acceleration)));
  if (shape.gravity) sum = sum_of(sum, times(p[kGravity], input(*shape.gravity)));
  if (p[kOffset] != 0) sum = sum_of(sum, constant(p[kOffset]));
  return sum.empty() ? constant(0) : sum;
}

// The parameters that a model has, tied ones as one; LM moves them in units of their own.
class BamProblem : public LeastSquaresProblem {
 public:
  BamProblem(const BamShape& shape, const FiniteRows& data, Budget& budget)
      : shape_(shape), data_(data), budget_(budget), values_(data.rows()), moved_(data.rows()) {
    const auto move = [this](Place place, double low, double high) {
      places_.push_back(place);
      low_.push_back(low);
      high_.push_back(high);
    };
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    for (const double v : data.columns[shape.velocity]) top_ = std::max(top_, std::abs(v));
    if (shape.acceleration) move(kInertia, -kUnbounded, kUnbounded);
    if (shape.gravity) move(kGravity, -kUnbounded, kUnbounded);
    if (shape.offset) move(kOffset, -kUnbounded, kUnbounded);
    move(kViscous, -kUnbounded, kUnbounded);
    move(kCoulomb, 0, kUnbounded);
    if (shape.has_stribeck()) {
      move(kStribeck, 0, kUnbounded);
      move(kVelocity, 1e-3 * top_, top_);
      move(kExponent, 1, 10);
    }
    if (shape.has_load()) move(kMotor, 0, kLargestShare);
    if (shape.model >= 5) move(kExternal, 0, 1);
    if (shape.has_load() && shape.has_stribeck()) move(kMotorStribeck, 0, kLargestShare);
    if (shape.model >= 5) move(kExternalStribeck, 0, 1);
    if (shape.model == 6) {
      move(kMotorQuadratic, 0, kUnbounded);
      move(kExternalQuadratic, 0, kUnbounded);
    }
  }

  double sum_squares(std::span<const double> x) override {
    x_.assign(x.begin(), x.end());
    if (!evaluate(x, values_)) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (std::size_t r = 0; r < values_.size(); ++r) {
      values_[r] -= data_.target[r];
      sum += values_[r] * values_[r];
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

  // Differences forward, backward at an upper bound: the model is smooth but at its kinks.
  void normal_equations(NormalEquations& sums) override {
    const std::size_t p = x_.size();
    const std::size_t n = values_.size();
    sums.gradient.assign(p, 0);
    sums.curvature.assign(p * p, 0);
    sums.sum_squares = 0;
    std::vector<std::vector<double>> columns(p);
    for (const double error : values_) sums.sum_squares += error * error;
    for (std::size_t j = 0; j < p; ++j) {
      std::vector<double> x = x_;
      double step = 1e-7 * std::max(std::abs(x[j]), scale_of(places_[j]));
      if (x[j] + step > high_[j]) step = -step;
      x[j] += step;
      columns[j].assign(n, 0);
      if (!evaluate(x, moved_)) {
        sums.sum_squares = std::numeric_limits<double>::infinity();
        return;
      }
      for (std::size_t r = 0; r < n; ++r) {
        columns[j][r] = (moved_[r] - data_.target[r] - values_[r]) / step;
        sums.gradient[j] += columns[j][r] * values_[r];
      }
      for (std::size_t i = 0; i <= j; ++i) {
        double product = 0;
        for (std::size_t r = 0; r < n; ++r) product += columns[i][r] * columns[j][r];
        sums.curvature[i * p + j] = product;
        sums.curvature[j * p + i] = product;
      }
    }
  }

  Values values_at(std::span<const double> x) const {
    Values all{};
    all[kVelocity] = top_ > 0 ? top_ : 1;
    all[kExponent] = 1;
    for (std::size_t i = 0; i < places_.size(); ++i) all[places_[i]] = x[i];
    if (shape_.model < 5) {
      all[kExternal] = all[kMotor];
      all[kExternalStribeck] = all[kMotorStribeck];
    }
    return all;
  }

  // A start with a Stribeck velocity and a share of the load; what is linear follows by the walk.
  std::vector<double> start(double velocity_share, double load_share) const {
    double level = 0;
    for (const double y : data_.target) level += std::abs(y);
    level /= static_cast<double>(data_.target.size());
    Values all{};
    all[kGravity] = 0.5;
    all[kCoulomb] = level;
    all[kStribeck] = 0.1 * level;
    all[kVelocity] = velocity_share * top_;
    all[kExponent] = 1.35;
    all[kMotor] = all[kExternal] = load_share;
    all[kMotorStribeck] = all[kExternalStribeck] = 0.5 * load_share;
    std::vector<double> x;
    for (const Place place : places_) x.push_back(all[place]);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::clamp(x[i], low_[i], high_[i]);
    return x;
  }

  std::span<const double> low() const { return low_; }
  std::span<const double> high() const { return high_; }

 private:
  // Below it a parameter is as good as 0: where its difference quotient takes its step from.
  double scale_of(Place place) const {
    if (place == kVelocity) return std::max(top_, 1e-300);
    return place >= kExponent && place <= kExternalStribeck ? 0.01 : 1e-3 * largest_target();
  }

  double largest_target() const {
    double largest = 1e-300;
    for (const double y : data_.target) largest = std::max(largest, std::abs(y));
    return largest;
  }

  bool evaluate(std::span<const double> x, std::span<double> out) {
    const Expression formula = formula_of(shape_, values_at(x));
    if (!budget_.spend(node_rows(formula, data_.rows()))) return false;
    evaluator_.evaluate(formula, data_.table(), out);
    return true;
  }

  const BamShape& shape_;
  const FiniteRows& data_;
  Budget& budget_;
  Evaluator evaluator_;
  double top_ = 0;
  std::vector<Place> places_;
  std::vector<double> low_;
  std::vector<double> high_;
  std::vector<double> x_;
  std::vector<double> values_;  // errors at x_
  std::vector<double> moved_;
};

class BamModel : public Regressor {
 public:
  BamModel(int model, const Parameters& parameters)
      : model_(model), offset_(parameters.flag("offset")) {}

  FitResult fit(FitContext& context) const override {
    const auto inputs = find_friction_inputs(context.data.inputs);
    if (!inputs) return unsupported_without_role("needs an input", "velocity");
    BamShape shape{model_, inputs->velocity, inputs->sign(), inputs->acceleration, {}, offset_};
    for (std::size_t j = 0; j < context.data.inputs.size() && !shape.gravity; ++j) {
      if (context.data.inputs[j].role == Role::gravity_torque) shape.gravity = j;
    }
    if (shape.has_load() && !shape.gravity) {
      return unsupported_without_role("friction from load needs an input", "gravity_torque");
    }
    const FiniteRows data(context.data);
    if (data.rows() == 0) return FitResult::unsupported("there is no row without missing values");
    if (context.budget.remaining() == 0) return {{}, 0, StopReason::budget, "no budget"};
    return fit_shape(shape, data, context);
  }

 private:
  FitResult fit_shape(const BamShape& shape, const FiniteRows& data, FitContext& context) const {
    BamProblem problem(shape, data, context.budget);
    LevenbergMarquardt walker;
    LevenbergMarquardtOptions options;
    options.max_iterations = 100;
    options.low = problem.low();
    options.high = problem.high();
    double best = std::numeric_limits<double>::infinity();
    std::vector<double> found;
    for (const double velocity : {0.03, 0.3}) {
      for (const double load : {0.02, 0.2}) {
        std::vector<double> x = problem.start(velocity, load);
        walker.minimize(problem, x, options);
        const double value = problem.sum_squares(x);
        if (!(value < best)) continue;
        best = value;
        found = std::move(x);
      }
    }
    if (found.empty()) return {{}, 0, StopReason::budget, "no budget for a fit"};
    FitResult result;
    result.reason = context.budget.exhausted() ? StopReason::budget : StopReason::converged;
    result.front = {formula_of(shape, problem.values_at(found))};
    if (context.progress != nullptr) {
      context.progress->improved(best / static_cast<double>(data.rows()), context.budget.spent());
    }
    return result;
  }

  int model_;
  bool offset_;
};

template <int model>
AlgorithmEntry entry(std::string what) {
  return {fmt::format("bam_m{}", model),
          fmt::format("BAM's model M{}: {}", model, what),
          {{"offset", "adds a constant sensor offset", true}},
          true,
          [](const Parameters& parameters, const MakeMethod&) -> std::unique_ptr<Regressor> {
            return std::make_unique<BamModel>(model, parameters);
          }};
}

}  // namespace

std::vector<AlgorithmEntry> bam_entries() {
  return {entry<1>("Coulomb and viscous friction"),
          entry<2>("Stribeck"),
          entry<3>("friction from load"),
          entry<4>("Stribeck and friction from load"),
          entry<5>("friction from load by its direction"),
          entry<6>("M5 with a quadratic share of the weaker side")};
}

}  // namespace tribench
