// SPDX-License-Identifier: MIT
//
// Recordings as `tribench loop` is asked about them: files with options. Planted campaigns and
// lists of measured ones become the same thing here, so that a study asks about both alike.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/study/loop_cases.hpp"
#include "problems/reading/csv_cells.hpp"

namespace tribench {

struct RecordingFile {
  std::string name;  // "joint1.csv": of a file without a movement column the movement's name
  CsvCells cells;
};

// A campaign and how `tribench loop` is asked about it.
struct RecordingToTell {
  std::string name;  // "single/stribeck/1/301": names it everywhere
  std::vector<RecordingFile> files;
  std::vector<std::string> options;  // "--roles", "tau=motor_torque", "--unordered"
  std::uint64_t seed = 1;
  double torque_unit = 1;  // a torque of 1 of this telling in the unit of the first telling
};

// Planted campaigns: `count` of the study's cases whose key begins with `only` (empty: any), drawn
// with the seed among those that are not at the limit of what can be found (0.5 times the noise and
// more, or nothing planted). Throws Error (bad_input) where no key begins so.
std::vector<RecordingToTell> planted_recordings(LoopGenerator generator, int count,
                                                std::uint64_t first_seed, std::string_view only);

struct RecordingList {
  std::vector<RecordingToTell> recordings;
  std::vector<std::string> missing;  // names of those whose files are not there
};
// From TOML: [[recording]] with name, files (in `folder`) and options = ["--roles", ...]. `name` is
// what messages call the text. Throws Error (bad_input).
RecordingList read_recordings(std::string_view toml, const std::string& name,
                              const std::filesystem::path& folder);
// The measured sets of docs/loop_on_measured_data.md with the options named there.
std::string_view measured_recordings_toml();

// Writes the files to a folder and returns what asks the loop about them, program aside:
// {"loop", "DIR/a.csv", ..., "--seed", "1"}. Throws Error (failed) where a file cannot be written.
std::vector<std::string> write_recording(const RecordingToTell& recording,
                                         const std::filesystem::path& folder);

}  // namespace tribench
