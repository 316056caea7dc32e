// SPDX-License-Identifier: MIT
//
// One night: a grid is run, a sample is run again and must come out the same, the run is compared
// with the base and with the nights since, and recorded. The store's folder
// (reports/night_store.hpp) holds the runs beside it, under runs/; one that was cut short goes on
// the next time.
//
// The base is the blessed night, and stays it until another one is blessed: a level that creeps is
// always measured from where it began. A missing or damaged base is refused, never replaced; the
// first night of an empty store is blessed by itself.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/grid.hpp"
#include "harness/run.hpp"
#include "reports/comparison.hpp"
#include "reports/night_tests.hpp"
#include "reports/run_folder.hpp"

namespace tribench {

struct NightlyOptions {
  std::filesystem::path store;
  RunOptions run;                  // without `out` and `resume`
  std::size_t sample = 10;         // cells that are run again
  std::size_t keep_runs = 14;      // folders of runs that stay, besides the base's
  std::size_t keep_nights = 4000;  // records that stay, besides blessed ones
  double least_free_mib = 1024;    // of the store's disk
  double tolerance = 0.05;         // as of `compare`
  std::filesystem::path benches;   // folder of bench programs (benches.hpp); empty: none
};

// What a nightly job spends in a year: one false alarm, two thirds of it on the comparison with the
// base, one on the tests over nights.
inline constexpr double kNightlyAlarmsAYear = 1;
inline constexpr double kComparisonShare = 2.0 / 3;
inline constexpr double kNightsAYear = 365.25;
ComparisonOptions nightly_comparison();
NightTestOptions nightly_tests();

enum class NightEnd { fine, regression, undecided, failed };

struct NightlyResult {
  NightEnd end = NightEnd::fine;
  std::string name;
  std::string summary;  // ten lines, for mail or chat
};

// Throws Error (bad_input) where another night holds the store or the base cannot be used,
// (environment) where the disk is nearly full; else as run_grid does.
NightlyResult run_night(const Grid& grid, const NightlyOptions& options,
                        const std::atomic<bool>& stop);

// When the run started and of which code: "2026-11-22T023000Z-abc1234".
std::string night_name(const RunFolder& run);

}  // namespace tribench
