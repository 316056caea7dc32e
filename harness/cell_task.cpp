// SPDX-License-Identifier: MIT
#include "harness/cell_task.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "problems/user/user_problem_text.hpp"

namespace tribench {
namespace {

using nlohmann::json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

double number(const json& object, const char* key) {
  const json& value = object.at(key);
  return value.is_null() ? kMissing : value.get<double>();
}

// Text that came from outside may not be UTF-8; JSON must be.
std::string dump(const json& object) { return write_json(object); }

json parameters_json(const std::map<std::string, ParameterValue>& parameters) {
  json object = json::object();
  for (const auto& [name, value] : parameters) {
    std::visit([&object, &key = name](const auto& plain) { object[key] = plain; }, value);
  }
  return object;
}

std::map<std::string, ParameterValue> parse_parameters(const json& object) {
  std::map<std::string, ParameterValue> parameters;
  for (const auto& [name, value] : object.items()) {
    if (value.is_boolean()) {
      parameters[name] = value.get<bool>();
    } else if (value.is_number_integer()) {
      parameters[name] = value.get<std::int64_t>();
    } else if (value.is_number()) {
      parameters[name] = value.get<double>();
    } else {
      parameters[name] = value.get<std::string>();
    }
  }
  return parameters;
}

json operators_json(const OperatorSet& set) {
  json operators = json::array();
  for (const Op op : set.operators()) operators.push_back(static_cast<int>(op));
  return {
      {"name", set.name()}, {"operators", operators}, {"proved_free_only", set.proved_free_only()}};
}

OperatorSet parse_operators(const json& object) {
  std::vector<Op> operators;
  for (const json& op : object.at("operators")) operators.push_back(static_cast<Op>(op.get<int>()));
  return {object.at("name"), {}, operators, object.at("proved_free_only")};
}

json limits_json(const CellLimits& limits) {
  return {{"evaluations", limits.evaluations},   {"seconds", limits.seconds},
          {"wall_seconds", limits.wall_seconds}, {"cpu_limit_seconds", limits.cpu_limit_seconds},
          {"memory_mib", limits.memory_mib},     {"spend", limits.spend}};
}

CellLimits parse_limits(const json& object) {
  return {object.at("evaluations"),       object.at("seconds"),    object.at("wall_seconds"),
          object.at("cpu_limit_seconds"), object.at("memory_mib"), object.at("spend")};
}

json record_json(const Record& r) {
  json object = {{"cell", r.cell},
                 {"problem", r.problem},
                 {"dataset", r.dataset},
                 {"joint", r.joint},
                 {"load", r.load},
                 {"method", r.method},
                 {"operators", r.operators},
                 {"seed", r.seed},
                 {"status", r.status},
                 {"reason", r.reason},
                 {"mae_train", number(r.mae_train)},
                 {"mae_test", number(r.mae_test)},
                 {"rmse_test", number(r.rmse_test)},
                 {"max_error_test", number(r.max_error_test)},
                 {"r2_test", number(r.r2_test)},
                 {"mae_truth", number(r.mae_truth)},
                 {"mae_ceiling", number(r.mae_ceiling)},
                 {"mae_law", number(r.mae_law)},
                 {"mae_refitted", number(r.mae_refitted)},
                 {"mae_truth_refitted", number(r.mae_truth_refitted)},
                 {"relative_error_train", number(r.relative_error_train)},
                 {"relative_error_test", number(r.relative_error_test)},
                 {"complexity", r.complexity},
                 {"nodes", r.nodes},
                 {"complexity_adaptation", r.complexity_adaptation},
                 {"evaluations", r.evaluations},
                 {"fit_cpu_s", number(r.fit_cpu_s)},
                 {"fit_wall_s", number(r.fit_wall_s)},
                 {"fit_instructions", number(r.fit_instructions)},
                 {"peak_memory_mib", number(r.peak_memory_mib)},
                 {"eval_ns_per_row", number(r.eval_ns_per_row)},
                 {"singularity", r.singularity},
                 {"witness", r.witness},
                 {"grid_check", r.grid_check},
                 {"dissipative", r.dissipative},
                 {"monotone", r.monotone},
                 {"odd", r.odd},
                 {"formula", r.formula},
                 {"note", r.note}};
  // Few problems have it: the others' records, and their fingerprints, stay as they are.
  if (std::isfinite(r.motion_error)) object["motion_error"] = r.motion_error;
  return object;
}

Record parse_record(const json& object) {
  Record r;
  r.cell = object.at("cell");
  r.problem = object.at("problem");
  r.dataset = object.at("dataset");
  r.joint = object.at("joint");
  r.load = object.at("load");
  r.method = object.at("method");
  r.operators = object.at("operators");
  r.seed = object.at("seed");
  r.status = object.at("status");
  r.reason = object.at("reason");
  r.mae_train = number(object, "mae_train");
  r.mae_test = number(object, "mae_test");
  r.rmse_test = number(object, "rmse_test");
  r.max_error_test = number(object, "max_error_test");
  r.r2_test = number(object, "r2_test");
  r.mae_truth = number(object, "mae_truth");
  r.mae_ceiling = number(object, "mae_ceiling");
  r.mae_law = number(object, "mae_law");
  r.mae_refitted = number(object, "mae_refitted");
  r.mae_truth_refitted = number(object, "mae_truth_refitted");
  r.relative_error_train = number(object, "relative_error_train");
  r.relative_error_test = number(object, "relative_error_test");
  r.complexity = object.at("complexity");
  r.nodes = object.at("nodes");
  r.complexity_adaptation = object.at("complexity_adaptation");
  r.evaluations = object.at("evaluations");
  r.fit_cpu_s = number(object, "fit_cpu_s");
  r.fit_wall_s = number(object, "fit_wall_s");
  // Journals of older programs have none.
  if (object.contains("fit_instructions")) r.fit_instructions = number(object, "fit_instructions");
  r.peak_memory_mib = number(object, "peak_memory_mib");
  r.eval_ns_per_row = number(object, "eval_ns_per_row");
  r.singularity = object.at("singularity");
  r.witness = object.at("witness");
  r.grid_check = object.at("grid_check");
  r.dissipative = object.at("dissipative");
  r.monotone = object.at("monotone");
  r.odd = object.at("odd");
  r.formula = object.at("formula");
  r.note = object.at("note");
  if (object.contains("motion_error")) r.motion_error = number(object, "motion_error");
  return r;
}

// The cell's key is left out of fronts and traces on the wire: the record has it.
json front_json(const FrontRecord& f) {
  return {{"complexity", f.complexity},
          {"nodes", f.nodes},
          {"mae_train", number(f.mae_train)},
          {"mae_test", number(f.mae_test)},
          {"singularity", f.singularity},
          {"chosen", f.chosen},
          {"formula", f.formula}};
}

json trace_json(const TraceRecord& t) {
  return {
      {"evaluations", t.evaluations}, {"cpu_s", t.cpu_s}, {"train_error", number(t.train_error)}};
}

template <typename Parse>
auto parse_or_throw(std::string_view text, Parse parse) {
  std::string reason;
  const json message = read_json<json>(text, &reason);
  if (message.is_discarded()) {
    throw Error(ErrorKind::failed, fmt::format("a malformed message: {}", reason));
  }
  try {
    return parse(message);
  } catch (const json::exception& error) {
    throw Error(ErrorKind::failed, fmt::format("a malformed message: {}", error.what()));
  }
}

}  // namespace

CellTask make_task(const Grid& grid, const Cell& cell, const std::string& data) {
  const Method& method = grid.method(cell.method);
  CellTask task{
      cell,       method, grid.operator_set(cell.operators), grid.limits_of(method), 1, data,
      grid.prior, {}};
  if (const user::UserProblem* own = grid.own_problem(cell.problem)) task.own = *own;
  return task;
}

Record empty_record(const Cell& cell) {
  Record record;
  record.cell = cell.key();
  record.problem = cell.problem;
  record.method = cell.method;
  record.operators = cell.operators;
  record.seed = cell.seed;
  return record;
}

std::string print_task(const CellTask& task) {
  const std::string own = task.own ? user::print_user_problem(*task.own) : std::string();
  return dump({{"problem", task.cell.problem},
               {"seed", task.cell.seed},
               {"method", task.method.name},
               {"algorithm", task.method.algorithm},
               {"parameters", parameters_json(task.method.parameters)},
               {"command", task.method.command},
               {"operators", operators_json(task.operators)},
               {"limits", limits_json(task.limits)},
               {"threads", task.threads},
               {"data", task.data},
               {"own", own},
               {"max_degree", task.prior.max_degree}});
}

CellTask parse_task(std::string_view text) {
  return parse_or_throw(text, [](const json& object) {
    CellTask task;
    task.operators = parse_operators(object.at("operators"));
    task.cell = {object.at("problem"), object.at("method"), task.operators.name(),
                 object.at("seed")};
    task.method.name = object.at("method");
    task.method.algorithm = object.at("algorithm");
    task.method.parameters = parse_parameters(object.at("parameters"));
    task.method.command = object.at("command").get<std::vector<std::string>>();
    task.limits = parse_limits(object.at("limits"));
    task.threads = object.at("threads");
    task.data = object.at("data");
    const std::string own = object.at("own");
    for (user::UserProblem& one : user::parse_user_problems(own, "task", {})) {
      task.cell.data = one.hash();
      task.own = std::move(one);
    }
    task.prior.max_degree = object.at("max_degree").get<std::map<std::string, int>>();
    return task;
  });
}

std::string print_result(const CellResult& result) {
  json front = json::array();
  json trace = json::array();
  for (const FrontRecord& f : result.front) front.push_back(front_json(f));
  for (const TraceRecord& t : result.trace) trace.push_back(trace_json(t));
  return dump({{"record", record_json(result.record)}, {"front", front}, {"trace", trace}});
}

CellResult parse_result(std::string_view text) {
  return parse_or_throw(text, [](const json& object) {
    CellResult result;
    result.record = parse_record(object.at("record"));
    const std::string& cell = result.record.cell;
    for (const json& f : object.at("front")) {
      result.front.push_back({cell, f.at("complexity"), f.at("nodes"), number(f, "mae_train"),
                              number(f, "mae_test"), f.at("singularity"), f.at("chosen"),
                              f.at("formula")});
    }
    for (const json& t : object.at("trace")) {
      result.trace.push_back(
          {cell, t.at("evaluations"), number(t, "cpu_s"), number(t, "train_error")});
    }
    return result;
  });
}

}  // namespace tribench
