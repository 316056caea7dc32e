// SPDX-License-Identifier: MIT
#include "harness/study/exploration_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <fstream>

#include "algorithms/exploration/fixed_plans.hpp"
#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "harness/study/each_case.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

double thread_cpu_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

ExplorationRun explore_world(const ExplorationStudyOptions& options, std::uint64_t seed,
                             const loop::NamedPlan& plan) {
  simulation::World world({seed, options.level, options.kind});
  loop::ExplorerOptions how;
  how.alpha = options.alpha;
  how.budget_s = options.budget_s;
  const loop::ExecuteMovement execute = [&](const PlannedMovement& movement) {
    return world.execute(movement, "the plan");
  };
  const double start_s = thread_cpu_seconds();
  const loop::Exploration done = loop::explore(world.limits(), execute, how, plan.make(seed));
  ExplorationRun run;
  run.cpu_s = thread_cpu_seconds() - start_s;
  run.seed = seed;
  run.kind = world_kind_name(world.truth().kind);
  std::vector<std::string> causes;
  for (const PlantedEffect& effect : world.truth().effects) causes.push_back(effect.family);
  run.causes = causes.empty() ? "none" : fmt::format("{}", fmt::join(causes, "+"));
  run.plan = plan.name;
  run.verdict = done.verdict;
  run.stopped_sure = done.end == loop::ExplorationEnd::sure;
  run.says = judge_verdict(done.families, done.unknown, world.truth());
  run.right = is_right(run.says);
  run.seconds = done.seconds;
  run.movements = done.steps.size();
  return run;
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
    const bool ended = run.stopped_sure && run.right;
    figure.sure_right += ended ? 1 : 0;
    figure.sure_wrong += run.stopped_sure && !run.right ? 1 : 0;
    seconds.push_back(ended ? run.seconds : budget_s);
    if (ended) movements.push_back(static_cast<double>(run.movements));
  }
  figure.median_seconds = median_of(std::move(seconds));
  figure.median_movements = median_of(std::move(movements));
  return figure;
}

void write_runs(const std::vector<ExplorationRun>& runs, const std::filesystem::path& folder) {
  if (folder.empty()) return;
  std::string text;
  append_csv_row(text, std::vector<std::string>{"seed", "kind", "causes", "plan", "verdict", "sure",
                                                "right", "says", "seconds", "movements", "cpu_s"});
  for (const ExplorationRun& run : runs) {
    append_csv_row(text, std::vector<std::string>{
                             fmt::format("{}", run.seed), run.kind, run.causes, run.plan,
                             run.verdict, run.stopped_sure ? "1" : "0", run.right ? "1" : "0",
                             std::string(says_name(run.says)), fmt::format("{:.2f}", run.seconds),
                             fmt::format("{}", run.movements), fmt::format("{:.2f}", run.cpu_s)});
  }
  write_file(folder / "explorations.csv", text);
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
  if (!options.out.empty()) make_output_folder(options.out);
  ExplorationStudy study;
  study.runs.resize(static_cast<std::size_t>(options.worlds) * plans.size());
  for_each_case(study.runs.size(), options.threads, options.quiet, [&](std::size_t k) {
    study.runs[k] =
        explore_world(options, options.first_seed + k / plans.size(), *plans[k % plans.size()]);
  });
  write_runs(study.runs, options.out);
  std::vector<std::string> groups = {"all", "none", "single", "pair", "unknown"};
  std::vector<std::string> causes;
  for (const ExplorationRun& run : study.runs) {
    if (run.kind == "single" && std::ranges::count(causes, run.causes) == 0) {
      causes.push_back(run.causes);
    }
  }
  std::ranges::sort(causes);
  groups.insert(groups.end(), causes.begin(), causes.end());
  for (const std::string& group : groups) {
    for (const loop::NamedPlan* plan : plans) {
      const ExplorationFigure figure = figure_of(study.runs, group, plan->name, options.budget_s);
      if (figure.worlds > 0) study.figures.push_back(figure);
    }
  }
  return study;
}

}  // namespace tribench
