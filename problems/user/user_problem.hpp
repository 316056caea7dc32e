// SPDX-License-Identifier: MIT
//
// A user's own files as a problem: which they are, what their columns mean, which rows test. Said
// once, in a grid or on a command line; every worker process makes the same problem of it again,
// and refuses files that are no longer the ones that were named.
//
// Not for sets that others use too (problems/suite, problems/measured).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "problems/preparation/data_options.hpp"
#include "problems/problem.hpp"
#include "problems/suite/suite_problem.hpp"

namespace tribench::user {

// The unit of the last input of a problem with categories: no method sees it.
inline constexpr const char* kCategoryUnit = "category";

struct DataSource {
  std::filesystem::path file;  // absolute, or from the working directory
  std::string sha256;          // of its bytes
  bool is_found = false;       // in a folder or by a pattern: nobody named the file itself
};

// Which rows test. Rows of one group are never parted.
struct HeldOut {
  enum class Kind {
    nothing,
    share,   // of the groups, drawn
    values,  // rows whose `column` has one of `values`
    files,   // all rows of other files
  };
  Kind kind = Kind::share;
  double share = 0.25;
  std::vector<std::uint64_t> seeds;  // of the draw, one a cell seed, round and round; empty: that
  std::string column;
  std::vector<std::string> values;
  std::vector<DataSource> files;
};

struct UserProblem {
  std::string name;
  std::string place = {};         // of its table in a grid, "mine.toml:9:1"; empty: of options
  std::vector<DataSource> files;  // one campaign, in this order
  std::string target;
  std::vector<std::string> inputs;  // empty: every other column of numbers
  DataOptions reading;              // names tell nothing, whatever it says
  // Rows with the same text in this column are one movement; without it a movement is what the
  // roles say, of several files each one, of a single file each row.
  std::string group;
  // The column of numbers that tells categories (joints, machines) apart: one shape for all, with
  // constants of each one's own.
  std::string category;
  HeldOut held_out;
  std::vector<std::filesystem::path> passed_over = {};  // notes that lie among its files
  std::string law;                                      // over the inputs, where it is known
  std::map<std::string, std::string> units;  // what figures are labelled with; converts nothing
  std::map<std::string, std::pair<double, double>> box;  // else the rows' ranges
  // What a formula's motion is judged by on the rows that test; their roles say which columns are
  // the time, the position and the motor torque.
  std::optional<MotionTerms> motion = {};

  // Of all its files: 12 hexadecimal digits, of a single file the first of its SHA-256.
  std::string hash() const;
};

// Throws Error (bad_input) where a file is missing or has changed.
void require_unchanged(const UserProblem& own);

// The inputs where nobody names them: every column of numbers that is not the time, not taken
// and not what `where` (COLUMN=VALUE, or empty) chooses rows by.
std::vector<std::string> other_columns(const Dataset& data, std::set<std::string> taken,
                                       const std::string& where);

// The rows as they were read, with roles, groups and warnings of the reader; every column that is
// a number. Throws Error (bad_input) with file, line and column.
DataFile read_user_rows(const UserProblem& own);

// Whether its columns bear what is said of them: the target is one, the law and the gravity can be
// read, units and ranges are of inputs. Throws Error (bad_input).
void check_user_problem(const UserProblem& own, const Dataset& data, const suite::LawReader& laws);

// The seed draws the rows that test. Throws Error (bad_input) where a file cannot be read or has
// changed, a column is not there, nothing or everything is held out, a row lies outside the box.
Problem make_user_problem(const UserProblem& own, const suite::LawReader& laws, std::uint64_t seed);

void add_entries(std::vector<ProblemEntry>& entries, std::span<const UserProblem> own,
                 const suite::LawReader& laws);

// "0.2" as a share, "fold=3" as a column's value. Throws Error (bad_input) with `place`.
HeldOut parse_held_out(const std::string& text, const std::string& place);

// What FILE, FOLDER or 'PATTERN*' name, in the order of their names: of a folder its data files.
// Throws Error (bad_input) where there is none.
std::vector<std::filesystem::path> find_data_files(const std::filesystem::path& named,
                                                   const std::string& place);
// The files with their hashes. Throws Error (bad_input) where one cannot be read.
std::vector<DataSource> hashed(std::span<const std::filesystem::path> files);
// Both in one, of one name.
std::vector<DataSource> find_sources(const std::filesystem::path& named, const std::string& place);

// Rows that a method was trained on say nothing about it: throws Error (bad_input) where a file
// that tests trains too, under this or another path or as a copy with the same bytes.
void require_apart(std::span<const DataSource> train, std::span<const DataSource> test,
                   const std::string& place);
// The same of files that need not be on a disk (a pipe can be read once only).
void require_apart(std::span<const std::filesystem::path> train, const std::filesystem::path& test,
                   const std::string& place);
// The same for files that somebody named; those that were only found in a folder or by a pattern
// are left out of what trains, for that is what whoever names the folder and a test file in it
// means. Throws Error (bad_input) where none is left.
void leave_out_tests(std::vector<DataSource>& train, std::span<const DataSource> test,
                     const std::string& place);

// Notes that lie among data: texts (.txt) that were only found in a folder or by a pattern and have
// no column `target`. They are taken out and returned, for whoever says so; none where no data
// would be left.
std::vector<std::filesystem::path> take_out_notes(std::vector<DataSource>& sources,
                                                  const std::string& target);

// A file's name as a problem's: "joint 1 (up).csv" -> "joint_1_up".
std::string name_of_file(const std::filesystem::path& file);

}  // namespace tribench::user
