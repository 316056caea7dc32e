// SPDX-License-Identifier: MIT
//
// What is to be explained: data with units, a split by whole movements, an input box and, where it
// is known, the true law. A method sees the training tables of the stages and nothing else.
//
// A staged problem (the paper's adaptation) has two stages: a second formula, with its own inputs,
// is fitted to what the first leaves. The formula judged is the sum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/motion_case.hpp"

namespace tribench {

// As many as a formula can name (kMaxInputs of algorithms/expression).
inline constexpr std::size_t kMostInputs = 65'536;

struct Input {
  std::string name;
  std::string unit;
  Role role = Role::none;
  // The input box, which proofs and singularity checks range over.
  double low = 0;
  double high = 0;
  // An input named sgn_X is the sign of X: this is X's place among the inputs.
  std::optional<std::size_t> sign_of;
  // A prior, declared by a problem or a grid and the same for every method: the highest power of
  // this input in any product; 0: none is declared. What an input is called declares nothing.
  int max_degree = 0;
  // An input that is a state of others (algorithms/states): the law it obeys, over the names of the
  // inputs before it, as a formula's text declares it; empty: it was measured.
  std::string law = {};
};

// All that was recorded, whatever rows a table takes of it: what a friction with memory has seen
// before a row. Inputs alone, of training and test movements alike; never a target.
struct Trail {
  std::vector<double> time;                  // s
  std::vector<std::vector<double>> columns;  // column j belongs to inputs[j]
  std::vector<std::size_t> starts;           // first rows of stretches without a break in time
};

// Rows for fitting or judging; column j belongs to inputs[j] of the table's owner.
struct Table {
  std::vector<std::vector<double>> columns;
  std::vector<double> target;
  std::vector<int> movement;                // per row; equal numbers stand together
  std::vector<double> truth;                // noise-free target where the law is known, else empty
  std::shared_ptr<const Trail> trail = {};  // none where the problem has no time
  std::vector<std::size_t> trail_row = {};  // per row: its place in the trail

  std::size_t rows() const { return target.size(); }
};

struct Stage {
  std::string name;                 // "fit", "adapt"
  std::vector<std::size_t> inputs;  // places among the problem's inputs that this stage may use
  Table train;                      // columns of ALL the problem's inputs, in the problem's order
  // What lies behind the target, less what earlier stages explain, as a formula over the problem's
  // inputs (print form); empty where it is not one or not known.
  std::string law = {};
};

struct Problem {
  std::string name;     // "A/j2/no_load"
  std::string summary;  // one line
  std::string dataset;  // "A", "B", "emps", ...
  int joint = 0;        // 0 where it makes no sense
  bool load = false;
  std::string target;  // "tau_f"
  std::string target_unit;
  std::vector<Input> inputs;
  std::vector<Stage> stages;  // at least one
  Table test;
  // The test movements as a formula's motion is judged by; empty where the problem declares none.
  // Reads files where the data are measured. Throws Error where one is missing or has changed.
  std::function<MotionCase()> motion = {};

  // The laws of all stages together, in print form; empty where one of them is not known.
  std::string true_law() const;
  bool staged() const { return stages.size() > 1; }
  std::vector<std::string> input_names() const;
};

// A place in the catalogue: cheap to list, built on demand.
struct ProblemEntry {
  std::string name;
  std::string summary;
  // Same seed, same data, bit for bit. Measured problems ignore the seed's noise but use it for
  // the split. Throws Error where data are missing, naming where they were looked for.
  std::function<Problem(std::uint64_t seed)> make;
  // The recording behind the problem with every channel, training and test movements alike; empty
  // where there is nothing beyond the problem's own tables.
  std::function<Dataset(std::uint64_t seed)> data;
  // Where it comes from, for people: a page, a paper, a file; empty: this program makes it up.
  std::string source = {};
};

}  // namespace tribench
