// SPDX-License-Identifier: MIT
#include "algorithms/forward_dynamics/joint_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"
#include "algorithms/forward_dynamics/drive.hpp"
#include "foundation/error.hpp"
#include "tests/algorithms/forward_dynamics/simulated_joint.hpp"

namespace tribench::forward {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

NamedColumns pendulum_columns() {
  NamedColumns columns;
  columns.columns = {{"angle", Role::position},         {"speed", Role::velocity},
                     {"load_Nm", Role::gravity_torque}, {"oil", Role::temperature},
                     {"torque", Role::motor_torque},    {"extra", Role::none}};
  return columns;
}

TEST(JointInputs, NamesMeanTheSimulatedMotionOrWhatWasRecorded) {
  const std::vector<std::string> names = {"angle", "speed",   "sgn_speed", "load_Nm", "oil",
                                          "a",     "torque",  "g",         "sgn_g",   "d",
                                          "tau_m", "v_lag30", "sgn_extra"};
  const JointInputs inputs = bind_inputs(names, pendulum_columns(), "--formula");
  std::vector<Source> sources;
  for (const Binding& binding : inputs.bindings) sources.push_back(binding.source);
  EXPECT_THAT(sources, ::testing::ElementsAre(
                           Source::position, Source::velocity, Source::direction, Source::recorded,
                           Source::recorded, Source::acceleration, Source::motor_torque,
                           Source::recorded, Source::recorded_sign, Source::memory,
                           Source::motor_torque, Source::memory, Source::recorded_sign));
  EXPECT_THAT(inputs.recorded, ::testing::ElementsAre("load_Nm", "oil", "extra"));
  EXPECT_THAT(inputs.memories, ::testing::ElementsAre("d", "v_lag30"));
}

TEST(JointInputs, GravityOfTheModelStandsInPlaceOfARecordedOne) {
  NamedColumns columns = pendulum_columns();
  columns.has_gravity = true;
  const JointInputs inputs =
      bind_inputs(std::vector<std::string>{"load_Nm", "sgn_load_Nm", "g"}, columns, "--formula");
  EXPECT_EQ(inputs.bindings[0].source, Source::gravity);
  EXPECT_EQ(inputs.bindings[1].source, Source::gravity_sign);
  EXPECT_EQ(inputs.bindings[2].source, Source::gravity);
  EXPECT_TRUE(inputs.recorded.empty());
}

TEST(JointInputs, AnUnknownNameIsAnsweredWithTheNearest) {
  const std::string message = error_of(
      [] { bind_inputs(std::vector<std::string>{"sped"}, pendulum_columns(), "--formula"); });
  EXPECT_THAT(message, HasSubstr("--formula"));
  EXPECT_THAT(message, HasSubstr("'sped'"));
  EXPECT_THAT(message, HasSubstr("speed"));
  EXPECT_THAT(error_of([] { bind_inputs(std::vector<std::string>{"g"}, {}, "--formula"); }),
              HasSubstr("--gravity"));
}

TEST(Controller, AnUnknownNameIsAnsweredWithTheNearest) {
  EXPECT_THAT(error_of([] {
                parse_controller("2*(refrence - q)", "", {{{"reference", Role::none}}, false, {}},
                                 "--control");
              }),
              HasSubstr("reference"));
}

TEST(JointModel, WithoutAnyInertiaThereIsNoMotion) {
  const JointModel model = testing::joint(0, "2*sgn_v");
  EXPECT_THAT(error_of([&] { JointEquation(model, "the model"); }), HasSubstr("--inertia"));
}

TEST(JointModel, TellsHowAFormulaDependsOnAColumn) {
  const std::vector<std::string> names = {"a", "v"};
  const auto degree = [&](const char* text) { return degree_in(parse(text, names), 0); };
  EXPECT_EQ(degree("v + 2*sin(v)"), 0);
  EXPECT_EQ(degree("3*a*exp(v) - a/(1 + v^2)"), 1);
  EXPECT_EQ(degree("a*a"), 2);
  EXPECT_EQ(degree("v/a"), 2);
  EXPECT_EQ(degree("tanh(a)"), 2);
  EXPECT_EQ(degree("a^2"), 2);
}

}  // namespace
}  // namespace tribench::forward
