// SPDX-License-Identifier: MIT
//
// A diagnosis that is asked again for other names begins where its searches ended.
#include <gtest/gtest.h>

#include "tests/algorithms/diagnosis/planted_diagnosis.hpp"

namespace tribench::loop {
namespace {

// The second leaves something over, so that its search begins otherwise, too.
TEST(SearchMemory, AskedAgainForOtherNamesSaysWhatItWouldHaveSaidAtOnce) {
  const kuka::PlantedCase cases[] = {{.effects = {{"load_coulomb", 1.0}, {"hysteresis", 1.0}}},
                                     {.effects = {{"load_coulomb", 1.0}, {"velocity_bump", 2.0}}}};
  for (const kuka::PlantedCase& planted : cases) {
    const Observations data = observe(kuka::make_planted(planted, 5).data);
    DiagnosisOptions options = options_of_planted();
    SearchMemory memory;
    const Diagnosis first = diagnose(data, coulomb_viscous_base, options, {}, &memory);
    ASSERT_FALSE(first.effects.empty());
    options.unnamed = {first.effects.front().family};
    const Diagnosis again = diagnose(data, coulomb_viscous_base, options, {}, &memory);
    const Diagnosis at_once = diagnose(data, coulomb_viscous_base, options);
    EXPECT_NE(families(again), families(first));
    EXPECT_EQ(again.verdict, at_once.verdict);
    EXPECT_EQ(families(again), families(at_once));
    EXPECT_EQ(again.tried, at_once.tried);
    EXPECT_EQ(again.leftover.inputs, at_once.leftover.inputs);
    EXPECT_EQ(again.after.coefficients, at_once.after.coefficients);
  }
}

}  // namespace
}  // namespace tribench::loop
