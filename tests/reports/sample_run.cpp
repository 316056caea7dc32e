// SPDX-License-Identifier: MIT
#include "tests/reports/sample_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "foundation/random.hpp"
#include "reports/record_csv.hpp"
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
  record.status = "ok";
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
  record.singularity = "proved_free";
  record.formula = "3.66*qd + 8.52*sgn_qd*exp(-0.78*qd^2)";
  return record;
}

void spoil(Record& record) {
  const bool division = record.operators == "paper+div";
  if (record.method == "pysr" && division && record.seed == 2) {
    record.singularity = "refuted";
    record.witness = R"({"qd": 0.25})";
    record.formula = "qd/(qd - 0.25) + 8.1*sgn_qd";
  }
  if (record.method == "parfam" && division && record.joint == 4) {
    const Record empty;
    record.status = "failed";
    record.reason = record.seed == 1 ? "timeout" : "crashed (SIGSEGV)";
    record.mae_train = record.mae_test = record.rmse_test = record.max_error_test = kMissing;
    record.r2_test = record.mae_truth = record.eval_ns_per_row = kMissing;
    record.complexity = record.nodes = 0;
    record.singularity.clear();
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
  const fs::path folder = fs::path(::testing::TempDir()) / ("tribench_reports_" + name);
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

nlohmann::json sample_loop() {
  using nlohmann::json;
  json loop = json::parse(R"json({
    "verdict": "UNKNOWN", "alpha": {"lib": 0.003, "gen": 0.002, "flips": 1999}, "seed": 1,
    "effects": [
      {"family": "stribeck", "atom": "s*exp(-|v|/0.05)", "order": 1, "p_adj": 0.0005,
       "cv_gain": 212.4, "cv_se": 20.1, "rms_contribution": 0.31, "vif": 1.2,
       "params": [{"name": "Fs - Fc", "value": 1.2, "lo": 1.1, "hi": 1.3}],
       "alias": [], "separate_by": []
},
      {"family": "power_quadrant_gain", "atom": "g", "order": 2, "p_adj": 0.001, "cv_gain": 80,
       "cv_se": 12, "rms_contribution": 0.9, "vif": 3.1, "provisional": true,
       "params": [{"name": "c1", "value": 0.08, "lo": 0.07, "hi": 0.09}],
       "alias": [{"family": "payload", "corr": 0.95, "gain_diff": 1, "se": 2, "exact": false}],
       "separate_by": ["R3"]}],
    "leftover": {"p": 0.001, "inputs": ["position"]},
    "untestable": [{"family": "inertia", "reason": "no acceleration in the data", "ask": "R4"}],
    "events": [{"movement": 17, "t0": 1.2, "t1": 1.3, "peak": 4.1}],
    "error": {"test_movements": 22, "mae_before": 0.81, "mae_after": 0.24,
              "ci_diff": [0.49, 0.63], "ceiling": 0.19, "attainable": 0.2, "closed_fraction": 0.91,
              "closed_fraction_ci": [0.85, 0.95], "closed_fraction_high": 0.93},
    "candidates": [{"family": "stribeck", "p_adj": 0.0005, "score": 14.2},
                   {"family": "temperature", "p_adj": 0.31, "score": 2.2}],
    "formula": "8.1*sgn_v + 14*v"
})json");
  json residual = {{"channel", "velocity"}, {"unit", "rad/s"}};
  RandomStream random(8);
  for (int i = 0; i < 200; ++i) {
    const double v = -0.6 + 1.2 * i / 199.0;
    const double effect = (v > 0 ? 1 : -1) * 1.2 * std::exp(-std::abs(v) / 0.05);
    const double after = 0.2 * random.normal();
    residual["x"].push_back(v);
    residual["before"].push_back(effect + after);
    residual["after"].push_back(after);
    residual["effect"].push_back(effect);
  }
  json movements = json::array();
  for (int m = 0; m < 30; ++m) {
    movements.push_back({{"name", std::to_string(m)},
                         {"test", m % 5 == 0},
                         {"mae_before", 0.8 + 0.1 * random.normal()},
                         {"mae_after", 0.24 + 0.03 * random.normal()}});
  }
  loop["pictures"] = {{"target", "friction torque"},
                      {"unit", "N m"},
                      {"base_formula", "8*sgn_v + 14*v"},
                      {"residuals", {residual}},
                      {"movements", movements},
                      {"alias_map",
                       {{"families", {"stribeck", "power_quadrant_gain", "payload"}},
                        {"correlation", {{1, 0.1, 0.05}, {0.1, 1, 0.95}, {0.05, 0.95, 1}}}}}};
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
