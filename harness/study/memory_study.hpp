// SPDX-License-Identifier: MIT
//
// What a memory is worth on recordings of one's own: friction models without and with a state, each
// fitted to all recordings of a file but one and judged on that one, in turn.
//
// Cost: one fit a method and recording; of 15 000 rows half a second for a state, some 0.05 s
// without.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "algorithms/registry.hpp"

namespace tribench {

struct MemoryStudyOptions {
  std::vector<std::filesystem::path> files;  // each is a joint by itself
  std::string target;
  std::vector<std::string> inputs;
  std::string roles;  // as --roles; a time and a velocity are among them
  std::string group;  // the column whose values are the recordings
  std::vector<std::string> without = {"symmetric", "bam_m2", "bam_m4", "bam_m5"};
  std::vector<std::string> with = {"dahl", "lugre", "maxwell_slip"};
  bool load = false;  // bristles press harder under load
  int threads = 0;
  bool quiet = false;
};

struct MemoryFigure {
  std::string file;
  std::string method;
  bool has_state = false;
  bool is_best_without = false;
  std::size_t recordings = 0;
  double rmse = 0;  // mean over the recordings held out, in the target's unit
  // Over the best method without a state, mean and half of its 95 % interval by recordings
  // (Student's t); NaN for methods without one. That best one is chosen by the same figures, to the
  // states' disadvantage.
  double gain = std::numeric_limits<double>::quiet_NaN();
  double half = std::numeric_limits<double>::quiet_NaN();
  std::string failed = {};  // why there is no figure

  // "gains", "loses", "not distinguishable"; empty without a state.
  std::string verdict() const;
};

// File by file, methods in the order given. Throws Error (bad_input): fewer than three recordings,
// unknown methods, what reading throws.
std::vector<MemoryFigure> run_memory_study(const MemoryStudyOptions& options,
                                           const Registry& registry);

}  // namespace tribench
