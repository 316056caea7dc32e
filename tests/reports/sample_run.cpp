// SPDX-License-Identifier: MIT
#include "tests/reports/sample_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "foundation/output_file.hpp"
#include "foundation/random.hpp"
#include "reports/record/record_csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

struct SampleMethod {
  const char* name;
  const char* operators;
  double error;  // N m, median
  int complexity;
};

constexpr SampleMethod kMethods[] = {
    {"symmetric", "-", 0.12, 13},      {"pysr", "paper", 0.037, 15},
    {"pysr", "paper+div", 0.036, 17},  {"parfam", "paper", 0.0371, 22},
    {"parfam", "paper+div", 0.05, 24},
};

Record sample_record(const std::string& problem, const SampleMethod& method, std::uint64_t seed) {
  Record record;
  record.problem = problem;
  record.dataset = "A";
  record.joint = problem == "A/j2/no_load" ? 2 : 4;
  record.method = method.name;
  record.operators = method.operators;
  record.seed = seed;
  record.cell = problem + "|" + method.name + "|" + method.operators + "|" + std::to_string(seed);
  RandomStream noise(key_of(record.cell));
  const double error = method.error * (1 + 0.05 * noise.uniform(-1, 1));
  record.status = CellStatus::ok;
  record.mae_train = 0.95 * error;
  record.mae_test = error;
  record.rmse_test = 1.25 * error;
  record.max_error_test = 4 * error;
  record.r2_test = 1 - error * error / 40;
  record.mae_truth = 0.3 * error;
  record.complexity = method.complexity;
  record.nodes = method.complexity + 6;
  record.evaluations = 1'000'000 + noise.below(1000);
  record.fit_cpu_s = 0.5 + noise.uniform();
  record.fit_wall_s = record.fit_cpu_s + 0.01;
  record.peak_memory_mib = 12.5;
  record.eval_ns_per_row = 3.25;
  record.singularity = Singularity::proved_free;
  record.formula = "3.66*qd + 8.52*sgn_qd*exp(-0.78*qd^2)";
  return record;
}

void spoil(Record& record) {
  const bool division = record.operators == "paper+div";
  if (record.method == "pysr" && division && record.seed == 2) {
    record.singularity = Singularity::refuted;
    record.witness = R"({"qd": 0.25})";
    record.formula = "qd/(qd - 0.25) + 8.1*sgn_qd";
  }
  if (record.method == "parfam" && division && record.joint == 4) {
    const Record empty;
    mark_failed(record, FailureKind::timeout);
    if (record.seed != 1) mark_failed(record, FailureKind::crashed, "SIGSEGV");
    record.mae_train = record.mae_test = record.rmse_test = record.max_error_test = kMissing;
    record.r2_test = record.mae_truth = record.eval_ns_per_row = kMissing;
    record.complexity = record.nodes = 0;
    record.singularity.reset();
    record.formula.clear();
  }
}

}  // namespace

std::vector<Record> sample_records(std::uint64_t seeds) {
  std::vector<Record> records;
  for (const char* problem : {"A/j2/no_load", "A/j4/no_load"}) {
    for (const SampleMethod& method : kMethods) {
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        records.push_back(sample_record(problem, method, seed));
        spoil(records.back());
      }
    }
  }
  return records;
}

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = testing::scratch_folder() / ("tribench_reports_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

void write_sample_run(const fs::path& folder, std::uint64_t seeds) {
  const std::vector<Record> records = sample_records(seeds);
  std::vector<PlannedCell> planned;
  for (const Record& r : records) {
    planned.push_back({r.cell, r.problem, r.method, r.operators, r.seed});
  }
  planned.push_back({"A/j4/no_load|pysr|paper|99", "A/j4/no_load", "pysr", "paper", 99});
  write_file(folder / "results.csv", results_csv(records));
  write_file(folder / "planned.csv", planned_csv(planned));
  write_file(
      folder / "provenance.json",
      R"({"code": {"version": "0.1.0", "commit": "abc1234", "dirty": false, "compiler": "g++ 12.2"},
                 "sessions": [{"started": "2026-01-31T12:00:00Z", "machine": {"cpu": "some CPU"},
                               "calibration": {"samples": [{"cpu_s": 0.02}, {"cpu_s": 0.0201}]}}]})");
  write_file(folder / "grid.toml", "[grid]\nname = \"sample\"\n");
}

namespace {

std::vector<double> grid(double from, double to, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return values;
}

// Bins over x with values of f, its spread and a band.
template <class F>
LoopSeries bins(LoopSplit split, std::vector<double> x, F f) {
  LoopSeries series;
  series.split = split;
  series.x = std::move(x);
  for (const double at : series.x) {
    series.measured.push_back(f(at) + 0.02 * std::sin(40 * at));
    series.spread.push_back(0.05);
    series.before.push_back(0.9 * f(at));
    series.after.push_back(f(at));
    series.band.push_back(0.03);
    series.rows.push_back(40);
  }
  return series;
}

LoopPictures sample_pictures() {
  LoopPictures pictures;
  const auto friction = [](double v) { return (v > 0 ? 8 : -8) + 14 * v; };
  pictures.friction.x = {"velocity", "rad/s"};
  pictures.friction.series = {bins(LoopSplit::all, grid(-0.6, -0.02, 12), friction),
                              bins(LoopSplit::all, grid(0.02, 0.6, 12), friction)};
  const auto falling = [](double v) { return 1.2 * std::exp(-v / 0.05); };
  pictures.effects.push_back({"stribeck",
                              {"velocity", "rad/s", true},
                              true,
                              {bins(LoopSplit::all, grid(0.005, 0.3, 20), falling)},
                              {}});
  const auto wave = [](double q) { return 0.9 * std::sin(q / 0.0025 * 6.283); };
  pictures.effects.push_back(
      {"gear_ripple",
       {"position", "m", false, 0.0025},
       false,
       {bins(LoopSplit::forward, grid(0, 0.0025, 20), wave),
        bins(LoopSplit::backward, grid(0, 0.0025, 20), [&](double q) { return -wave(q); })},
       {}});
  const auto bump = [](double q) { return std::exp(-50 * (q - 0.5) * (q - 0.5)); };
  pictures.inputs.push_back({{"position", "rad"},
                             true,
                             {bins(LoopSplit::forward, grid(-1, 1, 30), bump),
                              bins(LoopSplit::backward, grid(-1, 1, 30), bump)}});
  pictures.inputs.push_back(
      {{"velocity", "rad/s"}, false, {bins(LoopSplit::forward, grid(0, 1, 30), [](double) {
         return 0.01;
       })}});
  LoopMapPicture map{{"position", "rad"}, {"temperature", "degC"}, {}};
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j)
      map.cells.push_back({0.1 * i, 0.1 * i + 0.1, 20.0 + j, 21.0 + j, 0.1 * (i - j), 30});
  }
  pictures.maps.push_back(map);
  LoopTrace trace;
  trace.movement = "up slow, third repeat, with payload";
  trace.why = "middle";
  trace.held_out = true;
  trace.x = grid(0, 4, 200);
  for (const double t : trace.x) {
    trace.before.push_back(8 + std::sin(t));
    trace.after.push_back(8.4 + std::sin(t));
    trace.measured.push_back(8.4 + std::sin(t) + 0.1 * std::sin(60 * t));
  }
  pictures.traces = {trace, trace};
  pictures.traces[1].why = "most";
  for (int m = 0; m < 30; ++m) {
    pictures.movements.push_back({std::to_string(m), m % 5 == 0, 0.8 + 0.01 * m, 0.24 + 0.003 * m});
  }
  pictures.aliases = {{"stribeck", "power_quadrant_gain", "payload"},
                      {{1, 0.1, 0.05}, {0.1, 1, 0.95}, {0.05, 0.95, 1}}};
  pictures.residuals.channels = {{"velocity", "rad/s", {0.1, 0.2}}};
  pictures.residuals.before = {0.5, 0.6};
  pictures.residuals.after = {0.1, 0.2};
  pictures.residuals.effect = {0.4, 0.4};
  pictures.residuals.effects = {{"stribeck", {0.4, 0.4}}};
  return pictures;
}

std::vector<LoopEffect> sample_effects() {
  LoopEffect stribeck;
  stribeck.family = "stribeck";
  stribeck.atom = "sgn_v*exp(-(abs(v)/vs)^delta)";
  stribeck.order = 1;
  stribeck.adjusted_p = 0.0005;
  stribeck.gain = 212.4;
  stribeck.gain_error = 20.1;
  stribeck.rms = 0.31;
  stribeck.chosen_share = 1;
  stribeck.parameters = {{"excess", 1.2, 1.1, 1.3}};
  LoopEffect gain;
  gain.family = "power_quadrant_gain";
  gain.atom = "g";
  gain.order = 2;
  gain.adjusted_p = 0.001;
  gain.gain = 80;
  gain.gain_error = 12;
  gain.rms = 0.9;
  gain.chosen_share = 0.7;
  gain.provisional = true;
  gain.parameters = {{"gain", 0.08, 0.07, 0.09}};
  gain.aliases = {{"payload", 0.95, 1, 2, false, ""}};
  gain.separate_by = {"R3"};
  return {stribeck, gain};
}

LoopError sample_error() {
  LoopError error;
  error.test_movements = 22;
  error.how = "held out";
  error.mae_before = 0.81;
  error.mae_after = 0.24;
  error.difference_low = 0.49;
  error.difference_high = 0.63;
  error.ceiling = 0.19;
  error.attainable = 0.2;
  error.closed_fraction = 0.91;
  error.closed_low = 0.85;
  error.closed_high = 0.95;
  error.closed_fraction_high = 0.93;
  return error;
}

}  // namespace

LoopRecord sample_loop() {
  LoopRecord loop;
  loop.title = "joint 2";
  loop.verdict = LoopVerdict::unknown;
  loop.target = "friction_torque_Nm";
  loop.unit = "N m";
  loop.alpha_library = 0.003;
  loop.alpha_leftover = 0.002;
  loop.flips = 1999;
  loop.seed = 1;
  loop.noise = {0.2, 0.05, 0.1, 5760, 108, 90, 4000};
  loop.friction_rms = 10;
  loop.effects = sample_effects();
  loop.leftover.p = 0.001;
  loop.leftover.inputs = {"position"};
  loop.unused_columns = {{"toolload", 0.31}};
  loop.untestable = {{"inertia", "no acceleration in the data", 0, 0, "R4"}};
  loop.bursts = {{17, "up slow", 1.2, 1.3, 4.1}};
  loop.error = sample_error();
  loop.shortest_wave = 0.005;
  loop.shortest_wave_unit = "rad";
  loop.candidates = {{"stribeck", "sgn_v*exp(-(abs(v)/vs)^delta)", 0.0005, 14.2, 212.4, 0.05},
                     {"temperature", "v*(T - T0)", 0.31, 2.2, kNoFigure, 0.1}};
  loop.base = "coulomb_viscous";
  loop.base_formula = "8*sgn_v + 14*v";
  loop.formula = "8.1*sgn_v + 14*v + 1.2*(sgn_v*exp(-abs(v)/0.05)) + 0.08*g";
  loop.terms = {{"", "8.1*sgn_v + 14*v"},
                {"stribeck", "1.2*sgn_v*exp(-20*abs(v))"},
                {"power_quadrant_gain", "0.08*g"}};
  loop.symbols = {
      {"v", "velocity_rad_s", "rad/s", "velocity", "", true, -0.6, 0.6},
      {"sgn_v", "velocity_rad_s", "-", "direction of motion (1, 0 or -1)", "", true, -1, 1},
      {"g", "gravity_Nm", "N m", "gravity torque", "", true, -20, 20}};
  loop.code = "double friction(double v, double g);\n";
  loop.notes = {"'stribeck' replaced by 'nonlinear_viscous' (R5, R7)"};
  loop.warnings = {"12 of 5772 rows are slower than 0.05: left out (--min-speed)"};
  loop.steps = {{"read from the file", 5772}, {"rows that count for friction", 5760}};
  loop.pictures = sample_pictures();
  loop.families = {{"stribeck", "Stribeck effect", "friction falls with speed near standstill"},
                   {"power_quadrant_gain", "loss that differs in back-driving",
                    "losses differ between driving and back-driving, in proportion to the load"},
                   {"payload", "payload error", "the declared gravity torque lacks a mass"},
                   {"gear_ripple", "gear ripple", "torque repeats with the motor's turn"},
                   {"nonlinear_viscous", "nonlinear viscous friction",
                    "viscous friction is not proportional to speed"},
                   {"temperature", "temperature", "friction changes with temperature"},
                   {"inertia", "inertia error", "the declared inertia is off"}};
  loop.experiments = {{"R3", "use two postures or a known payload"}, {"R4", "run reversals"}};
  return loop;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void expect_golden(const std::string& text, const std::string& name) {
  const fs::path file = testing::source_dir() / "tests/golden" / name;
  if (std::getenv("TRIBENCH_UPDATE_GOLDEN") != nullptr) write_file(file, text);
  EXPECT_EQ(text, text_of(file)) << "differs from " << file
                                 << "; if the change is meant, run the test with "
                                    "TRIBENCH_UPDATE_GOLDEN=1 and review the difference";
}

}  // namespace tribench
