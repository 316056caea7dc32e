// SPDX-License-Identifier: MIT
//
// A suite: problems of symbolic regression that others use too, as data. Laws with the points they
// are drawn at, or tables with their splits; what counts as recovered; figures that others reached.
// suites/*.toml are such files, docs/suites.md describes them.
//
// Not for measured robots, which have manifests (problems/measured).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "problems/suite/published_results.hpp"

namespace tribench::suite {

// How one input is drawn.
struct Draw {
  enum class Kind {
    uniform,  // [low, high)
    log,      // 10^u, u uniform between log10(low) and log10(high); 0 < low
    whole,    // whole numbers, both ends included
    lattice,  // low, low + step, ... up to high: with other lattices every combination
  };
  enum class Sign { as_drawn, either, negative };  // either: turned with probability 1/2
  Kind kind = Kind::uniform;
  double low = 0;
  double high = 1;
  double step = 0;
  Sign sign = Sign::as_drawn;
  bool operator==(const Draw&) const = default;
};

// How many values a lattice has, a whole number; 1 for what is drawn.
double lattice_points(const Draw& draw);

struct SuiteInput {
  std::string name;  // as in the law
  std::string unit = "-";
  std::string meaning;  // "distance"
  Draw train;
  Draw test;
};

struct SuiteProblem {
  std::string name;  // within the suite
  std::string note;
  // A law over the inputs, in the project's formulas; of a table it may be unknown (empty).
  std::string law;
  std::string law_place;           // "mine.toml:9:7"
  std::vector<SuiteInput> inputs;  // of a law; a table's are its other columns
  std::string unit = "-";          // of the target
  std::size_t rows = 0;  // of drawn inputs, 1 at least; lattices have as many as they have
  std::size_t test_rows = 0;
  std::string file;  // of a table: its path in the folder of data; empty: the law is drawn
  std::string target = "target";
  std::string splits;  // which of its rows test, a file of dataset,seed,test_rows
};

// What others reached: the share of problems recovered, in a median time.
struct SuiteReference {
  std::string method;
  double seconds = 0;    // wall clock, theirs
  double recovered = 0;  // share
  double low = 0;
  double high = 0;
};

struct Suite {
  std::string name;
  std::string summary;
  std::string source;
  // Recovered: the fraction of variance left unexplained on unseen rows is at most this.
  double recovered_below = 1.1920928955078125e-07;
  double test_share = 0.25;  // of a table's rows where no file says which
  bool standardise = false;  // inputs and target, by mean and spread of the training rows
  std::vector<SuiteProblem> problems;
  std::vector<SuiteReference> references;
  std::string reference_note;  // how to read them
  PublishedTable published;
  std::vector<PublishedResult> results;  // those of `published`, where the folder of data is known
  std::uint64_t identity = 0;            // of the text it was read from

  // Throws Error (bad_input) with the nearest name.
  const SuiteProblem& find(std::string_view problem) const;
};

// [suite] and [[problem]] of a TOML text; other tables ([grid], [budget], ...) are left to whoever
// reads the run it asks for. Throws Error (bad_input) with file, line and the nearest key.
Suite read_suite(std::string_view toml, const std::string& file_name);
// The keys of [suite].
const std::vector<std::string>& suite_keys();

struct ShippedSuite {
  std::string_view name;
  std::string_view toml;
};
// Those that come with the program, held inside it.
const std::vector<ShippedSuite>& shipped_suites();

}  // namespace tribench::suite
