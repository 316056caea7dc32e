// SPDX-License-Identifier: MIT
//
// Trains the policy on one problem: sample, score, let genetic programming improve the batch, push
// the policy towards the best.
//
// Sources: risk-seeking policy gradient with hierarchical entropy, Petersen et al. 2021, section
// 3.2, and Landajuela et al. 2021; priority-queue training, Abolafia et al. 2018; PPO, Schulman et
// al. 2017. Defaults: the public code's config_regression.json.
#pragma once

#include <string>

#include "algorithms/udsr/genetic.hpp"
#include "algorithms/udsr/policy.hpp"
#include "algorithms/udsr/population.hpp"

namespace tribench::udsr {

enum class PolicyUpdate { none, risk_seeking, priority_queue, ppo };
// What a kept reward is compared with: the quantile (the published default, R_e), a moving average
// of the kept rewards' mean (ewma_R) or of the quantile (ewma_R_e), or the quantile plus a moving
// average of the mean's distance from it (combined).
enum class Baseline { quantile, moving_mean, moving_quantile, combined };

struct TrainingOptions {
  int batch = 500;
  int max_steps = 200;
  int patience = 60;      // steps without a better formula before stopping
  double epsilon = 0.05;  // share of the batch that is kept; 0.02 with GP in the original
  double learning_rate = 5e-4;
  double entropy_weight = 0.03;
  double entropy_gamma = 0.7;
  double baseline_decay = 0.5;
  int queue_size = 10;
  double queue_weight = 200;
  double ppo_clip = 0.2;
  int ppo_iterations = 10;
  int ppo_minibatches = 4;
  PolicyUpdate update = PolicyUpdate::risk_seeking;
  Baseline baseline = Baseline::quantile;
  bool genetic = true;
  GeneticOptions gp;
  // Squared: the normalised mean squared error at which the problem counts as solved.
  double success_nmse = 1e-12;
};

// Runs until solved, out of budget, out of patience or out of steps.
void train(Policy& policy, const Prior& prior, const TrainingOptions& options,
           const RandomStream& random, Scoreboard& scoreboard);

// The (1 - epsilon) quantile by the "higher" rule: the smallest reward that at least a share
// 1 - epsilon of all does not exceed.
double reward_quantile(std::vector<double> rewards, double epsilon);

}  // namespace tribench::udsr
