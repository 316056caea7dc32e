// SPDX-License-Identifier: MIT
//
// What a nightly job finds, and how often it cries without cause: nights are drawn from real runs.
//
// A grid is run with several streams of random numbers, each method under as many names: errors of
// the same code on the same data that differ only in what the search drew. That is how code differs
// that was changed without harm. A made night draws one of the streams for every method, problem
// and seed, each by itself; where a loss is planted the errors of one method on one problem are
// multiplied by it. What is asked is what `tribench nightly` asks: the comparison with the base and
// the tests over nights, at the levels that a night spends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/grid.hpp"
#include "reports/run_folder.hpp"

namespace tribench {

// The grid with every method under `streams` names, "pysr.1", "pysr.2", ...
Grid grid_of_streams(const Grid& grid, std::size_t streams);

struct StreamSeries {
  std::string problem;
  std::string method;
  std::string operators;
  std::map<std::uint64_t, std::vector<double>> log_errors;  // by seed, one a stream
  double spread = 0;  // between streams: median over seeds of the distance from a seed's median
};

// Throws Error (bad_input) where the run has no methods with streams. Failed cells are left out.
std::vector<StreamSeries> streams_of(const RunFolder& run);

struct NightStudyOptions {
  std::size_t pairs = 1000;     // of a base and a night, of identical code
  std::size_t sequences = 100;  // of nights of identical code
  std::size_t nights = 60;      // of a sequence
  std::size_t trials = 100;     // of each planted loss
  std::size_t before = 20;      // harmless nights between the base and a planted loss
  int threads = 0;
  bool quiet = false;
};

// Alarms: nights that cried. A comparison's and the tests' over nights are counted apart.
struct FalseAlarms {
  std::size_t asked = 0;
  std::size_t by_comparison = 0;
  std::size_t by_nights = 0;
  std::size_t undecided = 0;        // without an alarm
  std::size_t undecided_asked = 0;  // of so many
  double allowed_a_night = 0;
};

// How many of `trials` were found by the first, third, seventh night that has the loss, as a
// finding that names the method (and, where it names a problem, the problem).
struct Detection {
  std::string problem;  // empty: each trial another series that has any spread
  std::string method;
  double loss = 0;  // planted: 0.05 is 5 %; of a creep: each night's
  bool creep = false;
  std::size_t before = 0;
  std::size_t trials = 0;
  std::size_t found[3] = {};  // by night 1, 3, 7; of a creep by night 3, 5, 7
};

struct NightStudy {
  std::vector<StreamSeries> series;
  FalseAlarms pairs;
  FalseAlarms sequences;
  std::vector<Detection> detections;
};

NightStudy run_night_study(const RunFolder& run, const NightStudyOptions& options);

}  // namespace tribench
