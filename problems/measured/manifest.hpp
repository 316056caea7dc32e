// SPDX-License-Identifier: MIT
//
// What is known about a measured set: where it comes from, under which licence, what its files
// must hash to, what its columns are, and the problems made of it. One TOML file a set, embedded
// in the program, or beside the data of whoever has a set of their own; the data themselves are
// never part of the program.
//
// A table [[problem]] may have `joints = [1, 2, ...]`: it then stands for one problem a joint,
// {joint} in its texts replaced by the number.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/motion_case.hpp"

namespace tribench::measured {

struct File {
  std::string name;
  std::string sha256;  // lower-case hexadecimal
  std::size_t rows = 0;
};

struct ColumnMeaning {
  Role role = Role::none;
  std::optional<std::string> unit;  // where the column's name has none or another
};

// A channel computed from others, row by row, before anything is averaged or decimated.
struct DerivedChannel {
  enum class Kind { sign, difference, scaled };
  std::string name;
  Kind kind = Kind::sign;
  std::vector<std::string> of;  // one channel; two for a difference (the first minus the second)
  double factor = 1;            // of a scaled channel
  Role role = Role::none;
  std::string unit = "-";
};

// How a file is cut into movements.
struct MovementRule {
  enum class Kind {
    whole,      // the file is one
    column,     // one a run of equal values of a column
    reversals,  // one a run of equal sign of the velocity
  };
  Kind kind = Kind::whole;
  std::string column;
  int pieces = 1;  // each is cut into as many equal parts, in the order of time
};

struct ProblemPlan {
  std::string name;
  std::string summary;
  int joint = 0;
  bool load = false;
  std::string file;
  std::string test_file;  // empty: movements of `file` are held out
  std::string target;
  std::vector<std::string> inputs;
  std::map<std::string, ColumnMeaning, std::less<>> columns;  // the set's, and its own on top
  std::vector<DerivedChannel> derived;
  MovementRule movements;
  std::string keep_column;  // only rows in which it has keep_value; empty: all
  double keep_value = 0;
  int decimate = 1;                   // see decimate.hpp
  bool average = false;               // one row a movement: the mean of every channel
  std::size_t rows_per_movement = 0;  // 0: all
  double test_share = 0.2;            // of the movements
  std::optional<MotionTerms> motion;  // formulas are judged by their motion too
  // Published error on this problem, 100 |y - f| / |y|, by model; NaN-free, may be empty.
  std::map<std::string, double, std::less<>> published_percent;
};

struct Manifest {
  std::string name;
  std::string title;
  std::string source;
  std::string licence;
  std::string cite;
  std::vector<File> files;
  std::vector<ProblemPlan> problems;
};

// Throws Error (bad_input) with file and line; unknown keys are refused with the nearest name.
Manifest parse_manifest(std::string_view toml, std::string_view file);

// The sets the program brings, by name.
const std::vector<Manifest>& shipped_manifests();

// Those, and the ones of <data>/NAME/manifest.toml in the order of their names; one of these with a
// shipped one's name takes its place. Throws Error (bad_input) where one cannot be read, is called
// otherwise than its folder, or has a problem that another set has.
std::vector<Manifest> known_manifests(const std::optional<std::filesystem::path>& data);

// Throws Error (bad_input) with the nearest name.
const Manifest& find_manifest(const std::vector<Manifest>& known, std::string_view name);

}  // namespace tribench::measured
