// SPDX-License-Identifier: MIT
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "foundation/child_process.hpp"
#include "reports/csv.hpp"
#include "tests/support/paths.hpp"

namespace tribench::testing {
namespace {

using Rows = std::vector<std::vector<std::string>>;

// The header first, then the rows.
Rows read_rows(const std::filesystem::path& file) {
  std::ifstream stream(file);
  Rows rows;
  const auto take = [&](const std::vector<std::string_view>& fields) {
    rows.emplace_back(fields.begin(), fields.end());
  };
  read_csv(stream, take, take);
  return rows;
}

}  // namespace

ProgramRun run_to_end(const std::vector<std::string>& command,
                      const std::vector<std::string>& environment) {
  const ChildRun run = run_child({.command = command, .environment = environment});
  return {run.exit.status, run.exit.signal, run.output, run.errors};
}

ProgramRun run_tribench(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {program().string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_to_end(command);
}

ProgramRun run_tribench_in_shell(const std::string& arguments) {
  return run_to_end({"sh", "-c", "\"$0\" " + arguments + " 2>&1", program().string()});
}

std::string output_of(const std::string& line) { return run_to_end({"bash", "-c", line}).output; }

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "tribench-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

bool is_running(int pid) {
  const std::string stat = read_text("/proc/" + std::to_string(pid) + "/stat");
  return !stat.empty() && stat.find(") Z ") == std::string::npos;
}

std::string timeless_results(const std::filesystem::path& run_folder) {
  static constexpr std::array kTimes = {"fit_cpu_s", "fit_wall_s", "fit_instructions",
                                        "peak_memory_mib", "eval_ns_per_row"};
  const Rows rows = read_rows(run_folder / "results.csv");
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (std::ranges::count(kTimes, rows.front()[j]) == 0) text += row[j] + ";";
    }
    text += "\n";
  }
  return text;
}

std::map<std::string, std::string> column_of(const std::filesystem::path& run_folder,
                                             std::string_view column) {
  const Rows rows = read_rows(run_folder / "results.csv");
  std::map<std::string, std::string> values;
  if (rows.empty()) return values;
  const auto place_of = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(rows.front(), name) - rows.front().begin());
  };
  const std::size_t cell = place_of("cell");
  const std::size_t wanted = place_of(column);
  for (std::size_t r = 1; r < rows.size(); ++r) values[rows[r].at(cell)] = rows[r].at(wanted);
  return values;
}

}  // namespace tribench::testing
