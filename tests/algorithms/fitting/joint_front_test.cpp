// SPDX-License-Identifier: MIT
#include "algorithms/fitting/joint_front.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "algorithms/expression/text.hpp"

namespace tribench {
namespace {

const std::vector<std::string> kNames = {"v"};

class JointFrontTest : public ::testing::Test {
 protected:
  JointFrontTest() {
    for (int r = 0; r < 60; ++r) {
      v_.push_back(0.05 * r - 1);
      target_.push_back(v_.back() * v_.back() + (r % 2 == 0 ? 0.1 : -0.1));
    }
  }
  static std::vector<Expression> front(const std::vector<std::string>& texts) {
    std::vector<Expression> formulas;
    for (const std::string& text : texts) formulas.push_back(parse(text, kNames));
    return formulas;
  }
  static std::vector<std::string> texts(const JointFront& joint) {
    std::vector<std::string> all;
    for (const Expression& formula : joint.formulas()) all.push_back(print(formula, kNames));
    return all;
  }

  std::vector<double> v_;
  std::vector<double> target_;
  const double* column_ = nullptr;
  Inputs table() {
    column_ = v_.data();
    return {{&column_, 1}, v_.size()};
  }
};

TEST_F(JointFrontTest, KeepsWhatNoOtherBeatsAndStandsForTheChoiceWithTheMostEvidence) {
  JointFront joint(table(), target_);
  joint.add(front({"-9", "v", "1.02*v^2"}), 2);
  joint.add(front({"v", "v^2"}), 1);    // v stands there already
  joint.add(front({"0.2", "v^3"}), 1);  // a choice with less evidence
  EXPECT_EQ(print(joint.formulas()[joint.chosen()], kNames), "v^2");
  EXPECT_EQ(texts(joint), (std::vector<std::string>{"0.2", "v", "v^2"}));
  EXPECT_FALSE(joint.is_explained());
}

TEST_F(JointFrontTest, KnowsWhenTheRowsAreExplainedToRoundingAndStandsForTheShortest) {
  for (std::size_t r = 0; r < v_.size(); ++r) target_[r] = v_[r] * v_[r];
  JointFront joint(table(), target_);
  joint.add(front({"v"}), 0);
  EXPECT_FALSE(joint.is_explained());
  joint.add(front({"v", "v^2", "v^2 + 1e-13*v"}), 2);
  EXPECT_TRUE(joint.is_explained());
  EXPECT_EQ(print(joint.formulas()[joint.chosen()], kNames), "v^2");
}

}  // namespace
}  // namespace tribench
