// SPDX-License-Identifier: MIT
#include "harness/nightly.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "foundation/error.hpp"
#include "foundation/output_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/scratch_folder.hpp"
#include "harness/benches.hpp"
#include "harness/provenance.hpp"
#include "harness/verify.hpp"
#include "harness/whole_run.hpp"
#include "reports/bench_comparison.hpp"
#include "reports/comparison.hpp"
#include "reports/night_feed.hpp"
#include "reports/night_page.hpp"
#include "reports/night_store.hpp"
#include "reports/night_tests.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPending = "pending";   // a run that has not been recorded yet
const std::string kAbandoned = "abandoned-";  // one that could not be gone on with

// A time as names of files have it.
std::string file_time(std::string when) {
  std::erase(when, ':');
  return when;
}

// One night at a time; the kernel lets go of it however this process ends.
class StoreLock {
 public:
  explicit StoreLock(const fs::path& store) {
    const fs::path file = store / "lock";
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
      throw Error(ErrorKind::failed, std::strerror(errno), file.string());
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      ::close(descriptor_);
      throw_bad_input("another night is using this store", store.string(), "wait for it to end");
    }
  }
  ~StoreLock() { ::close(descriptor_); }
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

 private:
  int descriptor_ = -1;
};

void require_free_disk(const NightlyOptions& options) {
  const double free_mib =
      static_cast<double>(fs::space(options.store).available) / (1024.0 * 1024.0);
  if (free_mib >= options.least_free_mib) return;
  throw Error(ErrorKind::environment, fmt::format("{:.0f} MiB are free", free_mib),
              options.store.string(),
              fmt::format("make room for {:.0f} MiB (--least-free)", options.least_free_mib));
}

// Nights are ordered by when they began: one with a clock that was set back would stand before
// nights that it comes after, and be compared with none of them.
void require_running_clock(const NightStore& store) {
  const std::vector<std::string> names = store.names();
  const std::string now = file_time(utc_now());
  if (names.empty() || names.back().substr(0, now.size()) <= now) return;
  throw_bad_input(fmt::format("the clock says {}, which is before the newest night", now),
                  names.back(),
                  "set the clock; a night from a wrong clock can be taken out of nights/");
}

// The first night, recorded and perhaps blessed, but cut short before its run got its name.
bool is_unfinished_first(const NightStore& store) {
  const std::vector<std::string> names = store.names();
  const fs::path pending = store.runs() / kPending;
  return names.size() == 1 && fs::exists(pending / "provenance.json") &&
         night_name(read_run_folder(pending)) == names.front();
}

// Nights that begin within a second are told apart; one that was recorded and then cut short,
// before its run got its name, keeps its own.
std::string unused_name(const NightStore& store, const std::string& name) {
  std::string unused = name;
  for (int k = 2; fs::exists(store.runs() / unused); ++k) unused = fmt::format("{}.{}", name, k);
  return unused;
}

std::optional<Night> usable_base(const NightStore& store) {
  if (is_unfinished_first(store)) return std::nullopt;
  std::optional<Night> base = store.base();
  if (base && !fs::exists(store.runs() / base->name / "results.csv")) {
    throw_bad_input("the base's run is missing or was not finished",
                    (store.runs() / base->name).string(),
                    "bring it back from a copy, or bless another night: tribench history bless");
  }
  return base;
}

// A run cut short under other code, grid or data cannot be gone on with: it is put aside.
WholeRun run_pending(const Grid& grid, RunOptions options, const std::atomic<bool>& stop) {
  options.resume = true;
  try {
    return run_whole(grid, options, stop);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input || !fs::exists(options.out / "cells.jsonl")) throw;
    const RunIdentity now = identity_of(grid, options.data);
    if (read_journal(options.out / "cells.jsonl").identity.difference(now).empty()) throw;
  }
  const std::string aside = kAbandoned + file_time(utc_now());
  fs::rename(options.out, options.out.parent_path() / aside);
  return run_whole(grid, options, stop);
}

VerifyResult verify_sample(const Grid& grid, const WholeRun& run, const NightlyOptions& options,
                           const std::atomic<bool>& stop) {
  const ScratchFolder scratch;
  RunOptions again = options.run;
  again.out = scratch.path() / "run";
  again.resume = false;
  return verify_run(grid, run.journal, options.sample, again, stop);
}

// The nights after the base, the newest last, as many as are looked at. A damaged one tells
// nothing: read_history says which, and the others go on.
std::vector<Night> nights_since(const NightStore& store, const Night& base, const Night& now) {
  std::vector<Night> nights;
  const std::vector<std::string> names = store.names();
  for (auto name = names.rbegin(); name != names.rend() && nights.size() + 1 < kNightsLookedAt;
       ++name) {
    if (*name >= now.name) continue;
    if (*name <= base.name) break;
    try {
      nights.push_back(store.read(*name));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
    }
  }
  std::ranges::reverse(nights);
  nights.push_back(now);
  return nights;
}

void keep_last_runs(const NightStore& store, const std::string& base, std::size_t keep) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(store.runs())) {
    if (entry.is_directory() && entry.path().filename() != kPending)
      folders.push_back(entry.path());
  }
  // By time, whatever they are called: else what was put aside would count as the newest for ever.
  std::ranges::sort(folders, {}, [](const fs::path& folder) {
    const std::string name = folder.filename().string();
    return name.starts_with(kAbandoned) ? name.substr(kAbandoned.size()) : name;
  });
  for (std::size_t i = 0; i + keep < folders.size(); ++i) {
    if (folders[i].filename() != base) fs::remove_all(folders[i]);
  }
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// What one night came to.
struct Verdict {
  std::optional<Comparison> comparison;
  std::vector<NightFinding> losses;
  BenchComparison benches;
  std::vector<std::string> bench_complaints;
  VerifyResult verified;
  bool stopped = false;
  bool all_failed = false;

  NightEnd end() const {
    if (stopped || all_failed) return NightEnd::failed;
    if (!verified.different.empty() || !losses.empty() || !benches.worse.empty()) {
      return NightEnd::regression;
    }
    const ComparisonOutcome outcome = comparison ? comparison->outcome() : ComparisonOutcome::fine;
    if (outcome == ComparisonOutcome::regression) return NightEnd::regression;
    const bool is_open = outcome == ComparisonOutcome::undecided || !bench_complaints.empty() ||
                         !benches.gone.empty() || !benches.why_not_counted.empty();
    return is_open ? NightEnd::undecided : NightEnd::fine;
  }
};

const char* name_of(NightEnd end) {
  switch (end) {
    case NightEnd::fine:
      return "fine";
    case NightEnd::regression:
      return "REGRESSION";
    case NightEnd::undecided:
      return "UNDECIDED";
    default:
      return "FAILED";
  }
}

std::string bench_line(const Verdict& verdict) {
  std::string text = verdict.benches.sentence();
  for (const std::string& complaint : verdict.bench_complaints) {
    text += fmt::format("{}{}", text.empty() ? "benches: " : "; ", complaint);
  }
  return text.empty() ? text : text + "\n";
}

// Ten lines at most.
std::string summary_of(const Verdict& verdict, const Grid& grid, const WholeRun& run,
                       const Night& night, const std::optional<Night>& base,
                       const fs::path& folder) {
  std::string text = fmt::format("tribench {}: {}; night {}, code {}\n", grid.name,
                                 name_of(verdict.end()), night.name, night.code);
  text += fmt::format("{} of {} cells, {} failed, {:.0f} s\n", run.tally.done(), run.tally.cells,
                      run.tally.failed, run.tally.wall_s);
  text += fmt::format(
      "{} cells run again, {} differ{}\n", verdict.verified.compared,
      verdict.verified.different.size(),
      verdict.verified.different.empty() ? "" : ": " + verdict.verified.different.front());
  text += bench_line(verdict);
  if (!verdict.comparison) return text + "the first night: it is the base from now on\n";
  const Comparison& comparison = *verdict.comparison;
  text += fmt::format("base {}: {}\n", base->name, comparison.sentence());
  if (!comparison.conditions.empty()) {
    text += fmt::format("asked differently: {}{}\n", comparison.conditions.front(),
                        comparison.conditions.size() > 1
                            ? fmt::format(" and {} more", comparison.conditions.size() - 1)
                            : "");
  }
  const std::vector<std::string> doubts = comparison.doubts();
  if (!doubts.empty()) {
    text += fmt::format("not decided: {}{}\n", doubts.front(),
                        doubts.size() > 1 ? fmt::format(" and {} more", doubts.size() - 1) : "");
  }
  if (!verdict.losses.empty()) {
    text += fmt::format(
        "{}{}\n", first_line(losses_text(verdict.losses)),
        verdict.losses.size() > 1 ? fmt::format(" and {} more", verdict.losses.size() - 1) : "");
  }
  if (!comparison.visibility().empty()) text += comparison.visibility() + "\n";
  return text + fmt::format("{}\n", (folder / "report.html").string());
}

std::string damage_line(const std::vector<std::string>& damaged) {
  return fmt::format("left out: {}{}\n", damaged.front(),
                     damaged.size() > 1 ? fmt::format("; and {} more", damaged.size() - 1) : "");
}

}  // namespace

ComparisonOptions nightly_comparison() {
  // A comparison looks for losses in three ways (medians, cells at their limits, singular
  // formulas), each with a two-sided level of which half is worse.
  constexpr double kWays = 3;
  ComparisonOptions options;
  options.level = kComparisonShare * kNightlyAlarmsAYear / kNightsAYear / kWays * 2;
  return options;
}

NightTestOptions nightly_tests() {
  NightTestOptions options;
  options.alarms_a_year = (1 - kComparisonShare) * kNightlyAlarmsAYear;
  options.nights_a_year = kNightsAYear;
  return options;
}

std::string night_name(const RunFolder& run) {
  const std::string when = file_time(run.provenance_of("sessions.0.started"));
  if (when.empty()) {
    throw_bad_input("the run does not say when it started", (run.path / "provenance.json").string(),
                    "run 'tribench report' on the folder, or leave the run out");
  }
  return fmt::format("{}-{}", when, run.provenance_of("code.commit").substr(0, 12));
}

NightlyResult run_night(const Grid& grid, const NightlyOptions& options,
                        const std::atomic<bool>& stop) {
  NightStore store(options.store);
  make_output_folder(store.runs());
  const StoreLock lock(options.store);
  require_free_disk(options);
  if (!options.benches.empty()) require_benches(options.benches);
  require_running_clock(store);
  const std::optional<Night> base = usable_base(store);
  RunOptions running = options.run;
  running.out = store.runs() / kPending;
  const WholeRun run = run_pending(grid, running, stop);
  const RunFolder now = read_run_folder(running.out);
  Night night = night_of_run(now, unused_name(store, night_name(now)));
  const fs::path folder = store.runs() / night.name;
  Verdict verdict;
  verdict.stopped = run.tally.stopped;
  verdict.all_failed = run.all_failed();
  if (verdict.stopped) {  // the next night goes on with it
    return {verdict.end(), night.name,
            summary_of(verdict, grid, run, night, std::nullopt, running.out)};
  }
  verdict.verified = verify_sample(grid, run, options, stop);
  if (!options.benches.empty()) {
    BenchRun benches = run_benches({.folder = options.benches}, stop);
    night.benches = std::move(benches.benches);
    night.bench_conditions = std::move(benches.conditions);
    verdict.bench_complaints = std::move(benches.complaints);
  }
  if (base) {
    ComparisonOptions comparing = nightly_comparison();
    comparing.tolerance = options.tolerance;
    verdict.comparison = compare_runs(read_run_folder(store.runs() / base->name), now, comparing);
    verdict.benches = compare_benches(*base, night);
    const std::vector<Night> since = nights_since(store, *base, night);
    verdict.losses = find_losses(*base, since, nightly_tests());
    settle_by_nights(*verdict.comparison, *base, since);
  }
  night.outcome = name_of(verdict.end());
  std::string summary = summary_of(verdict, grid, run, night, base, folder);
  if (verdict.comparison) {
    write_file(running.out / "comparison.md", comparison_markdown(*verdict.comparison) + "\n" +
                                                  losses_text(verdict.losses) +
                                                  bench_table(verdict.benches));
  }
  write_file(running.out / "summary.txt", summary);
  // In this order: cut short anywhere, the next night finds a whole store and does the rest again.
  store.record(night);
  if (store.blessings().empty() && !verdict.all_failed)
    store.bless({night.name, "the first night", utc_now()});
  fs::rename(running.out, folder);
  const StoreHistory history = read_history(store);
  if (!history.damaged.empty()) {
    summary += damage_line(history.damaged);
    write_file(folder / "summary.txt", summary);
  }
  write_file(options.store / "nights.html", history_page(history));
  write_file(options.store / "nights.atom", history_feed(history));
  keep_last_runs(store, base ? base->name : night.name, options.keep_runs);
  store.prune(options.keep_nights, true);
  return {verdict.end(), night.name, summary};
}

}  // namespace tribench
