// SPDX-License-Identifier: MIT
//
// Nights as a timer runs them: the first, the next, one with a worse method, one that is killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <thread>

#include "foundation/child_process.hpp"
#include "foundation/random.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;

class NightlyTest : public ::testing::Test {
 protected:
  // As many seeds as say something of a loss.
  static constexpr int kEnough = 12;
  // `loss`: what the outside method adds to its one constant.
  void write_grid(const std::string& evaluations, const std::string& loss = "0", int seeds = 3) {
    write_text(folder_ / "g.toml",
               "[grid]\nname = \"night\"\nproblems = [\"A/j2/no_load\"]\n"
               "methods = [\"linear\", \"outside\"]\nseeds = { first = 1, count = " +
                   std::to_string(seeds) + " }\n[budget]\nevaluations = " + evaluations +
                   "\n"
                   "[[external]]\nname = \"outside\"\ncommand = [\"bash\", \"" +
                   (folder_ / "method.sh").string() + "\"]\n");
    write_text(folder_ / "method.sh",
               "echo '{\"front\": [\"8*sgn_qd + 10*qd + " + loss + "\"]}'\n");
  }
  std::vector<std::string> command() const {
    return {program().string(), "nightly",
            "--store",          store().string(),
            "--grid",           (folder_ / "g.toml").string(),
            "--least-free",     "0",
            "--jobs",           "2",
            "--sample",         "3"};
  }
  // Kills the command at random instants, then lets it go on.
  void kill_and_go_on(int kills) {
    write_grid("2_000_000", "0", kEnough);
    RandomStream random(key_of("nightly"));
    for (int kill = 0; kill < kills; ++kill) {
      // Killed with the keepers of its workers, it leaves temporary files.
      ChildProcess program(ChildOptions{command(), {"TMPDIR=" + (folder_ / ".").string()}});
      std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform(0.02, 0.6)));
      ::kill(program.pid(), SIGKILL);
      program.wait();
    }
    const ProgramRun last = night();
    EXPECT_EQ(last.status, 0) << last.output << last.errors;
    const ProgramRun shown = history("show", {"--json"});
    ASSERT_EQ(shown.status, 0) << shown.errors;
    EXPECT_THAT(shown.output, HasSubstr("\"damaged\": []"));
  }
  ProgramRun night(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = command();
    words.insert(words.end(), more.begin(), more.end());
    return run_to_end(words);
  }
  ProgramRun history(const std::string& what, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"history", what, store().string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_tribench(words);
  }
  std::filesystem::path store() const { return folder_ / "store"; }
  static int count_files(const std::filesystem::path& folder) {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
  }
  // Nights are told apart by the second in which they begin.
  static void next_second() {
    const auto second = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    std::this_thread::sleep_until(second + std::chrono::milliseconds(1010));
  }

  TemporaryFolder folder_;
};

TEST_F(NightlyTest, TheFirstIsTheBaseTheSecondIsComparedAndAWorseOneIsFound) {
  write_grid("2_000_000", "0", kEnough);
  const std::string told = (folder_ / "told").string();
  const ProgramRun first = night({"--notify", "cat > " + told});
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_THAT(first.output, HasSubstr("the first night: it is the base"));
  EXPECT_EQ(read_text(told), first.output);
  next_second();
  const ProgramRun second = night();
  EXPECT_EQ(second.status, 0) << second.output << second.errors;
  EXPECT_THAT(second.output, HasSubstr("All 24 cells are identical apart from time"));
  EXPECT_THAT(second.output, HasSubstr("3 cells run again, 0 differ"));
  next_second();
  write_grid("2_000_000", "2", kEnough);
  const ProgramRun third = night();
  EXPECT_EQ(third.status, 1) << third.output << third.errors;
  EXPECT_THAT(third.output, HasSubstr("REGRESSION"));
  next_second();
  // A bad night is no base: the next is compared with the first again.
  EXPECT_EQ(night().status, 1);
  ASSERT_EQ(history("bless", {"the new level is meant"}).status, 0);
  next_second();
  const ProgramRun blessed = night();
  EXPECT_EQ(blessed.status, 0) << blessed.output << blessed.errors;
  EXPECT_THAT(history("show").output, HasSubstr("5 nights, 2 series; base"));
  EXPECT_TRUE(std::filesystem::exists(store() / "nights.html"));
}

TEST_F(NightlyTest, FoldersOfRunsBecomeAHistoryAndABaseWithoutItsRunIsSaid) {
  write_grid("2_000_000");
  ASSERT_EQ(night().status, 0);
  next_second();
  ASSERT_EQ(night().status, 0);
  std::vector<std::string> words = {"history", "record", (folder_ / "another").string()};
  for (const auto& entry : std::filesystem::directory_iterator(store() / "runs")) {
    words.push_back(entry.path().string());
  }
  ASSERT_EQ(run_tribench(words).status, 0);
  const ProgramRun shown = run_tribench({"history", "show", (folder_ / "another").string()});
  EXPECT_THAT(shown.output, HasSubstr("2 nights, 2 series"));
  const ProgramRun kept = history("bless", {"its run is here"});
  EXPECT_EQ(kept.errors, "");
  std::filesystem::remove_all(words.back());
  const std::string name = std::filesystem::path(words.back()).filename().string();
  const ProgramRun gone = history("bless", {"its run is gone", "--night", name});
  EXPECT_EQ(gone.status, 0);
  EXPECT_THAT(gone.errors, HasSubstr("the night's run is not kept any more"));
}

TEST_F(NightlyTest, AnotherBudgetIsUndecidedAndSaidFirst) {
  write_grid("2_000_000");
  ASSERT_EQ(night().status, 0);
  next_second();
  write_grid("1_000_000");
  const ProgramRun other = night();
  EXPECT_EQ(other.status, 4) << other.output;
  EXPECT_THAT(other.output, HasSubstr("budget.evaluations: 2000000 -> 1000000"));
}

TEST_F(NightlyTest, AMissingOrDamagedBaseIsRefusedAndNeverReplaced) {
  write_grid("2_000_000");
  ASSERT_EQ(night().status, 0);
  std::filesystem::path record;
  for (const auto& entry : std::filesystem::directory_iterator(store() / "nights")) {
    record = entry.path();
  }
  const std::string whole = read_text(record);
  write_text(record, whole.substr(0, whole.size() / 2));
  const ProgramRun damaged = night();
  EXPECT_EQ(damaged.status, 2);
  EXPECT_THAT(damaged.errors, HasSubstr("damaged"));
  std::filesystem::remove(record);
  EXPECT_EQ(night().status, 2);
  write_text(record, whole);
  std::filesystem::remove_all(store() / "runs" / record.stem());
  const ProgramRun gone = night();
  EXPECT_EQ(gone.status, 2);
  EXPECT_THAT(gone.errors, HasSubstr("the base's run is missing"));
}

// Of hundreds of records one is no reason to lose a night.
TEST_F(NightlyTest, ADamagedNightThatIsNotTheBaseIsNamedAndLeftOut) {
  write_grid("2_000_000");
  ASSERT_EQ(night().status, 0);
  next_second();
  ASSERT_EQ(night().status, 0);
  std::filesystem::path record;  // the second: names begin with the time
  for (const auto& entry : std::filesystem::directory_iterator(store() / "nights")) {
    record = std::max(record, entry.path());
  }
  write_text(record, read_text(record) + "x");
  next_second();
  const ProgramRun third = night();
  EXPECT_EQ(third.status, 0) << third.errors;
  EXPECT_THAT(third.output, HasSubstr("left out: " + record.string() + ": this is no night's"));
}

TEST_F(NightlyTest, ASecondOneAtATimeAndAFullDiskAreRefused) {
  write_grid("2_000_000");
  const ProgramRun full = run_tribench({"nightly", "--store", store().string(), "--grid",
                                        (folder_ / "g.toml").string(), "--least-free", "1e9"});
  EXPECT_EQ(full.status, 3);
  EXPECT_THAT(full.errors, HasSubstr("MiB are free"));
  // A method that takes its time holds the store.
  write_text(folder_ / "method.sh", "sleep 30\n");
  ChildProcess slow(ChildOptions{command(), {"TMPDIR=" + (folder_ / ".").string()}});
  for (int i = 0; i < 500 && !std::filesystem::exists(store() / "runs" / "pending"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const ProgramRun second = night();
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.errors, HasSubstr("another night is using this store"));
}

// Of the runs the newest stay, and what was put aside years ago is none of them.
TEST_F(NightlyTest, ARunThatWasPutAsideIsAsOldAsItIs) {
  write_grid("2_000_000");
  const std::filesystem::path aside = store() / "runs" / "abandoned-2020-01-01T000000Z";
  std::filesystem::create_directories(aside);
  ASSERT_EQ(night({"--keep-runs", "1"}).status, 0);
  next_second();
  ASSERT_EQ(night({"--keep-runs", "1"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(aside));
  EXPECT_EQ(count_files(store() / "runs"), 2) << "the base and the newest";
}

TEST_F(NightlyTest, AClockThatWasSetBackIsRefused) {
  write_grid("2_000_000");
  ASSERT_EQ(night().status, 0);
  for (const auto& entry : std::filesystem::directory_iterator(store() / "nights")) {
    std::filesystem::copy_file(entry.path(),
                               store() / "nights" / "2999-01-01T000000Z-abcdef123456.night");
    break;
  }
  const ProgramRun late = night();
  EXPECT_EQ(late.status, 2);
  EXPECT_THAT(late.errors, HasSubstr("before the newest night"));
  EXPECT_FALSE(std::filesystem::exists(store() / "runs" / "pending"));
}

// A power cut at any moment: the store is whole and the next night goes on.
TEST_F(NightlyTest, KilledAgainAndAgainItComesToItsEnd) { kill_and_go_on(12); }
TEST_F(NightlyTest, DISABLED_KilledFiftyTimesItComesToItsEnd) { kill_and_go_on(50); }

// Loops that differ by one per cent of their work under one name: the second is found by its count,
// whatever the machine does meanwhile.
TEST_F(NightlyTest, ALoopOfOnePerCentMoreWorkIsFoundByItsCount) {
  if (run_to_end({"sh", "-c", "command -v valgrind"}).status != 0) GTEST_SKIP() << "no valgrind";
#ifdef TRIBENCH_SANITIZED
  GTEST_SKIP() << "valgrind runs no program of a sanitizer";
#endif
  if (!std::filesystem::exists(TRIBENCH_PLANTED_BENCHES "/planted_bench_as_it_was")) {
    GTEST_SKIP() << "built without Google Benchmark";
  }
  const std::filesystem::path folder = folder_ / "benches";
  const auto use = [&](const char* program) {
    std::filesystem::create_directories(folder);
    std::filesystem::copy_file(std::filesystem::path(TRIBENCH_PLANTED_BENCHES) / program,
                               folder / "loop_bench",
                               std::filesystem::copy_options::overwrite_existing);
  };
  write_text(folder_ / "g.toml",
             "[grid]\nname = \"night\"\nproblems = [\"A/j2/no_load\"]\nmethods = [\"linear\"]\n"
             "seeds = { first = 1, count = 3 }\n");
  use("planted_bench_as_it_was");
  ASSERT_EQ(night({"--benches", folder.string()}).status, 0);
  next_second();
  const ProgramRun same = night({"--benches", folder.string()});
  EXPECT_EQ(same.status, 0) << same.output << same.errors;
  EXPECT_THAT(same.output, HasSubstr("benches: 1 cases, none dearer"));
  next_second();
  use("planted_bench_one_per_cent_slower");
  const ProgramRun slower = night({"--benches", folder.string()});
  EXPECT_EQ(slower.status, 1) << slower.output << slower.errors;
  EXPECT_THAT(slower.output, HasSubstr("dearer: loop_bench inner_loop: 1.0 % more instructions"));
  EXPECT_LE(std::ranges::count(slower.output, '\n'), 10) << slower.output;
  EXPECT_THAT(read_text(store() / "nights.html"), HasSubstr("loop_bench inner_loop"));
  EXPECT_TRUE(std::filesystem::exists(store() / "nights.atom"));
  const ProgramRun none = night({"--benches", (folder_ / "nowhere").string()});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("no bench in this folder"));
}

}  // namespace
}  // namespace tribench::testing
