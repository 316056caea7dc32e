// SPDX-License-Identifier: MIT
#include "harness/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "foundation/error.hpp"
#include "harness/slurm.hpp"

namespace tribench {
namespace {

Grid grid_of(int slow_cells, int fast_cells) {
  Grid grid;
  grid.problems = {"p"};
  grid.methods = {{"slow", "slow", {}, false, {}, {}, {}}, {"fast", "fast", {}, true, {}, {}, {}}};
  grid.operators = {find_operator_set("paper")};
  grid.seed_count = static_cast<std::uint64_t>(std::max(slow_cells, fast_cells));
  return grid;
}

TEST(PlanWork, TakesTheExpensiveCellsFirst) {
  const std::vector<PlannedWork> work = plan_work(grid_of(3, 3));
  ASSERT_EQ(work.size(), 6U);
  EXPECT_TRUE(std::ranges::is_sorted(work, std::greater<>(), &PlannedWork::predicted_s));
  EXPECT_EQ(work.front().cell.method, "slow");
  EXPECT_EQ(work.back().cell.method, "fast");
}

TEST(PlanWork, DealsEveryCellToExactlyOneShardOfAboutEqualCost) {
  const Grid grid = grid_of(10, 10);
  for (const std::size_t count : {1U, 2U, 3U, 7U}) {
    std::set<std::string> seen;
    double least = 1e300;
    double most = 0;
    for (std::size_t k = 1; k <= count; ++k) {
      double cost = 0;
      for (const PlannedWork& item : plan_work(grid, {k, count})) {
        EXPECT_TRUE(seen.insert(item.cell.key()).second) << "twice: " << item.cell.key();
        cost += item.predicted_s;
      }
      least = std::min(least, cost);
      most = std::max(most, cost);
    }
    EXPECT_EQ(seen.size(), grid.cells().size());
    // At most one cell more than another shard.
    EXPECT_LE(most - least, predict_seconds(grid, grid.cells().front()) + 1e-9);
  }
}

TEST(PlanWork, BelievesMeasuredCosts) {
  const Grid grid = grid_of(2, 2);
  const std::vector<PlannedWork> work = plan_work(grid, {}, {{"fast", 100.0}});
  EXPECT_EQ(work.front().cell.method, "fast");
  EXPECT_EQ(work.front().predicted_s, 100.0);
}

// A line's end in a value would begin a line of the script's header, which is a command to Slurm.
TEST(SlurmPlan, RefusesValuesThatWouldAddLinesToTheHeader) {
  const Grid grid = parse_grid("[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"linear\"]\n",
                               "g.toml", Registry(), Catalogue());
  SlurmOptions options;
  options.out = "/tmp/with blanks";
  EXPECT_NE(plan_slurm(grid, options)
                .array_script.find("#SBATCH --output=\"/tmp/with blanks/log/element-%a.log\"\n"),
            std::string::npos);
  options.partition = "short\n#SBATCH --wrap=evil";
  EXPECT_THROW(plan_slurm(grid, options), Error);
}

TEST(SlurmPlan, AsksForWhatTheGreediestMethodMayTake) {
  const auto plan = [](const std::string& more) {
    return plan_slurm(parse_grid("[grid]\nproblems = [\"A/j2/no_load\"]\nmethods = [\"linear\", "
                                 "\"own\"]\n[budget]\nwall_seconds = 60\nmemory_mib = 500\n"
                                 "[[external]]\nname = \"own\"\ncommand = [\"true\"]\n" +
                                     more,
                                 "g.toml", Registry(), Catalogue()),
                      {.out = "/tmp/out", .program = {}, .data = {}, .jobs = 2, .partition = {}});
  };
  const SlurmPlan usual = plan("");
  const SlurmPlan greedy = plan("wall_seconds = 1260\nmemory_mib = 3000\n");
  EXPECT_EQ(greedy.memory_mib - usual.memory_mib, 2 * 2500);
  EXPECT_EQ(greedy.minutes - usual.minutes, 20);
  EXPECT_EQ(plan("wall_seconds = 6\nmemory_mib = 100\n").minutes, usual.minutes);
}

TEST(ParseShard, RefusesWhatIsNone) {
  EXPECT_EQ(parse_shard("3/8"), (Shard{3, 8}));
  for (const char* text : {"", "3", "0/8", "9/8", "a/b", "3/8x", "-1/2", "1/0"}) {
    EXPECT_THROW(parse_shard(text), Error) << text;
  }
}

}  // namespace
}  // namespace tribench
