// SPDX-License-Identifier: MIT
#include "algorithms/udsr/data_encoder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/udsr/policy.hpp"
#include "algorithms/udsr/pretraining.hpp"
#include "foundation/error.hpp"

namespace tribench::udsr::data_encoder_test {
namespace {

struct Fixture {
  TokenLibrary library{find_operator_set("paper"), 2, {.constants = false, .linear = true}};
  Prior prior{library, {}, {{1, 1}, -1, 1}};
  Policy policy{library, RandomStream(5)};
  DataEncoder encoder{RandomStream(6)};
  Eigen::MatrixXd features = Eigen::MatrixXd::Zero(DataEncoder::kFeatures, 12);

  // Every weight away from zero, so that no part of a gradient vanishes by symmetry.
  Fixture() {
    RandomStream random(7);
    for (double& p : policy.parameters()) p = 0.4 * random.normal();
    for (double& p : encoder.parameters()) p = 0.4 * random.normal();
    for (Eigen::Index k = 0; k < features.cols(); ++k) {
      for (Eigen::Index j = 0; j < features.rows(); ++j) features(j, k) = random.normal();
    }
  }
};

TEST(DataEncoder, GradientThroughThePolicyAgreesWithFiniteDifferences) {
  Fixture f;
  const std::vector<Sequence> sequences = f.policy.sample(5, f.prior, RandomStream(8));
  const auto loss_of = [&](Eigen::VectorXd& gradient, Eigen::MatrixXd& starts) {
    const Eigen::VectorXd start = f.encoder.encode(f.features);
    std::vector<WeightedSequence> batch;
    for (std::size_t i = 0; i < sequences.size(); ++i) {
      batch.push_back({&sequences[i], 0.3 + 0.2 * static_cast<double>(i), 0.05, &start});
    }
    return f.policy.loss(batch, f.prior, 0.7, gradient, &starts);
  };
  Eigen::VectorXd policy_gradient;
  Eigen::MatrixXd starts;
  loss_of(policy_gradient, starts);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(DataEncoder::size());
  for (Eigen::Index i = 0; i < starts.cols(); ++i) {
    f.encoder.add_gradient(f.features, starts.col(i), gradient);
  }
  Eigen::VectorXd unused;
  Eigen::MatrixXd unused_starts;
  const auto expect_slope = [&](double& parameter, double slope) {
    constexpr double kStep = 1e-5;
    const double value = parameter;
    parameter = value + kStep;
    const double up = loss_of(unused, unused_starts);
    parameter = value - kStep;
    const double down = loss_of(unused, unused_starts);
    parameter = value;
    EXPECT_NEAR(slope, (up - down) / (2 * kStep), 1e-6 * (1 + std::abs(slope)));
  };
  for (Eigen::Index i = 0; i < gradient.size(); i += 7) {
    expect_slope(f.encoder.parameters()[i], gradient[i]);
  }
  // The recurrent weights see the first state too.
  RandomStream pick(9);
  for (int k = 0; k < 100; ++k) {
    const auto i =
        static_cast<Eigen::Index>(pick.below(static_cast<std::uint64_t>(policy_gradient.size())));
    expect_slope(f.policy.parameters()[i], policy_gradient[i]);
  }
}

TEST(DataEncoder, DoesNotSeeTheOrderOfTheRows) {
  const Fixture f;
  const Eigen::MatrixXd reversed = f.features.rowwise().reverse();
  EXPECT_LT((f.encoder.encode(f.features) - f.encoder.encode(reversed)).cwiseAbs().maxCoeff(),
            1e-14);
}

TEST(DataEncoder, SeesTheTargetAndNotItsUnit) {
  const Fixture f;
  const std::vector<double> v = {-1, -0.5, 0.5, 1};
  const std::vector<double> y = {1, 0.25, 0.25, 1};
  const std::vector<double> other = {-1, -0.5, 0.5, 1};
  std::vector<double> scaled;
  for (const double value : y) scaled.push_back(1000 * value + 7);
  const std::vector<const double*> columns = {v.data()};
  const auto code = [&](const std::vector<double>& target) {
    return f.encoder.encode(DataEncoder::features({columns, 4}, target));
  };
  EXPECT_LT((code(y) - code(scaled)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((code(y) - code(other)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(DataEncoder, UntrainedLeavesThePolicyAsItIs) {
  Fixture f;
  const std::vector<Sequence> before = f.policy.sample(50, f.prior, RandomStream(10));
  f.policy.begin_from(DataEncoder(RandomStream(11)).encode(f.features));
  EXPECT_EQ(before, f.policy.sample(50, f.prior, RandomStream(10)));
  f.policy.begin_from(f.encoder.encode(f.features));
  EXPECT_NE(before, f.policy.sample(50, f.prior, RandomStream(10)));
}

TEST(DataEncoder, LetsThePolicyTellLawsApartByTheirRows) {
  // Two formulas, as likely as each other: only the rows say which it is.
  const TokenLibrary library = pretraining_library();
  PretrainingOptions options;
  options.sequences = 400;
  options.held_out = 200;
  options.epochs = 8;
  Policy blind(library, RandomStream(1));
  const double without = pretrain(blind, nullptr, options, [](double) {}).loss_per_token;
  Policy seeing(library, RandomStream(1));
  DataEncoder encoder(RandomStream(2));
  const double with = pretrain(seeing, &encoder, options, [](double) {}).loss_per_token;
  EXPECT_LT(with, without);
}

TEST(DataEncoder, IsKeptInTheWeightFileAndAskedForOnlyWhereItIs) {
  const Fixture f;
  Fixture g;
  DataEncoder rounded = f.encoder;
  for (double& p : rounded.parameters()) p = static_cast<float>(p);
  const std::string with = write_weights(f.policy, &rounded, {"test", 1, 2, 3});
  EXPECT_EQ(read_encoder(with, "w.json").parameters(), rounded.parameters());
  read_weights(with, "w.json", g.policy);
  EXPECT_EQ(g.policy.parameters().cast<float>(), f.policy.parameters().cast<float>());
  const std::string without = write_weights(f.policy, nullptr, {"test", 1, 2, 3});
  EXPECT_THROW(read_encoder(without, "w.json"), Error);
  std::string tampered = with;
  tampered[tampered.rfind("0.")] = '7';
  EXPECT_THROW(read_encoder(tampered, "w.json"), Error);
}

}  // namespace
}  // namespace tribench::udsr::data_encoder_test
