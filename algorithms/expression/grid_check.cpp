// SPDX-License-Identifier: MIT
#include "algorithms/expression/grid_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "foundation/elementary.hpp"

namespace tribench {
namespace {

// Inputs with a range that the formula depends on, by themselves or by their sign.
std::vector<std::size_t> axes_of(const Expression& formula, const InputBox& box) {
  std::vector<std::size_t> axes;
  for (const Node& node : formula.nodes()) {
    if (node.is_variable()) axes.push_back(box[node.variable].sign_of.value_or(node.variable));
  }
  std::sort(axes.begin(), axes.end());
  axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
  return axes;
}

}  // namespace

bool is_finite_on_grid(const Expression& formula, const InputBox& box, std::size_t points) {
  check_box(formula, box);
  const std::vector<std::size_t> axes = axes_of(formula, box);
  std::size_t along = 1;
  std::size_t rows = 1;
  if (!axes.empty()) {
    const double root =
        elementary::pow(static_cast<double>(points), 1.0 / static_cast<double>(axes.size()));
    along = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(root)));
    for (std::size_t k = 0; k < axes.size(); ++k) rows *= along;
  }
  std::vector<std::vector<double>> columns(box.size(), std::vector<double>(rows));
  std::size_t stride = 1;
  for (const std::size_t j : axes) {
    for (std::size_t row = 0; row < rows; ++row) {
      const auto step = static_cast<double>(row / stride % along) / static_cast<double>(along - 1);
      columns[j][row] = box[j].low + step * (box[j].high - box[j].low);
    }
    stride *= along;
  }
  std::vector<const double*> pointers;
  for (std::size_t j = 0; j < box.size(); ++j) {
    if (box[j].sign_of) {
      const std::vector<double>& base = columns[*box[j].sign_of];
      std::transform(base.begin(), base.end(), columns[j].begin(),
                     [](double x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); });
    }
    pointers.push_back(columns[j].data());
  }
  std::vector<double> values(rows);
  Evaluator().evaluate(formula, {pointers, rows}, values);
  return std::all_of(values.begin(), values.end(), [](double y) { return std::isfinite(y); });
}

}  // namespace tribench
