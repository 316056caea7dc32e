// SPDX-License-Identifier: MIT
//
// Runs a program to its end and keeps what it printed; temporary folders that clean up.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tribench::testing {

struct ProgramRun {
  int status = 0;
  int signal = 0;
  std::string output;
  std::string errors;
};

ProgramRun run_to_end(const std::vector<std::string>& command,
                      const std::vector<std::string>& environment = {});

// The built tribench with these arguments.
ProgramRun run_tribench(const std::vector<std::string>& arguments);
// The same with arguments as a shell takes them; errors stand among the output.
ProgramRun run_tribench_in_shell(const std::string& arguments);

// What a line of shell prints; empty where it cannot be run.
std::string output_of(const std::string& line);

// A folder of its own that is removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, std::string_view text);

// Whether the process is there and not merely waiting to be fetched by its parent.
bool is_running(int pid);

// results.csv without the columns of time and memory: what must be equal byte for byte.
std::string timeless_results(const std::filesystem::path& run_folder);

// One column of results.csv by cell.
std::map<std::string, std::string> column_of(const std::filesystem::path& run_folder,
                                             std::string_view column);

}  // namespace tribench::testing
