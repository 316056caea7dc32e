// SPDX-License-Identifier: MIT
#include "algorithms/relay/subset_fits.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "algorithms/fitting/cholesky.hpp"

namespace tribench::relay {
namespace {

constexpr std::size_t kKept = 300;
constexpr double kNew = 1e-10;  // of a column's square, for it to add anything

}  // namespace

// The sums that leave least, each once.
class SubsetFits::Best {
 public:
  // What a sum must leave less than to be among them.
  double bound() const { return bound_; }
  void add(SparseSum sum) {
    sums_.push_back(std::move(sum));
    if (sums_.size() >= 4 * kKept) cut();
  }
  std::vector<SparseSum> taken() {
    cut();
    return std::move(sums_);
  }

 private:
  void cut() {
    std::ranges::stable_sort(sums_, {}, &SparseSum::left);
    std::set<std::vector<std::size_t>> seen;
    std::erase_if(sums_, [&](const SparseSum& sum) { return !seen.insert(sum.terms).second; });
    if (sums_.size() > kKept) sums_.resize(kKept);
    if (sums_.size() == kKept) bound_ = sums_.back().left;
  }

  std::vector<SparseSum> sums_;
  double bound_ = HUGE_VAL;
};

SubsetFits::SubsetFits(std::vector<double> gram, std::vector<char> once)
    : gram_(std::move(gram)),
      once_(std::move(once)),
      columns_(once_.size()),
      stride_(columns_ + 1) {
  std::vector<double> scale(stride_);
  for (std::size_t i = 0; i < stride_; ++i) {
    const double square = gram_[i * stride_ + i];
    scale[i] = square > 0 && std::isfinite(square) ? 1 / std::sqrt(square) : 0;
  }
  for (std::size_t i = 0; i < stride_; ++i) {
    for (std::size_t j = 0; j < stride_; ++j) gram_[i * stride_ + j] *= scale[i] * scale[j];
  }
}

std::vector<SparseSum> SubsetFits::best_pairs() const {
  Best best;
  std::vector<std::size_t> all(columns_);
  std::iota(all.begin(), all.end(), 0);
  add_pairs(all, gram_, {}, 1, best);
  return best.taken();
}

std::vector<SparseSum> SubsetFits::best_with_one_marked(std::size_t most, Budget& budget) const {
  Best best;
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < columns_; ++k) {
    if (once_[k] == 0) others.push_back(k);
  }
  // A pair is looked at once, and its entry of the matrix made before: thrice the work.
  const std::size_t each = 3 * others.size() * others.size() / 2 + 1;
  std::vector<double> gram(gram_.size());
  std::size_t spent = 0;
  for (std::size_t k = 0; k < columns_ && spent + each <= most; ++k) {
    if (once_[k] == 0) continue;
    if (!budget.in_time()) break;
    spent += each;
    fill_without(k, others, gram);
    add_pairs(others, gram, {k}, 1 - with_target(k) * with_target(k), best);
  }
  return best.taken();
}

void SubsetFits::fill_without(std::size_t k, std::span<const std::size_t> others,
                              std::vector<double>& gram) const {
  std::vector<double> along(stride_);
  std::vector<double> scale(stride_, 1.0);
  for (std::size_t i = 0; i < stride_; ++i) {
    along[i] = gram_[i * stride_ + k];
    const double square = gram_[i * stride_ + i] - along[i] * along[i];
    if (i < columns_) scale[i] = square > kNew ? 1 / std::sqrt(square) : 0;
  }
  const auto fill = [&](std::size_t i, std::size_t j) {
    gram[i * stride_ + j] = (gram_[i * stride_ + j] - along[i] * along[j]) * scale[i] * scale[j];
  };
  for (const std::size_t i : others) {
    fill(i, columns_);
    for (const std::size_t j : others) fill(i, j);
  }
}

std::vector<SparseSum> SubsetFits::grown(const std::vector<SparseSum>& sums, Budget& budget) const {
  Best best;
  for (const SparseSum& sum : sums) {
    if (!budget.in_time()) break;
    add_grown(sum, best);
  }
  return best.taken();
}

void SubsetFits::add_grown(const SparseSum& sum, Best& best) const {
  const std::size_t p = sum.terms.size();
  std::vector<double> factor(p * p);
  std::vector<double> target(p);
  for (std::size_t i = 0; i < p; ++i) {
    target[i] = with_target(sum.terms[i]);
    for (std::size_t j = 0; j < p; ++j) {
      factor[i * p + j] = gram_[sum.terms[i] * stride_ + sum.terms[j]];
    }
  }
  if (!cholesky_factor(factor, p)) return;
  cholesky_solve_lower(factor, p, target);
  std::vector<double> solved(p);
  const bool has_once =
      std::ranges::any_of(sum.terms, [&](std::size_t k) { return once_[k] != 0; });
  for (std::size_t k = 0; k < columns_; ++k) {
    if (has_once && once_[k] != 0) continue;
    for (std::size_t i = 0; i < p; ++i) solved[i] = gram_[sum.terms[i] * stride_ + k];
    cholesky_solve_lower(factor, p, solved);
    double square = gram_[k * stride_ + k];
    double product = with_target(k);
    for (std::size_t i = 0; i < p; ++i) {
      square -= solved[i] * solved[i];
      product -= solved[i] * target[i];
    }
    if (!(square > kNew)) continue;
    const double left = sum.left - product * product / square;
    if (!(left < best.bound())) continue;
    SparseSum longer{sum.terms, left};
    longer.terms.insert(std::ranges::lower_bound(longer.terms, k), k);
    best.add(std::move(longer));
  }
}

void SubsetFits::add_pairs(std::span<const std::size_t> among, const std::vector<double>& gram,
                           const std::vector<std::size_t>& terms, double left, Best& best) const {
  for (std::size_t p = 0; p < among.size(); ++p) {
    const std::size_t i = among[p];
    const double a = gram[i * stride_ + columns_];
    for (std::size_t q = p + 1; q < among.size(); ++q) {
      const std::size_t j = among[q];
      if (once_[i] != 0 && once_[j] != 0) continue;
      const double b = gram[j * stride_ + columns_];
      const double c = gram[i * stride_ + j];
      const double determinant = 1 - c * c;
      if (!(determinant > 1e-12)) continue;
      const double rest = left - (a * a + b * b - 2 * a * b * c) / determinant;
      if (!(rest < best.bound())) continue;
      SparseSum sum{terms, rest};
      sum.terms.push_back(i);
      sum.terms.push_back(j);
      std::ranges::sort(sum.terms);
      best.add(std::move(sum));
    }
  }
}

}  // namespace tribench::relay
