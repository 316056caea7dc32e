// SPDX-License-Identifier: MIT
#include "algorithms/closed_loop/learned_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/text.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

// The training movements dealt out to two hands, in random order.
std::vector<int> half_of_movements(const Diagnosis& diagnosis, const Observations& data,
                                   RandomStream random) {
  std::vector<int> training;
  for (const int m : data.movements()) {
    if (!std::ranges::binary_search(diagnosis.held_out, m)) training.push_back(m);
  }
  random.shuffle(std::span(training));
  training.resize(training.size() / 2);
  std::ranges::sort(training);
  return training;
}

std::vector<char> rows_in(const Diagnosis& diagnosis, const Observations& data,
                          const std::vector<int>& half, bool in_half) {
  std::vector<char> keep(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool test = std::ranges::binary_search(diagnosis.held_out, data.movement[i]);
    const bool own = std::ranges::binary_search(half, data.movement[i]);
    const bool masked = !diagnosis.masked.empty() && diagnosis.masked[i] != 0;
    keep[i] = !test && !masked && own == in_half ? 1 : 0;
  }
  return keep;
}

// The formula a method finds for the residual over the leftover's inputs and the direction.
Expression search_formula(const Observations& data, const Diagnosis& diagnosis,
                          const Regressor& method, Budget& budget, RandomStream random) {
  std::vector<std::string> wanted = diagnosis.leftover.signals;
  wanted.emplace_back("sgn_v");
  std::vector<Input> inputs;
  std::vector<const double*> columns;
  std::vector<std::size_t> places;
  for (std::size_t j = 0; j < data.signals.size(); ++j) {
    const Signal& signal = data.signals[j];
    if (std::ranges::count(wanted, signal.name) == 0) continue;
    const auto [low, high] = std::ranges::minmax(signal.values);
    inputs.push_back({signal.name, signal.unit, signal.role, low, high, std::nullopt});
    columns.push_back(signal.values.data());
    places.push_back(j);
  }
  const Eigen::VectorXd residual = target_vector(data) - predict(diagnosis.after, data);
  const std::vector<double> target(residual.begin(), residual.end());
  const TrainingData training{inputs, columns, target, data.movement};
  FitContext context{training, find_operator_set("full"), budget, random};
  const FitResult fitted = method.fit(context);
  if (fitted.front.empty()) return {};
  std::vector<Node> nodes(fitted.front[fitted.chosen].nodes().begin(),
                          fitted.front[fitted.chosen].nodes().end());
  for (Node& node : nodes) {
    if (node.is_variable()) node = Node::input(places[node.variable]);
  }
  return Expression(std::move(nodes));
}

bool varies(const Expression& formula, const Observations& data) {
  if (formula.empty() || columns_used(formula) == 0) return false;
  const std::vector<Expression> one = {formula};
  const Eigen::VectorXd values = evaluate_columns(one, data).col(0);
  return values.allFinite() && values.maxCoeff() > values.minCoeff();
}

}  // namespace

std::optional<LearnedEffect> learn_effect(const Diagnosis& diagnosis, const Observations& data,
                                          const Regressor& method, const std::string& method_name,
                                          Budget& budget, std::uint64_t seed) {
  if (diagnosis.leftover.signals.empty()) return std::nullopt;
  const RandomStream random = RandomStream(seed).split("learned");
  const std::vector<int> half = half_of_movements(diagnosis, data, random.split("halves"));
  const Observations finding = data.select(rows_in(diagnosis, data, half, true));
  const Observations testing = data.select(rows_in(diagnosis, data, half, false));
  if (finding.rows() < 50 || testing.rows() < 50) return std::nullopt;
  const Expression formula =
      search_formula(finding, diagnosis, method, budget, random.split("search"));
  if (!varies(formula, testing)) return std::nullopt;
  LearnedEffect learned;
  learned.formula = print(formula, data.names());
  learned.found_on = finding.movements().size();
  learned.tested_on = testing.movements().size();
  const std::string inputs = fmt::format("{}", fmt::join(diagnosis.leftover.inputs, "_"));
  learned.family.name = std::string(kLearnedPrefix) + inputs;
  learned.family.id = "learned";
  learned.family.summary = fmt::format("grown from data, in {}", inputs);
  learned.family.phrase = fmt::format("a dependence on {} that was learned from data", inputs);
  learned.family.source = fmt::format("{} on {} movements", method_name, learned.found_on);
  learned.family.atoms = {{{learned.formula}, {"factor"}}};
  std::vector<std::string> names;
  for (const int m : half) names.push_back(data.movement_names[static_cast<std::size_t>(m)]);
  learned.family.origin = fmt::format("{}", fmt::join(names, ", "));
  DiagnosisOptions options = diagnosis.options;
  options.learned = {learned.family};
  options.families = {learned.family.name};
  const std::string base = formula_text(diagnosis.after, data);
  const BaseMaker maker = [&base](const Observations& rows) { return formula_base(rows, base); };
  const Diagnosis second = diagnose(testing, maker, options);
  if (!second.candidates.empty()) {
    learned.p = second.candidates[0].adjusted_p;
    learned.gain = second.candidates[0].gain;
  }
  if (!second.effects.empty()) {
    learned.gain = second.effects[0].gain;
    learned.gain_error = second.effects[0].gain_error;
    learned.accepted = true;
  }
  return learned;
}

}  // namespace tribench::loop
