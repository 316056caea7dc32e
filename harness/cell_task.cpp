// SPDX-License-Identifier: MIT
#include "harness/cell_task.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "problems/user/user_problem_text.hpp"
#include "reports/record/record_json.hpp"

namespace tribench {
namespace {

using nlohmann::json;

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
    throw Error(ErrorKind::failed, fmt::format("a malformed message: {}", json_complaint(error)));
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
    for (const json& f : object.at("front")) result.front.push_back(parse_front(f, cell));
    for (const json& t : object.at("trace")) result.trace.push_back(parse_trace(t, cell));
    return result;
  });
}

}  // namespace tribench
