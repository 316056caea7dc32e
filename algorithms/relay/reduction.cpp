// SPDX-License-Identifier: MIT
#include "algorithms/relay/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/named_values.hpp"
#include "algorithms/relay/scaling.hpp"
#include "algorithms/relay/surrogate.hpp"
#include "foundation/elementary.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr double kRough = 0.1;           // error of a surrogate whose slopes say nothing
constexpr double kNoise = 50;            // times a surrogate's error: of its slopes
constexpr std::size_t kMostGuessed = 6;  // inputs
constexpr double kLeast = 0.02;
constexpr double kSteady = 0.02;    // a slope that is a power, for its constant to be told
constexpr double kNearName = 1e-4;  // of that constant, a number with a name
constexpr double kMost = 0.3;

double tolerance_of(const Surrogate& surrogate) {
  return std::clamp(kNoise * surrogate.error(), kLeast, kMost);
}

bool is_positive(const Factor& input) {
  return input.has_logs() && !input.changes_sign && input.values[0] > 0;
}

// T(y) = y^p.
double exponent_of(TargetForm form) {
  return form == TargetForm::square           ? 2
         : form == TargetForm::inverse        ? -1
         : form == TargetForm::inverse_square ? -2
                                              : 1;
}

class Finder {
 public:
  Finder(const LogRows& rows, Guesses guesses, Budget& budget)
      : rows_(rows),
        guesses_(guesses),
        budget_(budget),
        has_one_sign_(rows.target().has_logs() && !rows.target().changes_sign) {}

  Reductions run() {
    struct Power {
      double exponent;
      std::vector<double> target;
      Surrogate surrogate;
    };
    std::optional<Power> power;  // of y, that a polynomial is nearest to
    double log_error = HUGE_VAL;
    for (const TargetForm form : kTargetForms) {
      if (form != TargetForm::plain && !has_one_sign_) continue;
      std::vector<double> target = formed_target(rows_.target().values, form);
      Surrogate surrogate(rows_, target, budget_);
      roughness_ = std::min(roughness_, surrogate.error());
      if (!(surrogate.error() <= kRough)) continue;
      add_terms(form, surrogate);
      if (form == TargetForm::logarithm) {
        // log y is homogeneous of degree 0 up to a constant where y is homogeneous.
        const std::vector<double> ones(rows_.rows(), 1.0);
        add_scalings(TargetForm::plain, surrogate, ones);
        add_scalings(TargetForm::logarithm, surrogate, target);
        add_shifts(surrogate);
        log_error = surrogate.error();
      } else if (!power || surrogate.error() < power->surrogate.error()) {
        power = Power{exponent_of(form), std::move(target), std::move(surrogate)};
      }
    }
    // Near a pole or a root the logarithm is rougher than a power.
    if (power && power->surrogate.error() < log_error) {
      add_scalings(TargetForm::plain, power->surrogate, power->target, power->exponent);
      add_shifts(power->surrogate);
    }
    if (!has_one_sign_) add_of_compressed();
    if (!has_scaling_ && guesses_ == Guesses::yes) add_guesses();
    std::ranges::stable_sort(found_, {}, [](const Reduction& r) { return r.inputs.size(); });
    return {roughness_, std::move(found_)};
  }

 private:
  // T(y) = g of the products that no scaling changes, times a product; the surrogate is of T(y) to
  // some power.
  void add_scalings(TargetForm form, const Surrogate& surrogate,
                    const std::vector<double>& reference, double exponent = 1) {
    std::vector<std::size_t> scaled;
    std::vector<std::vector<double>> slopes;  // by the logarithms of the inputs
    for (std::size_t j = 0; j < rows_.inputs().size(); ++j) {
      if (!is_positive(rows_.inputs()[j])) continue;
      scaled.push_back(j);
      slopes.push_back(surrogate.slope(j));
      for (std::size_t r = 0; r < rows_.rows(); ++r) {
        slopes.back()[r] *= rows_.inputs()[j].values[r];
      }
    }
    for (Rescaled& rescaled : find_scalings(slopes, reference, tolerance_of(surrogate))) {
      for (double& power : rescaled.outer) power /= exponent;
      add_scaling(form, scaled, rescaled);
      has_scaling_ = true;
    }
  }

  void add_scaling(TargetForm form, const std::vector<std::size_t>& scaled,
                   const Rescaled& rescaled) {
    std::vector<Expression> factors;
    for (const std::size_t j : scaled) factors.push_back(input(j));
    Reduction reduction{form, false, product_of(1, factors, rescaled.outer), {}};
    for (const auto& exponents : rescaled.inner) {
      reduction.inputs.push_back(product_of(1, factors, exponents));
    }
    for (std::size_t j = 0; j < rows_.inputs().size(); ++j) {
      if (std::ranges::count(scaled, j) == 0) reduction.inputs.push_back(input(j));
    }
    if (!reduction.inputs.empty() && std::ranges::count(found_, reduction) == 0) {
      found_.push_back(std::move(reduction));
    }
  }

  // A target of both signs over decades: what leaves it alone leaves a compressed one alone.
  void add_of_compressed() {
    std::vector<double> sizes = rows_.target().values;
    for (double& y : sizes) y = std::abs(y);
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::ranges::nth_element(sizes, middle);
    const double unit = *middle;
    std::vector<double> target;
    for (const double y : rows_.target().values) {
      target.push_back(std::copysign(elementary::log(1 + std::abs(y) / unit), y));
    }
    const Surrogate surrogate(rows_, target, budget_);
    roughness_ = std::min(roughness_, surrogate.error());
    if (!(surrogate.error() <= kRough)) return;
    add_scalings(TargetForm::plain, surrogate, {});
    add_shifts(surrogate);
  }

  // Where no slope says anything: one input or two less, for the caller to see.
  void add_guesses() {
    std::vector<std::size_t> scaled;
    for (std::size_t j = 0; j < rows_.inputs().size(); ++j) {
      if (is_positive(rows_.inputs()[j])) scaled.push_back(j);
    }
    if (rows_.inputs().size() > kMostGuessed || rows_.inputs().size() < 2) return;
    const auto add = [&](std::vector<double> outer, std::size_t without, std::size_t other,
                         double power) {
      Rescaled rescaled{std::move(outer), {}};
      for (std::size_t k = 0; k < scaled.size(); ++k) {
        if (k == without) continue;
        rescaled.inner.emplace_back(scaled.size(), 0.0);
        rescaled.inner.back()[k] = 1;
        if (k == other) rescaled.inner.back()[without] = power;
      }
      const std::size_t before = found_.size();
      add_scaling(TargetForm::plain, scaled, rescaled);
      if (found_.size() > before) found_.back().is_guess = true;
    };
    for (std::size_t j = 0; j < rows_.inputs().size(); ++j) {
      for (const double c : {1.0, -1.0}) {
        add_sum(TargetForm::plain, c, j, 1);
        found_.back().is_guess = true;
      }
    }
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      std::vector<double> outer(scaled.size(), 0.0);
      for (const double c : {1.0, -1.0}) {
        outer[i] = c;
        add(outer, i, i, 0);
      }
      outer[i] = 0;
      for (std::size_t j = i + 1; j < scaled.size(); ++j) {
        add(outer, i, j, -1);
        add(outer, i, j, 1);
      }
    }
  }

  void add_shifts(const Surrogate& surrogate) {
    const std::size_t n = rows_.inputs().size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        const std::vector<double>& a = surrogate.slope(i);
        const std::vector<double>& b = surrogate.slope(j);
        const double aa = mean_product(a, a);
        const double bb = mean_product(b, b);
        const double ab = mean_product(a, b);
        const double left = aa + bb - 2 * std::abs(ab);
        const double tolerance = tolerance_of(surrogate);
        if (!(left <= tolerance * tolerance * std::min(aa, bb))) continue;
        Reduction reduction{TargetForm::plain, false, constant(1), {}};
        reduction.inputs.push_back(ab < 0 ? input(i) - input(j) : input(i) + input(j));
        for (std::size_t k = 0; k < n; ++k) {
          if (k != i && k != j) reduction.inputs.push_back(input(k));
        }
        found_.push_back(std::move(reduction));
      }
    }
  }

  void add_terms(TargetForm form, const Surrogate& surrogate) {
    if (rows_.inputs().size() < 2) return;
    for (std::size_t j = 0; j < rows_.inputs().size(); ++j) {
      const bool has_all_powers = is_positive(rows_.inputs()[j]);
      for (const double p : {1.0, 2.0, -1.0, -2.0, 0.5, -0.5}) {
        if (!has_all_powers && p != 1 && p != 2) continue;
        if (add_term(form, surrogate, j, p)) break;
      }
    }
  }

  bool add_term(TargetForm form, const Surrogate& surrogate, std::size_t j, double p) {
    const std::vector<double>& slope = surrogate.slope(j);
    const std::vector<double>& x = rows_.inputs()[j].values;
    std::vector<double> own(x.size());
    for (std::size_t r = 0; r < x.size(); ++r) own[r] = p * elementary::pow(x[r], p - 1);
    const double c = mean_product(slope, own) / mean_product(own, own);
    const double square = mean_product(slope, slope);
    const double left = square - c * c * mean_product(own, own);
    const double tolerance = std::min(tolerance_of(surrogate), kSteady);
    if (!(left <= tolerance * tolerance * square)) return false;
    const std::vector<double> names = named_values(c);
    if (names.empty() || std::abs(names[0] - c) > kNearName * std::abs(c)) return false;
    add_sum(form, names[0], j, p);
    return true;
  }

  // T(y) = c x_j^p + g(the others).
  void add_sum(TargetForm form, double c, std::size_t j, double p) {
    const double exponents[] = {p};
    const Expression factors[] = {input(j)};
    Reduction reduction{form, true, product_of(c, factors, exponents), {}};
    for (std::size_t k = 0; k < rows_.inputs().size(); ++k) {
      if (k != j) reduction.inputs.push_back(input(k));
    }
    found_.push_back(std::move(reduction));
  }

  const LogRows& rows_;
  Guesses guesses_;
  Budget& budget_;
  bool has_one_sign_;
  double roughness_ = HUGE_VAL;
  bool has_scaling_ = false;
  std::vector<Reduction> found_;
};

}  // namespace

Reductions find_reductions(const LogRows& rows, Guesses guesses, Budget& budget) {
  return Finder(rows, guesses, budget).run();
}

}  // namespace tribench::relay
