// SPDX-License-Identifier: MIT
#include "harness/benches.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "algorithms/expression/vector/level.hpp"
#include "foundation/child_process.hpp"
#include "foundation/elementary.hpp"
#include "foundation/error.hpp"
#include "foundation/json_text.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/scratch_folder.hpp"
#include "foundation/text.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kPath = "PATH=/usr/local/bin:/usr/bin:/bin";

std::vector<fs::path> programs_in(const fs::path& folder) {
  std::vector<fs::path> programs;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && ::access(entry.path().c_str(), X_OK) == 0) {
      programs.push_back(fs::absolute(entry.path()));
    }
  }
  if (programs.empty()) {
    throw_bad_input("there is no bench in this folder", folder.string(),
                    "name the folder that has the programs: build/release/bench");
  }
  std::ranges::sort(programs);
  return programs;
}

// The highest that valgrind can run.
std::string counted_level() {
  const auto& levels = available_vector_levels();
  const bool has_avx2 = std::ranges::count(levels, VectorLevel::avx2) > 0;
  return std::string(vector_level_name(has_avx2 ? VectorLevel::avx2 : VectorLevel::baseline));
}

// The simulated machine has these caches: valgrind would otherwise take those of the processor it
// runs on, and misses of two machines would be two different figures.
constexpr const char* kFirstLevel = "32768,8,64";
constexpr const char* kLastLevel = "8388608,16,64";

std::string valgrind_version() {
  try {
    const ChildRun run = run_child({.command = {"env", "-i", kPath, "valgrind", "--version"}});
    return run.exit.ok() ? std::string(trimmed(run.output)) : std::string();
  } catch (const Error&) {
    return {};
  }
}

// A bench run in a folder of its own, where its answer is "answer.json". It is called by the same
// name wherever it is installed: a program's name lies on its stack. Empty where it went well.
std::string run_program(std::vector<std::string> command, const fs::path& program,
                        const std::vector<std::string>& arguments, const fs::path& folder,
                        double patience_s) {
  const fs::path name = program.filename();
  fs::create_symlink(program, folder / name);
  command.push_back("./" + name.string());
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.insert(command.end(), {"--benchmark_out=answer.json", "--benchmark_out_format=json"});
  const ChildRun run =
      run_child({.command = command, .working_directory = folder}, {}, {patience_s, 64U << 20});
  if (run.timed_out) return fmt::format("took more than {:.0f} s", patience_s);
  if (run.exit.signal != 0) return fmt::format("ended by {}", signal_name(run.exit.signal));
  return run.exit.ok() ? std::string() : fmt::format("exit status {}", run.exit.status);
}

// The cases of an answer that ran: no aggregates, none that was skipped.
std::vector<json> cases_of(const fs::path& folder) {
  const json answer = read_json<json>(read_file_if_there(folder / "answer.json").value_or(""));
  std::vector<json> cases;
  if (!answer.is_object() || !answer.contains("benchmarks")) return cases;
  for (const json& each : answer.at("benchmarks")) {
    if (each.value("run_type", "") == "aggregate" || each.value("error_occurred", false)) continue;
    cases.push_back(each);
  }
  return cases;
}

// "events: Ir Dr ..." and "totals: 12 3 ..." of one of callgrind's dumps, by the events' names.
std::map<std::string, double> totals_of(const fs::path& dump) {
  std::vector<std::string> names;
  std::map<std::string, double> totals;
  for (const std::string& line : split(read_file_if_there(dump).value_or(""), '\n')) {
    if (line.starts_with("events: ")) names = split(line.substr(8), ' ');
    if (!line.starts_with("totals: ")) continue;
    const std::vector<std::string> figures = split(line.substr(8), ' ');
    for (std::size_t k = 0; k < std::min(names.size(), figures.size()); ++k) {
      double figure = 0;
      std::from_chars(figures[k].data(), figures[k].data() + figures[k].size(), figure);
      totals[names[k]] = figure;
    }
  }
  return totals;
}

using Benches = std::map<std::string, NightBench>;

NightBench& bench_of(Benches& benches, const fs::path& program, const json& each) {
  const std::string name =
      fmt::format("{} {}", program.filename().string(), each.value("run_name", ""));
  NightBench& bench = benches[name];
  bench.name = name;
  return bench;
}

std::string count(const fs::path& program, const BenchOptions& options, Benches& benches) {
  const ScratchFolder scratch;
  const std::string complaint = run_program(
      {"env", "-i", kPath, "TRIBENCH_VECTOR_LEVEL=" + counted_level(), "TRIBENCH_NIGHT=1",
       "LD_BIND_NOW=1", "valgrind", "--tool=callgrind", "--cache-sim=yes",
       fmt::format("--I1={}", kFirstLevel), fmt::format("--D1={}", kFirstLevel),
       fmt::format("--LL={}", kLastLevel), "--instr-atstart=no", "--callgrind-out-file=counted"},
      program, {"--benchmark_min_time=0"}, scratch.path(), options.patience_s);
  if (!complaint.empty()) return complaint;
  for (const json& each : cases_of(scratch.path())) {
    const int dump = static_cast<int>(each.value("counted", 0.0));
    if (dump <= 0) return "was built without valgrind's header";
    auto totals = totals_of(scratch.path() / fmt::format("counted.{}", dump));
    const double turns = std::max(1.0, each.value("iterations", 1.0));
    NightBench& bench = bench_of(benches, program, each);
    bench.instructions = totals["Ir"] / turns;
    bench.first_level_misses = (totals["I1mr"] + totals["D1mr"] + totals["D1mw"]) / turns;
    bench.last_level_misses = (totals["ILmr"] + totals["DLmr"] + totals["DLmw"]) / turns;
  }
  return {};
}

std::string time(const fs::path& program, const BenchOptions& options, Benches& benches) {
  const ScratchFolder scratch;
  const std::string complaint =
      run_program({"env", "-i", kPath, "TRIBENCH_NIGHT=1"}, program,
                  {fmt::format("--benchmark_repetitions={}", options.repetitions),
                   fmt::format("--benchmark_min_time={}", options.least_time_s)},
                  scratch.path(), options.patience_s);
  if (!complaint.empty()) return complaint;
  const std::map<std::string, double> micro = {{"ns", 1e-3}, {"us", 1}, {"ms", 1e3}, {"s", 1e6}};
  std::map<NightBench*, std::vector<double>> paired;
  for (const json& each : cases_of(scratch.path())) {
    const auto unit = micro.find(each.value("time_unit", ""));
    const double reference_us = each.value("reference_us", 0.0);
    const double cpu = each.value("cpu_time", 0.0);
    if (unit == micro.end() || !(reference_us > 0) || !(cpu > 0)) continue;
    paired[&bench_of(benches, program, each)].push_back(cpu * unit->second / reference_us);
  }
  for (auto& [bench, ratios] : paired) {
    bench->time = median(ratios);
    std::vector<double> logs;
    for (const double ratio : ratios) logs.push_back(elementary::log(ratio / bench->time));
    bench->time_spread = kMadToSd * upper_median_magnitude(logs);
  }
  return {};
}

}  // namespace

void require_benches(const fs::path& folder) { programs_in(folder); }

BenchRun run_benches(const BenchOptions& options, const std::atomic<bool>& stop) {
  BenchRun run;
  Benches benches;
  const std::string version = valgrind_version();
  run.conditions = version.empty() ? "not counted"
                                   : fmt::format("{}, {}, caches {} {}, heap settled, glibc {}",
                                                 version, counted_level(), kFirstLevel, kLastLevel,
                                                 gnu_get_libc_version());
  if (version.empty()) {
    run.complaints.emplace_back("valgrind is not installed: nothing was counted");
  }
  const auto complain = [&](const fs::path& program, const std::string& complaint) {
    if (complaint.empty()) return;
    run.complaints.push_back(fmt::format("{}: {}", program.filename().string(), complaint));
  };
  for (const fs::path& program : programs_in(options.folder)) {
    if (stop) break;
    if (!version.empty()) complain(program, count(program, options, benches));
    if (!stop) complain(program, time(program, options, benches));
  }
  for (auto& [name, bench] : benches) run.benches.push_back(std::move(bench));
  return run;
}

}  // namespace tribench
