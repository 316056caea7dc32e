// SPDX-License-Identifier: MIT
//
// What can happen at night, all at once: methods that crash, hang, eat memory and fill the disk,
// while the run itself is killed again and again. At the end every cell is there exactly once, and
// the healthy ones are those of an undisturbed run, bit for bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "foundation/child_process.hpp"
#include "foundation/random.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

#ifdef TRIBENCH_SANITIZED  // whose shadow memory is too large to be limited
constexpr const char* kEndOfMemoryEaters = "timeout";
#else
constexpr const char* kEndOfMemoryEaters = "out_of_memory";
#endif

struct Chaos {
  int seeds;  // ten cells a seed
  int kills;
};

std::string grid_of(const Chaos& chaos) {
  return R"([grid]
name = "chaos"
problems = ["A/j2/no_load"]
methods = ["test_mean", "test_search", "test_sleep", "test_spin", "test_pole", "test_crash",
           "test_hang", "test_eat_memory", "test_fill_disk", "test_throw"]
operators = ["paper"]
quarantine = []
seeds = { first = 1, count = )" +
         std::to_string(chaos.seeds) + R"( }
[budget]
evaluations = 300_000
seconds = 20
wall_seconds = 2
cpu_limit_seconds = 20
memory_mib = 200
[[method]]
name = "test_sleep"
parameters = { seconds = 0.02 }
[[method]]
name = "test_spin"
parameters = { seconds = 0.02 }
)";
}

// Lines of the results whose method behaves: what must not differ.
std::string healthy(const std::string& results) {
  std::istringstream stream(results);
  std::string kept;
  for (std::string line; std::getline(stream, line);) {
    for (const char* method : {"|test_mean|", "|test_search|", "|test_sleep|", "|test_spin|"}) {
      if (line.find(method) != std::string::npos) kept += line + "\n";
    }
  }
  return kept;
}

class ChaosTest : public ::testing::Test {
 protected:
  std::vector<std::string> command(const std::string& out, bool resume) const {
    std::vector<std::string> words = {test_program().string(),
                                      "run",
                                      (folder_ / "grid.toml").string(),
                                      "--out",
                                      (folder_ / out).string(),
                                      "--jobs",
                                      "4",
                                      "--quiet"};
    if (resume) words.push_back("--resume");
    return words;
  }

  // Runs and kills the program at random moments, then lets it come to its end.
  void run_disturbed(int kills) {
    RandomStream random(key_of("chaos"));
    for (int i = 0; i < kills; ++i) {
      // Killed with the keepers of its workers, it leaves temporary files.
      ChildProcess program(
          ChildOptions{command("disturbed", i > 0), {"TMPDIR=" + (folder_ / ".").string()}});
      std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform(0.1, 1.5)));
      ::kill(program.pid(), SIGKILL);
      program.wait();
    }
    const ProgramRun last = run_to_end(command("disturbed", true));
    ASSERT_EQ(last.status, 0) << last.errors;
  }

  void survive(const Chaos& chaos) {
    write_text(folder_ / "grid.toml", grid_of(chaos));
    const ProgramRun calm = run_to_end(command("calm", false));
    ASSERT_EQ(calm.status, 0) << calm.errors;
    run_disturbed(chaos.kills);
    const auto cells = column_of(folder_ / "disturbed", "status");
    EXPECT_EQ(cells.size(), static_cast<std::size_t>(10 * chaos.seeds));
    const std::string results = timeless_results(folder_ / "disturbed");
    EXPECT_EQ(std::count(results.begin(), results.end(), '\n'), 10 * chaos.seeds + 1)
        << "a cell stands there twice";
    EXPECT_EQ(healthy(results), healthy(timeless_results(folder_ / "calm")));
    for (const auto& [cell, reason] : column_of(folder_ / "disturbed", "reason")) {
      if (cell.find("|test_crash|") != std::string::npos) EXPECT_EQ(reason, "crashed (SIGSEGV)");
      if (cell.find("|test_hang|") != std::string::npos) EXPECT_EQ(reason, "timeout");
      if (cell.find("|test_eat_memory|") != std::string::npos)
        EXPECT_EQ(reason, kEndOfMemoryEaters);
    }
  }

  TemporaryFolder folder_;
};

TEST_F(ChaosTest, FortyCellsAndFourKills) { survive({4, 4}); }

// For the night: ctest -L slow runs it by name.
TEST_F(ChaosTest, DISABLED_FiveHundredCellsAndTwentyKills) { survive({50, 20}); }

}  // namespace
}  // namespace tribench::testing
