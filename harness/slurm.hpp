// SPDX-License-Identifier: MIT
//
// A grid on a cluster: a Slurm job array whose elements are shards, and a job that merges them.
// Nothing coordinates: an element is `tribench run --shard K/N --resume`, the merge is `tribench
// merge`. Submitting the same grid to the same folder again runs only what is missing.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>

#include "harness/grid.hpp"
#include "harness/plan.hpp"

namespace tribench {

struct SlurmOptions {
  std::filesystem::path out;
  std::filesystem::path program;     // the program that the elements run
  std::string data;                  // folder of the measured sets; may be empty
  std::size_t shards = 0;            // 0: as many as give elements of about five minutes
  int jobs = 1;                      // worker processes, and processors, an element
  std::string partition;             // empty: the cluster's default
  std::size_t largest_array = 1000;  // Slurm's MaxArraySize less one; sites raise it
};

struct SlurmPlan {
  std::size_t shards = 1;
  double predicted_element_s = 0;  // wall time of the longest element
  int minutes = 0;                 // the time limit asked for
  int memory_mib = 0;
  std::string array_script;
  std::string merge_script;
};

// Packs the cells by their predicted cost; an element takes 1 to 10 minutes where the grid and the
// limit on arrays allow it.
SlurmPlan plan_slurm(const Grid& grid, const SlurmOptions& options,
                     const MeasuredCosts& costs = {});

struct SlurmJobs {
  std::string array;
  std::string merge;
};

// Writes grid.toml and the scripts into the folder and submits them. Throws Error (bad_input)
// where sbatch is missing, (failed) with what sbatch says.
SlurmJobs submit_slurm(const Grid& grid, const SlurmPlan& plan, const SlurmOptions& options);

// Waits until both jobs have left the queue, telling how many elements are left, or that Slurm does
// not answer. False where `stop` was set first: the jobs go on.
bool follow_slurm(const SlurmJobs& jobs, const std::atomic<bool>& stop);

}  // namespace tribench
