// SPDX-License-Identifier: MIT
#include "harness/study/loop_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>

#include "foundation/error.hpp"
#include "harness/study/external_diagnosis.hpp"
#include "tests/support/paths.hpp"

namespace tribench {
namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

const LoopFigure& figure(const LoopStudy& study, const std::string& name) {
  const auto found = std::ranges::find(study.figures, name, &LoopFigure::name);
  if (found == study.figures.end()) throw std::runtime_error("no figure " + name);
  return *found;
}

LoopAnswer says_nothing(const LoopCase& /*one*/, const PlantedData& planted) {
  LoopAnswer answer;
  answer.before = planted.truth.base;
  answer.after = planted.truth.base;
  return answer;
}

// Knows the truth: what the best of methods would say.
LoopAnswer knows_all(const LoopCase& /*one*/, const PlantedData& planted) {
  LoopAnswer answer;
  answer.before = planted.truth.base;
  answer.after = planted.truth.noise_free();
  for (const PlantedEffect& effect : planted.truth.effects) {
    if (effect.in_library()) {
      answer.effects.push_back({effect.names.front(),
                                {},
                                false,
                                effect.stiffness,
                                0.9 * effect.stiffness,
                                1.1 * effect.stiffness});
      continue;
    }
    answer.unknown = true;
    for (const Role role : effect.lives_in) answer.inputs.emplace_back(role_name(role));
  }
  const std::vector<double>& time = planted.data.find(Role::time)->values;
  for (const PlantedCollision& burst : planted.truth.collisions) {
    answer.bursts.push_back({burst.movement, time[burst.first_row], time[burst.last_row]});
  }
  return answer;
}

LoopStudyOptions small_study() { return {.null_runs = 5, .runs_per_cell = 2, .first_seed = 900}; }

TEST(LoopStudy, AMethodThatKnowsTheTruthMeetsEveryTarget) {
  const LoopStudy study = run_loop_study(small_study(), knows_all);
  for (const LoopFigure& one : study.figures) {
    if (one.name.find("for comparison") == std::string::npos) {
      EXPECT_TRUE(one.met) << one.name << ": " << one.value;
    }
  }
  EXPECT_NEAR(figure(study, "held-out MAE after / ceiling, k = 4").value, 1, 1e-9);
  EXPECT_NEAR(figure(study, "closed fraction [%], k = 4").value, 100, 1e-6);
  EXPECT_EQ(figure(study, "two effects, recall, k = 2").trials, 14U);
}

TEST(LoopStudy, AMethodThatSaysNothingRaisesNoAlarmAndFindsNothing) {
  const LoopStudy study = run_loop_study(small_study(), says_nothing);
  EXPECT_EQ(figure(study, "false alarm, any").hits, 0U);
  EXPECT_EQ(figure(study, "first pick right, k = 4").hits, 0U);
  EXPECT_EQ(figure(study, "bursts found, 16 sd").hits, 0U);
  EXPECT_FALSE(figure(study, "exact verdict, k = 1").met);
  // The naive tests look at the data, not at the method.
  EXPECT_GE(figure(study, "for comparison: rows taken for independent, F test and BH 5 %").hits,
            4U);
}

TEST(LoopStudy, AStudyThatWasStoppedGoesOnWhereItWas) {
  const fs::path out = testing::scratch_folder() / "loop_study_resumed";
  fs::remove_all(out);
  std::atomic<int> calls = 0;
  LoopStudyOptions options = small_study();
  options.only = "single/stribeck";
  options.out = out;
  const LoopMethod counting = [&calls](const LoopCase& one, const PlantedData& planted) {
    if (++calls > 6) throw_bad_input("enough");
    return knows_all(one, planted);
  };
  EXPECT_THROW(run_loop_study(options, counting), Error);
  std::ofstream(out / "runs.csv", std::ios::app) << "single/stribeck/4/901,sing";  // torn
  calls = 0;
  const LoopStudy resumed = run_loop_study(options, counting);
  EXPECT_EQ(calls, 4);
  LoopStudyOptions afresh = options;
  afresh.out.clear();
  const LoopStudy whole = run_loop_study(afresh, knows_all);
  ASSERT_EQ(whole.outcomes.size(), 10U);
  for (std::size_t i = 0; i < whole.outcomes.size(); ++i) {
    EXPECT_EQ(resumed.outcomes[i].key, whole.outcomes[i].key);
    EXPECT_EQ(resumed.outcomes[i].claimed, whole.outcomes[i].claimed);
    EXPECT_EQ(resumed.outcomes[i].mae_before, whole.outcomes[i].mae_before);
  }
  EXPECT_EQ(read_text(out / "runs.csv").find(",sing\n"), std::string::npos);
}

LoopStudyOptions small_simulated_study() {
  return {
      .generator = LoopGenerator::simulated, .null_runs = 2, .runs_per_cell = 2, .first_seed = 950};
}

TEST(LoopStudy, OnSimulatedCampaignsTheTruthMeetsEveryTargetAndSilenceIsNeverWrong) {
  const LoopStudy best = run_loop_study(small_simulated_study(), knows_all);
  for (const LoopFigure& one : best.figures) EXPECT_TRUE(one.met) << one.name;
  EXPECT_EQ(figure(best, "named, k >= 1").trials, 100U);
  EXPECT_EQ(figure(best, "false alarm, noise skewed").trials, 2U);
  for (const CauseAnswers& one : best.answers) EXPECT_EQ(one.counts[0], one.runs) << one.cause;
  EXPECT_EQ(figure(best, "stiffness within 10 %, k >= 1").trials, 12U);
  EXPECT_EQ(figure(best, "stiffness in its 95 % interval, k >= 1").hits, 12U);
  const auto too_sure = [](const LoopCase& one, const PlantedData& planted) {
    LoopAnswer answer = knows_all(one, planted);
    for (LoopAnswer::Effect& effect : answer.effects) effect.stiffness_low *= 1.2;
    return answer;
  };
  // Nothing else has a stiffness.
  LoopStudyOptions presliding = small_simulated_study();
  presliding.only = "simulated/presliding";
  const LoopStudy sure = run_loop_study(presliding, too_sure);
  EXPECT_EQ(figure(sure, "stiffness in its 95 % interval, k >= 1").trials, 12U);
  EXPECT_EQ(figure(sure, "stiffness in its 95 % interval, k >= 1").hits, 0U);
  const LoopStudy silent = run_loop_study(small_simulated_study(), says_nothing);
  EXPECT_EQ(figure(silent, "stiffness within 10 %, k >= 1").hits, 0U);
  EXPECT_EQ(figure(silent, "named, k >= 1").hits, 0U);
  EXPECT_EQ(figure(silent, "confidently wrong").hits, 0U);
  EXPECT_EQ(figure(silent, "false alarm, noise bursty").hits, 0U);
}

// Every worth an answer can have, against one cause and against two.
TEST(LoopStudy, AnAnswerIsWorthWhatItNames) {
  PlantedData planted;
  planted.data.channels = {{"t", "s", Role::time, {0}}, {"f", "N m", Role::friction_torque, {0}}};
  planted.truth = {{0}, {0}, 1, {}, {}};
  PlantedEffect lag;
  lag.family = "lag_of_velocity";
  lag.names = {"lag", "inertia"};
  lag.beside = {"hysteresis"};
  planted.truth.effects = {lag};
  LoopCase one;
  const auto says = [&](std::vector<LoopAnswer::Effect> effects, bool unknown) {
    LoopAnswer answer;
    answer.effects = std::move(effects);
    answer.unknown = unknown;
    answer.before = answer.after = {0};
    return judge_answer(one, answer, planted).says;
  };
  EXPECT_EQ(says({{"lag", {}}}, false), Says::exact);
  EXPECT_EQ(says({{"inertia", {}}, {"hysteresis", {}}}, false), Says::exact);
  EXPECT_EQ(says({{"lag", {}, true}}, false), Says::another_shape);
  EXPECT_EQ(says({{"lag", {}}}, true), Says::with_unknown);
  EXPECT_EQ(says({{"lag", {}}, {"drift", {}}}, false), Says::with_more);
  EXPECT_EQ(says({{"hysteresis", {}}}, false), Says::partly);
  EXPECT_EQ(says({{"drift", {"lag"}}}, false), Says::alias);
  EXPECT_EQ(says({{"drift", {"payload"}}}, false), Says::wrong);
  EXPECT_EQ(says({{"drift", {}}}, true), Says::unknown);
  EXPECT_EQ(says({}, true), Says::unknown);
  EXPECT_EQ(says({}, false), Says::nothing);
  PlantedEffect notch;
  notch.family = "position_notch";
  notch.lives_in = {Role::position};
  planted.truth.effects = {notch};
  EXPECT_EQ(says({}, true), Says::exact);
  EXPECT_EQ(says({{"drift", {"lag"}}}, false), Says::wrong);
  planted.truth.effects = {};
  EXPECT_EQ(says({}, false), Says::exact);
  EXPECT_EQ(says({{"drift", {}}}, false), Says::wrong);
  EXPECT_EQ(says({}, true), Says::unknown);
}

// A program of one's own that knows a single effect.
TEST(LoopStudy, AProgramIsJudgedLikeTheLoop) {
  const LoopMethod program = make_external_diagnosis(
      {"python3", (tribench::testing::source_dir() / "tests/harness/study/load_only.py").string()});
  LoopStudyOptions options{.null_runs = 2, .runs_per_cell = 1, .first_seed = 920};
  for (const char* only : {"single/load_coulomb/2", "single/load_coulomb/4",
                           "single/load_viscous/2", "single/load_viscous/4"}) {
    options.only = only;
    const LoopStudy study = run_loop_study(options, program);
    ASSERT_EQ(study.outcomes.size(), 1U) << only;
    const LoopOutcome& one = study.outcomes.front();
    EXPECT_EQ(one.claimed, std::vector<std::string>{"load_coulomb"}) << one.key;
    EXPECT_EQ(one.is_exact(), one.planted[0] == "load_coulomb") << one.key;
    EXPECT_TRUE(one.is_covered()) << one.key;  // the other one is its alias
    EXPECT_LT(one.mae_after, one.mae_before) << one.key;
    if (one.is_exact()) EXPECT_NEAR(one.mae_after / one.mae_noise, 1, 0.05) << one.key;
  }
  options.only = "null";
  EXPECT_EQ(figure(run_loop_study(options, program), "false alarm, any").hits, 0U);
}

TEST(LoopStudy, WhatAProgramCannotTellIsNoClaim) {
  LoopStudyOptions options{.null_runs = 1, .runs_per_cell = 1, .first_seed = 922};
  options.only = "single/stribeck/4";
  const auto claimed_with = [&](const std::string& verdict) {
    const std::string answer = "{\"verdict\": \"" + verdict +
                               "\", \"effects\": [{\"family\": \"drift\"}], \"held_out\": [";
    const std::string script =
        "printf '%s' '" + answer +
        "'; sed '1d;s/.*/0/' \"${0%/*}\"/held_out.csv | tr '\\n' ',' | sed 's/,$//'; echo ']}'";
    const LoopStudy study = run_loop_study(options, make_external_diagnosis({"sh", "-c", script}));
    return study.outcomes.at(0).claimed;
  };
  EXPECT_EQ(claimed_with("EFFECTS"), std::vector<std::string>{"drift"});
  EXPECT_EQ(claimed_with("CANNOT_TELL"), std::vector<std::string>{});
}

// As json.dumps(answer, indent=1) has it.
TEST(LoopStudy, AnAnswerMayTakeSeveralLines) {
  const std::string printed =
      "reading {\n{\n \"verdict\": \"EFFECTS\",\n \"effects\": [\n  {\n   \"family\": "
      "\"stribeck\"\n"
      "  }\n ],\n \"held_out\": [\n  0.25,\n  -1\n ]\n}\ndone\n";
  const LoopAnswer answer = read_diagnosis(printed, {{"up"}, {0, 1, 1}, {0, 0, 0}});
  ASSERT_EQ(answer.effects.size(), 1U);
  EXPECT_EQ(answer.effects[0].family, "stribeck");
  EXPECT_EQ(answer.after[1], 0.25);
  EXPECT_EQ(answer.after[2], -1);
}

TEST(LoopStudy, AProgramThatFailsIsNamedWithItsCase) {
  LoopStudyOptions options{.null_runs = 1, .runs_per_cell = 1, .first_seed = 921};
  options.only = "null";
  const std::vector<std::pair<std::vector<std::string>, std::string>> failures = {
      {{"false"}, "status 1"},
      {{"echo", "garbage"}, "no JSON object"},
      {{"sh", "-c", "echo '{\"effects\": []}'"}, "malformed"},
      {{"echo", "{\"verdict\": \"NONE\", \"held_out\": [NaN]}"}, "(NaN)"},
      {{"echo", "{\"verdict\": \"MAYBE\", \"held_out\": []}"},
       "no verdict 'MAYBE', only NONE, EFF"},
      {{"echo", "{\"verdict\": \"EFECTS\", \"held_out\": []}"}, "did you mean EFFECTS?"},
      {{"echo", "{\"verdict\": \"EFFECTS\", \"effects\": [{\"family\": \"gremlin\"}]}"},
       "no family 'gremlin'; known: asymmetry, stribeck"},
      {{"echo",
        "{\"verdict\": \"EFFECTS\", \"effects\": [{\"family\": \"lag\", \"alias\": "
        "[{\"family\": \"stribek\"}]}]}"},
       "did you mean stribeck?"},
      {{"echo", "{\"verdict\": \"NONE\"}"}, "a prediction for each of the"},
      {{"sh", "-c", "echo '{\"verdict\": \"NONE\", \"held_out\": [1]}'"}, "1 predictions"}};
  for (const auto& [command, what] : failures) {
    try {
      run_loop_study(options, make_external_diagnosis(command));
      FAIL() << what;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      EXPECT_EQ(error.place(), "null//0/921");
    }
  }
}

TEST(LoopStudy, AFileOfSomethingElseIsRefused) {
  const fs::path out = testing::scratch_folder() / "loop_study_foreign";
  fs::create_directories(out);
  std::ofstream(out / "runs.csv") << "cell,problem\n1,2\n";
  LoopStudyOptions options = small_study();
  options.out = out;
  EXPECT_THROW(run_loop_study(options, knows_all), Error);
  EXPECT_EQ(read_text(out / "runs.csv"), "cell,problem\n1,2\n");
}

TEST(LoopStudy, TheLoopItselfIsTheSameForAnyNumberOfThreads) {
  LoopStudyOptions options{.null_runs = 5, .runs_per_cell = 1, .first_seed = 910};
  options.only = "single/load_coulomb";
  options.threads = 1;
  const LoopStudy one = run_loop_study(options, diagnosis_without({}));
  options.threads = 3;
  const LoopStudy three = run_loop_study(options, diagnosis_without({}));
  for (std::size_t i = 0; i < one.outcomes.size(); ++i) {
    EXPECT_EQ(one.outcomes[i].mae_after, three.outcomes[i].mae_after);
    EXPECT_EQ(one.outcomes[i].claimed, three.outcomes[i].claimed);
  }
  EXPECT_EQ(figure(one, "first pick right, k = 1").hits, 1U);
}

}  // namespace
}  // namespace tribench
