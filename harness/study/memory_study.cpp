// SPDX-License-Identifier: MIT
#include "harness/study/memory_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include "algorithms/expression/operator_set.hpp"
#include "foundation/error.hpp"
#include "harness/catalogue.hpp"
#include "harness/run_cell.hpp"
#include "harness/study/each_case.hpp"
#include "problems/user/user_problem.hpp"

namespace tribench {
namespace {

constexpr std::size_t kFewestRecordings = 3;
constexpr double kSeconds = 600;  // of a fit: none of these methods comes near

// 97.5 % of Student's t: a table, then Cornish and Fisher's series.
double student(std::size_t freedom) {
  constexpr std::array kTable = {12.706, 4.303, 3.182, 2.776, 2.571,
                                 2.447,  2.365, 2.306, 2.262, 2.228};
  if (freedom <= kTable.size()) return kTable.at(freedom - 1);
  const auto n = static_cast<double>(freedom);
  return 1.95996 + 2.37227 / n + 2.82250 / (n * n) + 2.5559 / (n * n * n);
}

user::UserProblem problem_of(const MemoryStudyOptions& options, const std::filesystem::path& file,
                             const std::string& held_out) {
  user::UserProblem own;
  own.name = user::name_of_file(file);
  own.files = user::hashed({{file}});
  own.target = options.target;
  own.inputs = options.inputs;
  own.reading.roles = parse_roles(options.roles + "," + options.group + "=movement", "--roles");
  own.reading.names_tell = false;
  own.group = options.group;
  own.held_out.kind = user::HeldOut::Kind::values;
  own.held_out.column = options.group;
  own.held_out.values = {held_out};
  return own;
}

std::vector<std::string> recordings_of(const MemoryStudyOptions& options,
                                       const std::filesystem::path& file) {
  std::vector<std::string> all =
      user::read_user_rows(problem_of(options, file, {})).data.movement_names;
  if (all.size() < kFewestRecordings) {
    throw_bad_input(fmt::format("{} recordings in column '{}'", all.size(), options.group),
                    file.string(), "three at least tell how far their figures scatter");
  }
  return all;
}

struct Trial {
  std::size_t file = 0;
  std::size_t method = 0;
  std::string held_out;
  double rmse = 0;
  std::string failed;
};

struct Contestant {
  std::string name;
  bool has_state = false;
  std::unique_ptr<Regressor> method;
};

std::vector<Contestant> contestants(const MemoryStudyOptions& options, const Registry& registry) {
  std::vector<Contestant> all;
  for (const std::string& name : options.without) {
    all.push_back({name, false, registry.make(name)});
  }
  for (const std::string& name : options.with) {
    std::map<std::string, ParameterValue> given;
    if (options.load) given["load"] = true;
    all.push_back({name, true, registry.make(name, given)});
  }
  return all;
}

void run_trial(const MemoryStudyOptions& options, const Contestant& one, Trial& trial) {
  const user::UserProblem own = problem_of(options, options.files[trial.file], trial.held_out);
  const Problem problem = user::make_user_problem(own, law_reader(), 1);
  CellTask task;
  task.cell = {own.name, one.name, kFixedForm, 1, own.hash()};
  task.method.name = task.method.algorithm = one.name;
  task.operators = find_operator_set("full");
  task.limits.seconds = kSeconds;
  const Record record = fit_and_judge(problem, *one.method, task).record;
  trial.rmse = record.rmse_test;
  if (!is_ok(record)) trial.failed = reason_text(record.reason);
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void set_gain(MemoryFigure& figure, const std::vector<double>& own,
              const std::vector<double>& best) {
  std::vector<double> gains(own.size());
  std::ranges::transform(best, own, gains.begin(), std::minus<>());
  figure.gain = mean(gains);
  double spread = 0;
  for (const double one : gains) spread += (one - figure.gain) * (one - figure.gain);
  const auto n = static_cast<double>(gains.size());
  figure.half = student(gains.size() - 1) * std::sqrt(spread / (n - 1) / n);
}

// Figures of one file: errors[m] of each recording held out.
void add_figures(std::vector<MemoryFigure>& figures, std::size_t first,
                 const std::vector<std::vector<double>>& errors) {
  MemoryFigure* best = nullptr;
  for (std::size_t m = 0; m < errors.size(); ++m) {
    MemoryFigure& one = figures[first + m];
    one.rmse = mean(errors[m]);
    if (one.has_state || !one.failed.empty()) continue;
    if (best == nullptr || one.rmse < best->rmse) best = &one;
  }
  if (best == nullptr) return;
  best->is_best_without = true;
  const auto at = static_cast<std::size_t>(best - &figures[first]);
  for (std::size_t m = 0; m < errors.size(); ++m) {
    MemoryFigure& one = figures[first + m];
    if (one.has_state && one.failed.empty()) set_gain(one, errors[m], errors[at]);
  }
}

}  // namespace

std::string MemoryFigure::verdict() const {
  if (!has_state || !std::isfinite(gain)) return {};
  return gain > half ? "gains" : gain < -half ? "loses" : "not distinguishable";
}

std::vector<MemoryFigure> run_memory_study(const MemoryStudyOptions& options,
                                           const Registry& registry) {
  const std::vector<Contestant> methods = contestants(options, registry);
  std::vector<Trial> trials;
  std::vector<std::size_t> recordings;
  for (std::size_t f = 0; f < options.files.size(); ++f) {
    const std::vector<std::string> all = recordings_of(options, options.files[f]);
    recordings.push_back(all.size());
    for (std::size_t m = 0; m < methods.size(); ++m) {
      for (const std::string& one : all) trials.push_back({f, m, one, 0, {}});
    }
  }
  for_each_case(trials.size(), options.threads, options.quiet,
                [&](std::size_t i) { run_trial(options, methods[trials[i].method], trials[i]); });
  std::vector<MemoryFigure> figures;
  std::size_t next = 0;
  for (std::size_t f = 0; f < options.files.size(); ++f) {
    std::vector<std::vector<double>> errors(methods.size());
    const std::size_t first = figures.size();
    for (std::size_t m = 0; m < methods.size(); ++m) {
      figures.push_back({.file = options.files[f].stem().string(),
                         .method = methods[m].name,
                         .has_state = methods[m].has_state,
                         .recordings = recordings[f]});
      for (std::size_t k = 0; k < recordings[f]; ++k, ++next) {
        errors[m].push_back(trials[next].rmse);
        if (!trials[next].failed.empty()) figures.back().failed = trials[next].failed;
      }
    }
    add_figures(figures, first, errors);
  }
  return figures;
}

}  // namespace tribench
