// SPDX-License-Identifier: MIT
#include "algorithms/exploration/explanation_search.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "foundation/elementary.hpp"

namespace tribench::loop {
namespace {

// Of the prior: what share each number of missing effects has, all of the library or one of them
// of none; three take half of what more take, four a quarter, ...
constexpr double kNone = 0.2;
constexpr double kOne = 0.25;
constexpr double kUnknown = 0.1;
constexpr double kTwo = 0.25;
constexpr double kWithUnknown = 0.1;
constexpr double kMore = 0.07;
constexpr double kMoreWithUnknown = 0.03;

constexpr std::size_t kSinglesToExtend = 3;
constexpr std::size_t kPairsToExtend = 3;
constexpr std::size_t kMostFamilies = 8;
constexpr std::size_t kNarrowBlocks = 6;  // of one column, that are looked at in earnest

// Of a column's squares, in the noise's: a coefficient of the expected size shows.
constexpr double kVisited = 20;

// Of a block the columns with these numbers in it.
EffectBlock part_of(const EffectBlock& block, const ColumnBlock& kept) {
  if (kept.size() == block.columns.size()) return block;
  EffectBlock part{{}, block.size, block.misfit};
  for (const Eigen::Index k : kept)
    part.columns.push_back(block.columns[static_cast<std::size_t>(k)]);
  if (block.metric.size() > 0) {
    part.metric = block.metric(kept, kept);
    part.metric /= part.metric.trace();
  }
  if (block.shared.size() > 0) part.shared = block.shared(kept, Eigen::all);
  return part;
}

class ExplanationSearch {
 public:
  ExplanationSearch(const ExplanationSpace& space, const EvidenceTable& table)
      : families_(space.families()), space_(space), table_(table) {
    for (const ExplainingFamily& family : families_) {
      out.blocks.push_back(visited(family));
      (family.unknown ? unknown_ : library_) += 1;
    }
  }

  FoundExplanations out;

  void run() {
    out.explanations.push_back(made({}, {}, 0));
    extend(0);
    const std::vector<std::size_t> singles = likeliest(1, kSinglesToExtend);
    for (const std::size_t i : singles) extend(i);
    const std::vector<std::size_t> pairs = likeliest(2, kPairsToExtend);
    add_other_pairs();
    for (const std::size_t i : pairs) extend(i);
    // A real joint may lack more: as long as what was last laid beside the others is likelier than
    // all without it.
    for (std::size_t size = 3; size < kMostFamilies; ++size) {
      const std::size_t best = likeliest_of_all();
      if (out.explanations[best].families.size() != size) break;
      extend(best);
    }
  }

 private:
  // What lives in a temperature is judged at those that came, as none comes at will: at others it
  // may be anything. Places, speeds and times can be visited; until then nothing there is ruled
  // out.
  std::vector<EffectBlock> visited(const ExplainingFamily& family) const {
    const std::string temperature(role_name(Role::temperature));
    if (!family.unknown || std::ranges::count(family.inputs, temperature) == 0) {
      return family.blocks;
    }
    std::vector<EffectBlock> all;
    for (const EffectBlock& block : family.blocks) {
      ColumnBlock seen;
      for (std::size_t k = 0; k < block.columns.size(); ++k) {
        const Eigen::Index j = block.columns[k];
        if (table_.gram()(j, j) * block.size * block.size < kVisited) continue;
        seen.push_back(static_cast<Eigen::Index>(k));
      }
      if (!seen.empty()) all.push_back(part_of(block, seen));
    }
    return all;
  }

  // Alike for all sets of as many effects, with or without one of no library.
  double log_prior_of(std::span<const std::size_t> families) const {
    const bool unknown =
        std::ranges::any_of(families, [&](std::size_t f) { return families_[f].unknown; });
    const std::size_t known = families.size() - (unknown ? 1 : 0);
    double share = kNone;
    if (families.size() == 1) share = unknown ? kUnknown : kOne;
    if (families.size() == 2) share = unknown ? kWithUnknown : kTwo;
    if (families.size() > 2) {
      share = std::ldexp(unknown ? kMoreWithUnknown : kMore, 2 - static_cast<int>(families.size()));
    }
    double sets = unknown ? unknown_ : 1;
    for (std::size_t k = 0; k < known; ++k) {
      sets *= (library_ - static_cast<double>(k)) / static_cast<double>(k + 1);
    }
    return elementary::log(share / sets);
  }

  Explanation made(std::vector<std::size_t> families, std::vector<const EffectBlock*> blocks,
                   double log_evidence) const {
    Explanation one;
    one.log_prior = log_prior_of(families);
    one.verdict = verdict_of(space_, families);
    one.families = std::move(families);
    one.blocks = std::move(blocks);
    one.log_evidence = log_evidence;
    return one;
  }

  // Of a family's blocks those that are worth a system of equations beside what is there already.
  std::vector<const EffectBlock*> candidates(std::size_t family,
                                             const Eigen::VectorXd& left) const {
    std::vector<const EffectBlock*> wide;
    std::vector<std::pair<double, const EffectBlock*>> narrow;
    for (const EffectBlock& block : out.blocks[family]) {
      if (block.columns.size() > 1 || !families_[family].unknown) {
        wide.push_back(&block);
        continue;
      }
      const Eigen::Index j = block.columns.front();
      const double precision = 1 / (block.size * block.size);
      narrow.emplace_back(left[j] * left[j] / (table_.gram()(j, j) + precision), &block);
    }
    const std::size_t kept = std::min(narrow.size(), kNarrowBlocks);
    std::ranges::stable_sort(narrow,
                             [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t k = 0; k < kept; ++k) wide.push_back(narrow[k].second);
    return wide;
  }

  // Whether every block that has one draws its curve of speed: else another family draws it.
  bool draw_their_curves(const std::vector<const EffectBlock*>& blocks) const {
    std::vector<SpeedCurve> curves;
    for (const EffectBlock* block : blocks) curves.push_back(space_.curve_of(*block));
    const auto has_curve = [](SpeedCurve curve) { return curve != SpeedCurve::any; };
    if (std::ranges::none_of(curves, has_curve)) return true;
    const EvidenceTable::Posterior found = table_.posterior(blocks);
    const ExplanationSpace::Speeds& speeds = space_.speeds();
    const Eigen::VectorXd base = speeds.base * found.base;
    Eigen::Index own = 0;
    Eigen::Index misfit = 0;
    for (const EffectBlock* block : blocks) misfit += std::ssize(block->columns);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const ColumnBlock& columns = blocks[k]->columns;
      const ColumnBlock& further = blocks[k]->misfit;
      if (has_curve(curves[k])) {
        const Eigen::VectorXd friction =
            base +
            speeds.columns(Eigen::all, columns) * found.mean.segment(own, std::ssize(columns)) +
            speeds.columns(Eigen::all, further) * found.mean.segment(misfit, std::ssize(further));
        const bool falls = falls_with_speed({friction.data(), speeds.v.size()}, speeds.v);
        if (falls != (curves[k] == SpeedCurve::falls)) return false;
      }
      own += std::ssize(columns);
      misfit += std::ssize(further);
    }
    return true;
  }

  // Every further family beside explanation i, all of its blocks.
  void extend(std::size_t i) {
    const Explanation from = out.explanations[i];
    const double before = table_.log_factor(from.blocks);
    const Eigen::VectorXd left = table_.left_of_products(from.blocks);
    const bool has_unknown =
        std::ranges::any_of(from.families, [&](std::size_t f) { return families_[f].unknown; });
    for (std::size_t f = 0; f < families_.size(); ++f) {
      if (out.blocks[f].empty() || (has_unknown && families_[f].unknown)) continue;
      if (std::ranges::count(from.families, f) > 0) continue;
      std::vector<std::size_t> families = from.families;
      families.push_back(f);
      std::vector<const EffectBlock*> blocks = from.blocks;
      blocks.push_back(nullptr);
      const EffectBlock* best = nullptr;
      std::vector<double> logs;
      for (const EffectBlock* block : candidates(f, left)) {
        blocks.back() = block;
        if (!draw_their_curves(blocks)) continue;
        const double log = table_.log_factor(blocks);
        if (best == nullptr || log > *std::ranges::max_element(logs)) best = block;
        logs.push_back(log);
      }
      if (best == nullptr) continue;
      blocks.back() = best;
      const double mean =
          log_sum(logs) - elementary::log(static_cast<double>(out.blocks[f].size()));
      add(made(std::move(families), std::move(blocks), from.log_evidence + mean - before));
    }
  }

  // A set may be reached in several ways: the likeliest counts.
  void add(Explanation one) {
    std::vector<std::size_t> key = one.families;
    std::ranges::sort(key);
    const auto [place, is_new] = place_.try_emplace(key, out.explanations.size());
    if (is_new) {
      out.explanations.push_back(std::move(one));
    } else if (one.log_evidence > out.explanations[place->second].log_evidence) {
      out.explanations[place->second] = std::move(one);
    }
  }

  void add_other_pairs() {
    std::vector<Explanation> singles;
    for (const Explanation& one : out.explanations) {
      if (one.families.size() == 1) singles.push_back(one);
    }
    for (std::size_t a = 0; a < singles.size(); ++a) {
      for (std::size_t b = a + 1; b < singles.size(); ++b) {
        const std::size_t f = singles[a].families.front();
        const std::size_t g = singles[b].families.front();
        if ((families_[f].unknown && families_[g].unknown) || place_.contains({f, g})) continue;
        add(made({f, g}, {singles[a].blocks.front(), singles[b].blocks.front()},
                 std::min(singles[a].log_evidence + singles[b].log_evidence,
                          std::max(singles[a].log_evidence, singles[b].log_evidence))));
      }
    }
  }

  double log_weight(std::size_t i) const {
    return out.explanations[i].log_evidence + out.explanations[i].log_prior;
  }

  std::size_t likeliest_of_all() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < out.explanations.size(); ++i) {
      if (log_weight(i) > log_weight(best)) best = i;
    }
    return best;
  }

  // Numbers of the likeliest explanations of so many families.
  std::vector<std::size_t> likeliest(std::size_t families, std::size_t most) const {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < out.explanations.size(); ++i) {
      if (out.explanations[i].families.size() == families) all.push_back(i);
    }
    std::ranges::stable_sort(
        all, [&](std::size_t a, std::size_t b) { return log_weight(a) > log_weight(b); });
    all.resize(std::min(all.size(), most));
    return all;
  }

  const std::vector<ExplainingFamily>& families_;
  const ExplanationSpace& space_;
  const EvidenceTable& table_;
  double library_ = 0;
  double unknown_ = 0;
  std::map<std::vector<std::size_t>, std::size_t> place_;  // by sorted families
};

}  // namespace

double log_sum(std::span<const double> logs) {
  if (logs.empty()) return -std::numeric_limits<double>::infinity();
  const double top = *std::ranges::max_element(logs);
  double sum = 0;
  for (const double x : logs) sum += elementary::exp(x - top);
  return top + elementary::log(sum);
}

FoundExplanations find_explanations(const ExplanationSpace& space, const EvidenceTable& table) {
  ExplanationSearch search(space, table);
  search.run();
  return std::move(search.out);
}

std::string verdict_of(const ExplanationSpace& space, const std::vector<std::size_t>& families) {
  std::vector<std::string> names;
  bool elsewhere = false;
  for (const std::size_t f : families) {
    const ExplainingFamily& family = space.families()[f];
    if (!family.unknown) {
      names.push_back(family.name);
      continue;
    }
    elsewhere = std::ranges::none_of(families, [&](std::size_t g) {
      const ExplainingFamily& other = space.families()[g];
      const auto is_in = [&](const std::vector<std::string>& inputs) {
        return [&](const std::string& input) { return std::ranges::count(inputs, input) > 0; };
      };
      return !other.unknown && std::ranges::all_of(family.inputs, is_in(other.inputs)) &&
             std::ranges::any_of(family.inputs, is_in(other.characteristic));
    });
  }
  return verdict_text(std::move(names), elsewhere);
}

std::string verdict_text(std::vector<std::string> names, bool unknown) {
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (unknown) names.emplace_back(kUnknownVerdict);
  return names.empty() ? "NONE" : fmt::format("{}", fmt::join(names, "+"));
}

}  // namespace tribench::loop
