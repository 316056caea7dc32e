// SPDX-License-Identifier: MIT
//
// Data files, in and out. A line of names, then numbers, as people and robots write it (what is
// understood: csv_layout.hpp); gzip is unpacked.
//
//   movement,time_s,velocity_rad_s,friction_torque_Nm
//   up slow,0.000,0.31,9.82
//
// What a column is, and in which unit, comes from the roles that are given, then from a row of
// units, then from the column's name (channel_names.hpp). A channel with a role is converted to SI
// (units.hpp) here and nowhere else; one without stays as it is. A column named `movement` may hold
// any text; rows of one movement stand together, and their order is the campaign's. Without one the
// file is one movement, named after the file. A column of text is kept apart and is no channel.
//
// Missing values: an empty cell, nan, inf, NA, null. In a column that is used they are an error
// that names line and column, or the row is dropped and counted. Nothing is interpolated.
//
// Errors: tribench::Error (bad_input) with file:line:column and the mend. Cost: O(bytes).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problems/dataset.hpp"
#include "problems/reading/roles.hpp"
#include "problems/reading/units.hpp"

namespace tribench {

// What the numbers of a column have to be.
struct ColumnRule {
  std::string column;
  std::function<bool(double)> holds;
  std::string words;  // for people: "weights are 0 or more"
};

struct CsvOptions {
  GivenRoles roles;  // by column; wins over the name
  bool drop_missing = false;
  bool names_tell = true;  // false: a column is what `roles` says, and nothing else
  // The columns that are used beside those with a role; without a list all are. What is not used
  // is not looked at and becomes no channel.
  std::optional<std::vector<std::string>> used = {};
  std::optional<int> joint = {};  // of several in the names: q1 ... q7
  Drive drive = {};
  bool all_positions = false;              // the other joints' positions are channels too
  std::optional<double> sample_rate = {};  // rows a second, of a file without a time
  // What is not used is read where it holds a number in every row of every file (and --roles do not
  // say that it is nothing), and becomes a channel without a role.
  bool spare = false;
  std::string joint_word = {};          // or the word that the names have for it: "elbow"
  std::optional<ColumnRule> rule = {};  // a row that breaks it is refused with its line
};

struct TextColumn {
  std::string name;
  std::vector<std::string> values;  // per row of the dataset
};

// What a column was taken for, and why.
struct ColumnReading {
  std::string column;
  Role role = Role::none;
  std::string role_from;      // "--roles", "name", "name (libfranka)"; empty without a role
  std::string unit;           // as the file has it, "rpm@motor"; empty: not known
  std::string unit_from;      // "--roles", "row of units", "name", "libfranka", "size"; empty
  std::string si;             // what it became
  double factor = 1;          // of the conversion
  bool unit_assumed = false;  // by the name's source alone: to be checked against the data
  bool unit_asked = false;    // not known, and needed
  std::string needs;          // what is missing for the conversion: "--counts-per-turn N"
  std::string remark;
};

// The position of one of a file's several joints.
struct JointPosition {
  std::string joint;  // "3", or the word that the columns' names have for it: "elbow"
  std::string channel;
};

struct DataFile {
  Dataset data;
  std::vector<TextColumn> texts;
  std::vector<ColumnReading> readings;  // every column of the file, in its order
  std::vector<int> joints;  // numbers in the names of which one has to be chosen; else empty
  std::string joint;        // that was chosen, by its number or its word; empty: none was
  bool joints_have_words = false;
  // Of the joints whose positions were asked for, in the order of their numbers, of words in that
  // of the columns.
  std::vector<JointPosition> joint_positions;
  // "joint = 1, 2": a column in which several joints take turns, and what it calls them; else
  // empty.
  std::string in_turn;
  std::vector<std::string> spare;  // channels that nobody asked for
  bool has_movements = false;      // a column tells them
  std::size_t dropped_rows = 0;
  std::vector<std::string> warnings;  // one sentence each
};

DataFile read_csv(const std::filesystem::path& file, const CsvOptions& options = {});

// The same from memory; `file` names it in messages.
DataFile parse_csv(std::string_view text, std::string_view file, const CsvOptions& options = {});

// Several files as one campaign, in the order given; all must have the same channels. Movements
// that share a name in different files are told apart by the file's name. A file with the very
// rows of one before it, whatever their time, is left out, and that is said.
DataFile read_csv_files(std::span<const std::filesystem::path> files,
                        const CsvOptions& options = {});

// Comma-separated, numbers as the shortest text that reads back to the same double, a `movement`
// column first. Throws Error (failed) where the file cannot be written.
void write_csv(const Dataset& data, std::ostream& out);
void write_csv(const Dataset& data, const std::filesystem::path& file);

}  // namespace tribench
