// SPDX-License-Identifier: MIT
//
// The journal of a run, cells.jsonl: one line a cell, appended when the cell has ended, never
// changed. Each line carries a checksum; a torn last line (the machine died while it was written)
// is dropped, a damaged line in the middle is left out and reported, and its cell runs again. The
// first line says what the run is: its grid, code and data.
//
// One writer a file: a second one is refused while the first lives. Not for reports: they read the
// CSV files made from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "harness/cell_task.hpp"

namespace tribench {

// What makes two runs the same run: resuming and merging need equal ones.
struct RunIdentity {
  std::string grid;  // as printed by print_grid
  std::string code;  // version, commit and, where the tree was dirty, the program's hash
  std::string data;  // a hash of every problem's data
  // Of the grid's programs (program_files.hpp).
  std::map<std::string, std::string> programs = {};

  // Empty where equal; else what differs, as text for people.
  std::string difference(const RunIdentity& other) const;
};

// A line of the journal with this body (JSON): its checksum and its end included.
std::string journal_line(std::string_view body);

struct JournalContents {
  RunIdentity identity;
  std::vector<CellResult> results;  // the last one of each cell, in order of first appearance
  std::vector<std::string> damage;  // what was left out, for people
  std::size_t repeated = 0;         // of merged ones: results that an earlier folder had as well
  std::uintmax_t good_bytes = 0;    // up to the end of the last good line
  std::uintmax_t bytes = 0;         // of the whole file when it was read
};

// Throws Error (bad_input) where the file is missing or is no journal.
JournalContents read_journal(const std::filesystem::path& file);

class Journal {
 public:
  // Starts a new file; throws Error (bad_input) where there is one already, (failed) where the
  // folder cannot be written to.
  static Journal create(const std::filesystem::path& file, const RunIdentity& identity);
  // Goes on with an existing one, of which `contents` was read: cuts off a torn last line. Throws
  // Error (bad_input) where somebody else writes to it, or has since it was read.
  static Journal resume(const std::filesystem::path& file, const JournalContents& contents);

  Journal(Journal&&) noexcept;
  ~Journal();

  // Safe from several threads. Throws Error (failed) where the disk is full (what was written
  // before stays good) or the file was removed; nothing more is written after that.
  void append(const CellResult& result);

 private:
  Journal(std::filesystem::path file, int descriptor, std::uintmax_t size);
  void write_line(const std::string& body);
  void refuse_if_removed();
  void sync_if_due();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uintmax_t size_ = 0;  // bytes of good lines
  bool failed_ = false;
  double last_sync_s_ = 0;
  std::mutex mutex_;
};

}  // namespace tribench
