// SPDX-License-Identifier: MIT
#include "algorithms/udsr/weights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/udsr/pretraining.hpp"
#include "foundation/error.hpp"
#include "tests/algorithms/udsr/tokens.hpp"

namespace tribench::udsr {
namespace {

class WeightsTest : public testing::Test {
 protected:
  WeightsTest() {
    RandomStream random(2);
    // What a file holds is single precision.
    for (double& p : policy.parameters()) p = static_cast<float>(0.3 * random.normal());
    text = write_weights(policy, nullptr, {"test", 1, 2, 3});
  }
  static PriorOptions plain() {
    PriorOptions options;
    options.uniform_arity = false;
    options.soft_length = false;
    options.domain_range = false;
    return options;
  }

  TokenLibrary library = pretraining_library();
  Prior prior{library, plain(), {std::vector<double>(8, -1.0), -1, 1}};
  Policy policy{library, RandomStream(1)};
  std::string text;
};

TEST_F(WeightsTest, AreReadBackToTheSameParameters) {
  Policy copy(library, RandomStream(3));
  read_weights(text, "w.json", copy);
  EXPECT_EQ(policy.parameters(), copy.parameters());
}

TEST_F(WeightsTest, ServeASmallerLibraryByName) {
  const TokenLibrary small(find_operator_set("paper"), 2, {.constants = false, .linear = true});
  Policy reduced(small, RandomStream(3));
  read_weights(text, "w.json", reduced);
  const Prior small_prior(small, plain(), {{-1, -1}, -1, 1});
  // The smaller library's probabilities are the larger's, shared out among fewer tokens: the ratio
  // of two continuations of the same start is the same.
  const auto log_p = [](const Policy& p, const Prior& rules, const Sequence& sequence) {
    const Sequence* pointer = &sequence;
    return p.log_probabilities({&pointer, 1}, rules)[0];
  };
  const auto ratio = [&](const Policy& p, const Prior& rules, const TokenLibrary& tokens) {
    return log_p(p, rules, sequence_of(tokens, {"+", "x1", "exp", "x1"})) -
           log_p(p, rules, sequence_of(tokens, {"+", "x1", "exp", "x2"}));
  };
  EXPECT_NEAR(ratio(reduced, small_prior, small), ratio(policy, prior, library), 1e-9);
}

TEST_F(WeightsTest, RefuseADamagedFile) {
  const auto refused = [&](const std::string& damaged, const char* why) {
    try {
      read_weights(damaged, "w.json", policy);
      ADD_FAILURE() << why;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(why));
      EXPECT_THAT(error.what(), testing::HasSubstr("w.json"));
    }
  };
  refused("{}", "not a policy's weight file");
  refused(text.substr(0, text.size() / 2), "not a policy's weight file");
  std::string tampered = text;
  tampered[tampered.rfind("0.")] = '7';
  refused(tampered, "hash");
  std::string other = text;
  other.replace(other.find("\"version\":1"), 11, "\"version\":9");
  refused(other, "version 9");
}

TEST_F(WeightsTest, ShippedOnesPreferFrictionLawsTheyHaveNotSeen) {
  read_weights(embedded::udsr_weights(), "shipped", policy);
  const Policy untrained(library, RandomStream(1));
  const std::vector<Sequence> laws = make_corpus(library, prior, 300, 1.0, RandomStream(99));
  std::vector<const Sequence*> pointers;
  for (const Sequence& law : laws) pointers.push_back(&law);
  const std::vector<double> after = policy.log_probabilities(pointers, prior);
  const std::vector<double> before = untrained.log_probabilities(pointers, prior);
  double gain = 0;
  for (std::size_t i = 0; i < laws.size(); ++i) gain += (after[i] - before[i]) / 300;
  EXPECT_GT(gain, 5.0);  // nats a formula
}

TEST(Pretraining, LowersTheLossOnFormulasItHasNotSeen) {
  const TokenLibrary library = pretraining_library();
  PretrainingOptions options;
  options.sequences = 400;
  options.held_out = 200;
  options.epochs = 0;
  Policy policy(library, RandomStream(1));
  const double before = pretrain(policy, nullptr, options, [](double) {}).loss_per_token;
  options.epochs = 6;
  EXPECT_LT(pretrain(policy, nullptr, options, [](double) {}).loss_per_token, 0.97 * before);
}

}  // namespace
}  // namespace tribench::udsr
