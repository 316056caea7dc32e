// SPDX-License-Identifier: MIT
#include "harness/study/external_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "algorithms/diagnosis/diagnosis.hpp"
#include "algorithms/effects/effect_library.hpp"
#include "algorithms/loop_model/model_fit.hpp"
#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/suggestion.hpp"
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
  const json request = {{"protocol", kDiagnosisProtocol},
                        {"train", "train.csv"},
                        {"held_out", "held_out.csv"},
                        {"target", planted.data.find(Role::friction_torque)->name},
                        {"families", loop::builtin_effect_names()},
                        {"gear_ratio", one.gear_ratio},
                        {"seed", one.seed}};
  std::ofstream(folder / "request.json") << write_json(request, 1) << "\n";
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
  throw Error(ErrorKind::failed,
              fmt::format("the program ended with {}", told_of_end(run.exit, run.errors)));
}

[[noreturn]] void throw_no_answer(std::string_view why, std::string_view mend = {}) {
  throw Error(ErrorKind::failed, why, {}, mend);
}

// The last JSON object; all else is chatter. What cannot be read is chatter too, unless nothing
// else has a verdict.
json object_in(const std::string& text) {
  json found;
  std::size_t broken = text.size();
  for (std::size_t at = find_json_object(text, 0); at < text.size();
       at = find_json_object(text, at)) {
    const std::size_t begin = at;
    json object = read_json_at<json>(text, at);
    if (object.is_object()) {
      found = std::move(object);
    } else {
      broken = begin;
    }
  }
  if (broken < text.size() && !found.contains("verdict")) {
    std::string reason;
    read_json_at<json>(text, broken, &reason);
    throw_no_answer(fmt::format("the program's answer cannot be read: {}", reason),
                    "a prediction is a finite number");
  }
  if (!found.is_object()) throw_no_answer("the program printed no JSON object");
  return found;
}

std::string known_family(const json& name) {
  const auto family = name.get<std::string>();
  const std::vector<std::string> known = loop::builtin_effect_names();
  if (std::ranges::count(known, family) == 0) {
    throw_no_answer(fmt::format("there is no family '{}'", family), did_you_mean(family, known));
  }
  return family;
}

std::string verdict_in(const json& object) {
  const auto verdict = object.at("verdict").get<std::string>();
  std::vector<std::string> known;
  for (const loop::Verdict one : {loop::Verdict::none, loop::Verdict::effects,
                                  loop::Verdict::unknown, loop::Verdict::cannot_tell}) {
    known.emplace_back(loop::verdict_name(one));
  }
  if (std::ranges::count(known, verdict) == 0) {
    throw_no_answer(
        fmt::format("there is no verdict '{}', only {}", verdict, fmt::join(known, ", ")),
        did_you_mean(verdict, known, "print one of them"));
  }
  return verdict;
}

std::vector<LoopAnswer::Effect> effects_in(const json& object) {
  std::vector<LoopAnswer::Effect> effects;
  for (const json& effect : object.value("effects", json::array())) {
    effects.push_back({known_family(effect.at("family")), {}});
    const json bristles = effect.value("bristles", json::object());
    effects.back().stiffness = bristles.value("stiffness", 0.0);
    effects.back().stiffness_low = bristles.value("lo", 0.0);
    // Without an upper end it is null.
    const bool ends = bristles.contains("hi") && bristles["hi"].is_number();
    effects.back().stiffness_high =
        ends ? bristles["hi"].get<double>() : std::numeric_limits<double>::infinity();
    for (const json& alias : effect.value("alias", json::array())) {
      effects.back().aliases.push_back(known_family(alias.at("family")));
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
      throw_no_answer(fmt::format("there is no movement '{}'", name));
    }
    bursts.push_back(
        {static_cast<int>(found - movement_names.begin()), event.at("t0"), event.at("t1")});
  }
  return bursts;
}

LoopAnswer answer_in(const json& object, const AskedDiagnosis& asked) {
  LoopAnswer answer;
  const std::string verdict = verdict_in(object);
  answer.effects = effects_in(object);
  if (verdict == loop::verdict_name(loop::Verdict::cannot_tell)) answer.effects.clear();
  answer.bursts = bursts_in(object, asked.movement_names);
  answer.unknown = verdict == loop::verdict_name(loop::Verdict::unknown);
  if (object.contains("leftover")) {
    for (const json& input : object.at("leftover").value("inputs", json::array())) {
      answer.inputs.push_back(input.get<std::string>());
    }
  }
  const auto rows = static_cast<std::size_t>(std::ranges::count(asked.held_out, 1));
  const std::string mend = fmt::format(
      "\"held_out\": [...], a prediction for each of the {} rows of held_out.csv", rows);
  if (!object.contains("held_out")) throw_no_answer("the answer has no 'held_out'", mend);
  const json& predictions = object.at("held_out");
  if (predictions.size() != rows) {
    throw_no_answer(
        fmt::format("'held_out' has {} predictions for {} rows", predictions.size(), rows), mend);
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
    throw_no_answer(fmt::format("the program's answer is malformed: {}", json_complaint(error)));
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
