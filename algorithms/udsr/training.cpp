// SPDX-License-Identifier: MIT
#include "algorithms/udsr/training.hpp"

#include <algorithm>
#include <cmath>

#include "foundation/elementary.hpp"

namespace tribench::udsr {
namespace {

// The kept part of one step's samples.
struct Kept {
  std::vector<const Sequence*> sequences;
  std::vector<double> rewards;
  double quantile = 0;
};

struct Batch {
  std::vector<Sequence> sequences;
  std::vector<double> rewards;
};

Kept keep_best(const Batch& batch, double epsilon) {
  Kept kept;
  kept.quantile = reward_quantile(batch.rewards, epsilon);
  for (std::size_t i = 0; i < batch.sequences.size(); ++i) {
    if (batch.rewards[i] < kept.quantile || batch.rewards[i] <= 0) continue;
    kept.sequences.push_back(&batch.sequences[i]);
    kept.rewards.push_back(batch.rewards[i]);
  }
  return kept;
}

class Trainer {
 public:
  Trainer(Policy& policy, const Prior& prior, const TrainingOptions& options,
          Scoreboard& scoreboard)
      : policy_(policy),
        prior_(prior),
        options_(options),
        scoreboard_(scoreboard),
        adam_(policy.parameters().size(), options.learning_rate) {}

  Batch sample(const RandomStream& random) {
    Batch batch;
    batch.sequences =
        policy_.sample(static_cast<std::size_t>(options_.batch), prior_, random.split("sample"));
    batch.rewards = scoreboard_.rewards(batch.sequences);
    if (!options_.genetic || scoreboard_.exhausted()) return batch;
    for (Elite& elite : evolve(batch.sequences, batch.rewards, prior_, options_.gp,
                               policy_.library(), random.split("genetic"), scoreboard_)) {
      batch.sequences.push_back(std::move(elite.sequence));
      batch.rewards.push_back(elite.reward);
    }
    return batch;
  }

  void update(const Batch& batch, const RandomStream& random) {
    if (options_.update == PolicyUpdate::none) return;
    const Kept kept = keep_best(batch, options_.epsilon);
    if (kept.sequences.empty()) return;
    switch (options_.update) {
      case PolicyUpdate::risk_seeking:
        return risk_seeking(kept);
      case PolicyUpdate::priority_queue:
        return priority_queue(kept);
      default:
        return ppo(kept, random.split("minibatches"));
    }
  }

 private:
  double baseline(const Kept& kept) {
    double mean = 0;
    for (const double r : kept.rewards) mean += r;
    mean /= static_cast<double>(kept.rewards.size());
    switch (options_.baseline) {
      case Baseline::quantile:
        return kept.quantile;
      case Baseline::moving_mean:
        return moving_average(mean);
      case Baseline::moving_quantile:
        return moving_average(kept.quantile);
      default:
        return kept.quantile + moving_average(mean - kept.quantile);
    }
  }

  double moving_average(double value) {
    const double decay = options_.baseline_decay;
    average_ = has_average_ ? decay * value + (1 - decay) * average_ : value;
    has_average_ = true;
    return average_;
  }

  std::vector<WeightedSequence> weighted(const Kept& kept, double b) const {
    const double n = static_cast<double>(kept.sequences.size());
    std::vector<WeightedSequence> items;
    for (std::size_t i = 0; i < kept.sequences.size(); ++i) {
      items.push_back({kept.sequences[i], (kept.rewards[i] - b) / n, options_.entropy_weight / n});
    }
    return items;
  }

  void descend(const std::vector<WeightedSequence>& items) {
    Eigen::VectorXd gradient;
    policy_.loss(items, prior_, options_.entropy_gamma, gradient);
    adam_.step(gradient, policy_.parameters());
  }

  void risk_seeking(const Kept& kept) { descend(weighted(kept, baseline(kept))); }

  // The policy gradient, and maximum likelihood of the best formulas ever seen.
  void priority_queue(const Kept& kept) {
    std::vector<WeightedSequence> items = weighted(kept, baseline(kept));
    const std::size_t size =
        std::min(scoreboard_.best().size(), static_cast<std::size_t>(options_.queue_size));
    for (std::size_t i = 0; i < size; ++i) {
      items.push_back({&scoreboard_.best()[i].sequence,
                       options_.queue_weight / static_cast<double>(size), 0.0});
    }
    descend(items);
  }

  // The clipped surrogate's gradient is that of advantage * ratio * log p where it is not clipped.
  void ppo(const Kept& kept, const RandomStream& random) {
    const double b = baseline(kept);
    const std::vector<double> old = policy_.log_probabilities(kept.sequences, prior_);
    const std::size_t parts =
        std::min(kept.sequences.size(), static_cast<std::size_t>(options_.ppo_minibatches));
    for (int k = 0; k < options_.ppo_iterations; ++k) {
      std::vector<std::size_t> order(kept.sequences.size());
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
      RandomStream shuffling = random.split(static_cast<std::uint64_t>(k));
      shuffling.shuffle(std::span(order));
      for (std::size_t part = 0; part < parts; ++part) {
        Kept mini;
        std::vector<double> old_mini;
        for (std::size_t i = part; i < order.size(); i += parts) {
          mini.sequences.push_back(kept.sequences[order[i]]);
          mini.rewards.push_back(kept.rewards[order[i]]);
          old_mini.push_back(old[order[i]]);
        }
        descend(clipped(mini, b, old_mini));
      }
    }
  }

  std::vector<WeightedSequence> clipped(const Kept& mini, double b,
                                        const std::vector<double>& old) const {
    std::vector<WeightedSequence> items = weighted(mini, b);
    const std::vector<double> now = policy_.log_probabilities(mini.sequences, prior_);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const double ratio = elementary::exp(now[i] - old[i]);
      const bool improves = items[i].advantage > 0;
      const bool is_clipped =
          improves ? ratio > 1 + options_.ppo_clip : ratio < 1 - options_.ppo_clip;
      items[i].advantage *= is_clipped ? 0.0 : ratio;
    }
    return items;
  }

  Policy& policy_;
  const Prior& prior_;
  const TrainingOptions& options_;
  Scoreboard& scoreboard_;
  Adam adam_;
  double average_ = 0;
  bool has_average_ = false;
};

}  // namespace

double reward_quantile(std::vector<double> rewards, double epsilon) {
  if (rewards.empty()) return 0;
  std::ranges::sort(rewards);
  const double place = (1 - epsilon) * static_cast<double>(rewards.size() - 1);
  return rewards[static_cast<std::size_t>(std::ceil(place))];
}

void train(Policy& policy, const Prior& prior, const TrainingOptions& options,
           const RandomStream& random, Scoreboard& scoreboard) {
  Trainer trainer(policy, prior, options, scoreboard);
  int since_better = 0;
  // An improvement in the sixth digit of the reward is not a reason to go on.
  constexpr double kBetter = 1e-5;
  for (int step = 0; step < options.max_steps && since_better < options.patience; ++step) {
    const double before = scoreboard.best_reward();
    const RandomStream part = random.split(static_cast<std::uint64_t>(step));
    const Batch batch = trainer.sample(part);
    const double nmse = scoreboard.best_nrmse() * scoreboard.best_nrmse();
    if (nmse < options.success_nmse || scoreboard.exhausted()) return;
    trainer.update(batch, part);
    since_better = scoreboard.best_reward() > before + kBetter ? 0 : since_better + 1;
  }
}

}  // namespace tribench::udsr
