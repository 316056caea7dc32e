// SPDX-License-Identifier: MIT
#include "algorithms/udsr/term_selection.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "algorithms/fitting/posterior_choice.hpp"
#include "algorithms/fitting/symmetric_system.hpp"
#include "algorithms/udsr/linear_token.hpp"
#include "foundation/elementary.hpp"

namespace tribench::udsr {
namespace {

constexpr std::size_t kBeam = 100;
constexpr std::size_t kMostTerms = 12;
constexpr std::size_t kRowsForATerm = 5;
constexpr std::size_t kSubsetsALook = 500;  // at the clock: a millisecond
// Residuals below this share of the target are rounding.
constexpr double kRounding = 1e-14;

using Subset = std::vector<Eigen::Index>;  // increasing

struct Rated {
  Subset terms;
  double sum_squares = 0;
};

// Least squares on any subset of the terms, from one Gram matrix of unit diagonal.
class Subsets {
 public:
  Subsets(std::span<const Monomial> terms, const ScoringProblem& problem)
      : design_(static_cast<Eigen::Index>(problem.rows()),
                static_cast<Eigen::Index>(terms.size())) {
    for (std::size_t k = 0; k < terms.size(); ++k) {
      design_.col(static_cast<Eigen::Index>(k)) =
          column_of(terms[k], problem.inputs().columns, problem.rows());
    }
    scale_ = design_.colwise().norm().cwiseMax(1e-150).cwiseInverse();
    design_ = design_ * scale_.asDiagonal();
    const Eigen::Map<const Eigen::VectorXd> target(
        problem.target().data(), static_cast<Eigen::Index>(problem.target().size()));
    gram_ = design_.transpose() * design_;
    gram_.diagonal().array() += 1e-11;
    moment_ = design_.transpose() * target;
    size_ = target.squaredNorm();
  }

  Eigen::VectorXd coefficients(const Subset& subset) const {
    const Eigen::VectorXd moment = moment_(subset);
    const Eigen::MatrixXd gram = gram_(subset, subset);
    return solve_symmetric(gram, moment);
  }
  double sum_squares(const Subset& subset) const {
    return std::max(size_ - coefficients(subset).dot(moment_(subset)), kRounding * size_);
  }
  // In the terms' own units.
  std::vector<double> unscaled(const Subset& subset) const {
    const Eigen::VectorXd values = coefficients(subset).cwiseProduct(scale_(subset));
    return {values.begin(), values.end()};
  }
  Eigen::Index terms() const { return design_.cols(); }

 private:
  Eigen::MatrixXd design_;
  Eigen::VectorXd scale_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd moment_;
  double size_ = 0;  // the target's sum of squares
};

// The best subsets that are a member of the beam and one term more.
// None where the seconds run out.
std::vector<Rated> next_level(const std::vector<Rated>& beam, const Subsets& subsets,
                              Budget& budget) {
  std::set<Subset> wider;
  for (const Rated& member : beam) {
    for (Eigen::Index term = 0; term < subsets.terms(); ++term) {
      if (std::ranges::binary_search(member.terms, term)) continue;
      Subset subset = member.terms;
      subset.insert(std::ranges::upper_bound(subset, term), term);
      wider.insert(std::move(subset));
    }
  }
  std::vector<Rated> level;
  std::size_t looked_at = 0;
  for (const Subset& subset : wider) {
    if (looked_at++ % kSubsetsALook == 0 && !budget.in_time()) return {};
    const double sum_squares = subsets.sum_squares(subset);
    if (std::isfinite(sum_squares)) level.push_back({subset, sum_squares});
  }
  std::ranges::stable_sort(level, {}, &Rated::sum_squares);
  if (level.size() > kBeam) level.resize(kBeam);
  return level;
}

}  // namespace

std::vector<Monomial> wide_terms(std::span<const Input> inputs, int degree, std::size_t rows) {
  for (; degree > 0; --degree) {
    std::vector<int> caps = exponent_caps(inputs, degree);
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      if (is_sign(inputs[j])) caps[j] = 0;
    }
    const auto signs = static_cast<int>(std::ranges::count_if(inputs, is_sign));
    if (std::ldexp(monomial_count(caps, degree), signs) * kRowsForATerm >
        static_cast<double>(rows)) {
      continue;
    }
    std::vector<Monomial> terms = monomials(caps, degree);
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      if (!is_sign(inputs[j])) continue;
      const std::size_t without = terms.size();
      for (std::size_t k = 0; k < without; ++k) {
        terms.push_back(terms[k]);
        terms.back()[j] = 1;
      }
    }
    return terms;
  }
  return {};
}

std::vector<Expression> select_terms(std::span<const Monomial> terms, const ScoringProblem& problem,
                                     Budget& budget) {
  if (terms.empty() || !budget.in_time()) return {};
  const Subsets subsets(terms, problem);
  std::uint64_t node_rows = terms.size() * terms.size() * problem.rows();
  const auto n = static_cast<double>(problem.rows());
  std::vector<std::pair<double, Rated>> all;  // nats against
  std::vector<Rated> beam = {{}};
  for (std::size_t size = 1; size <= std::min(kMostTerms, terms.size()); ++size) {
    beam = next_level(beam, subsets, budget);
    for (const Rated& rated : beam) {
      const double against = 0.5 * n * elementary::log(rated.sum_squares) +
                             0.5 * static_cast<double>(size) * elementary::log(n);
      all.push_back({against, rated});
    }
    node_rows += kBeam * terms.size() * size * size;
  }
  budget.spend(node_rows);
  std::ranges::stable_sort(all, {}, &std::pair<double, Rated>::first);
  std::vector<Expression> result;
  for (const auto& [against, rated] : all) {
    if (result.size() == kBeam || against > all.front().first + kNegligibleNats) break;
    std::vector<Monomial> chosen;
    for (const Eigen::Index term : rated.terms) {
      chosen.push_back(terms[static_cast<std::size_t>(term)]);
    }
    result.push_back(polynomial(chosen, subsets.unscaled(rated.terms)));
  }
  return result;
}

}  // namespace tribench::udsr
