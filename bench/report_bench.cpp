// SPDX-License-Identifier: MIT
//
// Rendering a made-up run of many cells (25 problems, 20 methods, three operator sets; three
// formulas of a front and four steps of a trace a cell, three pictures a method), and how soon its
// page can be used: milliseconds from the start of loading to the end of the page's own script, in
// headless chromium, where there is one. Targets for 300 000 cells: 10 s, 1 GiB, 3 s.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bench/measured_loop.hpp"
#include "foundation/output_file.hpp"
#include "foundation/random.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/run_reports.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

constexpr int kProblems = 25;
constexpr int kMethods = 20;
constexpr int kSets = 3;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Record made_up(int problem, int method, int set, std::uint64_t seed) {
  Record r;
  r.problem = fmt::format("made_up/{:02}", problem);
  r.method = fmt::format("method_{:02}", method);
  r.operators = fmt::format("set_{}", set);
  r.seed = seed;
  r.cell = fmt::format("{}|{}|{}|{}", r.problem, r.method, r.operators, seed);
  RandomStream random(key_of(r.cell));
  const double error = (1 + 0.1 * method) * (1 + 0.1 * random.uniform());
  if (random.uniform() < 0.01) {
    mark_failed(r, FailureKind::timeout);
    return r;
  }
  r.status = CellStatus::ok;
  r.mae_train = 0.9 * error;
  r.mae_test = error;
  r.rmse_test = 1.25 * error;
  r.max_error_test = 4 * error;
  r.r2_test = 0.99;
  r.complexity = 10 + method;
  r.nodes = 20 + method;
  r.evaluations = 1'000'000 + random.below(1000);
  r.fit_cpu_s = 1 + random.uniform();
  r.singularity = random.uniform() < 0.02 ? Singularity::refuted : Singularity::proved_free;
  if (r.singularity == Singularity::refuted) r.witness = R"({"qd":0.25,"g":3.5})";
  r.formula = fmt::format("{:.15g}*qd + {:.15g}*sgn_qd*exp(-0.78*qd^2) + 0.01*g/(qd - 0.25)",
                          random.uniform(3, 4), random.uniform(8, 9));
  return r;
}

void add_curves(const Record& r, std::vector<CurveRecord>& curves) {
  for (const char* picture : {"friction", "error", "profile"}) {
    for (int i = 0; i < 60; ++i) {
      const double x = -0.6 + 0.02 * i;
      curves.push_back({r.cell, r.problem, r.method, r.operators, picture, "model",
                        "velocity in rad/s", "torque in N m", x, 8 * x + r.mae_test});
    }
  }
}

fs::path made_up_run(std::uint64_t cells) {
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("tribench_report_bench_{}", cells);
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::vector<Record> records;
  std::vector<FrontRecord> front;
  std::vector<TraceRecord> trace;
  std::vector<CurveRecord> curves;
  const std::uint64_t series = kMethods * kSets;
  const std::uint64_t problems = std::min<std::uint64_t>(kProblems, cells / series);
  const std::uint64_t seeds = cells / (problems * series);
  for (int problem = 0; problem < static_cast<int>(problems); ++problem) {
    for (int method = 0; method < kMethods; ++method) {
      for (int set = 0; set < kSets; ++set) {
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
          Record r = made_up(problem, method, set, seed);
          if (is_ok(r)) {
            for (int i = 0; i < 3; ++i) {
              front.push_back({r.cell, 5 + 5 * i, 8 + 6 * i, 3.0 - i, (3.0 - i) * r.mae_test,
                               Singularity::proved_free, i == 2, r.formula});
            }
            for (int i = 1; i <= 4; ++i) {
              trace.push_back({r.cell, static_cast<std::uint64_t>(i) * 250'000, 0.25 * i,
                               (5.0 - i) * r.mae_train});
            }
            if (seed == 1) add_curves(r, curves);
          }
          records.push_back(std::move(r));
        }
      }
    }
  }
  write_file(folder / "results.csv", results_csv(std::move(records)));
  write_file(folder / "front.csv", front_csv(front));
  write_file(folder / "trace.csv", trace_csv(trace));
  write_file(folder / "curves.csv", curves_csv(curves));
  write_file(folder / "grid.toml", "[grid]\nname = \"made up\"\n");
  return folder;
}

// Milliseconds until the page's own script has run, least of three; 0 without a browser.
double milliseconds_to_use(const fs::path& page) {
  std::string text = text_of(page);
  text.insert(text.rfind("</body>"),
              "<script>document.body.innerHTML = '<pre>READY' + performance.now() + "
              "' ' + document.documentElement.dataset.ready + '</pre>';</script>");
  const fs::path asked = page.parent_path() / "asked.html";
  write_file(asked, text);
  const fs::path answer = page.parent_path() / "answer";
  double least = 0;
  for (int round = 0; round < 3; ++round) {
    const std::string command = fmt::format(
        "timeout 90 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage "
        "--user-data-dir={}/profile --window-size=1300,1000 --dump-dom file://{} >{} 2>/dev/null",
        page.parent_path().string(), asked.string(), answer.string());
    if (std::system(command.c_str()) != 0) return 0;
    const std::string dom = text_of(answer);
    const std::size_t at = dom.find("READY");
    if (at == std::string::npos || dom.find(" yes", at) == std::string::npos) return 0;
    const double ms = std::stod(dom.substr(at + 5));
    least = round == 0 ? ms : std::min(least, ms);
  }
  return least;
}

void BM_Report(benchmark::State& state) {
  if (state.range(0) > 1'000 && is_left_out_at_night(state)) return;
  const fs::path folder = made_up_run(static_cast<std::uint64_t>(state.range(0)));
  std::string head;
  for (auto _ : state) head = write_run_reports(folder);
  if (head.find("method_00") == std::string::npos || head.find("timeout") == std::string::npos) {
    state.SkipWithError("the leaderboard lacks its winner or its failures");
    return;
  }
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  // The made-up run itself is written from memory: its own peak counts too.
  state.counters["peak_MiB"] = static_cast<double>(use.ru_maxrss) / 1024;
  const fs::path page = folder / "report.html";
  state.counters["page_MB"] = static_cast<double>(fs::file_size(page)) / 1e6;
  state.counters["usable_after_ms"] = milliseconds_to_use(page);
  fs::remove_all(folder);
}

BENCHMARK(BM_Report)
    ->Arg(300)
    ->Arg(3'000)
    ->Arg(300'000)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace tribench
