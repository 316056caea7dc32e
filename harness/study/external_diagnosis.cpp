// SPDX-License-Identifier: MIT
#include "harness/study/external_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "algorithms/loop_model/model_fit.hpp"
#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/loop/judged_diagnosis.hpp"
#include "problems/preparation/test_movements.hpp"
#include "problems/reading/csv.hpp"

namespace tribench {
namespace {

using nlohmann::json;

constexpr int kDiagnosisProtocol = 1;
constexpr std::size_t kMaxOutputBytes = 1U << 24;  // a program that prints without end is stopped

// The rows with keep[row] != 0; without the target where it is to be predicted.
Dataset part_of(const Dataset& data, const std::vector<char>& keep, bool with_target) {
  Dataset part;
  part.name = data.name;
  part.movement_names = data.movement_names;
  for (const Channel& channel : data.channels) {
    if (!with_target && channel.role == Role::friction_torque) continue;
    Channel kept{channel.name, channel.unit, channel.role, {}};
    for (std::size_t i = 0; i < data.rows(); ++i) {
      if (keep[i] != 0) kept.values.push_back(channel.values[i]);
    }
    part.channels.push_back(std::move(kept));
  }
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (keep[i] != 0) part.movement.push_back(data.movement[i]);
  }
  return part;
}

// Per row 1 for the movements that the loop itself holds out.
std::vector<char> held_out_rows(const loop::Observations& data) {
  const std::vector<int> test =
      loop::choose_test_movements(data, loop::JudgingOptions().test_share);
  std::vector<char> held_out(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i) {
    held_out[i] = std::ranges::binary_search(test, data.movement[i]) ? 1 : 0;
  }
  return held_out;
}

// Coulomb and viscous friction by direction, by plain least squares on the training rows.
Eigen::VectorXd base_prediction(const loop::Observations& data, const std::vector<char>& train) {
  const loop::Observations rows = data.select(train);
  loop::LoopModel model;
  model.base = loop::coulomb_viscous_base(data);
  model.coefficients.setZero(static_cast<Eigen::Index>(model.base.linear_terms.size()));
  const loop::Clusters clusters = loop::make_clusters(rows.movement, 1);
  loop::Noise plain;
  plain.within_sd = 1;
  loop::fit_model(model, rows, clusters, plain, loop::FitScope::linear);
  return loop::predict(model, data);
}

void write_request(const std::filesystem::path& folder, const LoopCase& one,
                   const PlantedData& planted, const std::vector<char>& held_out,
                   const std::vector<char>& train) {
  write_csv(part_of(planted.data, train, true), folder / "train.csv");
  write_csv(part_of(planted.data, held_out, false), folder / "held_out.csv");
  json families = json::array();
  for (const loop::EffectFamily& family : loop::builtin_effects()) families.push_back(family.name);
  const json request = {{"protocol", kDiagnosisProtocol},
                        {"train", "train.csv"},
                        {"held_out", "held_out.csv"},
                        {"target", planted.data.find(Role::friction_torque)->name},
                        {"families", families},
                        {"gear_ratio", one.gear_ratio},
                        {"seed", one.seed}};
  std::ofstream(folder / "request.json") << request.dump(1) << "\n";
}

// What the program printed; throws where it failed or took too long.
std::string output_of(const std::vector<std::string>& command, const std::filesystem::path& folder,
                      double limit_s) {
  ChildOptions options;
  options.command = command;
  options.command.push_back((folder / "request.json").string());
  options.scratch = folder;
  options.environment.push_back("TMPDIR=" + folder.string());
  for (const char* name : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"}) {
    options.environment.push_back(fmt::format("{}=1", name));
  }
  const ChildRun run = run_child(options, {}, {limit_s, kMaxOutputBytes});
  if (run.timed_out) {
    throw Error(ErrorKind::failed, fmt::format("the program took longer than {} s", limit_s));
  }
  if (run.exit.ok()) return run.output;
  const ChildExit& exit = run.exit;
  const std::string& errors = run.errors;
  const std::string how =
      exit.signal != 0 ? signal_name(exit.signal) : fmt::format("status {}", exit.status);
  throw Error(
      ErrorKind::failed,
      fmt::format("the program ended with {}: {}", how,
                  errors.substr(errors.size() - std::min<std::size_t>(errors.size(), 400))));
}

// The last line that is a JSON object; the others are chatter.
json object_in(const std::string& text) {
  json found;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const json line = read_json<json>(std::string_view(text).substr(begin, end - begin));
    if (line.is_object()) found = line;
    begin = end + 1;
  }
  if (!found.is_object()) throw Error(ErrorKind::failed, "the program printed no JSON object");
  return found;
}

std::vector<LoopAnswer::Effect> effects_in(const json& object) {
  std::vector<LoopAnswer::Effect> effects;
  for (const json& effect : object.value("effects", json::array())) {
    effects.push_back({effect.at("family").get<std::string>(), {}});
    const json bristles = effect.value("bristles", json::object());
    effects.back().stiffness = bristles.value("stiffness", 0.0);
    effects.back().stiffness_low = bristles.value("lo", 0.0);
    // Without an upper end it is null.
    const bool ends = bristles.contains("hi") && bristles["hi"].is_number();
    effects.back().stiffness_high =
        ends ? bristles["hi"].get<double>() : std::numeric_limits<double>::infinity();
    for (const json& alias : effect.value("alias", json::array())) {
      effects.back().aliases.push_back(alias.at("family").get<std::string>());
    }
  }
  return effects;
}

std::vector<LoopAnswer::Burst> bursts_in(const json& object,
                                         const std::vector<std::string>& movement_names) {
  std::vector<LoopAnswer::Burst> bursts;
  for (const json& event : object.value("events", json::array())) {
    const auto name = event.at("movement_name").get<std::string>();
    const auto found = std::ranges::find(movement_names, name);
    if (found == movement_names.end()) {
      throw Error(ErrorKind::failed, fmt::format("there is no movement '{}'", name));
    }
    bursts.push_back(
        {static_cast<int>(found - movement_names.begin()), event.at("t0"), event.at("t1")});
  }
  return bursts;
}

LoopAnswer answer_in(const json& object, const AskedDiagnosis& asked) {
  LoopAnswer answer;
  if (object.at("verdict") != "CANNOT_TELL") answer.effects = effects_in(object);
  answer.bursts = bursts_in(object, asked.movement_names);
  answer.unknown = object.at("verdict") == "UNKNOWN";
  if (object.contains("leftover")) {
    for (const json& input : object.at("leftover").value("inputs", json::array())) {
      answer.inputs.push_back(input.get<std::string>());
    }
  }
  const auto rows = static_cast<std::size_t>(std::ranges::count(asked.held_out, 1));
  const json& predictions = object.at("held_out");
  if (predictions.size() != rows) {
    throw Error(ErrorKind::failed,
                fmt::format("'held_out' has {} predictions for {} rows", predictions.size(), rows));
  }
  answer.before.assign(asked.held_out.size(), std::numeric_limits<double>::quiet_NaN());
  answer.after = answer.before;
  for (std::size_t i = 0, next = 0; i < asked.held_out.size(); ++i) {
    if (asked.held_out[i] == 0) continue;
    answer.before[i] = asked.before[i];
    answer.after[i] = predictions[next++].get<double>();
  }
  return answer;
}

}  // namespace

LoopAnswer read_diagnosis(const std::string& output, const AskedDiagnosis& asked) {
  try {
    return answer_in(object_in(output), asked);
  } catch (const json::exception& error) {
    throw Error(ErrorKind::failed,
                fmt::format("the program's answer is malformed: {}", error.what()));
  }
}

LoopMethod make_external_diagnosis(std::vector<std::string> command, double limit_s) {
  return [command = std::move(command), limit_s](const LoopCase& one, const PlantedData& planted) {
    const loop::Observations data = loop::observe(planted.data);
    const std::vector<char> held_out = held_out_rows(data);
    std::vector<char> train(held_out.size());
    std::ranges::transform(held_out, train.begin(), [](char row) { return row == 0 ? 1 : 0; });
    const ScratchFolder scratch;
    write_request(scratch.path(), one, planted, held_out, train);
    const Eigen::VectorXd before = base_prediction(data, train);
    try {
      return read_diagnosis(
          output_of(command, scratch.path(), limit_s),
          {planted.data.movement_names, held_out, {before.begin(), before.end()}});
    } catch (const Error& error) {
      throw Error(ErrorKind::failed, error.what(), one.key());
    }
  };
}

}  // namespace tribench
