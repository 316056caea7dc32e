// SPDX-License-Identifier: MIT
//
// A formula turned into machine code, for formulas that are evaluated many times with other
// constants: fits, basin hopping, the bootstrap. Arithmetic runs as one loop over the rows with all
// intermediate values in registers; exp, log, sin, cos, tanh, atan, sgn and general powers run
// between such loops by the evaluator's own block kernels. So the result has the same bits as
// `Evaluator`, which is the reference and the fallback where no code can be generated.
//
//   std::optional<CompiledFormula> code = CompiledFormula::compile(formula);
//   if (code) code->evaluate(constants, inputs, out);   // else evaluator.evaluate(...)
//
// Compiling costs some tens of microseconds (bench/README.md), an evaluation a third or less of
// the interpreter's; RepeatedEvaluator makes the choice.
//
// Code is generated for x86-64 with AVX2 or AVX-512 by Xbyak, written once and then made
// executable and read-only.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/expression/evaluate.hpp"
#include "algorithms/expression/expression.hpp"
#include "algorithms/expression/vector/level.hpp"

namespace tribench {

template <typename T>
class BasicCompiledFormula {
 public:
  // None where the level or the machine allows no generated code.
  static std::optional<BasicCompiledFormula> compile(const Expression& formula,
                                                     VectorLevel level = vector_level());
  ~BasicCompiledFormula();
  BasicCompiledFormula(BasicCompiledFormula&&) noexcept;
  BasicCompiledFormula& operator=(BasicCompiledFormula&&) noexcept;

  // How many constants the tape has, in its order; what `evaluate` wants.
  std::size_t constants() const;

  // out[r] = the formula at row r with these constants in place of its own. A whole number that
  // is the exponent of ^ keeps the value that it had when compiled: it decides which code there is.
  // Not const: it works in buffers of its own. One thread at a time.
  void evaluate(std::span<const T> constants, const BasicInputs<T>& inputs, std::span<T> out);

 private:
  struct Code;
  explicit BasicCompiledFormula(std::unique_ptr<Code> code);
  std::unique_ptr<Code> code_;
};

extern template class BasicCompiledFormula<double>;
extern template class BasicCompiledFormula<float>;
using CompiledFormula = BasicCompiledFormula<double>;

// Evaluates one formula again and again, and compiles it once that pays: when interpreting it has
// cost as much as compiling would (so that the choice never costs more than twice the better one).
class RepeatedEvaluator {
 public:
  explicit RepeatedEvaluator(VectorLevel level = vector_level()) : evaluator_(level) {}

  void prepare(const Expression& formula);
  // New values of all constants, in the order of the tape; exponents of ^ are left as they are.
  void set_constants(std::span<const double> constants);
  void evaluate(const Inputs& inputs, std::span<double> out);
  bool is_compiled() const { return code_.has_value(); }

 private:
  Evaluator evaluator_;
  Expression formula_;
  std::vector<std::size_t> positions_;
  std::vector<double> constants_;
  std::optional<CompiledFormula> code_;
  double spent_ns_ = 0;  // estimate of what interpreting has cost
  bool tried_ = false;
};

}  // namespace tribench
