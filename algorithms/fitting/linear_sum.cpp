// SPDX-License-Identifier: MIT
#include "algorithms/fitting/linear_sum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "algorithms/expression/build.hpp"
#include "algorithms/fitting/cross_validation.hpp"
#include "algorithms/fitting/subset_average.hpp"

namespace tribench {
namespace {

constexpr int kFolds = 10;
// A slope that changes less than this share of what one fitted number costs is not written.
constexpr double kNotWorthIt = 0.1;

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

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t r = 0; r < a.size(); ++r) sum += a[r] * b[r];
  return sum;
}

double mean_of(const std::vector<double>& values) {
  double mean = 0;
  for (const double x : values) mean += x / static_cast<double>(values.size());
  return mean;
}

// Some rows of the inputs and of the target, less their means, the inputs of unit length.
class Centred {
 public:
  Centred(const Inputs& table, std::span<const double> target,
          const std::vector<std::size_t>& rows) {
    for (const double* column : table.columns) {
      std::vector<double> values;
      for (const std::size_t r : rows) values.push_back(column[r]);
      means_.push_back(centre(values));
      sizes_.push_back(std::sqrt(dot(values, values)));
      for (double& x : values) x = sizes_.back() > 0 ? x / sizes_.back() : 0;
      columns_.push_back(std::move(values));
    }
    for (const std::size_t r : rows) target_.push_back(target[r]);
    mean_ = centre(target_);
  }

  // The mean of the lines through all subsets of the inputs that say most.
  Line average() const {
    const std::vector<std::size_t> inputs = foremost();
    std::vector<const std::vector<double>*> columns;
    for (const std::size_t j : inputs) columns.push_back(&columns_[j]);
    columns.push_back(&target_);
    std::vector<double> products;
    for (const auto* a : columns) {
      for (const auto* b : columns) products.push_back(dot(*a, *b));
    }
    Line line{inputs, average_over_subsets(products, target_.size(), columns_.size()), mean_};
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      line.slopes[k] /= sizes_[inputs[k]];
      line.offset -= line.slopes[k] * means_[inputs[k]];
    }
    return line;
  }

  // Without the inputs whose slopes change the rows by less than `square` in the mean.
  Line without_idle(const Line& line, double square) const {
    const auto rows = static_cast<double>(target_.size());
    Line kept{{}, {}, mean_};
    for (std::size_t k = 0; k < line.inputs.size(); ++k) {
      const std::size_t j = line.inputs[k];
      const double change = line.slopes[k] * sizes_[j];
      if (!(change * change / rows > square)) continue;
      kept.inputs.push_back(j);
      kept.slopes.push_back(line.slopes[k]);
      kept.offset -= line.slopes[k] * means_[j];
    }
    return kept;
  }

 private:
  static double centre(std::vector<double>& values) {
    const double mean = mean_of(values);
    for (double& x : values) x -= mean;
    return mean;
  }

  // Forward selection by modified Gram-Schmidt.
  std::vector<std::size_t> foremost() const {
    std::vector<std::vector<double>> left = columns_;
    std::vector<double> target = target_;
    std::vector<std::size_t> chosen;
    while (chosen.size() < kMostAveraged) {
      std::size_t best = left.size();
      double most = 0;
      for (std::size_t j = 0; j < left.size(); ++j) {
        const double square = dot(left[j], left[j]);
        const double along = dot(left[j], target);
        if (!(square > kNewShare) || !(along * along > most * square)) continue;
        most = along * along / square;
        best = j;
      }
      if (best == left.size()) break;
      chosen.push_back(best);
      const std::vector<double> direction = left[best];
      remove(direction, target);
      for (auto& column : left) remove(direction, column);
      std::ranges::fill(left[best], 0.0);
    }
    return chosen;
  }
  static void remove(const std::vector<double>& direction, std::vector<double>& values) {
    const double share = dot(values, direction) / dot(direction, direction);
    for (std::size_t r = 0; r < values.size(); ++r) values[r] -= share * direction[r];
  }

  std::vector<std::vector<double>> columns_;
  std::vector<double> means_;
  std::vector<double> sizes_;
  std::vector<double> target_;
  double mean_ = 0;
};

// Mean square on rows that the line did not see.
double held_out_error(const Inputs& inputs, std::span<const double> target,
                      const std::vector<int>& fold) {
  double sum = 0;
  const int folds = 1 + *std::ranges::max_element(fold);
  for (int f = 0; f < folds; ++f) {
    std::vector<std::size_t> trained;
    for (std::size_t r = 0; r < target.size(); ++r) {
      if (fold[r] != f) trained.push_back(r);
    }
    const Line line = Centred(inputs, target, trained).average();
    for (std::size_t r = 0; r < target.size(); ++r) {
      if (fold[r] != f) continue;
      const double error = line.at(inputs, r) - target[r];
      sum += error * error;
    }
  }
  return sum / static_cast<double>(target.size());
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
  const double held_out =
      held_out_error(inputs, target, held_out_folds(movement, target.size(), kFolds));
  std::vector<std::size_t> all(target.size());
  std::iota(all.begin(), all.end(), 0);
  const Centred rows(inputs, target, all);
  const double square = kNotWorthIt * held_out / static_cast<double>(target.size());
  return {written(rows.without_idle(rows.average(), square)), held_out};
}

}  // namespace tribench
