// SPDX-License-Identifier: MIT
#include "algorithms/external/external_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "algorithms/expression/text.hpp"
#include "algorithms/external/answer_reader.hpp"
#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/scratch_folder.hpp"

namespace tribench {
namespace {

using nlohmann::json;

constexpr int kProtocol = 1;
constexpr std::size_t kMaxOutputBytes = 1U << 24;  // a program that prints without end is stopped

void write_or_throw(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) {
    throw Error(ErrorKind::environment, "there is no room to write", file.string(),
                "make room in the folder of temporary files, or name another by TMPDIR");
  }
}

// A program that failed while the disk was full has shown nothing about itself.
void require_room(const std::filesystem::path& folder) {
  const std::filesystem::path probe = folder / "probe";
  write_or_throw(probe, std::string(1U << 16, '-'));
  std::filesystem::remove(probe);
}

std::vector<std::string> names_of(const TrainingData& data) {
  std::vector<std::string> names;
  for (const Input& input : data.inputs) names.push_back(input.name);
  return names;
}

// The columns that train.csv has beside the inputs.
constexpr const char* kTargetColumn = "target";
constexpr const char* kMovementColumn = "movement";

// An input of such a name would be a second column of it, and which of the two a program reads is
// its CSV library's choice.
const Input* input_of_taken_name(const TrainingData& data) {
  const auto found = std::ranges::find_if(data.inputs, [](const Input& input) {
    return input.name == kTargetColumn || input.name == kMovementColumn;
  });
  return found == data.inputs.end() ? nullptr : &*found;
}

// Rows without a target are left out: the program need not know of missing values.
void write_training_rows(const TrainingData& data, const std::filesystem::path& file) {
  std::string text;
  for (const std::string& name : names_of(data)) text += name + ",";
  text += fmt::format("{},{}\n", kTargetColumn, kMovementColumn);
  for (std::size_t r = 0; r < data.rows(); ++r) {
    bool is_finite = std::isfinite(data.target[r]);
    for (const double* column : data.columns) is_finite = is_finite && std::isfinite(column[r]);
    if (!is_finite) continue;
    for (const double* column : data.columns) text += print_number(column[r]) + ",";
    text += fmt::format("{},{}\n", print_number(data.target[r]), data.movement[r]);
  }
  write_or_throw(file, text);
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
    if (input.max_degree > 0) inputs.back()["max_degree"] = input.max_degree;
  }
  json operators = json::array();
  for (const Op op : context.operators.operators()) operators.push_back(op_name(op));
  RandomStream random = context.random;
  return {{"protocol", kProtocol},
          {"train", "train.csv"},
          {"target", kTargetColumn},
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

// Asks the program to end once the budget is stopped, and ends it where it does not.
class StopOnDemand {
 public:
  StopOnDemand(ChildProcess& program, const Budget& budget) : program_(program), budget_(budget) {}

  bool asked() const { return asked_.has_value(); }
  void look() {
    const auto now = std::chrono::steady_clock::now();
    if (!asked_ && budget_.is_stopped()) {
      asked_ = now;
      program_.ask_to_end();
    }
    if (asked_ && now - *asked_ > std::chrono::duration<double>(kSecondsToEnd)) program_.kill();
  }

 private:
  ChildProcess& program_;
  const Budget& budget_;
  std::optional<std::chrono::steady_clock::time_point> asked_;
};

class ExternalMethod : public Regressor {
 public:
  ExternalMethod(std::vector<std::string> command, std::map<std::string, ParameterValue> parameters,
                 ProgramLimits limits)
      : command_(std::move(command)), parameters_(std::move(parameters)), limits_(limits) {}

  FitResult fit(FitContext& context) const override {
    if (context.budget.remaining() == 0) return {{}, 0, StopReason::budget, "no budget"};
    if (const Input* taken = input_of_taken_name(context.data)) {
      return FitResult::unsupported(
          fmt::format("an input is called '{}' like a column that programs are given; give that "
                      "column of the data another name",
                      taken->name));
    }
    const ScratchFolder scratch;
    write_training_rows(context.data, scratch.path() / "train.csv");
    const std::filesystem::path request = scratch.path() / "request.json";
    write_or_throw(request, write_json(request_json(context, parameters_), 1) + "\n");
    ChildOptions options;
    options.command = command_;
    options.command.push_back(request.string());
    options.scratch = scratch.path();
    options.environment.push_back("TMPDIR=" + scratch.path().string());
    // One thread unless the cell may use more: libraries below Python start their own.
    for (const char* name : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"}) {
      options.environment.push_back(fmt::format("{}={}", name, context.threads));
    }
    try {
      ChildProcess program(options);
      program.close_input();
      return converse(program, context);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::failed) require_room(scratch.path().parent_path());
      throw;
    }
  }

 private:
  FitResult converse(ChildProcess& program, FitContext& context) const {
    const auto start = std::chrono::steady_clock::now();
    AnswerReader answer(context);
    std::string errors;
    std::size_t bytes = 0;
    StopOnDemand stop(program, context.budget);
    for (bool ended = false; !ended;) {
      const ChildOutput output = program.read(1.0);
      answer.take(output.output);
      bytes += output.output.size();
      if (bytes > kMaxOutputBytes) throw Error(ErrorKind::failed, "the program prints without end");
      errors += output.errors;
      if (errors.size() > 65536) errors.erase(0, errors.size() - 4096);
      ended = output.ended;
      require_time_left(program, start);
      stop.look();
    }
    while (!program.ends_within(1.0)) {
      require_time_left(program, start);
      stop.look();
    }
    const ChildExit exit = program.wait();
    // How it ended was our doing: what it has answered by then counts.
    return answer.finish(stop.asked() ? ChildExit() : exit, errors);
  }

  void require_time_left(const ChildProcess& program,
                         std::chrono::steady_clock::time_point start) const {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    if (wall.count() > limits_.wall_s) {
      throw Error(ErrorKind::failed,
                  fmt::format("the program took more than {:.3g} s of wall time", limits_.wall_s));
    }
    if (std::isfinite(limits_.cpu_s) && process_tree_use(program.pid()).cpu_s > limits_.cpu_s) {
      throw Error(ErrorKind::failed,
                  fmt::format("the program took more than {:.3g} s of CPU time", limits_.cpu_s));
    }
  }

  std::vector<std::string> command_;
  std::map<std::string, ParameterValue> parameters_;
  ProgramLimits limits_;
};

}  // namespace

std::unique_ptr<Regressor> make_external_method(std::vector<std::string> command,
                                                std::map<std::string, ParameterValue> parameters,
                                                ProgramLimits limits) {
  return std::make_unique<ExternalMethod>(std::move(command), std::move(parameters), limits);
}

}  // namespace tribench
