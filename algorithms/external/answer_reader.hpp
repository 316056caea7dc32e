// SPDX-License-Identifier: MIT
//
// What a program answers, line by line: improvements for the trace, formulas for the front. Text
// in, a FitResult out; knows no process. The protocol is docs/external_methods.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/regressor.hpp"
#include "foundation/child_process.hpp"

namespace tribench {

// Everything in an answer may be wrong: whatever cannot be used throws Error (failed) with the
// place in it, from any of the functions.
class AnswerReader {
 public:
  explicit AnswerReader(FitContext& context);

  // Some bytes of the program's standard output, in the order in which they come.
  void take(std::string_view text);
  // After the last byte; `errors`: what stands on its standard error. A program that met a limit on
  // the size of files throws Error (environment), one that says that it was refused memory
  // std::bad_alloc.
  FitResult finish(const ChildExit& exit, std::string_view errors);

 private:
  void take_line(const std::string& line);
  void take_front(const nlohmann::json& object);
  Expression parse_formula(const std::string& text) const;

  FitContext& context_;
  std::vector<std::string> names_;
  std::string pending_;
  std::string other_output_;  // the first line that is no answer
  std::string unread_;        // why the first that was meant as one cannot be read
  std::optional<FitResult> result_;
};

}  // namespace tribench
