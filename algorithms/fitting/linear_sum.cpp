// SPDX-License-Identifier: MIT
#include "algorithms/fitting/linear_sum.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/cross_validation.hpp"

namespace tribench {
namespace {

constexpr int kFolds = 10;
constexpr std::size_t kMostTerms = 20;
constexpr std::size_t kRowsATerm = 4;
constexpr double kNew = 1e-8;  // of a column's square, for it to add anything

// A straight line through the chosen columns, least squares.
struct Line {
  std::vector<std::size_t> inputs;
  std::vector<double> slopes;
  double offset = 0;

  double at(const Inputs& table, std::size_t row) const {
    double value = offset;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      value += slopes[k] * table.columns[inputs[k]][row];
    }
    return value;
  }
};

// Forward selection by modified Gram-Schmidt: one orthogonal direction a term, and how it is
// written in the inputs.
class Selection {
 public:
  Selection(const Inputs& table, std::span<const double> target, std::vector<std::size_t> rows)
      : table_(table), rows_(std::move(rows)) {
    for (const double* column : table.columns) {
      std::vector<double> values;
      for (const std::size_t r : rows_) values.push_back(column[r]);
      means_.push_back(centre(values));
      squares_.push_back(dot(values, values));
      columns_.push_back(std::move(values));
    }
    for (const std::size_t r : rows_) left_.push_back(target[r]);
    mean_ = centre(left_);
  }

  std::size_t most_terms() const {
    return std::min({kMostTerms, columns_.size(), rows_.size() / kRowsATerm});
  }

  // The line with one input more; false where none adds anything.
  bool extend() {
    std::size_t best = columns_.size();
    double most = 0;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const double square = dot(columns_[j], columns_[j]);
      if (!(square > kNew * squares_[j])) continue;
      const double along = dot(columns_[j], left_);
      if (along * along / square > most) {
        most = along * along / square;
        best = j;
      }
    }
    if (best == columns_.size()) return false;
    take(best);
    return true;
  }

  Line line() const {
    // Back substitution: x_k = q_k + sum_i<k parts_[k][i] q_i.
    Line line{chosen_, weights_, mean_};
    for (std::size_t k = chosen_.size(); k-- > 0;) {
      for (std::size_t i = 0; i < k; ++i) line.slopes[i] -= line.slopes[k] * parts_[k][i];
    }
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      line.offset -= line.slopes[k] * means_[chosen_[k]];
    }
    return line;
  }

 private:
  static double centre(std::vector<double>& values) {
    double mean = 0;
    for (const double x : values) mean += x / static_cast<double>(values.size());
    for (double& x : values) x -= mean;
    return mean;
  }
  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t r = 0; r < a.size(); ++r) sum += a[r] * b[r];
    return sum;
  }

  void take(std::size_t j) {
    const std::vector<double> q = columns_[j];
    const double square = dot(q, q);
    parts_.emplace_back();
    for (const auto& [direction, length] : directions_) {
      std::vector<double> whole;
      for (const std::size_t r : rows_) whole.push_back(table_.columns[j][r]);
      centre(whole);
      parts_.back().push_back(dot(whole, direction) / length);
    }
    const auto remove = [&](std::vector<double>& values) {
      const double share = dot(values, q) / square;
      for (std::size_t r = 0; r < q.size(); ++r) values[r] -= share * q[r];
      return share;
    };
    weights_.push_back(remove(left_));
    for (auto& column : columns_) remove(column);
    std::ranges::fill(columns_[j], 0.0);
    directions_.emplace_back(q, square);
    chosen_.push_back(j);
  }

  const Inputs& table_;
  std::vector<std::size_t> rows_;
  std::vector<std::vector<double>> columns_;  // what is left of them
  std::vector<double> means_;
  std::vector<double> squares_;
  std::vector<double> left_;
  double mean_ = 0;
  std::vector<std::size_t> chosen_;
  std::vector<double> weights_;
  std::vector<std::vector<double>> parts_;
  std::vector<std::pair<std::vector<double>, double>> directions_;
};

// Held-out squared error of a line of 0, 1, 2 ... inputs, summed over the rows.
std::vector<double> held_out_errors(const Inputs& inputs, std::span<const double> target,
                                    const std::vector<int>& fold) {
  std::vector<double> errors;
  const int folds = 1 + *std::ranges::max_element(fold);
  for (int f = 0; f < folds; ++f) {
    std::vector<std::size_t> trained;
    for (std::size_t r = 0; r < target.size(); ++r) {
      if (fold[r] != f) trained.push_back(r);
    }
    Selection selection(inputs, target, std::move(trained));
    const std::size_t most = selection.most_terms();
    errors.resize(f == 0 ? most + 1 : std::min(errors.size(), most + 1), 0.0);
    for (std::size_t terms = 0; terms < errors.size(); ++terms) {
      if (terms > 0) selection.extend();
      const Line line = selection.line();
      for (std::size_t r = 0; r < target.size(); ++r) {
        if (fold[r] != f) continue;
        const double error = line.at(inputs, r) - target[r];
        errors[terms] += error * error;
      }
    }
  }
  return errors;
}

Expression written(const Line& line) {
  using namespace build;
  Expression formula = constant(line.offset);
  for (std::size_t k = 0; k < line.inputs.size(); ++k) {
    formula = formula + constant(line.slopes[k]) * input(line.inputs[k]);
  }
  return formula;
}

}  // namespace

LinearSum fit_linear_sum(const Inputs& inputs, std::span<const double> target,
                         std::span<const int> movement) {
  const std::vector<double> errors =
      held_out_errors(inputs, target, held_out_folds(movement, target.size(), kFolds));
  const auto least = std::ranges::min_element(errors);
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < target.size(); ++r) all.push_back(r);
  Selection selection(inputs, target, std::move(all));
  for (auto terms = least - errors.begin(); terms > 0 && selection.extend(); --terms) {
  }
  return {written(selection.line()), *least / static_cast<double>(target.size())};
}

}  // namespace tribench
