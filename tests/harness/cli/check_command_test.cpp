// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/paths.hpp"
#include "tests/support/run_program.hpp"

namespace tribench {
namespace {

using testing::ProgramRun;
ProgramRun run_check(const std::string& arguments) {
  return testing::run_tribench_in_shell("check " + arguments);
}

TEST(CheckCommand, Exits0ForAProof1ForARefutationAnd2ForBadInput) {
  EXPECT_EQ(run_check("'1/(v^2 - 2*v + 2)' --box 'v=-2:2'").status, 0);
  EXPECT_EQ(run_check("'1/(v - 0.3)' --box 'v=-2:2'").status, 1);
  EXPECT_EQ(run_check("--box v=-2:2 -- '-1/v'").status, 1);
  EXPECT_EQ(run_check("'1/(v - ' --box 'v=-2:2'").status, 2);
  EXPECT_EQ(run_check("'1/x' --box 'v=-2:2'").status, 2);
  EXPECT_EQ(run_check("'v' --box 'v=2:-2'").status, 2);
  EXPECT_EQ(run_check("'v' --box 'v=0:inf'").status, 2);
  EXPECT_EQ(run_check("'v' --box 'v=0:1,v=0:2'").status, 2);
}

TEST(CheckCommand, NamesTheInputThatHasNoRangeAndTheMend) {
  const ProgramRun answer = run_check("'v + load' --box 'v=-2:2'");
  EXPECT_NE(answer.output.find("'load' has no range; add load=LOW:HIGH"), std::string::npos)
      << answer.output;
}

TEST(CheckCommand, AnswersInJsonWithAWitness) {
  const ProgramRun answer = run_check("'g/(v - 0.25)' --box 'v=-2:2,g=-60:60' --json");
  EXPECT_EQ(answer.status, 1);
  const auto json = nlohmann::json::parse(answer.output);
  EXPECT_EQ(json["verdict"], "refuted");
  EXPECT_EQ(json["witness"]["v"], 0.25);
  EXPECT_EQ(json["complexity"], 4);
  EXPECT_EQ(json["nodes"], 5);
  EXPECT_GE(json["boxes"].get<int>(), 1);
  EXPECT_GE(json["seconds"].get<double>(), 0);
}

TEST(CheckCommand, GivesTwoNeighboursForAPoleThatNoDoubleHits) {
  const auto json = nlohmann::json::parse(run_check("'1/(v^2 - 2)' --box 'v=0:2' --json").output);
  EXPECT_EQ(json["witness"]["between"][0]["v"], 1.414213562373095);
  EXPECT_EQ(json["witness"]["between"][1]["v"], 1.4142135623730951);
}

TEST(CheckCommand, UnderstandsTheSignBesideItsInput) {
  EXPECT_EQ(run_check("'sqrt(v*sgn_v)' --box 'v=-2:2'").status, 0);
  EXPECT_EQ(run_check("'1/(sgn_v + 0.5)' --box 'v=-2:2'").status, 0);
  EXPECT_EQ(run_check("'1/sgn_v' --box 'v=-2:2'").status, 1);
}

TEST(CheckCommand, DecidesPropertiesOfFrictionLaws) {
  EXPECT_EQ(run_check("'3*sgn_v + 2*v' --box v=-2:2 --property dissipative").status, 0);
  EXPECT_EQ(run_check("'3*sgn_v - 2*v' --box v=-2:2 --property dissipative").status, 1);
  EXPECT_EQ(run_check("'3*sgn_v + 2*v' --box v=-2:2 --property odd").status, 0);
  EXPECT_EQ(run_check("'3*sgn_v + 2*v' --box v=-2:2 --property bounded --limit 6.9").status, 1);
  EXPECT_EQ(run_check("'exp(v)' --box v=-700:700 --property bounded").status, 2);
  EXPECT_EQ(run_check("'sgn_w*exp(-w*sgn_w) + w' --box w=-2:2 --velocity w --from 0.1"
                      " --property monotone")
                .status,
            0);
  EXPECT_EQ(run_check("'v' --box v=-2:2 --property smooth").status, 2);
  const auto json =
      nlohmann::json::parse(run_check("'v' --box v=-2:2 --property odd --json").output);
  EXPECT_EQ(json["verdict"], "proved");
}

TEST(CheckCommand, SaysWhichSpeedsAProofOfMonotonyIsAbout) {
  const ProgramRun all = run_check("'v + sgn_v' --box v=-2:2 --property monotone");
  EXPECT_TRUE(all.output.starts_with(
      "proved: monotone (not falling from any v to a greater one) everywhere on v=-2:2"))
      << all.output;
  const ProgramRun beyond = run_check("'v^3' --box v=-2:2 --property monotone --from 0.1");
  EXPECT_TRUE(
      beyond.output.starts_with("proved: monotone (not falling from any v to a greater "
                                "one, |v| >= 0.1 at both) everywhere on v=-2:2"))
      << beyond.output;
  EXPECT_EQ(run_check("'v - sgn_v' --box v=-2:2 --property monotone").status, 1);
}

TEST(CheckCommand, WritesACertificateThatItVerifiesAndRejectsOnceTamperedWith) {
  const auto path = testing::scratch_folder() / "certificate.json";
  EXPECT_EQ(run_check("'v/(v^2 - 2*v + 2)' --box v=-2:2 --certificate " + path.string()).status, 0);
  const ProgramRun accepted = run_check("--json --verify " + path.string());
  EXPECT_EQ(accepted.status, 0);
  EXPECT_EQ(nlohmann::json::parse(accepted.output)["accepted"], true);
  std::ifstream in(path);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  text.replace(text.find("- 2*v"), 5, "- 3*v");
  std::ofstream(path) << text;
  EXPECT_EQ(run_check("--verify " + path.string()).status, 1);
  std::filesystem::remove(path);
  EXPECT_EQ(run_check("--verify " + path.string()).status, 2);
}

// Whose reader takes the first of two would check another formula than ours.
TEST(CheckCommand, AKeyThatStandsTwiceInAUsersFileIsNamed) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "file.json").string();
  ASSERT_EQ(run_check("'v/(v^2 - 2*v + 2)' --box v=-2:2 --certificate " + file).status, 0);
  testing::write_text(file, "{\"formula\": \"1/v\"," + testing::read_text(file).substr(1));
  const ProgramRun certificate = run_check("--verify " + file);
  EXPECT_EQ(certificate.status, 1);
  testing::write_text(file, R"({"formula": "v", "formula": "2*v"})");
  testing::write_text(folder / "data.csv", "v\n1\n");
  const ProgramRun model =
      testing::run_tribench_in_shell("predict " + file + " " + (folder / "data.csv").string());
  EXPECT_EQ(model.status, 2);
  const ProgramRun loop = testing::run_tribench_in_shell("export " + file + " --as c");
  EXPECT_EQ(loop.status, 2);
  for (const ProgramRun& run : {certificate, model, loop}) {
    EXPECT_NE(run.output.find("the key \"formula\" stands twice"), std::string::npos) << run.output;
  }
}

TEST(CheckCommand, DoesNotVerifyAnotherFormulaThanTheCertificates) {
  const auto path = testing::scratch_folder() / "other.json";
  EXPECT_EQ(run_check("'1/(v^2 + 1)' --box v=-3:3 --certificate " + path.string()).status, 0);
  EXPECT_EQ(run_check("'1/v' --verify " + path.string()).status, 2);
  EXPECT_EQ(run_check("--box v=-9:9 --verify " + path.string()).status, 2);
  EXPECT_EQ(run_check("--verify " + path.string()).status, 0);
  std::filesystem::remove(path);
}

TEST(CheckCommand, AConstantNeedsNoBox) {
  EXPECT_EQ(run_check("'2^0.5'").status, 0);
  EXPECT_EQ(run_check("'1/0'").status, 1);
}

TEST(CheckCommand, CertifiesThePropertyAskedForOrSaysThatItCannot) {
  const auto path = testing::scratch_folder() / "claim.json";
  const std::string asked = "'3*sgn_v + 2*v' --box v=-2:2 --certificate " + path.string();
  EXPECT_EQ(run_check(asked + " --property dissipative").status, 0);
  const auto dissipative =
      nlohmann::json::parse(run_check("--json --verify " + path.string()).output);
  EXPECT_EQ(dissipative["accepted"], true);
  EXPECT_EQ(dissipative["claim"], "finite and of no other sign than v");
  EXPECT_EQ(run_check(asked + " --property bounded --limit 7").status, 0);
  const auto bounded = nlohmann::json::parse(run_check("--json --verify " + path.string()).output);
  EXPECT_EQ(bounded["accepted"], true);
  std::filesystem::remove(path);
  EXPECT_EQ(run_check(asked + " --property bounded").status, 2);  // no limit
  EXPECT_EQ(run_check(asked + " --property odd").status, 2);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(CheckCommand, DecidesAFormulaWithMemoryByItsStoredEnergy) {
  const std::string state =
      "z = lugre(v, sliding=1e-3, breakaway=1.5e-3, stribeck_velocity=0.01); ";
  const std::string force = "1e4*z + 2000*(v - abs(v)*z/(1e-3 + 5e-4*exp(-(v/0.01)^2))) + ";
  const std::string rest = "*v' --box 'v=-2:2' --property dissipative";
  EXPECT_EQ(run_check("'" + state + force + "1001" + rest).status, 0);
  const ProgramRun refuted = run_check("'" + state + force + "100" + rest + " --json");
  EXPECT_EQ(refuted.status, 1);
  const nlohmann::json json = nlohmann::json::parse(refuted.output);
  EXPECT_EQ(json["verdict"], "refuted");
  EXPECT_LT(json["witness"]["work"], 0);
  EXPECT_EQ(json["witness"]["cycle"].size(), 2U);
  EXPECT_EQ(run_check("'" + state + "1/(0.0016 - z)' --box 'v=-2:2'").status, 0);
  EXPECT_EQ(run_check("'" + state + "1/(0.0014 - z)' --box 'v=-2:2'").status, 1);
  EXPECT_EQ(run_check("'z = lugre(v); z' --box 'v=-2:2'").status, 2);
}

}  // namespace
}  // namespace tribench
