// SPDX-License-Identifier: MIT
//
// The one interface of every method: baselines, symbolic regression, placebos, the closed loop.
//
// A method turns training rows into formulas. It does not score itself, split test data, measure
// time, print, log or read a clock; the harness does. It keeps no state between calls.
//
// Rules that the conformance tests check for every registered method: the same stream gives the
// same front for any number of threads; a zero budget returns at once; the front parses, keeps to
// the operator set (unless the method declares a fixed form) and is free of duplicates; data with
// NaN, a constant target, a single row or a scale of 1e6 are answered, never crash.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "algorithms/budget.hpp"
#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/operator_set.hpp"
#include "algorithms/states/state_column.hpp"
#include "foundation/random.hpp"
#include "problems/problem.hpp"

namespace tribench {

// What a method may look at: the inputs it may use and the training rows. Non-owning.
struct TrainingData {
  std::span<const Input> inputs;           // column j of the formula is inputs[j]
  std::span<const double* const> columns;  // columns[j]: rows() doubles
  std::span<const double> target;          // in the target's unit; may hold NaN: skip such rows
  std::span<const int> movement;           // per row; whole movements are the unit of validation
  // All that was recorded, with the same inputs, and where each row stands in it: for formulas with
  // states. Empty where the problem has no time.
  MotionRows motion = {};
  std::span<const std::size_t> motion_row = {};

  bool has_time() const { return !motion_row.empty(); }
  std::size_t rows() const { return target.size(); }
  Inputs table() const { return {columns, rows()}; }
};

// A parameter's value, as a grid file gives it.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

// What a method accepts: the grid refuses unknown names and values of another kind or out of range.
struct ParameterSpec {
  std::string name;
  std::string summary;  // one line, with the unit
  ParameterValue default_value;
  double low = -1e308;  // for numbers
  double high = 1e308;
  std::vector<std::string> choices = {};  // for texts; empty means any
  // A number outside the range that has a meaning of its own, which the summary says.
  std::optional<double> besides = {};
};

// What a command line says, in the kind of the parameter's default; the range is Parameters' to
// check. Throws Error (bad_input) where the text is no such value.
ParameterValue parameter_from_text(const std::vector<ParameterSpec>& specs, const std::string& name,
                                   std::string_view text);

// Defaults overridden by what the grid says. Lookups of a name that has no spec are a bug.
class Parameters {
 public:
  // Throws Error (bad_input) with the nearest name, or the range.
  Parameters(const std::vector<ParameterSpec>& specs,
             const std::map<std::string, ParameterValue>& given);

  bool flag(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double number(std::string_view name) const;  // an integer will do
  const std::string& text(std::string_view name) const;

 private:
  const ParameterValue& at(std::string_view name) const;
  std::map<std::string, ParameterValue, std::less<>> values_;
};

// Receives improving models while a fit runs: the anytime trace. train_error is what the method
// minimises (mean squared error unless it says otherwise); evaluations are node-rows spent.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void improved(double train_error, std::uint64_t evaluations) = 0;
};

struct FitContext {
  const TrainingData& data;
  const OperatorSet& operators;
  Budget& budget;
  RandomStream random;  // keyed by the cell; split it for parts
  int threads = 1;      // may be used; must not change the result
  Progress* progress = nullptr;
};

enum class StopReason { converged, budget, unsupported };

// What a method's model says of a constant; both ends belong to it.
struct ConstantRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool is_fixed() const { return low == high; }
};

struct FitResult {
  // Over data.inputs and, behind them, `states`; by increasing complexity, no two alike.
  std::vector<Expression> front;
  std::size_t chosen = 0;  // place in the front of the formula the method stands for
  StopReason reason = StopReason::converged;
  std::string note;  // one line for the record; says why where unsupported
  // The formulas' form is the user's (a template): whoever shortens formulas leaves them.
  bool keeps_form = false;
  // `chosen` is final (a program of the user's has said it): no other formula takes its place, and
  // no further round is fitted, which could only do that.
  bool keeps_choice = false;
  // On few rows a sum of few inputs may take the chosen formula's place where it stands better on
  // rows held out (fitting/held_out_choice.hpp): a part of the method, done when all rounds of it
  // have ended.
  bool yields_to_plain_sum = false;
  // So many rows that neither had seen say that what is chosen stands better than a sum of many
  // terms, or is it; 0: none were asked. A round that has asked fewer has no say beside it.
  std::size_t held_out_rows = 0;
  // What the formulas remember: column data.inputs.size() + k is states[k], driven by data.inputs.
  std::vector<StateDeclaration> states = {};
  // Of the constants of front[chosen], in the order of its tape, for whoever fits them anew; empty
  // where the method bounds none.
  std::vector<ConstantRange> ranges = {};

  static FitResult unsupported(std::string why) {
    return {{}, 0, StopReason::unsupported, std::move(why), false, {}};
  }
};

class Regressor {
 public:
  virtual ~Regressor() = default;
  // Pure with respect to *this; may run in several threads at once on different contexts.
  virtual FitResult fit(FitContext& context) const = 0;
};

// Makes another method by its name: for one that builds on it (the closed loop on its base, relay
// on its members). Round 0 has its defaults, a later one what its entry widens. Throws Error
// (bad_input) with the nearest name.
using MakeMethod = std::function<std::unique_ptr<Regressor>(std::string_view name, int round)>;

// One algorithm: what it is called, what it accepts, how it is made.
struct AlgorithmEntry {
  std::string name;     // "pysr"
  std::string summary;  // one line
  std::vector<ParameterSpec> parameters;
  // A fixed form (a baseline's exp and /) does not depend on the operator set; the grid runs such
  // a method once per problem and seed, under the set "-".
  bool fixed_form = false;
  // `other` outlives nothing: what a method needs of it is made at once.
  std::unique_ptr<Regressor> (*make)(const Parameters& parameters,
                                     const MakeMethod& other) = nullptr;
  // Where a budget shall be spent, a fit is followed by further rounds (harness/restarts.hpp): what
  // the round of this number, from 1 on, sets to search wider than the one before. None: every
  // round is the same but for its random numbers.
  std::map<std::string, ParameterValue> (*widened)(int round) = nullptr;
};

}  // namespace tribench
