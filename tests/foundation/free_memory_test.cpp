// SPDX-License-Identifier: MIT
#include "foundation/free_memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/paths.hpp"

namespace tribench {
namespace {

using testing::write_text;

constexpr std::uint64_t kKib = 1024;

TEST(FreeMemory, IsTheLeastOfTheMachinesAndOfItsControlGroups) {
  const testing::TemporaryFolder root;
  EXPECT_EQ(free_memory(root.path()), 0U);
  write_text(root / "proc/meminfo", "MemTotal: 9000 kB\nMemAvailable:    8000 kB\nBuffers: 3 kB\n");
  EXPECT_EQ(free_memory(root.path()), 8000 * kKib);
  // Version 2: a group without a limit in one that has 5000 KiB left.
  write_text(root / "proc/self/cgroup", "1:name=systemd:/\n0::/job/step\n");
  write_text(root / "sys/fs/cgroup/job/step/memory.max", "max\n");
  write_text(root / "sys/fs/cgroup/job/memory.max", "6144000\n");
  write_text(root / "sys/fs/cgroup/job/memory.current", "1024000\n");
  EXPECT_EQ(free_memory(root.path()), 5000 * kKib);
  // Version 1, seen from within a container: its own group is at the top.
  write_text(root / "proc/self/cgroup", "5:cpu,memory:/elsewhere\n");
  write_text(root / "sys/fs/cgroup/memory/memory.limit_in_bytes", "4096000\n");
  EXPECT_EQ(free_memory(root.path()), 4000 * kKib);
}

TEST(FreeMemory, IsTheMostThatIsAskedForFromThenOn) {
#ifdef TRIBENCH_SANITIZED
  GTEST_SKIP() << "the sanitizer's shadow memory is too large to be limited";
#endif
  const auto limit = [] {
    rlimit memory{};
    getrlimit(RLIMIT_DATA, &memory);
    return memory.rlim_cur;
  };
  EXPECT_EXIT(
      {
        const auto most = static_cast<double>(free_memory());
        hold_to_free_memory();
        const double ratio = static_cast<double>(limit()) / most;
        hold_to_free_memory();  // the lower limit stays
        std::exit(0.5 < ratio && ratio < 2 && static_cast<double>(limit()) < 2 * most ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace tribench
