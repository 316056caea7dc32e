// SPDX-License-Identifier: MIT
//
// Trains the policy before it has seen any data: maximum likelihood on formulas drawn from the
// token library under the prior, and on friction laws. What it learns is a prior over formulas.
//
// Source: Landajuela et al. 2022, section 3.4 (large-scale pre-training), whose corpus and weights
// were never published. Ours is small and made by one command. With a data encoder each formula of
// the corpus comes with rows made from it, and the encoder learns with the policy.
#pragma once

#include <cstdint>
#include <functional>

#include "algorithms/udsr/data_encoder.hpp"
#include "algorithms/udsr/policy.hpp"
#include "algorithms/udsr/weights.hpp"

namespace tribench::udsr {

struct PretrainingOptions {
  std::uint64_t seed = 1;
  int sequences = 20000;  // in the training corpus
  int held_out = 1000;
  int epochs = 5;
  int batch = 200;
  double learning_rate = 2e-3;
  double friction_share = 0.5;  // of the corpus; the rest comes from the library under the prior
};

// The operations of the shipped weights, eight inputs, constants and the linear token. That is all
// but atan, which is younger and in no friction law: what weights do not know begins untrained.
TokenLibrary pretraining_library();

// A friction law in tokens: inputs x1, x2 = sgn x1 and, in some, x3, x4 = sgn x3 (a load). Not
// every draw keeps the constraints of the prior.
Sequence friction_law(const TokenLibrary& library, RandomStream& random);

// A corpus whose sequences all keep the constraints.
std::vector<Sequence> make_corpus(const TokenLibrary& library, const Prior& prior, int size,
                                  double friction_share, const RandomStream& random);

// Features of rows that a formula could have made: constants and the linear token's coefficients
// N(0, 1), inputs uniform on [-1, 1], in three of four draws each even one the sign of the one
// before it, noise of a hundredth. No rows where the formula is not finite on most of them.
Eigen::MatrixXd imagined_features(const TokenLibrary& library, const Sequence& sequence,
                                  RandomStream random);

// progress(done) is told the share of the work done, 0 to 1. Returns where the weights came from.
// encoder: trained along, where there is one.
WeightsProvenance pretrain(Policy& policy, DataEncoder* encoder, const PretrainingOptions& options,
                           const std::function<void(double)>& progress);

}  // namespace tribench::udsr
