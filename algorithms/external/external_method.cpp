// SPDX-License-Identifier: MIT
#include "algorithms/external/external_method.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "algorithms/admission.hpp"
#include "algorithms/expression/text.hpp"
#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

using nlohmann::json;

constexpr int kProtocol = 1;
constexpr std::size_t kMaxOutputBytes = 1U << 24;  // a program that prints without end is stopped
constexpr std::size_t kQuotedCharacters = 200;

[[noreturn]] void throw_unusable(std::string_view what) { throw Error(ErrorKind::failed, what); }

std::string excerpt(std::string_view text) {
  std::string shown(text.substr(0, kQuotedCharacters));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = ' ';
  }
  return shown;
}

std::string last_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  const std::size_t start = text.rfind('\n');
  return excerpt(start == std::string_view::npos ? text : text.substr(start + 1));
}

std::vector<std::string> names_of(const TrainingData& data) {
  std::vector<std::string> names;
  for (const Input& input : data.inputs) names.push_back(input.name);
  return names;
}

// Rows without a target are left out: the program need not know of missing values.
void write_training_rows(const TrainingData& data, const std::filesystem::path& file) {
  std::string text;
  for (const std::string& name : names_of(data)) text += name + ",";
  text += "target,movement\n";
  for (std::size_t r = 0; r < data.rows(); ++r) {
    bool is_finite = std::isfinite(data.target[r]);
    for (const double* column : data.columns) is_finite = is_finite && std::isfinite(column[r]);
    if (!is_finite) continue;
    for (const double* column : data.columns) text += print_number(column[r]) + ",";
    text += fmt::format("{},{}\n", print_number(data.target[r]), data.movement[r]);
  }
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) throw_unusable(fmt::format("cannot write {}", file.string()));
}

json parameters_json(const std::map<std::string, ParameterValue>& parameters) {
  json object = json::object();
  for (const auto& [name, value] : parameters) {
    std::visit([&object, &key = name](const auto& plain) { object[key] = plain; }, value);
  }
  return object;
}

json request_json(const FitContext& context,
                  const std::map<std::string, ParameterValue>& parameters) {
  json inputs = json::array();
  for (const Input& input : context.data.inputs) {
    inputs.push_back({{"name", input.name},
                      {"unit", input.unit},
                      {"role", role_name(input.role)},
                      {"low", input.low},
                      {"high", input.high}});
  }
  json operators = json::array();
  for (const Op op : context.operators.operators()) operators.push_back(op_name(op));
  RandomStream random = context.random;
  return {{"protocol", kProtocol},
          {"train", "train.csv"},
          {"target", "target"},
          {"inputs", inputs},
          {"operator_set", context.operators.name()},
          {"operators", operators},
          {"proved_free_only", context.operators.proved_free_only()},
          {"evaluations", context.budget.remaining()},
          {"seconds", context.budget.remaining_seconds()},
          // 31 bits: what every language's generators take as a seed.
          {"seed", random.below(1ULL << 31)},
          {"threads", context.threads},
          {"parameters", parameters_json(parameters)}};
}

// Reads the program's lines as they come.
class AnswerReader {
 public:
  explicit AnswerReader(FitContext& context) : context_(context), names_(names_of(context.data)) {}

  void take(std::string_view text) {
    pending_ += text;
    std::size_t start = 0;
    for (std::size_t end = pending_.find('\n'); end != std::string::npos;
         end = pending_.find('\n', start)) {
      take_line(pending_.substr(start, end - start));
      start = end + 1;
    }
    pending_.erase(0, start);
  }

  // After the last byte. Throws where there was no usable answer.
  FitResult finish(const ChildExit& exit, const std::string& errors) {
    if (!pending_.empty()) take_line(std::exchange(pending_, {}));
    if (exit.signal != 0) {
      throw_unusable(fmt::format("the program was ended by {}", signal_name(exit.signal)));
    }
    if (exit.status != 0) {
      throw_unusable(
          fmt::format("the program ended with status {}: {}", exit.status, last_line(errors)));
    }
    if (result_) return std::move(*result_);
    throw_unusable(other_output_.empty()
                       ? std::string("the program printed no front")
                       : fmt::format("the program printed no front but '{}'", other_output_));
  }

 private:
  // Lines that are no JSON object are the program's own chatter.
  void take_line(const std::string& line) {
    const json object =
        line.starts_with('{') ? read_json<json>(line) : json(json::value_t::discarded);
    if (!object.is_object()) {
      if (other_output_.empty()) other_output_ = excerpt(line);
      return;
    }
    try {
      if (object.contains("improved")) take_improvement(object.at("improved"));
      if (object.contains("unsupported")) {
        result_ = FitResult::unsupported(object.at("unsupported"));
      }
      if (object.contains("front")) take_front(object);
    } catch (const json::exception& error) {
      throw_unusable(fmt::format("the program's answer is malformed: {}", error.what()));
    }
  }

  void take_improvement(const json& improvement) {
    if (context_.progress == nullptr) return;
    context_.progress->improved(improvement.at("train_error"),
                                improvement.value("evaluations", std::uint64_t{0}));
  }

  void take_front(const json& object) {
    FitResult result;
    for (const json& formula : object.at("front")) {
      result.front.push_back(parse_formula(formula.get<std::string>()));
    }
    if (result.front.empty()) throw_unusable("the program's front is empty");
    result.chosen = object.value("chosen", result.front.size() - 1);
    if (result.chosen >= result.front.size()) {
      throw_unusable(
          fmt::format("'chosen' is {} in a front of {}", result.chosen, result.front.size()));
    }
    result.note = object.value("note", std::string());
    keep_safe_formulas(result);
    context_.budget.book(object.value("evaluations", std::uint64_t{0}));
    result_ = std::move(result);
  }

  // Formulas not proved free go where the operator set admits no others. The next simpler one that
  // is left stands in for a choice that goes, else the simplest.
  void keep_safe_formulas(FitResult& result) const {
    const Admission admission(context_);
    std::vector<Expression> kept;
    std::size_t chosen = 0;
    for (std::size_t k = 0; k < result.front.size(); ++k) {
      if (!admission.is_safe(result.front[k])) continue;
      if (k <= result.chosen) chosen = kept.size();
      kept.push_back(std::move(result.front[k]));
    }
    if (kept.empty()) throw_unusable("no formula of the front is proved free of singularities");
    result.front = std::move(kept);
    result.chosen = chosen;
  }

  Expression parse_formula(const std::string& text) const {
    try {
      Expression formula = parse(text, names_);
      if (context_.operators.admits(formula)) return formula;
    } catch (const Error& error) {
      throw_unusable(
          fmt::format("the formula '{}' cannot be read: {}", excerpt(text), error.what()));
    }
    throw_unusable(fmt::format("the formula '{}' leaves the operator set {}", excerpt(text),
                               context_.operators.name()));
  }

  FitContext& context_;
  std::vector<std::string> names_;
  std::string pending_;
  std::string other_output_;
  std::optional<FitResult> result_;
};

class ExternalMethod : public Regressor {
 public:
  ExternalMethod(std::vector<std::string> command, std::map<std::string, ParameterValue> parameters)
      : command_(std::move(command)), parameters_(std::move(parameters)) {}

  FitResult fit(FitContext& context) const override {
    if (context.budget.remaining() == 0) return {{}, 0, StopReason::budget, "no budget"};
    const ScratchFolder scratch;
    write_training_rows(context.data, scratch.path() / "train.csv");
    const std::filesystem::path request = scratch.path() / "request.json";
    std::ofstream(request) << request_json(context, parameters_).dump(1) << "\n";
    ChildOptions options;
    options.command = command_;
    options.command.push_back(request.string());
    options.own_group = false;
    // One thread unless the cell may use more: libraries below Python start their own.
    for (const char* name : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"}) {
      options.environment.push_back(fmt::format("{}={}", name, context.threads));
    }
    ChildProcess program(options);
    program.close_input();
    return converse(program, context);
  }

 private:
  static FitResult converse(ChildProcess& program, FitContext& context) {
    AnswerReader answer(context);
    std::string errors;
    std::size_t bytes = 0;
    for (bool ended = false; !ended;) {
      const ChildOutput output = program.read(1.0);
      answer.take(output.output);
      bytes += output.output.size();
      if (bytes > kMaxOutputBytes) throw_unusable("the program prints without end");
      errors += output.errors;
      if (errors.size() > 65536) errors.erase(0, errors.size() - 4096);
      ended = output.ended;
    }
    const ChildExit exit = program.wait();
    return answer.finish(exit, errors);
  }

  std::vector<std::string> command_;
  std::map<std::string, ParameterValue> parameters_;
};

}  // namespace

std::unique_ptr<Regressor> make_external_method(std::vector<std::string> command,
                                                std::map<std::string, ParameterValue> parameters) {
  return std::make_unique<ExternalMethod>(std::move(command), std::move(parameters));
}

}  // namespace tribench
