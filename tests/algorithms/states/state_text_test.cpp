// SPDX-License-Identifier: MIT
#include "algorithms/states/state_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/singularity.hpp"
#include "foundation/error.hpp"

namespace tribench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<std::string> kInputs = {"v", "a", "g"};

TEST(StateText, ReadsBackWhatItPrints) {
  const std::vector<std::string> texts = {
      "z = lugre(v, sliding=1e-05, breakaway=1.5e-05, stribeck_velocity=0.01); 2000000*z + 100*v",
      "z = dahl(v, sliding=0.1); w = warmth(v, g, time_constant=600); z*(1 + 0.1*w) + 95*a",
      "b = backlash(v, g, half_gap=0.001, drift=-0.3); 3*b",
      "100*v + 2",
  };
  for (const std::string& text : texts) {
    EXPECT_EQ(print_stateful(parse_stateful(text, kInputs), kInputs), text);
  }
}

TEST(StateText, StatesFollowTheInputs) {
  const StatefulFormula read =
      parse_stateful("z = slip(v, limit=0.5); y=lag( g ,time_constant = 2 ) ;y + z", kInputs);
  ASSERT_EQ(read.states.size(), 2U);
  EXPECT_EQ(read.first_state, 3U);
  EXPECT_EQ(read.states[1], (StateDeclaration{"y", StateLaw::lag, {2}, {2}}));
  EXPECT_EQ(read.formula.node(0).variable, 4U);
  EXPECT_EQ(read.formula.node(1).variable, 3U);
}

TEST(StateText, CollectsInputsDrivesFirst) {
  std::vector<std::string> names;
  const StatefulFormula read =
      parse_stateful_collecting("z = dahl(w, sliding=2); 3*z + a*w + z", names);
  EXPECT_THAT(names, ElementsAre("w", "a"));
  EXPECT_EQ(read.first_state, 2U);
  EXPECT_EQ(print_stateful(read, names), "z = dahl(w, sliding=2); 3*z + a*w + z");
}

TEST(StateText, AStateThatIsNotReadIsNotPrinted) {
  const StatefulFormula read =
      parse_stateful("z = dahl(v, sliding=2); y = dahl(v, sliding=3); 2*y", kInputs);
  EXPECT_EQ(print_stateful(read, kInputs), "y = dahl(v, sliding=3); 2*y");
}

TEST(StateText, AStateIsProvedOverItsRange) {
  NamedBox box = parse_box("v=-1:1");
  const StatefulFormula read = parse_stateful_over(
      "z = lugre(v, sliding=0.1, breakaway=0.4, stribeck_velocity=0.2); 1/(0.5 - z) + sgn_v", box);
  EXPECT_THAT(box.names, ElementsAre("v", "z", "sgn_v"));
  EXPECT_EQ(box.ranges[1].low, -0.4);
  EXPECT_EQ(box.ranges[1].high, 0.4);
  EXPECT_EQ(prove_free(read.formula, box.ranges).verdict, Verdict::proved_free);
  NamedBox wide = parse_box("v=-1:1");
  const StatefulFormula pole = parse_stateful_over("z = dahl(v, sliding=0.6); 1/(0.5 - z)", wide);
  EXPECT_EQ(prove_free(pole.formula, wide.ranges).verdict, Verdict::refuted);
}

std::string refusal(const std::string& text) {
  try {
    parse_stateful(text, kInputs);
  } catch (const Error& error) {
    return std::string(error.what());
  }
  return "accepted";
}

TEST(StateText, RefusesWithPlaceAndMend) {
  EXPECT_THAT(refusal("z = lugra(v, sliding=1); z"), HasSubstr("lugre"));
  EXPECT_THAT(refusal("z = dahl(u, sliding=1); z"), HasSubstr("'u'"));
  EXPECT_THAT(refusal("z = dahl(v, sliding=x); z"), HasSubstr("no number"));
  EXPECT_THAT(refusal("z = dahl(v, slide=1); z"), HasSubstr("sliding"));
  EXPECT_THAT(refusal("z = dahl(v); z"), HasSubstr("missing"));
  EXPECT_THAT(refusal("z = dahl(v, sliding=1, sliding=2); z"), HasSubstr("twice"));
  EXPECT_THAT(refusal("z = dahl(v, sliding=-1); z"), HasSubstr("above 0"));
  EXPECT_THAT(refusal("z = dahl(v, sliding=nan); z"), HasSubstr("sliding"));
  EXPECT_THAT(refusal("v = dahl(v, sliding=1); v"), HasSubstr("taken"));
  EXPECT_THAT(refusal("z = dahl v; z"), HasSubstr("no law"));
  EXPECT_THAT(refusal("2*v; z"), HasSubstr("declares no state"));
  EXPECT_THAT(refusal("z = dahl(v, sliding=1); y"), HasSubstr("y"));
  EXPECT_THAT(refusal("z = dahl(v, sliding=1);"), HasSubstr("expected"));
}

}  // namespace
}  // namespace tribench
