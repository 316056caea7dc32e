// SPDX-License-Identifier: MIT
#include "reports/proofs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "reports/markdown.hpp"
#include "reports/run_folder.hpp"

namespace tribench {
namespace {

constexpr const char* kDivision = "paper+div";
constexpr const char* kSafeDivision = "paper+safe_div";

struct Counts {
  int formulas = 0;
  int proved = 0;
  int refuted = 0;
  int missed = 0;  // of the refuted, by a grid
  int undecided = 0;
  int dissipative = 0;
  int monotone = 0;
  int odd = 0;

  void add(const Record& r) {
    ++formulas;
    proved += r.singularity == "proved_free" ? 1 : 0;
    refuted += r.singularity == "refuted" ? 1 : 0;
    missed += r.grid_check == "missed" ? 1 : 0;
    undecided += r.singularity == "undecided" ? 1 : 0;
    dissipative += r.dissipative == "proved" ? 1 : 0;
    monotone += r.monotone == "proved" ? 1 : 0;
    odd += r.odd == "proved" ? 1 : 0;
  }
};

std::string table(const std::map<std::pair<std::string, std::string>, Counts>& all) {
  std::vector<MarkdownTable::Heading> headings = {{"operators"}, {"method"}};
  for (const char* name : {"formulas", "proved free", "refuted", "a grid misses", "undecided",
                           "dissipative", "monotone", "odd"}) {
    headings.push_back({name, Align::right});
  }
  MarkdownTable text(headings);
  for (const auto& [key, c] : all) {
    std::vector<std::string> cells = {key.first, key.second};
    for (const int count : {c.formulas, c.proved, c.refuted, c.missed, c.undecided, c.dissipative,
                            c.monotone, c.odd}) {
      cells.push_back(fmt::format("{}", count));
    }
    text.add(std::move(cells));
  }
  return text.text();
}

// Geometric mean of mae_test with one operator set over that with another, on the same problems and
// seeds, with the number of pairs.
std::pair<double, int> error_ratio(const std::vector<Record>& records, const std::string& method,
                                   const std::string& ours, const std::string& theirs) {
  std::map<std::pair<std::string, std::uint64_t>, double> reference;
  for (const Record& r : records) {
    if (is_ok(r) && r.method == method && r.operators == theirs) {
      reference[{r.problem, r.seed}] = r.mae_test;
    }
  }
  double logs = 0;
  int pairs = 0;
  for (const Record& r : records) {
    if (!is_ok(r) || r.method != method || r.operators != ours) continue;
    const auto other = reference.find({r.problem, r.seed});
    if (other == reference.end() || !(r.mae_test > 0) || !(other->second > 0)) continue;
    logs += std::log(r.mae_test / other->second);
    ++pairs;
  }
  return {pairs > 0 ? std::exp(logs / pairs) : kMissing, pairs};
}

std::string price_of_safety(const std::vector<Record>& records,
                            const std::map<std::pair<std::string, std::string>, Counts>& all) {
  std::string text;
  for (const auto& [key, counts] : all) {
    if (key.first != kSafeDivision) continue;
    for (const char* other : {kDivision, "paper"}) {
      const auto [ratio, pairs] = error_ratio(records, key.second, kSafeDivision, other);
      if (pairs == 0) continue;
      text += fmt::format("- {}: test error with `{}` is {:.3g} times that with `{}` ({} pairs).\n",
                          key.second, kSafeDivision, ratio, other, pairs);
    }
  }
  return text.empty() ? text : "\n" + text;
}

}  // namespace

std::string proofs_section(const std::vector<Record>& records) {
  std::map<std::pair<std::string, std::string>, Counts> all;
  for (const Record& record : records) {
    if (is_ok(record) && !record.singularity.empty()) {
      all[{record.operators, record.method}].add(record);
    }
  }
  if (all.empty()) return "";
  return "\n## Proofs\n\n"
         "Every formula is proved finite on its whole input box, refuted by a point, or undecided. "
         "*A grid misses*\n"
         "counts refuted formulas that are finite at 2 001 points on a grid. *Dissipative* (f v >= "
         "0), *monotone* (f\n"
         "grows with v beyond a quarter of the largest speed) and *odd* count formulas for which "
         "that is proved.\n\n" +
         table(all) + price_of_safety(records, all);
}

}  // namespace tribench
