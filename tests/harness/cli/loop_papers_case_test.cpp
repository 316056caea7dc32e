// SPDX-License-Identifier: MIT
//
// The paper's own case, told to the program as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "foundation/pivoted_qr.hpp"
#include "tests/harness/cli/loop_runs.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using testing::families;
using testing::generated;
using ::testing::HasSubstr;
using testing::run_tribench;
using Json = nlohmann::json;

struct PapersRow {
  std::string movement;
  double q, qd, g, tau;
};

std::vector<PapersRow> papers_rows(const std::string& file) {
  std::vector<PapersRow> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // movement,time_s,q,qd,sgn_qd,g,sgn_g,tau_f
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream cut(line);
    for (std::string cell; std::getline(cut, cell, ',');) cells.push_back(cell);
    rows.push_back({cells[0], std::stod(cells[2]), std::stod(cells[3]), std::stod(cells[5]),
                    std::stod(cells[7])});
  }
  return rows;
}

// Mean absolute error, on the movements that the loop has held out, of the law that the campaign
// was made with: its constants by least squares of all rows, the held-out ones too.
double error_of_the_true_law(const std::vector<PapersRow>& rows, const Json& loop) {
  Eigen::MatrixXd x(static_cast<Eigen::Index>(rows.size()), 15);
  Eigen::VectorXd y(x.rows());
  std::vector<std::string> movements;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const auto& [movement, q, v, g, tau] = rows[static_cast<std::size_t>(i)];
    if (movements.empty() || movements.back() != movement) movements.push_back(movement);
    const double s = v > 0 ? 1 : -1;
    const double f = v > 0 ? 1 : 0;
    const double v4 = v * v * v * v;
    x.row(i) << f, f * v, f * v4, 1 - f, (1 - f) * v, (1 - f) * v4, s * std::abs(g), g,
        std::tanh(g / 0.5), std::cos(160 * q), std::sin(160 * q), std::cos(320 * q),
        std::sin(320 * q), std::cos(3 * q), std::sin(3 * q);
    y[i] = tau;
  }
  const Eigen::VectorXd error = y - x * PivotedQr(x).solve(y);
  double sum = 0;
  double count = 0;
  for (const Json& held_out : loop["error"]["movements"]) {
    const std::string& name = movements.at(held_out["movement"].get<std::size_t>());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].movement != name) continue;
      sum += std::abs(error[static_cast<Eigen::Index>(i)]);
      ++count;
    }
  }
  return sum / count;
}

// The paper's own case: what the symmetric model lacks on raw data of joint 2, and nothing else. In
// the third campaign harmonics of the position stand in for a step of the load until the step is
// there. 720 held-out rows have a noise of 2.8 % more or less than its law says: what the loop
// leaves is held against what the true law leaves in the very same rows (1.002 and 1.005 times
// seen).
void expect_the_papers_joint2_down_to_its_noise(const std::vector<const char*>& seeds) {
  const testing::TemporaryFolder folder;
  for (const char* seed : seeds) {
    const std::string file = generated(folder, "A/j2/load", seed);
    const testing::ProgramRun run =
        run_tribench({"loop", file, "--model", "symmetric", "--gear-ratio", "160", "--json"});
    ASSERT_EQ(run.status, 0) << run.errors;
    const Json loop = Json::parse(run.output);
    EXPECT_EQ(loop["verdict"], "EFFECTS") << seed;
    std::vector<std::string> found = families(loop);
    for (const Json& effect : loop["effects"]) {
      // In one posture gravity is a sine of the angle: the two are named as each other's aliases.
      if (effect["family"] != "payload") continue;
      EXPECT_THAT(effect["alias"].dump(), HasSubstr("power_quadrant_gain"));
      std::ranges::replace(found, "payload", "power_quadrant_gain");
    }
    EXPECT_THAT(found, ::testing::UnorderedElementsAre("asymmetry", "load_coulomb",
                                                       "power_quadrant_gain", "power_quadrant_step",
                                                       "gear_ripple", "output_ripple"));
    const double least = error_of_the_true_law(papers_rows(file), loop);
    EXPECT_GT(loop["error"]["mae_before"].get<double>(), 5 * least) << seed;
    EXPECT_LT(loop["error"]["mae_after"].get<double>(), 1.01 * least) << seed;
  }
}

TEST(LoopCommand, ClosesTheLoopOnThePapersJoint2DownToItsNoise) {
  expect_the_papers_joint2_down_to_its_noise({"3"});
}
TEST(LoopCommand, DISABLED_ClosesTheLoopOnMoreOfThePapersCampaigns) {
  expect_the_papers_joint2_down_to_its_noise({"1", "3"});
}

}  // namespace
}  // namespace tribench
