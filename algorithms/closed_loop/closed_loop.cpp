// SPDX-License-Identifier: MIT
#include "algorithms/closed_loop/closed_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/expression/text.hpp"
#include "algorithms/loop_model/model_fit.hpp"
#include "algorithms/missing_role.hpp"
#include "foundation/error.hpp"

namespace tribench::loop {
namespace {

constexpr std::string_view kDefaultBase = "coulomb_viscous";
constexpr std::string_view kFormula = "formula:";
// A diagnosis costs about as much as this many evaluations of a node on every row.
constexpr std::uint64_t kNodesPerRow = 5000;
constexpr std::size_t kFewestRows = 40;

// The signals a base may be made of: friction is a matter of velocity and load; everything else is
// for the loop to find.
bool belongs_to_base(const Observations& data, const Signal& signal) {
  const bool rigid = std::ranges::count(data.rigid, signal.name) > 0;
  return rigid || signal.role == Role::velocity || signal.role == Role::velocity_sign ||
         signal.role == Role::gravity_torque || signal.role == Role::gravity_sign;
}

std::vector<std::size_t> rows_of_movements(const Observations& data) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (i == 0 || data.movement[i] != data.movement[i - 1]) rows.push_back(0);
    ++rows.back();
  }
  return rows;
}

// Renames the columns of a formula: column j becomes column to[j].
Expression renumbered(const Expression& formula, std::span<const std::size_t> to) {
  std::vector<Node> nodes(formula.nodes().begin(), formula.nodes().end());
  for (Node& node : nodes) {
    if (node.is_variable()) node = Node::input(to[node.variable]);
  }
  return Expression(std::move(nodes));
}

// A formula over the signals as one over the problem's inputs. A sign that is no input is the sign
// of the input it belongs to.
Expression over_inputs(const Expression& formula, const Observations& data,
                       std::span<const Input> inputs) {
  const auto place = [&](std::string_view channel) {
    return static_cast<std::size_t>(std::ranges::find(inputs, channel, &Input::name) -
                                    inputs.begin());
  };
  std::vector<Node> nodes;
  for (const Node& node : formula.nodes()) {
    if (!node.is_variable()) {
      nodes.push_back(node);
      continue;
    }
    const Signal& signal = data.signals[node.variable];
    const std::size_t input = place(signal.channel);
    nodes.push_back(Node::input(input));
    const bool derived_sign = signal.name.starts_with("sgn_") && inputs[input].role != signal.role;
    if (derived_sign) nodes.push_back({0, 1, 0, Op::sgn});
  }
  return Expression(std::move(nodes));
}

class ClosedLoop : public Regressor {
 public:
  ClosedLoop(const Parameters& parameters, const MakeMethod& other)
      : base_name_(parameters.text("base")) {
    options_.alpha_library = parameters.number("alpha_library");
    options_.alpha_leftover = parameters.number("alpha_leftover");
    options_.flips = static_cast<std::size_t>(parameters.integer("flips"));
    require_enough_flips(options_);
    options_.physical_vetoes = parameters.flag("physical_vetoes");
    const double ratio = parameters.number("gear_ratio");
    if (ratio > 0) options_.gear_ratios = {ratio};
    if (base_name_ != kDefaultBase && !base_name_.starts_with(kFormula)) {
      if (base_name_ == "closed_loop") {
        throw_bad_input("the closed loop cannot be its own base", "base",
                        "use coulomb_viscous, symmetric or another method");
      }
      const bool formula = base_name_.find_first_of("*+/(") != std::string::npos;
      if (formula) {
        throw_bad_input(fmt::format("'{}' is no method's name", base_name_), "base",
                        fmt::format("a formula is given as formula:{}", base_name_));
      }
      method_ = other(base_name_, 0);
    }
  }

  FitResult fit(FitContext& context) const override {
    try {
      return fit_observed(context, observe(context.data));
    } catch (const Error& error) {
      // Data that cannot be diagnosed, such as a target without one finite value.
      return FitResult::unsupported(error.what());
    }
  }

 private:
  FitResult fit_observed(FitContext& context, const Observations& data) const {
    if (data.find("v") == nullptr) {
      return unsupported_without_role("the closed loop needs an input", "velocity");
    }
    if (data.rows() < kFewestRows) {
      return FitResult::unsupported(fmt::format(
          "the closed loop needs at least {} rows, here are {}", kFewestRows, data.rows()));
    }
    if (!std::ranges::any_of(rows_of_movements(data),
                             [](std::size_t rows) { return rows >= kFewestRowsOfMovement; })) {
      return base_alone(context, data);
    }
    FitResult result;
    if (!context.budget.spend(kNodesPerRow * data.rows())) {
      result.reason = StopReason::budget;
      return result;
    }
    const Diagnosis diagnosis = diagnose(data, base_maker(context), options_);
    report(context, data, diagnosis, result);
    return result;
  }

  // Movements of a row or two: there is no noise within them to measure anything against.
  FitResult base_alone(FitContext& context, const Observations& data) const {
    Noise noise;
    noise.within_sd = 1;
    const Clusters clusters = make_clusters(data.movement, 1);
    LoopModel model;
    model.base = base_maker(context)(data);
    model.coefficients.setZero(static_cast<Eigen::Index>(model.base.linear_terms.size()));
    fit_model(model, data, clusters, noise, FitScope::everything);
    FitResult result;
    result.front = {over_inputs(formula_of(model), data, context.data.inputs)};
    result.note = fmt::format(
        "the base alone: every movement has fewer than {} rows, too few to tell noise from effects",
        kFewestRowsOfMovement);
    return result;
  }

  BaseMaker base_maker(FitContext& context) const {
    if (method_) {
      return method_base(*method_, base_name_, context.random.split("base"), context.budget);
    }
    if (base_name_.starts_with(kFormula)) {
      const std::string text = base_name_.substr(kFormula.size());
      return [text](const Observations& data) { return formula_base(data, text); };
    }
    return coulomb_viscous_base;
  }

  static void report(const FitContext& context, const Observations& data,
                     const Diagnosis& diagnosis, FitResult& result) {
    const auto add = [&](const LoopModel& model) {
      Expression formula = over_inputs(formula_of(model), data, context.data.inputs);
      if (result.front.empty() || !(result.front.back() == formula)) {
        result.front.push_back(std::move(formula));
      }
      if (context.progress == nullptr) return;
      const Eigen::VectorXd residual = target_vector(data) - predict(model, data);
      context.progress->improved(residual.squaredNorm() / static_cast<double>(data.rows()),
                                 context.budget.spent());
    };
    add(diagnosis.before);
    add(diagnosis.after);
    result.chosen = result.front.size() - 1;
    std::vector<std::string> names;
    for (const EffectFinding& effect : diagnosis.effects) names.push_back(effect.family);
    result.note = fmt::format(
        "{} {}{}", verdict_name(diagnosis.verdict), fmt::join(names, " "),
        diagnosis.leftover.inputs.empty()
            ? std::string()
            : fmt::format(" left over in {}", fmt::join(diagnosis.leftover.inputs, " x ")));
  }

  std::string base_name_;
  DiagnosisOptions options_;
  std::unique_ptr<Regressor> method_;
};

}  // namespace

BaseMaker method_base(const Regressor& method, std::string name, RandomStream random,
                      Budget& budget) {
  return [&method, name = std::move(name), random, &budget](const Observations& data) {
    std::vector<Input> inputs;
    std::vector<const double*> columns;
    std::vector<std::size_t> signals;
    for (std::size_t j = 0; j < data.signals.size(); ++j) {
      const Signal& signal = data.signals[j];
      if (!belongs_to_base(data, signal)) continue;
      const auto [low, high] = std::ranges::minmax(signal.values);
      inputs.push_back({signal.name, signal.unit, signal.role, low, high, std::nullopt});
      columns.push_back(signal.values.data());
      signals.push_back(j);
    }
    for (Input& input : inputs) {
      if (!input.name.starts_with("sgn_")) continue;
      const auto of = std::ranges::find(inputs, input.name.substr(4), &Input::name);
      if (of != inputs.end()) input.sign_of = static_cast<std::size_t>(of - inputs.begin());
    }
    const TrainingData training{inputs, columns, data.target, data.movement};
    FitContext context{training, find_operator_set("paper"), budget, random};
    const FitResult fitted = method.fit(context);
    if (fitted.front.empty()) {
      throw_bad_input(fmt::format("the base '{}' gave no formula{}{}", name,
                                  fitted.note.empty() ? "" : ": ", fitted.note),
                      {}, "give it more evaluations or choose another base");
    }
    BaseModel base;
    base.name = name;
    add_formula(base, renumbered(fitted.front[fitted.chosen], signals), fitted.ranges);
    // The method has seen the acceleration; what it made of it need not be linear.
    add_rigid_terms(base, data);
    return base;
  };
}

}  // namespace tribench::loop

namespace tribench {

AlgorithmEntry closed_loop_entry() {
  AlgorithmEntry entry;
  entry.name = "closed_loop";
  entry.summary = "adds to a base model the effects that its residual asks for";
  entry.parameters = {
      {"base", "coulomb_viscous, a method's name, or formula:TEXT over the inputs",
       std::string(loop::kDefaultBase)},
      {"alpha_library", "family-wise error of claiming an effect", 0.003, 1e-5, 0.5},
      {"alpha_leftover", "error of claiming that something else is left", 0.002, 1e-5, 0.5},
      {"flips", "sign flips of the null distribution", std::int64_t{1999}, 99, 99999},
      {"gear_ratio", "of the joint; 0 scans the usual ones", 0.0, 0, 10000},
      {"physical_vetoes", "an effect with unphysical parameters is no finding", true},
  };
  entry.fixed_form = true;
  entry.make = [](const Parameters& parameters, const MakeMethod& other) {
    return std::unique_ptr<Regressor>(std::make_unique<loop::ClosedLoop>(parameters, other));
  };
  return entry;
}

}  // namespace tribench
