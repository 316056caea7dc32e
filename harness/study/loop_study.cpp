// SPDX-License-Identifier: MIT
#include "harness/study/loop_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>

#include "foundation/error.hpp"
#include "harness/study/each_case.hpp"
#include "reports/csv.hpp"

namespace tribench {
namespace {

double thread_cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

LoopOutcome run_case(const LoopCase& one, const LoopMethod& method) {
  const PlantedData planted = one.make();
  const double start_s = thread_cpu_s();
  const LoopAnswer answer = method(one, planted);
  const double cpu_s = thread_cpu_s() - start_s;
  LoopOutcome out = judge_answer(one, answer, planted);
  out.cpu_s = cpu_s;
  if (one.group == "null") {
    out.naive = test_naively(loop::observe(planted.data), one.gear_ratio);
  }
  return out;
}

std::string header_row() {
  std::string row;
  append_csv_row(row, std::vector<std::string>(kOutcomeColumns.begin(), kOutcomeColumns.end()));
  return row;
}

// runs.csv: what is there already, and a line more for every run that ends.
class RunsFile {
 public:
  explicit RunsFile(const std::filesystem::path& folder) {
    if (folder.empty()) return;
    std::filesystem::create_directories(folder);
    file_ = folder / "runs.csv";
    read_back();
    write_afresh();
  }

  std::optional<LoopOutcome> done(const std::string& key) const {
    const auto found = done_.find(key);
    return found == done_.end() ? std::nullopt : std::optional(found->second);
  }

  // Safe from several threads.
  void append(const LoopOutcome& outcome) {
    if (file_.empty()) return;
    const std::lock_guard lock(mutex_);
    stream_ << outcome_row(outcome) << std::flush;
    if (!stream_) throw Error(ErrorKind::failed, "cannot write", file_.string());
  }

 private:
  void read_back() {
    std::ifstream in(file_);
    if (!in) return;
    const auto header = [&](const std::vector<std::string_view>& names) {
      if (std::ranges::equal(names, kOutcomeColumns)) return;
      throw_bad_input("this is no list of runs of this study", file_.string(),
                      "give --out a folder of its own");
    };
    read_csv(in, header, [&](const std::vector<std::string_view>& fields) {
      const LoopOutcome one = read_outcome(fields);
      done_[one.key] = one;
    });
  }

  // So that a torn last line is gone.
  void write_afresh() {
    stream_.open(file_, std::ios::trunc);
    stream_ << header_row();
    for (const auto& [key, outcome] : done_) stream_ << outcome_row(outcome);
    stream_ << std::flush;
    if (!stream_) throw Error(ErrorKind::failed, "cannot write", file_.string());
  }

  std::filesystem::path file_;
  std::ofstream stream_;
  std::map<std::string, LoopOutcome> done_;
  std::mutex mutex_;
};

}  // namespace

LoopStudy run_loop_study(const LoopStudyOptions& options, const LoopMethod& method) {
  const bool simulated = options.generator == LoopGenerator::simulated;
  std::vector<LoopCase> cases = (simulated ? make_simulated_cases : make_loop_cases)(
      options.null_runs, options.runs_per_cell, options.first_seed);
  std::erase_if(cases, [&](const LoopCase& one) { return !one.key().starts_with(options.only); });
  if (cases.empty()) {
    throw_bad_input(fmt::format("no case begins with '{}'", options.only), "--only",
                    "as in runs.csv: single/stribeck, null, pair");
  }
  RunsFile runs(options.out);
  LoopStudy study;
  study.outcomes.resize(cases.size());
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (std::optional<LoopOutcome> known = runs.done(cases[i].key())) {
      study.outcomes[i] = std::move(*known);
    } else {
      left.push_back(i);
    }
  }
  for_each_case(left.size(), options.threads, options.quiet, [&](std::size_t k) {
    LoopOutcome& outcome = study.outcomes[left[k]];
    outcome = run_case(cases[left[k]], method);
    runs.append(outcome);
  });
  study.figures = simulated ? simulated_figures(study.outcomes) : loop_figures(study.outcomes);
  if (simulated) study.answers = cause_answers(study.outcomes);
  return study;
}

}  // namespace tribench
