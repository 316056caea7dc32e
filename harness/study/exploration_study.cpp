// SPDX-License-Identifier: MIT
#include "harness/study/exploration_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <string_view>

#include "algorithms/exploration/fixed_plans.hpp"
#include "foundation/error.hpp"
#include "harness/study/each_case.hpp"
#include "harness/study/runs_file.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

double thread_cpu_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string worlds_name(const ExplorationStudyOptions& options) {
  const std::string level(simulation::world_level_name(options.level));
  return options.kind ? fmt::format("{} {}", level, world_kind_name(*options.kind)) : level;
}

std::string key_of_run(const ExplorationRun& run) {
  return fmt::format("{}/{}/{}/{}/{}/{}", run.worlds, run.seed, run.plan, run.budget_s, run.alpha,
                     run.smallest_effect);
}

// "lag+stribeck", "load_coulomb+UNKNOWN", "NONE".
Says says_of(std::string_view verdict, const simulation::WorldTruth& truth) {
  std::vector<std::string> families;
  bool unknown = false;
  while (!verdict.empty()) {
    const std::size_t end = std::min(verdict.find('+'), verdict.size());
    const std::string_view name = verdict.substr(0, end);
    if (name == loop::kUnknownVerdict) {
      unknown = true;
    } else if (name != "NONE") {
      families.emplace_back(name);
    }
    verdict.remove_prefix(std::min(end + 1, verdict.size()));
  }
  return judge_verdict(families, unknown, truth);
}

void count_aliases(const loop::Exploration& done, const simulation::WorldTruth& truth,
                   ExplorationRun& run) {
  constexpr double kAlias = 0.05;
  constexpr double kToldApart = 0.01;
  const auto first = std::ranges::find_if(done.steps, &loop::ExplorationStep::looked);
  if (first == done.steps.end()) return;
  const auto right_weight = [&](const std::vector<loop::WeighedVerdict>& verdicts) {
    double most = 0;
    for (const loop::WeighedVerdict& one : verdicts) {
      if (is_right(says_of(one.verdict, truth))) most = std::max(most, one.weight);
    }
    return most;
  };
  const double right_first = right_weight(first->verdicts);
  if (right_first == 0) return;
  const double right_last = right_weight(done.steps.back().verdicts);
  for (const loop::WeighedVerdict& one : first->verdicts) {
    if (is_right(says_of(one.verdict, truth)) || one.weight < kAlias * right_first) continue;
    ++run.aliases;
    const auto& last = done.steps.back().verdicts;
    const auto now = std::ranges::find(last, one.verdict, &loop::WeighedVerdict::verdict);
    const double weight = now == last.end() ? 0 : now->weight;
    if (right_last == 0 || weight > kToldApart * right_last) ++run.aliases_left;
  }
}

ExplorationRun planned_run(const ExplorationStudyOptions& options, std::uint64_t seed,
                           const loop::NamedPlan& plan) {
  ExplorationRun run;
  run.worlds = worlds_name(options);
  run.seed = seed;
  run.budget_s = options.budget_s;
  run.alpha = options.alpha;
  run.smallest_effect =
      options.smallest_effect.value_or(simulation::smallest_effect(options.level));
  run.plan = plan.name;
  return run;
}

void explore_world(const ExplorationStudyOptions& options, ExplorationRun& run) {
  simulation::World world({run.seed, options.level, options.kind});
  loop::ExplorerOptions how;
  how.alpha = options.alpha;
  how.smallest_effect = run.smallest_effect;
  how.budget_s = options.budget_s;
  how.stop = options.stop;
  const loop::ExecuteMovement execute = [&](const PlannedMovement& movement) {
    return world.execute(movement, "the plan");
  };
  const double start_s = thread_cpu_seconds();
  const loop::Exploration done =
      loop::explore(world.limits(), execute, how, loop::find_plan(run.plan).make(run.seed));
  run.cpu_s = thread_cpu_seconds() - start_s;
  run.kind = world_kind_name(world.truth().kind);
  std::vector<std::string> causes;
  for (const PlantedEffect& effect : world.truth().effects) causes.push_back(effect.family);
  run.causes = causes.empty() ? "none" : fmt::format("{}", fmt::join(causes, "+"));
  run.verdict = done.verdict;
  run.weight = done.weight;
  run.end = loop::exploration_end_name(done.end);
  run.diagnosis = done.diagnosis;
  run.says = judge_verdict(done.families, done.unknown, world.truth());
  run.right = is_right(run.says);
  run.seconds = done.seconds;
  run.movements = done.steps.size();
  count_aliases(done, world.truth(), run);
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

ExplorationFigure figure_of(const std::vector<ExplorationRun>& runs, const std::string& group,
                            std::string_view plan, double budget_s) {
  ExplorationFigure figure{group, std::string(plan)};
  std::vector<double> seconds;
  std::vector<double> movements;
  for (const ExplorationRun& run : runs) {
    if (run.plan != plan) continue;
    if (group != "all" && run.kind != group && run.causes != group) continue;
    ++figure.worlds;
    const bool ended = run.stopped_sure() && run.right;
    figure.sure_right += ended ? 1 : 0;
    figure.sure_wrong += run.stopped_sure() && !run.right ? 1 : 0;
    figure.aliases += run.aliases;
    figure.aliases_left += run.aliases_left;
    seconds.push_back(ended ? run.seconds : budget_s);
    if (ended) movements.push_back(static_cast<double>(run.movements));
  }
  figure.median_seconds = median_of(std::move(seconds));
  figure.median_movements = median_of(std::move(movements));
  return figure;
}

std::string run_row(const ExplorationRun& run) {
  std::string text;
  append_csv_row(text, std::vector<std::string>{
                           run.worlds, fmt::format("{}", run.seed), csv_number(run.budget_s),
                           csv_number(run.alpha), csv_number(run.smallest_effect), run.kind,
                           run.causes, run.plan, run.verdict, fmt::format("{:.4f}", run.weight),
                           run.end, run.diagnosis, run.right ? "1" : "0",
                           std::string(says_name(run.says)), fmt::format("{:.2f}", run.seconds),
                           fmt::format("{}", run.movements), fmt::format("{:.2f}", run.cpu_s),
                           fmt::format("{}", run.aliases), fmt::format("{}", run.aliases_left)});
  return text;
}

double number_of(std::string_view text) { return number_in_field(text, "explorations.csv"); }

ExplorationRun read_run(std::span<const std::string_view> fields) {
  ExplorationRun run;
  run.worlds = fields[0];
  run.seed = static_cast<std::uint64_t>(number_of(fields[1]));
  run.budget_s = number_of(fields[2]);
  run.alpha = number_of(fields[3]);
  run.smallest_effect = number_of(fields[4]);
  run.kind = fields[5];
  run.causes = fields[6];
  run.plan = fields[7];
  run.verdict = fields[8];
  run.weight = number_of(fields[9]);
  run.end = fields[10];
  run.diagnosis = fields[11];
  run.right = fields[12] == "1";
  run.says = find_says(fields[13]);
  run.seconds = number_of(fields[14]);
  run.movements = static_cast<std::size_t>(number_of(fields[15]));
  run.cpu_s = number_of(fields[16]);
  run.aliases = static_cast<std::size_t>(number_of(fields[17]));
  run.aliases_left = static_cast<std::size_t>(number_of(fields[18]));
  return run;
}

RunFormat<ExplorationRun> run_format() {
  return {{"worlds", "seed", "budget_s", "alpha", "smallest_effect", "kind", "causes", "plan",
           "verdict", "weight", "end", "diagnosis", "right", "says", "seconds", "movements",
           "cpu_s", "aliases", "aliases_left"},
          run_row,
          read_run,
          key_of_run};
}

std::vector<ExplorationFigure> figures_of(const std::vector<ExplorationRun>& runs,
                                          const std::vector<const loop::NamedPlan*>& plans,
                                          double budget_s) {
  std::vector<std::string> groups = {"all", "none", "single", "pair", "unknown"};
  std::vector<std::string> causes;
  for (const ExplorationRun& run : runs) {
    if (run.kind == "single" && std::ranges::count(causes, run.causes) == 0) {
      causes.push_back(run.causes);
    }
  }
  std::ranges::sort(causes);
  groups.insert(groups.end(), causes.begin(), causes.end());
  std::vector<ExplorationFigure> figures;
  for (const std::string& group : groups) {
    for (const loop::NamedPlan* plan : plans) {
      const ExplorationFigure figure = figure_of(runs, group, plan->name, budget_s);
      if (figure.worlds > 0) figures.push_back(figure);
    }
  }
  return figures;
}

}  // namespace

Says judge_verdict(const std::vector<std::string>& families, bool unknown,
                   const simulation::WorldTruth& truth) {
  LoopAnswer answer;
  for (const std::string& family : families) answer.effects.push_back({family, {}, false});
  answer.unknown = unknown;
  return judge_story(answer, truth.effects);
}

bool is_right(Says says) { return says == Says::exact || says == Says::another_shape; }

ExplorationStudy run_exploration_study(const ExplorationStudyOptions& options) {
  std::vector<const loop::NamedPlan*> plans;
  for (const std::string& name : options.plans) plans.push_back(&loop::find_plan(name));
  if (plans.empty()) {
    for (const loop::NamedPlan& plan : loop::movement_plans()) plans.push_back(&plan);
  }
  const std::filesystem::path file =
      options.out.empty() ? options.out : options.out / "explorations.csv";
  RunsFile<ExplorationRun> written(file, run_format());
  std::vector<ExplorationRun> runs;
  std::vector<std::size_t> left;
  for (int w = 0; w < options.worlds; ++w) {
    for (const loop::NamedPlan* plan : plans) {
      ExplorationRun run =
          planned_run(options, options.first_seed + static_cast<std::uint64_t>(w), *plan);
      if (std::optional<ExplorationRun> known = written.done(key_of_run(run))) {
        run = std::move(*known);
      } else {
        left.push_back(runs.size());
      }
      runs.push_back(std::move(run));
    }
  }
  const auto stopped = [&] { return options.stop != nullptr && *options.stop; };
  for_each_case(left.size(), options.threads, options.quiet, [&](std::size_t k) {
    if (stopped()) return;
    ExplorationRun run = runs[left[k]];
    explore_world(options, run);
    if (stopped()) return;
    written.append(run);
    runs[left[k]] = std::move(run);
  });
  ExplorationStudy study;
  study.left_out = std::erase_if(runs, [](const ExplorationRun& run) { return run.end.empty(); });
  study.runs = std::move(runs);
  study.figures = figures_of(study.runs, plans, options.budget_s);
  return study;
}

}  // namespace tribench
