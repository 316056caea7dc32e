// SPDX-License-Identifier: MIT
#include "algorithms/pysr/feature_selection.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tribench::pysr {
namespace {

constexpr int kTrees = 100;
constexpr int kDepth = 3;

// Rows of one node, or of the left of a split: how many (bootstrap counts), and their target's sum.
struct Group {
  double count = 0;
  double sum = 0;

  void add(double weight, double target) {
    count += weight;
    sum += weight * target;
  }
  Group without(const Group& part) const { return {count - part.count, sum - part.sum}; }
  double square() const { return count > 0 ? sum * sum / count : 0; }
};

struct Split {
  std::size_t input = 0;
  double threshold = std::numeric_limits<double>::infinity();  // larger values go right
  double gain = 0;                                             // fall of the squared error
};

// All trees share the order of the rows by each input; a tree is grown level by level, every node
// of a level in one pass over each input.
class Forest {
 public:
  Forest(const Rows& rows, std::size_t inputs) : rows_(rows), centred_(rows.target) {
    const double mean = std::accumulate(centred_.begin(), centred_.end(), 0.0) /
                        static_cast<double>(centred_.size());
    for (double& value : centred_) value -= mean;
    for (std::size_t j = 0; j < inputs; ++j) {
      std::vector<std::size_t> order(rows.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, {}, [&](std::size_t r) { return rows.columns[j][r]; });
      orders_.push_back(std::move(order));
    }
  }

  // Shares of the inputs in one tree on rows drawn with replacement.
  std::vector<double> tree(RandomStream random) {
    weights_.assign(rows_.size(), 0.0);
    for (std::size_t r = 0; r < rows_.size(); ++r) weights_[random.below(rows_.size())] += 1;
    nodes_.assign(rows_.size(), 0);
    std::vector<double> gains(orders_.size(), 0.0);
    for (int level = 0; level < kDepth; ++level) {
      const std::vector<Split> splits = best_splits(std::size_t{1} << level);
      for (const Split& split : splits) gains[split.input] += split.gain;
      descend(splits);
    }
    const double total = std::accumulate(gains.begin(), gains.end(), 0.0);
    for (double& gain : gains) gain = total > 0 ? gain / total : 0;
    return gains;
  }

 private:
  std::vector<Split> best_splits(std::size_t nodes) const {
    std::vector<Group> whole(nodes);
    for (std::size_t r = 0; r < rows_.size(); ++r) whole[nodes_[r]].add(weights_[r], centred_[r]);
    std::vector<Split> best(nodes);
    for (std::size_t j = 0; j < orders_.size(); ++j) improve(j, whole, best);
    return best;
  }

  // Takes a split on input j where it is better than the node's best so far.
  void improve(std::size_t j, const std::vector<Group>& whole, std::vector<Split>& best) const {
    std::vector<Group> left(whole.size());
    std::vector<double> last(whole.size(), 0.0);
    for (const std::size_t r : orders_[j]) {
      if (weights_[r] == 0) continue;
      const std::size_t node = nodes_[r];
      const double value = rows_.columns[j][r];
      if (left[node].count > 0 && value > last[node]) {
        const Group right = whole[node].without(left[node]);
        const double gain = left[node].square() + right.square() - whole[node].square();
        // Half way, unless that rounds up to the value.
        const double middle = last[node] + (value - last[node]) / 2;
        if (gain > best[node].gain) best[node] = {j, middle < value ? middle : last[node], gain};
      }
      left[node].add(weights_[r], centred_[r]);
      last[node] = value;
    }
  }

  void descend(const std::vector<Split>& splits) {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Split& split = splits[nodes_[r]];
      nodes_[r] = 2 * nodes_[r] + (rows_.columns[split.input][r] > split.threshold ? 1 : 0);
    }
  }

  const Rows& rows_;
  std::vector<double> centred_;
  std::vector<std::vector<std::size_t>> orders_;
  std::vector<double> weights_;
  std::vector<std::size_t> nodes_;  // of each row, within its level
};

}  // namespace

std::vector<double> forest_importances(const Rows& rows, std::size_t inputs, RandomStream random,
                                       Budget& budget) {
  const Rows seen = draw_sample(rows, kForestRows, random);
  const std::uint64_t cost = static_cast<std::uint64_t>(kTrees * kDepth) * inputs * seen.size();
  if (cost > budget.remaining() || !budget.spend(cost)) return {};
  Forest forest(seen, inputs);
  std::vector<double> shares(inputs, 0.0);
  const RandomStream trees = random.split("trees");
  for (int t = 0; t < kTrees; ++t) {
    const std::vector<double> tree = forest.tree(trees.split(static_cast<std::uint64_t>(t)));
    for (std::size_t j = 0; j < inputs; ++j) shares[j] += tree[j] / kTrees;
  }
  return shares;
}

std::vector<std::size_t> most_important(std::span<const double> importances, std::size_t count) {
  std::vector<std::size_t> places(importances.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, std::ranges::greater{},
                           [&](std::size_t j) { return importances[j]; });
  places.resize(std::min(count, places.size()));
  std::ranges::sort(places);
  return places;
}

}  // namespace tribench::pysr
