// SPDX-License-Identifier: MIT
#include "harness/study/log_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/child_process.hpp"
#include "foundation/error.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/study/each_case.hpp"
#include "problems/joint_simulation/causes.hpp"
#include "problems/preparation/recording.hpp"

namespace tribench {
namespace {

constexpr int kCannotTell = 4;  // the loop's exit status for data that cannot tell
// How far a channel's size may be from the truth's (ramps and rests are left out): a wrong unit
// makes three times that at least.
constexpr double kSameSize = 2;

// What may be found in a joint that moves for minutes, with what its log tells.
constexpr std::array<std::string_view, 8> kRotary = {
    "stribeck_exponential", "viscous_power",        "load",
    "presliding_dahl",      "presliding_lugre",     "output_ripple_harmonics",
    "stribeck_forwards",    "gear_ripple_harmonics"};
constexpr std::array<std::string_view, 3> kLinear = {"stribeck_exponential", "viscous_power",
                                                     "presliding_dahl"};

LogStory story_in(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text);
  LogStory story;
  story.answer.unknown = json.at("verdict") == "UNKNOWN";
  for (const nlohmann::json& effect : json.at("effects")) {
    story.answer.effects.push_back({effect.at("family"), {}, effect.at("another_shape")});
    for (const nlohmann::json& alias : effect.at("alias")) {
      story.answer.effects.back().aliases.push_back(alias.at("family"));
    }
  }
  return story;
}

LogStory ask(const std::string& program, const LogCase& one, const std::string& text,
             const std::vector<std::string>& options) {
  const ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "log.csv";
  std::ofstream(file, std::ios::binary) << text;
  ChildOptions child;
  child.command = {program, "loop", file.string(), "--seed", std::to_string(one.seed), "--json"};
  child.command.insert(child.command.end(), options.begin(), options.end());
  child.environment = {"OMP_NUM_THREADS=1"};  // the logs share the cores
  const ChildRun run = run_child(child);
  if (run.exit.signal == 0 && (run.exit.status == 0 || run.exit.status == kCannotTell)) {
    return story_in(run.output);
  }
  LogStory refused;
  refused.refused = true;
  refused.complaint = run.exit.signal != 0 ? std::string(signal_name(run.exit.signal)) : run.errors;
  while (refused.complaint.ends_with('\n')) refused.complaint.pop_back();
  return refused;
}

double range_of(const Channel* channel) {
  if (channel == nullptr || channel->values.empty()) return 0;
  return quantile(channel->values, 0.999) - quantile(channel->values, 0.001);
}

std::string clean_text(const simulation::ControlledRun& run) {
  std::ostringstream text;
  write_csv(run.clean(), text);
  return text.str();
}

// Whether the cause that was found first is a planted one.
bool is_first(const LoopAnswer& answer, const std::vector<PlantedEffect>& planted) {
  if (answer.effects.empty()) return false;
  LoopAnswer first;
  first.effects = {answer.effects.front()};
  first.effects.front().aliases.clear();
  const Says says = judge_story(first, planted);
  return says == Says::exact || says == Says::another_shape || says == Says::partly;
}

LogOutcome judge(const simulation::ControlledRun& run, const LogCase& one, LogTold told,
                 LogStory story) {
  LogOutcome out;
  out.name = one.name;
  out.told = told;
  out.says = judge_story(story.answer, run.effects);
  out.first = is_first(story.answer, run.effects);
  out.story = std::move(story);
  return out;
}

std::vector<LogOutcome> tell_case(const std::string& program, const LogCase& one,
                                  const LogStudyOptions& options) {
  const simulation::ControlledRun run = simulation::run_under_control(one.plan, one.seed);
  std::vector<LogOutcome> outcomes;
  std::vector<std::string> gear;
  if (!one.plan.linear) gear = {"--gear-ratio", fmt::format("{}", simulation::kGearRatio)};
  std::string clean = clean_text(run);
  outcomes.push_back(judge(run, one, LogTold::cleanly, ask(program, one, clean, gear)));
  outcomes.back().text = std::move(clean);
  outcomes.back().options = gear;
  for (const LogTold told : {LogTold::told, LogTold::bare}) {
    if (!options.raw) break;
    ToldLog log =
        tell_log(run, told == LogTold::told ? LogKnowledge::told : LogKnowledge::bare,
                 RandomStream(key_of("log_study")).split(one.seed).split(log_told_name(told)),
                 options.encoder_bits);
    LogOutcome out = judge(run, one, told, ask(program, one, log.text, log.options));
    out.summary = log.summary;
    out.same = out.story.same_as(outcomes[0].story);
    if (!out.story.refused) out.misread = misread_channel(run, log);
    out.text = std::move(log.text);
    out.options = std::move(log.options);
    outcomes.push_back(std::move(out));
  }
  // Files are kept where somebody will want to look at them.
  const bool fine = std::ranges::all_of(
      outcomes, [](const LogOutcome& out) { return out.is_right() && out.misread.empty(); });
  for (LogOutcome& out : outcomes) {
    if (fine) out.text.clear();
  }
  return outcomes;
}

LogFigure figure_of(LogTold told, const std::vector<LogOutcome>& outcomes) {
  LogFigure figure;
  figure.told = told;
  for (const LogOutcome& out : outcomes) {
    if (out.told != told) continue;
    const bool null = out.name.starts_with("none");
    ++figure.logs;
    figure.read += out.story.refused ? 0 : 1;
    figure.right += out.is_right() ? 1 : 0;
    figure.first += out.first && !null ? 1 : 0;
    figure.same += out.same ? 1 : 0;
    figure.misread += out.misread.empty() ? 0 : 1;
    figure.wrong += out.is_confidently_wrong() ? 1 : 0;
    figure.nulls += null ? 1 : 0;
    figure.false_alarms += null && !out.story.refused && !out.is_right() ? 1 : 0;
  }
  return figure;
}

}  // namespace

std::string_view log_told_name(LogTold told) {
  constexpr std::array<std::string_view, 3> kNames = {"cleanly", "told", "bare"};
  return kNames[static_cast<std::size_t>(told)];
}

std::string LogStory::text() const {
  if (refused) return "refused: " + complaint;
  std::vector<std::string> words;
  for (const LoopAnswer::Effect& effect : answer.effects) words.push_back(effect.family);
  if (answer.unknown) words.emplace_back("UNKNOWN");
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, " + "));
}

bool LogStory::same_as(const LogStory& other) const {
  const auto families = [](const LogStory& story) {
    std::vector<std::string> names;
    for (const LoopAnswer::Effect& effect : story.answer.effects) names.push_back(effect.family);
    std::ranges::sort(names);
    return names;
  };
  return refused == other.refused && answer.unknown == other.answer.unknown &&
         families(*this) == families(other);
}

LogCase make_log_case(std::uint64_t seed, double scale, double seconds) {
  LogCase one;
  one.seed = seed;
  RandomStream random = RandomStream(key_of("log_study")).split(seed);
  one.plan.seconds = seconds;
  one.plan.scale = scale;
  constexpr std::array kRates = {250.0, 500.0, 1000.0};
  one.plan.rate_hz = kRates[random.below(kRates.size())];
  one.plan.linear = seed % 10 == 9;
  one.plan.gravity = random.chance(0.7);
  if (one.plan.linear) {
    one.plan.cause = kLinear[seed / 10 % kLinear.size()];
  } else if (seed % 10 != 0) {
    one.plan.cause = kRotary[seed % 10 - 1];
  }
  one.plan.gravity = one.plan.gravity || one.plan.cause == "load";
  one.name = fmt::format("{}{}/{}", one.plan.linear ? "linear_" : "",
                         one.plan.cause.empty() ? "none" : one.plan.cause, seed);
  return one;
}

std::string misread_channel(const simulation::ControlledRun& run, const ToldLog& log) {
  DataFile file = parse_csv(
      log.text, "log.csv",
      CsvOptions{log.known.roles, false, true, std::vector<std::string>{}, {}, log.known.drive});
  const Dataset read = prepare(std::move(file), log.known).data;
  const Dataset truth = run.clean();
  const Role effort =
      read.find(Role::motor_torque) != nullptr ? Role::motor_torque : Role::motor_current;
  // The clean table's friction is not what the motor gives.
  const double torque = range_of(run.data.find(Role::motor_torque));
  for (const Role role : {Role::time, Role::position, Role::velocity, effort}) {
    const double size = role == effort ? range_of(read.find(role)) * log.torque_scale / torque
                                       : range_of(read.find(role)) / range_of(truth.find(role));
    if (size > 1 / kSameSize && size < kSameSize) continue;
    return fmt::format("{} is read {:.3g} times as large as it is", role_name(role), size);
  }
  return {};
}

LogStudy run_log_study(const std::string& program, const LogStudyOptions& options) {
  std::vector<LogCase> cases;
  for (int i = 0; i < options.logs; ++i) {
    cases.push_back(make_log_case(options.first_seed + static_cast<std::uint64_t>(i), options.scale,
                                  options.seconds));
  }
  std::erase_if(cases, [&](const LogCase& one) { return !one.name.starts_with(options.only); });
  if (cases.empty()) {
    throw_bad_input(fmt::format("no log begins with '{}'", options.only), "--only",
                    "as in the lines printed: load, linear_viscous_power/19");
  }
  std::vector<std::vector<LogOutcome>> by_case(cases.size());
  const auto stopped = [&] { return options.stop != nullptr && *options.stop; };
  for_each_case(cases.size(), options.threads, options.quiet, [&](std::size_t i) {
    if (stopped()) return;
    std::vector<LogOutcome> outcomes = tell_case(program, cases[i], options);
    if (!stopped()) by_case[i] = std::move(outcomes);
  });
  LogStudy study;
  study.left_out = static_cast<std::size_t>(
      std::ranges::count_if(by_case, [](const auto& outcomes) { return outcomes.empty(); }));
  for (std::vector<LogOutcome>& outcomes : by_case) {
    std::ranges::move(outcomes, std::back_inserter(study.outcomes));
  }
  for (const LogTold told : kLogTellings) study.figures.push_back(figure_of(told, study.outcomes));
  return study;
}

}  // namespace tribench
