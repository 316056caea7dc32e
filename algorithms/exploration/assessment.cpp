// SPDX-License-Identifier: MIT
#include "algorithms/exploration/assessment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/exploration/foresight.hpp"
#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

// Of the prior: what share each number of missing effects has.
constexpr double kNone = 0.2;
constexpr double kOne = 0.25;
constexpr double kUnknown = 0.1;
constexpr double kTwo = 0.25;
constexpr double kWithUnknown = 0.1;
constexpr double kThree = 0.1;

constexpr std::size_t kBlocksInPairs = 6;  // of a family, the best by themselves
constexpr std::size_t kBlocksBesideUnknown = 2;
constexpr std::size_t kBlocksInTriples = 2;
constexpr std::size_t kPairsToExtend = 5;

double log_sum(std::span<const double> logs) {
  if (logs.empty()) return -std::numeric_limits<double>::infinity();
  const double top = *std::ranges::max_element(logs);
  double sum = 0;
  for (const double x : logs) sum += elementary::exp(x - top);
  return top + elementary::log(sum);
}

double choose(double n, int k) { return k == 2 ? n * (n - 1) / 2 : n * (n - 1) * (n - 2) / 6; }

// All explanations with their evidence on one table.
class ExplanationSearch {
 public:
  ExplanationSearch(const ExplanationSpace& space, const EvidenceTable& table)
      : space_(space), table_(table) {
    for (const ExplainingFamily& family : space.families()) {
      (family.unknown ? unknown_ : library_) += 1;
    }
    add({}, {}, 0, elementary::log(kNone));
    add_singles();
    add_pairs();
    add_triples();
  }

  std::vector<Explanation> found;

 private:
  void add(std::vector<std::size_t> families, std::vector<const ColumnBlock*> blocks,
           double log_evidence, double log_prior) {
    Explanation one;
    one.verdict = verdict_of(space_, families);
    one.families = std::move(families);
    one.blocks = std::move(blocks);
    one.log_evidence = log_evidence;
    one.log_prior = log_prior;
    found.push_back(std::move(one));
  }

  void add_singles() {
    const auto& families = space_.families();
    top_.resize(families.size());
    for (std::size_t f = 0; f < families.size(); ++f) {
      std::vector<double> logs;
      std::vector<std::pair<double, const ColumnBlock*>> ranked;
      for (const ColumnBlock& block : families[f].blocks) {
        const std::array<const ColumnBlock*, 1> one = {&block};
        logs.push_back(table_.log_factor(one));
        ranked.emplace_back(logs.back(), &block);
      }
      std::ranges::stable_sort(ranked,
                               [](const auto& a, const auto& b) { return a.first > b.first; });
      for (std::size_t k = 0; k < std::min(ranked.size(), kBlocksInPairs); ++k) {
        top_[f].push_back(ranked[k].second);
      }
      // What lives somewhere is looked for as a whole and where it is most, however narrow.
      if (families[f].unknown) {
        const auto& blocks = families[f].blocks;
        const ColumnBlock& whole = *std::ranges::max_element(blocks, {}, &ColumnBlock::size);
        std::erase(top_[f], &whole);
        top_[f].insert(top_[f].begin(), &whole);
      }
      const bool unknown = families[f].unknown;
      const double prior = unknown ? kUnknown / unknown_ : kOne / library_;
      add({f}, {ranked.front().second},
          log_sum(logs) - elementary::log(static_cast<double>(logs.size())),
          elementary::log(prior));
    }
  }

  // Each combination of the families' best blocks; the others count as nothing.
  void add_set(const std::vector<std::size_t>& families, std::span<const ColumnBlock* const> fixed,
               std::size_t most, double prior) {
    std::vector<double> logs;
    double all = 1;
    for (const std::size_t f : families) {
      all *= static_cast<double>(space_.families()[f].blocks.size());
    }
    std::vector<const ColumnBlock*> best;
    double best_log = -std::numeric_limits<double>::infinity();
    std::vector<const ColumnBlock*> blocks(families.size());
    const auto try_block = [&](auto&& self, std::size_t place) -> void {
      if (place == families.size()) {
        logs.push_back(table_.log_factor(blocks));
        if (logs.back() > best_log) {
          best_log = logs.back();
          best = blocks;
        }
        return;
      }
      if (place < fixed.size()) {
        blocks[place] = fixed[place];
        self(self, place + 1);
        return;
      }
      const auto& top = top_[families[place]];
      for (std::size_t k = 0; k < std::min(most, top.size()); ++k) {
        blocks[place] = top[k];
        self(self, place + 1);
      }
    };
    try_block(try_block, 0);
    add(families, best, log_sum(logs) - elementary::log(all), elementary::log(prior));
  }

  void add_pairs() {
    const auto& families = space_.families();
    for (std::size_t f = 0; f < families.size(); ++f) {
      if (families[f].unknown) continue;
      for (std::size_t g = f + 1; g < families.size(); ++g) {
        const double prior =
            families[g].unknown ? kWithUnknown / (library_ * unknown_) : kTwo / choose(library_, 2);
        // Those of many columns take long.
        add_set({f, g}, {}, families[g].unknown ? kBlocksBesideUnknown : kBlocksInPairs, prior);
      }
    }
  }

  void add_triples() {
    std::vector<std::size_t> pairs;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].families.size() == 2) pairs.push_back(i);
    }
    const auto likelier = [&](std::size_t a, std::size_t b) {
      return found[a].log_evidence + found[a].log_prior >
             found[b].log_evidence + found[b].log_prior;
    };
    std::ranges::stable_sort(pairs, likelier);
    pairs.resize(std::min(pairs.size(), kPairsToExtend));
    std::vector<std::vector<std::size_t>> done;
    for (const std::size_t i : pairs) {
      for (std::size_t f = 0; f < space_.families().size(); ++f) {
        const Explanation pair = found[i];
        if (std::ranges::count(pair.families, f) > 0) continue;
        const bool two_unknown =
            space_.families()[f].unknown && space_.families()[pair.families[1]].unknown;
        std::vector<std::size_t> families = pair.families;
        families.push_back(f);
        std::vector<std::size_t> sorted = families;
        std::ranges::sort(sorted);
        if (two_unknown || std::ranges::count(done, sorted) > 0) continue;
        done.push_back(sorted);
        add_set(families, pair.blocks, kBlocksInTriples, kThree / choose(library_ + unknown_, 3));
      }
    }
  }

  const ExplanationSpace& space_;
  const EvidenceTable& table_;
  double library_ = 0;
  double unknown_ = 0;
  std::vector<std::vector<const ColumnBlock*>> top_;  // per family
};

// Posterior and e-values; the most likely first.
void weigh(std::vector<Explanation>& all) {
  std::vector<double> logs;
  for (const Explanation& one : all) logs.push_back(one.log_prior + one.log_evidence);
  const double total = log_sum(logs);
  for (Explanation& one : all) {
    one.weight = elementary::exp(one.log_prior + one.log_evidence - total);
    one.log_e_value = total - one.log_evidence;
  }
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

// What is left of the target with base and explanation in, by plain least squares with the blocks'
// priors.
Eigen::VectorXd residual_of(const Explanation& one, const Eigen::MatrixXd& base,
                            const Eigen::MatrixXd& columns, const Eigen::VectorXd& target,
                            std::size_t& fitted) {
  ColumnBlock all;
  for (const ColumnBlock* block : one.blocks) all.insert(all.end(), block->begin(), block->end());
  fitted = static_cast<std::size_t>(base.cols()) + all.size();
  Eigen::VectorXd rest = target;
  if (!all.empty()) {
    Eigen::MatrixXd own(columns.rows(), static_cast<Eigen::Index>(all.size()));
    ColumnBlock place;
    for (const Eigen::Index j : all) {
      place.push_back(static_cast<Eigen::Index>(place.size()));
      own.col(place.back()) = columns.col(j);
    }
    const std::array<const ColumnBlock*, 1> block = {&place};
    rest -= own * EvidenceTable(base, own, target).posterior(block).mean;
  }
  return rest - base * least_squares(base, rest);
}

}  // namespace

std::string verdict_of(const ExplanationSpace& space, const std::vector<std::size_t>& families) {
  std::vector<std::string> names;
  std::vector<std::string> inputs;
  for (const std::size_t f : families) {
    const ExplainingFamily& family = space.families()[f];
    if (family.unknown) continue;
    names.push_back(family.name);
    inputs.insert(inputs.end(), family.inputs.begin(), family.inputs.end());
  }
  const bool elsewhere = std::ranges::any_of(families, [&](std::size_t f) {
    const ExplainingFamily& family = space.families()[f];
    return family.unknown && std::ranges::any_of(family.inputs, [&](const std::string& input) {
             return std::ranges::count(inputs, input) == 0;
           });
  });
  std::ranges::sort(names);
  if (elsewhere) names.emplace_back(kUnknownVerdict);
  return names.empty() ? "NONE" : fmt::format("{}", fmt::join(names, "+"));
}

bool Assessment::sure() const {
  return std::ranges::all_of(
      alive, [&](std::size_t i) { return explanations[i].verdict == best().verdict; });
}

double Assessment::weight_of(const std::string& verdict) const {
  double sum = 0;
  for (const Explanation& one : explanations) sum += one.verdict == verdict ? one.weight : 0;
  return sum;
}

Assessment assess(const ExplanationSpace& space, const Observations& rows,
                  const Observations& foreseen, double alpha, const Explanation& before) {
  Assessment out;
  // Together: what a smoother's interval is follows from all rows it is asked for.
  const std::array<const Observations*, 2> parts = {&rows, &foreseen};
  const Eigen::MatrixXd all = space.columns(joined(parts));
  const auto count = static_cast<Eigen::Index>(rows.rows());
  out.base = space.base_columns(rows);
  out.columns = all.topRows(count);
  out.foreseen_base = space.base_columns(foreseen);
  out.foreseen_columns = all.bottomRows(all.rows() - count);
  const Eigen::VectorXd target = target_vector(rows);
  Clusters clusters = make_clusters(rows.movement, 1);
  std::size_t fitted = 0;
  const Eigen::VectorXd rest = residual_of(before, out.base, out.columns, target, fitted);
  const double floor = 1e-9 * std::sqrt(target.squaredNorm() / static_cast<double>(rows.rows()));
  clusters.weight = movement_weights(rest, clusters);
  out.noise = estimate_noise(rest, clusters, fitted, floor);
  out.noise.whitening = out.noise.rho;
  out.base = whitened(std::move(out.base), clusters, out.noise);
  out.columns = whitened(std::move(out.columns), clusters, out.noise);
  out.table = EvidenceTable(out.base, out.columns, whitened(target, clusters, out.noise));
  ExplanationSearch search(space, out.table);
  weigh(search.found);
  out.explanations = std::move(search.found);
  out.variance = out.table.posterior(out.best().blocks).variance;
  const double limit = -elementary::log(alpha);
  for (std::size_t i = 0; i < out.explanations.size(); ++i) {
    if (out.explanations[i].log_e_value < limit) out.alive.push_back(i);
  }
  return out;
}

}  // namespace tribench::loop
