// SPDX-License-Identifier: MIT
//
// A real Slurm of one node on loopback, started and stopped by the test: an array completes, an
// element killed half way is requeued and resumes, and the merged results are those of a local run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sanitized.hpp"

namespace tribench::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* kGrid = R"([grid]
name = "cluster"
problems = ["A/j2/no_load", "A/j4/no_load"]
methods = ["test_sleep", "test_search", "test_crash"]
operators = ["paper"]
seeds = { first = 1, count = 10 }

[budget]
evaluations = 1_000_000
seconds = 10
memory_mib = 400

[[method]]
name = "test_sleep"
parameters = { seconds = 0.3 }
)";

bool is_installed(const char* program) {
  return run_to_end({"bash", "-c", std::string("command -v ") + program}).status == 0;
}

// slurmd looks for control groups even where no plugin is told to use them.
bool has_control_groups() {
  return read_text("/proc/self/mounts").find(" /sys/fs/cgroup") != std::string::npos;
}

// One cluster for all tests: it takes seconds to start and to end. Each test has a folder of its
// own.
class Cluster {
 public:
  Cluster() {
    // By the shell: what run_to_end starts is ended with the script, and the daemons are to stay.
    const std::string start = "'" + script() + "' start '" + folder_.path().string() + "'";
    is_started_ = std::system(start.c_str()) == 0;
  }
  ~Cluster() { run_to_end({script(), "stop", folder_.path().string()}); }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  bool is_started() const { return is_started_; }
  ProgramRun run(const std::vector<std::string>& command) const {
    return run_to_end(command, {"SLURM_CONF=" + (folder_ / "slurm.conf").string()});
  }

 private:
  static std::string script() { return (source_dir() / "tests/slurm/cluster.sh").string(); }

  TemporaryFolder folder_;
  bool is_started_ = false;
};

class SlurmTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"sbatch", "slurmctld", "slurmd", "munged"}) {
      if (!is_installed(program)) {
        GTEST_SKIP() << program << " is not installed (./tribench test installs it)";
      }
    }
    if (kIsSanitized) GTEST_SKIP() << "its limits of memory are a plain build's";
    if (::geteuid() != 0) GTEST_SKIP() << "a Slurm of the test's own needs root";
    if (!has_control_groups()) GTEST_SKIP() << "slurmd needs /sys/fs/cgroup, which is not mounted";
    if (!cluster_) cluster_ = std::make_unique<Cluster>();
    ASSERT_TRUE(cluster_->is_started());
    write_text(folder_ / "grid.toml", kGrid);
  }
  static void TearDownTestSuite() {
    cluster_.reset();
    local_results_.reset();
  }

  ProgramRun slurm(const std::vector<std::string>& command) { return cluster_->run(command); }
  ProgramRun submit(const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> command = {test_program().string(),
                                        "submit",
                                        (folder_ / "grid.toml").string(),
                                        "--slurm",
                                        "--out",
                                        (folder_ / out).string(),
                                        "--shards",
                                        "3"};
    command.insert(command.end(), more.begin(), more.end());
    return slurm(command);
  }
  // What the same grid gives here, without a cluster; run once.
  const std::string& local_results() {
    if (!local_results_) {
      const ProgramRun local =
          run_to_end({test_program().string(), "run", (folder_ / "grid.toml").string(), "--out",
                      (folder_ / "local").string(), "--jobs", "2"});
      EXPECT_EQ(local.status, 0) << local.errors;
      local_results_ = timeless_results(folder_ / "local");
    }
    return *local_results_;
  }
  std::string log_of(const std::string& out) {
    return run_to_end({"bash", "-c", "tail -n 5 " + (folder_ / out).string() + "/log/*"}).output;
  }

  TemporaryFolder folder_;

 private:
  static inline std::unique_ptr<Cluster> cluster_;
  static inline std::optional<std::string> local_results_;
};

TEST_F(SlurmTest, AnArrayAndItsMergeGiveTheResultsOfALocalRun) {
  const ProgramRun submitted = submit("cluster", {});
  ASSERT_EQ(submitted.status, 0) << submitted.errors << log_of("cluster");
  EXPECT_THAT(submitted.output, HasSubstr("60 cells in 3 elements"));
  EXPECT_EQ(timeless_results(folder_ / "cluster"), local_results());
  EXPECT_EQ(column_of(folder_ / "cluster", "status").size(), 60U);
}

TEST_F(SlurmTest, AnElementKilledHalfWayIsRequeuedAndResumes) {
  const ProgramRun submitted = submit("cluster", {"--detach"});
  ASSERT_EQ(submitted.status, 0) << submitted.errors;
  const std::size_t at = submitted.output.find("array ") + 6;
  const std::string array = submitted.output.substr(at, submitted.output.find(',', at) - at);
  const std::string journal = (folder_ / "cluster/shard-1/cells.jsonl").string();
  const auto lines = [&] {
    const std::string text = read_text(journal);
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto wait_for = [](const auto& condition) {
    for (int i = 0; i < 1500; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  };
  ASSERT_TRUE(wait_for([&] { return lines() >= 4; })) << log_of("cluster");
  ASSERT_EQ(slurm({"scontrol", "requeue", array + "_1"}).status, 0);
  const std::string before = read_text(journal);
  EXPECT_LT(std::count(before.begin(), before.end(), '\n'), 21)
      << "the element had ended before it was killed";
  // Slurm holds a requeued job back for a while; a test need not wait for that.
  ASSERT_TRUE(wait_for([&] {
    slurm({"scontrol", "update", "JobId=" + array + "_1", "StartTime=now"});
    return std::filesystem::exists(folder_ / "cluster/results.csv");
  })) << log_of("cluster");
  EXPECT_TRUE(read_text(journal).starts_with(before.substr(0, before.rfind('\n') + 1)))
      << "the second life of the element did not go on where the first ended";
  EXPECT_EQ(timeless_results(folder_ / "cluster"), local_results());
}

// What the documents say of nights on a cluster: a job whose status is the night's.
TEST_F(SlurmTest, ANightIsAJobThatEndsAsTheNightDoes) {
  const auto night = [&](int seeds) {
    write_text(folder_ / "night.toml",
               "[grid]\nname = \"night\"\nproblems = [\"A/j2/no_load\"]\nmethods = [\"linear\"]\n"
               "seeds = { first = 1, count = " +
                   std::to_string(seeds) + " }\n");
    return slurm({"sbatch", "--wait", "-o", (folder_ / "night.log").string(), "--wrap",
                  "'" + program().string() + "' nightly --store '" + (folder_ / "store").string() +
                      "' --grid '" + (folder_ / "night.toml").string() +
                      "' --least-free 0 --jobs 1 --sample 1"});
  };
  EXPECT_EQ(night(3).status, 0) << read_text(folder_ / "night.log");
  EXPECT_THAT(read_text(folder_ / "night.log"), HasSubstr("it is the base from now on"));
  EXPECT_EQ(night(4).status, 4) << read_text(folder_ / "night.log");
  EXPECT_THAT(read_text(folder_ / "night.log"), HasSubstr("asked differently: grid.seeds"));
}

}  // namespace
}  // namespace tribench::testing
