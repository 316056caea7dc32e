// SPDX-License-Identifier: MIT
#include "reports/proofs.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "foundation/elementary.hpp"
#include "foundation/order_statistics.hpp"
#include "foundation/random.hpp"
#include "reports/figures.hpp"
#include "reports/markdown.hpp"
#include "reports/record/record_csv.hpp"
#include "reports/statistics/rank_tests.hpp"
#include "reports/summary.hpp"

namespace tribench {
namespace {

constexpr const char* kPlain = "paper";
constexpr const char* kDivision = "paper+div";
constexpr const char* kSafeDivision = "paper+safe_div";
constexpr std::size_t kRounds = 2000;

using GroupKey = std::pair<std::string, std::string>;  // operators, method

struct Counts {
  int formulas = 0;
  int dividing = 0;
  int proved = 0;
  int refuted = 0;
  int missed = 0;  // of the refuted, by a grid
  int undecided = 0;
  int dissipative = 0;
  int monotone = 0;
  int odd = 0;
  int on_fronts = 0;
  int dividing_on_fronts = 0;
  int refuted_on_fronts = 0;

  void add(const Record& r) {
    ++formulas;
    dividing += divides(r.formula) ? 1 : 0;
    proved += r.singularity == Singularity::proved_free ? 1 : 0;
    refuted += r.singularity == Singularity::refuted ? 1 : 0;
    missed += r.grid_check == GridCheck::missed ? 1 : 0;
    undecided += r.singularity == Singularity::undecided ? 1 : 0;
    dissipative += r.dissipative == PhysicsProof::proved ? 1 : 0;
    monotone += r.monotone == PhysicsProof::proved ? 1 : 0;
    odd += r.odd == PhysicsProof::proved ? 1 : 0;
  }
};

using AllCounts = std::map<GroupKey, Counts>;

AllCounts count_verdicts(const RunFolder& run) {
  AllCounts all;
  std::unordered_map<std::string_view, Counts*> of_cell;
  for (const Record& record : run.records) {
    if (!is_ok(record) || !record.singularity) continue;
    Counts& counts = all[{record.operators, record.method}];
    counts.add(record);
    of_cell.emplace(record.cell, &counts);
  }
  if (all.empty() || !std::filesystem::exists(run.path / "front.csv")) return all;
  read_front(run.path / "front.csv", [&](FrontRecord&& front) {
    const auto found = of_cell.find(front.cell);
    if (found == of_cell.end()) return;
    ++found->second->on_fronts;
    found->second->dividing_on_fronts += divides(front.formula) ? 1 : 0;
    found->second->refuted_on_fronts += front.singularity == Singularity::refuted ? 1 : 0;
  });
  return all;
}

std::string share(int count, int of) {
  return of == 0 ? std::string("-") : fmt::format("{}/{}", count, of);
}

std::string singularity_table(const AllCounts& all) {
  std::vector<MarkdownTable::Heading> headings = {{"operators"}, {"method"}};
  for (const char* name : {"formulas", "dividing", "proved free", "undecided", "refuted",
                           "a grid misses", "on fronts: dividing", "refuted"}) {
    headings.push_back({name, Align::right});
  }
  MarkdownTable text(headings);
  for (const auto& [key, c] : all) {
    text.add({key.first, key.second, fmt::format("{}", c.formulas), fmt::format("{}", c.dividing),
              fmt::format("{}", c.proved), fmt::format("{}", c.undecided),
              fmt::format("{}", c.refuted), share(c.missed, c.refuted),
              share(c.dividing_on_fronts, c.on_fronts), share(c.refuted_on_fronts, c.on_fronts)});
  }
  return text.text();
}

std::string physics_table(const AllCounts& all) {
  MarkdownTable text({{"operators"},
                      {"method"},
                      {"formulas", Align::right},
                      {"dissipative", Align::right},
                      {"monotone", Align::right},
                      {"odd", Align::right}});
  bool any = false;
  for (const auto& [key, c] : all) {
    any = any || c.dissipative + c.monotone + c.odd > 0;
    text.add({key.first, key.second, fmt::format("{}", c.formulas),
              fmt::format("{}", c.dissipative), fmt::format("{}", c.monotone),
              fmt::format("{}", c.odd)});
  }
  return any ? text.text() : std::string();
}

// By method: problem and seed -> error.
using Errors = std::map<std::string, std::map<std::pair<std::string, std::uint64_t>, double>>;

Errors errors_with(const std::vector<Record>& records, std::string_view operators) {
  Errors errors;
  for (const Record& r : records) {
    if (r.operators == operators) errors[r.method][{r.problem, r.seed}] = placing_error(r);
  }
  return errors;
}

// Logarithms of the ratios by problem; pairs of which both failed are left out.
std::map<std::string, std::vector<double>> log_ratios(const Errors::mapped_type& ours,
                                                      const Errors::mapped_type& theirs) {
  std::map<std::string, std::vector<double>> ratios;
  for (const auto& [key, error] : ours) {
    const auto other = theirs.find(key);
    if (other == theirs.end() || (std::isinf(error) && std::isinf(other->second))) continue;
    const double ratio = error == other->second ? 0.0 : elementary::log(error / other->second);
    ratios[key.first].push_back(ratio);
  }
  return ratios;
}

OperatorPrice price_of(const std::string& method, const char* operators, const char* against,
                       const Errors::mapped_type& ours, const Errors::mapped_type& theirs) {
  OperatorPrice price{method, operators, against, 0, kMissing, {kMissing, kMissing}, kMissing};
  std::vector<double> all;
  std::vector<std::vector<double>> groups;
  for (auto& [problem, ratios] : log_ratios(ours, theirs)) {
    all.insert(all.end(), ratios.begin(), ratios.end());
    groups.push_back(ratios);
  }
  price.pairs = all.size();
  if (all.empty()) return price;
  price.ratio = elementary::exp(median(all));
  const ConfidenceInterval logs = two_level_bootstrap(
      groups, [](std::span<const double> values) { return median(values); }, kConfidence, kRounds,
      RandomStream(key_of(fmt::format("price|{}|{}|{}", method, operators, against))));
  price.interval = {elementary::exp(logs.low), elementary::exp(logs.high)};
  price.p = wilcoxon_signed_rank(all).p;
  return price;
}

std::string price_in_words(const OperatorPrice& price) {
  if (price.interval.low >= 1 - kEquivalence && price.interval.high <= 1 + kEquivalence) {
    return "no practical difference";
  }
  if (!(price.p <= kLevel)) return "not distinguishable";
  return price.ratio > 1 ? "costs" : "gains";
}

std::string price_table(const std::vector<OperatorPrice>& prices) {
  if (prices.empty()) return {};
  MarkdownTable text({{"method"},
                      {"with"},
                      {"against"},
                      {"pairs", Align::right},
                      {"error ratio", Align::right},
                      {"95 %", Align::right},
                      {"p", Align::right},
                      {"in words"}});
  for (const OperatorPrice& price : prices) {
    text.add(
        {price.method, price.operators, price.against, fmt::format("{}", price.pairs),
         figure(price.ratio, 4),
         fmt::format("{} .. {}", figure(price.interval.low, 4), figure(price.interval.high, 4)),
         figure(price.p, 2), price_in_words(price)});
  }
  return fmt::format(
      "\nWhat division costs or gains: error on test movements with one operator set over that "
      "with "
      "another, same\n"
      "problem and seed, median of all pairs (signed-rank test, Holm-adjusted; a failed cell "
      "counts "
      "as infinite).\n\n{}",
      text.text());
}

}  // namespace

bool divides(std::string_view formula) {
  const auto after = [&](std::size_t at) {
    while (at < formula.size() && formula[at] == ' ') ++at;
    return at;
  };
  const auto is_digit = [&](std::size_t at) {
    return at < formula.size() &&
           (std::isdigit(static_cast<unsigned char>(formula[at])) != 0 || formula[at] == '.');
  };
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] == '^') {
      std::size_t at = after(i + 1);
      if (at < formula.size() && formula[at] == '(') at = after(at + 1);
      if (at < formula.size() && formula[at] == '-') return true;
    }
    if (formula[i] != '/') continue;
    std::size_t at = after(i + 1);
    if (at < formula.size() && formula[at] == '-') at = after(at + 1);
    if (!is_digit(at)) return true;
    // A number, unless it is the base of a power.
    while (is_digit(at) || (at < formula.size() && formula[at] == 'e')) {
      const bool exponent = formula[at] == 'e';
      ++at;
      if (exponent && at < formula.size() && (formula[at] == '-' || formula[at] == '+')) ++at;
    }
    at = after(at);
    if (at < formula.size() && formula[at] == '^') return true;
  }
  return false;
}

std::vector<OperatorPrice> operator_prices(const std::vector<Record>& records) {
  constexpr std::pair<const char*, const char*> kComparisons[] = {
      {kSafeDivision, kPlain}, {kSafeDivision, kDivision}, {kDivision, kPlain}};
  std::map<std::string, Errors> errors;
  for (const char* set : {kPlain, kDivision, kSafeDivision}) {
    errors[set] = errors_with(records, set);
  }
  std::vector<OperatorPrice> prices;
  for (const auto& [operators, against] : kComparisons) {
    for (const auto& [method, ours] : errors[operators]) {
      const auto theirs = errors[against].find(method);
      if (theirs == errors[against].end()) continue;
      prices.push_back(price_of(method, operators, against, ours, theirs->second));
    }
  }
  std::vector<double> p;
  for (const OperatorPrice& price : prices) p.push_back(price.p);
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < prices.size(); ++i) prices[i].p = adjusted[i];
  return prices;
}

std::string proofs_section(const RunFolder& run) {
  const AllCounts all = count_verdicts(run);
  if (all.empty()) return {};
  std::string text =
      "\n## Proofs\n\n"
      "Every formula is proved finite on its whole input box, refuted by a point, or undecided. "
      "*Dividing* counts\n"
      "formulas with a divisor that is no plain number; *a grid misses* counts refuted formulas "
      "that are finite at\n"
      "2 001 points on a grid over the box. First the formulas the cells stand for, then all "
      "formulas of their fronts.\n\n" +
      singularity_table(all) + price_table(operator_prices(run.records));
  const std::string physics = physics_table(all);
  if (!physics.empty()) {
    text +=
        "\nPhysics, proved on the whole box: *dissipative* (f v >= 0), *monotone* (f grows with v "
        "beyond a quarter of\n"
        "the largest speed), *odd* (f(-v) = -f(v)).\n\n" +
        physics;
  }
  return text;
}

}  // namespace tribench
