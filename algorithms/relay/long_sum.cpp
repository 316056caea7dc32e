// SPDX-License-Identifier: MIT
#include "algorithms/relay/long_sum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/expression/column_kernels.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/linear_least_squares.hpp"

namespace tribench::relay {
namespace {

using namespace build;

constexpr std::size_t kFewestRowsOfSum = 40;
constexpr std::size_t kMostInputsOfSum = 8;
constexpr std::size_t kMostOffered = 5000;  // columns: 200 MB for their products, fold by fold
constexpr std::size_t kManyInputs = 36;     // beyond, products of different inputs are left out
constexpr std::size_t kLongestSum = 150;    // bounds the cost; folds end most sums before
constexpr std::size_t kRowsATerm = 4;
constexpr int kFolds = 10;
constexpr double kNothingNew = 1e-6;      // of a column's square beside the columns before it
constexpr double kPlaces[] = {-1, 0, 1};  // of the knots, in standard deviations from the mean

struct Column {
  Expression formula;
  std::vector<double> values;  // less their mean, of unit variance; of the chosen rows
  std::vector<std::size_t> inputs;
};

// Rows for the choice, spread evenly.
class Sample {
 public:
  Sample(const FiniteRows& all, std::size_t most) {
    const std::size_t count = std::min(most, all.rows());
    for (std::size_t k = 0; k < count; ++k) rows_.push_back(k * all.rows() / count);
    for (const std::vector<double>& column : all.columns) columns_.push_back(taken(column));
    for (const std::vector<double>& column : columns_) pointers_.push_back(column.data());
    target_ = taken(all.target);
    for (const std::size_t r : rows_) movement_.push_back(all.movement[r]);
    folds_ = held_out_folds(movement_, count, kFolds);
  }

  std::size_t rows() const { return rows_.size(); }
  std::size_t inputs() const { return columns_.size(); }
  const std::vector<double>& input(std::size_t j) const { return columns_[j]; }
  const std::vector<double>& target() const { return target_; }
  const std::vector<int>& movement() const { return movement_; }
  const std::vector<int>& folds() const { return folds_; }
  Inputs table() const { return {pointers_, rows_.size()}; }

 private:
  std::vector<double> taken(const std::vector<double>& column) const {
    std::vector<double> values;
    for (const std::size_t r : rows_) values.push_back(column[r]);
    return values;
  }

  std::vector<std::size_t> rows_;
  std::vector<std::vector<double>> columns_;
  std::vector<const double*> pointers_;
  std::vector<double> target_;
  std::vector<int> movement_;
  std::vector<int> folds_;
};

struct Moments {
  double mean = 0;
  double deviation = 0;
};

Moments moments_of(std::span<const double> values) {
  Moments moments;
  const auto n = static_cast<double>(values.size());
  for (const double x : values) moments.mean += x / n;
  double square = 0;
  for (const double x : values) square += (x - moments.mean) * (x - moments.mean) / n;
  moments.deviation = std::sqrt(square);
  return moments;
}

// Empty where nothing varies.
std::vector<double> standardised(std::vector<double> values) {
  const Moments moments = moments_of(values);
  if (!(moments.deviation > 0) || !std::isfinite(moments.deviation)) return {};
  for (double& x : values) x = (x - moments.mean) / moments.deviation;
  return values;
}

// The columns that terms are chosen from.
class Library {
 public:
  explicit Library(const Sample& sample) : sample_(sample) {
    for (std::size_t j = 0; j < sample.inputs(); ++j)
      moments_.push_back(moments_of(sample.input(j)));
  }

  const std::vector<Column>& columns() const { return columns_; }

  // The inputs themselves and their products of two.
  void add_products(const std::vector<std::size_t>& inputs) {
    const std::vector<Column> factors = plain(inputs);
    add_all(factors);
    for (std::size_t a = 0; a < factors.size(); ++a) {
      const std::size_t end = inputs.size() > kManyInputs ? a + 1 : factors.size();
      for (std::size_t b = a; b < end; ++b) add(times(factors[a], factors[b]));
    }
  }

  // With distances too, and the inputs' products of three.
  void add_pieces(const std::vector<std::size_t>& inputs, bool with_distances) {
    const std::vector<Column> straight = plain(inputs);
    std::vector<Column> factors = straight;
    for (const std::size_t j : inputs) {
      for (const double place : kPlaces) {
        if (with_distances) factors.push_back(distance(j, place));
      }
    }
    add_all(factors);
    for (std::size_t a = 0; a < factors.size(); ++a) {
      for (std::size_t b = a; b < factors.size(); ++b) add(times(factors[a], factors[b]));
    }
    for (std::size_t a = 0; a < straight.size(); ++a) {
      for (std::size_t b = a; b < straight.size(); ++b) {
        const Column two = times(straight[a], straight[b]);
        for (std::size_t c = b; c < straight.size(); ++c) add(times(two, straight[c]));
      }
    }
  }

 private:
  std::vector<Column> plain(const std::vector<std::size_t>& inputs) const {
    std::vector<Column> factors;
    for (const std::size_t j : inputs) factors.push_back(from(j, moments_[j].mean));
    return factors;
  }

  // An input less a place; a place that is next to nothing is 0.
  Column from(std::size_t j, double place) const {
    constexpr double kNextToNothing = 1e-3;
    if (std::abs(place) <= kNextToNothing * moments_[j].deviation) place = 0;
    Column column{place == 0 ? input(j) : input(j) - constant(place), sample_.input(j), {j}};
    for (double& x : column.values) x -= place;
    return column;
  }

  Column distance(std::size_t j, double place) const {
    Column column = from(j, moments_[j].mean + place * moments_[j].deviation);
    column.formula = function(Op::abs, column.formula);
    for (double& x : column.values) x = std::abs(x);
    return column;
  }

  static Column times(const Column& a, const Column& b) {
    Column product{a.formula == b.formula ? power(a.formula, 2) : a.formula * b.formula, a.values,
                   a.inputs};
    columns::mul(a.values.data(), b.values.data(), product.values.data(), a.values.size());
    for (const std::size_t j : b.inputs) {
      if (std::ranges::count(product.inputs, j) == 0) product.inputs.push_back(j);
    }
    return product;
  }

  void add(Column column) {
    column.values = standardised(std::move(column.values));
    if (!column.values.empty()) columns_.push_back(std::move(column));
  }
  void add_all(const std::vector<Column>& columns) {
    for (const Column& column : columns) add(column);
  }

  const Sample& sample_;
  std::vector<Moments> moments_;
  std::vector<Column> columns_;
};

// Products of columns, of a constant (place 0) and of the target (the last): one matrix for all
// rows, one for each fold.
class Products {
 public:
  Products(const std::vector<Column>& columns, const Sample& sample, Budget& budget) {
    std::vector<const std::vector<double>*> all;
    const std::vector<double> ones(sample.rows(), 1.0);
    all.push_back(&ones);
    for (const Column& column : columns) all.push_back(&column.values);
    all.push_back(&sample.target());
    size_ = all.size();
    const int folds = 1 + *std::ranges::max_element(sample.folds());
    whole_.assign(size_ * size_, 0.0);
    for (int f = 0; f < folds; ++f) {
      is_whole_ = budget.in_time();
      if (!is_whole_) return;
      add_fold(all, sample.folds(), f);
      for (std::size_t k = 0; k < whole_.size(); ++k) whole_[k] += folds_.back()[k];
    }
  }

  bool is_whole() const { return is_whole_; }  // the time sufficed
  std::size_t size() const { return size_; }
  std::size_t folds() const { return folds_.size(); }
  const std::vector<double>& whole() const { return whole_; }
  const std::vector<double>& fold(std::size_t f) const { return folds_[f]; }
  std::vector<double> without(std::size_t f) const {
    std::vector<double> rest = whole_;
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= folds_[f][k];
    return rest;
  }

 private:
  void add_fold(const std::vector<const std::vector<double>*>& all, const std::vector<int>& fold,
                int f) {
    std::vector<std::vector<double>> parts(all.size());
    for (std::size_t r = 0; r < fold.size(); ++r) {
      if (fold[r] != f) continue;
      for (std::size_t k = 0; k < all.size(); ++k) parts[k].push_back((*all[k])[r]);
    }
    std::vector<const double*> pointers;
    for (const auto& part : parts) pointers.push_back(part.data());
    folds_.emplace_back(size_ * size_);
    columns::gram(pointers.data(), size_, parts[0].size(), folds_.back().data());
  }

  bool is_whole_ = true;
  std::size_t size_ = 0;
  std::vector<double> whole_;
  std::vector<std::vector<double>> folds_;
};

// Forward selection from products alone: a Cholesky factor that grows by a column a term.
class Selection {
 public:
  Selection(std::span<const double> products, std::size_t size)
      : products_(products), size_(size), rows_(size), left_(size) {
    for (std::size_t j = 0; j < size; ++j) left_[j] = products_[j * size + j];
    take(0);
  }

  const std::vector<std::size_t>& terms() const { return terms_; }  // the constant first

  // The column that explains most of what is left; false where none adds anything.
  bool extend() {
    const std::size_t target = size_ - 1;
    std::size_t best = 0;
    double most = 0;
    for (std::size_t j = 1; j < target; ++j) {
      if (!(left_[j] > kNothingNew * products_[j * size_ + j])) continue;
      double along = products_[j * size_ + target];
      for (std::size_t k = 0; k < terms_.size(); ++k) along -= rows_[j][k] * rows_[target][k];
      if (along * along > most * left_[j]) {
        most = along * along / left_[j];
        best = j;
      }
    }
    if (best == 0) return false;
    take(best);
    return true;
  }

  std::vector<double> coefficients() const {
    std::vector<double> c = rows_[size_ - 1];
    for (std::size_t k = c.size(); k-- > 0;) {
      for (std::size_t later = k + 1; later < c.size(); ++later) {
        c[k] -= rows_[terms_[later]][k] * c[later];
      }
      c[k] /= rows_[terms_[k]][k];
    }
    return c;
  }

 private:
  void take(std::size_t pivot) {
    const double length = std::sqrt(left_[pivot]);
    const std::vector<double> own = rows_[pivot];
    for (std::size_t j = 0; j < size_; ++j) {
      double along = products_[pivot * size_ + j];
      for (std::size_t k = 0; k < own.size(); ++k) along -= own[k] * rows_[j][k];
      rows_[j].push_back(along / length);
      left_[j] -= rows_[j].back() * rows_[j].back();
    }
    left_[pivot] = 0;
    terms_.push_back(pivot);
  }

  std::span<const double> products_;
  std::size_t size_;
  std::vector<std::vector<double>> rows_;  // of the factor, one a column
  std::vector<double> left_;               // of a column's square beside the terms
  std::vector<std::size_t> terms_;
};

// sum (y - sum c x)^2 over the rows of these products.
double squared_error(std::span<const double> products, std::size_t size,
                     const std::vector<std::size_t>& terms, const std::vector<double>& c) {
  const std::size_t target = size - 1;
  double sum = products[target * size + target];
  for (std::size_t k = 0; k < terms.size(); ++k) {
    sum -= 2 * c[k] * products[terms[k] * size + target];
    for (std::size_t l = 0; l < terms.size(); ++l) {
      sum += c[k] * c[l] * products[terms[k] * size + terms[l]];
    }
  }
  return sum;
}

struct Choice {
  std::vector<std::size_t> columns;  // in the order in which they were taken
  std::vector<double> held_out;      // mean squares, fold by fold
};

// None where the time ran out.
std::optional<Choice> choose(const std::vector<Column>& columns, const Sample& sample,
                             Budget& budget) {
  const Products products(columns, sample, budget);
  if (!products.is_whole()) return std::nullopt;
  const std::size_t size = products.size();
  // Of every number of terms, fold by fold.
  std::vector<std::vector<double>> held_out(1 + std::min(kLongestSum, sample.rows() / kRowsATerm));
  std::vector<double> errors(held_out.size(), 0.0);
  for (std::size_t f = 0; f < products.folds(); ++f) {
    const std::vector<double> rest = products.without(f);
    const auto count = static_cast<double>(std::ranges::count(sample.folds(), static_cast<int>(f)));
    Selection selection(rest, size);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const double error =
          squared_error(products.fold(f), size, selection.terms(), selection.coefficients());
      errors[k] += error;
      held_out[k].push_back(error / count);
      selection.extend();
    }
  }
  const auto least = std::ranges::min_element(errors);
  Selection selection(products.whole(), size);
  for (auto terms = least - errors.begin(); terms > 0 && selection.extend(); --terms) {
  }
  Choice choice{{}, held_out[static_cast<std::size_t>(least - errors.begin())]};
  for (const std::size_t term : selection.terms()) {
    if (term > 0) choice.columns.push_back(term - 1);
  }
  return choice;
}

// What the products cost, as node-rows: an eighth of a node each.
std::uint64_t cost_of(std::size_t columns, std::size_t rows) {
  return static_cast<std::uint64_t>(columns) * columns / 16 * rows;
}

// The inputs of the terms, those taken first before others.
std::vector<std::size_t> inputs_of(const Choice& choice, const std::vector<Column>& columns) {
  std::vector<std::size_t> inputs;
  for (const std::size_t k : choice.columns) {
    for (const std::size_t j : columns[k].inputs) {
      if (inputs.size() < kMostInputsOfSum && std::ranges::count(inputs, j) == 0)
        inputs.push_back(j);
    }
  }
  std::ranges::sort(inputs);
  return inputs;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double x : values) sum += x * x / static_cast<double>(values.size());
  return sum > 0 && std::isfinite(sum) ? std::sqrt(sum) : 1;
}

// With coefficients fitted to all rows.
Expression written(const Choice& choice, const std::vector<Column>& columns,
                   const FiniteRows& rows) {
  std::vector<std::vector<double>> values(choice.columns.size() + 1);
  values[0].assign(rows.rows(), 1.0);
  std::vector<const double*> pointers = {values[0].data()};
  std::vector<double> sizes = {1.0};
  Evaluator evaluator;
  for (std::size_t k = 0; k < choice.columns.size(); ++k) {
    values[k + 1].resize(rows.rows());
    evaluator.evaluate(columns[choice.columns[k]].formula, rows.table(), values[k + 1]);
    // Of unit size: in the users' units one column may be 1e20 times another.
    const double size = root_mean_square(values[k + 1]);
    for (double& x : values[k + 1]) x /= size;
    sizes.push_back(size);
    pointers.push_back(values[k + 1].data());
  }
  std::vector<double> c = solve_least_squares(pointers, rows.target).coefficients;
  for (std::size_t k = 0; k < c.size(); ++k) c[k] /= sizes[k];
  Expression sum = constant(c[0]);
  for (std::size_t k = 0; k < choice.columns.size(); ++k) {
    if (c[k + 1] != 0) sum = sum + constant(c[k + 1]) * columns[choice.columns[k]].formula;
  }
  return sum;
}

}  // namespace

double LongSum::mean_held_out() const {
  return std::reduce(held_out.begin(), held_out.end()) / static_cast<double>(held_out.size());
}

std::optional<LongSum> fit_long_sum(const FiniteRows& rows, const OperatorSet& operators,
                                    std::size_t most_rows, Budget& budget) {
  const bool is_possible =
      operators.allows(Op::add) && operators.allows(Op::sub) && operators.allows(Op::mul);
  if (rows.rows() < kFewestRowsOfSum || !is_possible) return std::nullopt;
  const Sample sample(rows, most_rows);
  std::vector<std::size_t> inputs(sample.inputs());
  std::iota(inputs.begin(), inputs.end(), 0);
  if (inputs.size() > kMostInputsOfSum) {
    Library products(sample);
    products.add_products(inputs);
    if (products.columns().size() > kMostOffered) return std::nullopt;
    if (!budget.spend(cost_of(products.columns().size(), sample.rows()))) return std::nullopt;
    const auto taken = choose(products.columns(), sample, budget);
    if (!taken) return std::nullopt;
    inputs = inputs_of(*taken, products.columns());
  }
  Library pieces(sample);
  pieces.add_pieces(inputs, operators.allows(Op::abs));
  if (pieces.columns().empty() || !budget.spend(cost_of(pieces.columns().size(), sample.rows()))) {
    return std::nullopt;
  }
  const auto choice = choose(pieces.columns(), sample, budget);
  if (!choice || choice->columns.empty()) return std::nullopt;
  Expression formula = written(*choice, pieces.columns(), rows);
  if (!operators.admits(formula)) return std::nullopt;
  return LongSum{std::move(formula), choice->held_out};
}

std::vector<double> held_out_errors(const Expression& formula, const FiniteRows& rows,
                                    std::size_t most_rows) {
  const Sample sample(rows, most_rows);
  return cross_validate({&formula, 1}, sample.table(), sample.target(), sample.movement(), {},
                        kFolds)
      .fold_errors[0];
}

}  // namespace tribench::relay
