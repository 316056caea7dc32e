// SPDX-License-Identifier: MIT
//
// Following jobs with a squeue that a test has written; the real one: tests/slurm.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "harness/slurm.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

// A controller that is started again loses no job: only one that Slurm does not know any more has
// ended.
TEST(SlurmQueue, AControllerThatDoesNotAnswerIsAskedAgain) {
  const testing::TemporaryFolder folder;
  const std::string calls = (folder / "calls").string();
  testing::write_text(
      folder / "squeue",
      "#!/bin/bash\necho >> " + calls + "\n" + "if [ \"$(wc -l < " + calls + ")\" -le 1 ]; then\n" +
          "echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2\n" +
          "else echo 'slurm_load_jobs error: Invalid job id specified' >&2\nfi\n" + "exit 1\n");
  std::filesystem::permissions(folder / "squeue", std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
  const std::atomic<bool> stop = false;
  ::testing::internal::CaptureStderr();
  EXPECT_TRUE(follow_slurm({"7", "8"}, stop));
  const std::string said = ::testing::internal::GetCapturedStderr();
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_NE(said.find("Slurm does not answer, asked again: slurm_load_jobs error: Unable"),
            std::string::npos)
      << said;
  EXPECT_EQ(testing::read_text(calls), "\n\n\n");  // one that failed, one a job
}

}  // namespace
}  // namespace tribench
