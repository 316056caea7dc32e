// SPDX-License-Identifier: MIT
//
// What a program answers is refused with the place, or gives formulas of the operator set over the
// problem's inputs; it reads the same in whatever pieces it comes.
#include <array>

#include "algorithms/expression/text.hpp"
#include "algorithms/external/answer_reader.hpp"
#include "foundation/error.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

using namespace tribench;

// Two inputs over four rows: enough for formulas to be parsed, admitted and proved.
struct SmallProblem {
  std::vector<Input> inputs = {{"v", "rad/s", Role::velocity, -1, 1, {}},
                               {"g", "N m", Role::gravity_torque, -10, 10, {}}};
  std::array<double, 4> v = {-1, -0.5, 0.5, 1};
  std::array<double, 4> g = {10, -10, 3, 0};
  std::array<double, 4> target = {-2, -1.5, 1.5, 2};
  std::array<int, 4> movement = {0, 0, 1, 1};
  std::vector<const double*> columns = {v.data(), g.data()};
  TrainingData data{inputs, columns, target, movement};
};

class IgnoreTrace : public Progress {
  void improved(double, std::uint64_t) override {}
};

// The answer as text, or why it was refused; the front's formulas are checked on the way.
std::string read_answer(std::string_view input, std::size_t piece) {
  SmallProblem problem;
  Budget budget({});
  const OperatorSet& operators = find_operator_set("paper+safe_div");
  IgnoreTrace trace;
  FitContext context{problem.data, operators, budget, RandomStream(1), 1, &trace};
  AnswerReader reader(context);
  try {
    for (std::size_t start = 0; start < input.size(); start += piece) {
      reader.take(input.substr(start, piece));
    }
    const FitResult result = reader.finish({}, "");
    if (result.reason == StopReason::unsupported) return "unsupported: " + result.note;
    fuzz::expect(result.chosen < result.front.size(), "the chosen formula is not in the front");
    std::string formulas;
    for (const Expression& formula : result.front) {
      fuzz::expect(operators.admits(formula), "a formula outside the operator set is offered");
      formulas += print(formula, std::vector<std::string>{"v", "g"}) + "\n";
    }
    return formulas;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::failed) throw;  // the cell's failure, and nobody else's
    return std::string("refused: ") + error.what();
  }
}

}  // namespace

TRIBENCH_FUZZ_TARGET(answer) {
  const std::string whole = read_answer(input, input.size() + 1);
  fuzz::expect(read_answer(input, 3) == whole,
               "in pieces it reads as something else than\n" + whole);
}
