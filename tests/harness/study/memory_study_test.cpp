// SPDX-License-Identifier: MIT
#include "harness/study/memory_study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "foundation/error.hpp"
#include "foundation/random.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

// Four recordings of 20 s at 33 Hz; bristles of 60 N m/rad or none.
std::filesystem::path recordings(const char* name, bool bristles) {
  const std::filesystem::path file = testing::scratch_folder() / name;
  std::ofstream out(file);
  out << "run,t,v,tau\n";
  RandomStream random(key_of("memory_study"));
  for (int run = 0; run < 4; ++run) {
    const double rate = random.uniform(1.5, 3);
    double z = 0;
    for (int i = 0; i < 20'000; ++i) {
      const double t = 0.001 * i;
      const double v = 0.05 * std::sin(rate * t) + 0.06 * std::sin(2.7 * rate * t);
      z += 0.001 * (v - std::abs(v) * z / 0.02);
      const double sign = v > 0 ? 1 : v < 0 ? -1 : 0;
      const double tau = (bristles ? 60 * z : 1.2 * sign) + 3 * v + 0.05 * random.normal();
      if (i % 30 == 0) out << 'r' << run << ',' << t << ',' << v << ',' << tau << '\n';
    }
  }
  return file;
}

MemoryStudyOptions options_for(const std::filesystem::path& file) {
  return {.files = {file},
          .target = "tau",
          .inputs = {"v"},
          .roles = "v=velocity,t=time",
          .group = "run",
          .without = {"symmetric", "bam_m2"},
          .with = {"dahl"},
          .load = false,
          .threads = 1,
          .quiet = true};
}

TEST(MemoryStudy, AStateGainsWhereThereAreBristles) {
  const Registry registry;
  const auto figures = run_memory_study(options_for(recordings("bristles.csv", true)), registry);
  ASSERT_EQ(figures.size(), 3U);
  EXPECT_EQ(figures[2].verdict(), "gains");
  EXPECT_EQ(figures[2].recordings, 4U);
  EXPECT_NEAR(figures[2].rmse, 0.05, 0.01);  // the noise
  EXPECT_GT(figures[2].gain, 0.1);
  EXPECT_EQ(figures[0].is_best_without + figures[1].is_best_without, 1);
}

TEST(MemoryStudy, AStateGainsNothingWhereThereAreNone) {
  const Registry registry;
  const auto figures = run_memory_study(options_for(recordings("static.csv", false)), registry);
  EXPECT_NE(figures[2].verdict(), "gains");
  EXPECT_EQ(figures[0].verdict(), "");
}

TEST(MemoryStudy, TwoRecordingsTellNothing) {
  const std::filesystem::path file = recordings("few.csv", true);
  std::string text;
  {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("r2") && !line.starts_with("r3")) text += line + "\n";
    }
  }
  std::ofstream(file) << text;
  EXPECT_THROW(run_memory_study(options_for(file), Registry()), Error);
}

}  // namespace
}  // namespace tribench
