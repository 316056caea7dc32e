// SPDX-License-Identifier: MIT
//
// The summary in words.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "reports/figures.hpp"
#include "reports/summary.hpp"

namespace tribench {
namespace {

std::vector<std::string> methods_with(const ProblemTable& table, Standing standing) {
  std::vector<std::string> names;
  for (const MethodRow& row : table.rows) {
    if (row.standing == standing) names.push_back(row.method);
  }
  return names;
}

std::string list_of(const std::vector<std::string>& names) {
  if (names.size() < 2) return names.empty() ? std::string() : names.front();
  const std::vector<std::string> head(names.begin(), names.end() - 1);
  return fmt::format("{} and {}", fmt::join(head, ", "), names.back());
}

const char* is_are(const std::vector<std::string>& names) {
  return names.size() == 1 ? "is" : "are";
}

// What repeats to the last digit is one draw.
std::string too_few(const ProblemTable& table) {
  std::size_t draws = 0;
  for (const MethodRow& row : table.rows) {
    if (row.standing == Standing::behind_untested) draws = std::max(draws, row.pairs);
  }
  const std::string seeds = counted(table.seeds, "seed");
  if (draws > 0 && draws < table.seeds) {
    return fmt::format("{} repeat {} and are too few for a test", seeds, counted(draws, "result"));
  }
  return fmt::format("{} {} too few for a test", seeds, table.seeds == 1 ? "is" : "are");
}

std::string failures_of(const ProblemTable& table) {
  std::vector<std::string> parts;
  for (const MethodRow& row : table.rows) {
    if (row.failed > 0) {
      parts.push_back(
          fmt::format("{} failed in {} of {} cells", row.method, row.failed, row.cells));
    }
    if (row.missing > 0)
      parts.push_back(fmt::format("{} lacks {}", row.method, counted(row.missing, "cell")));
  }
  return parts.empty() ? std::string() : fmt::format(" {}.", fmt::join(parts, "; "));
}

std::string singularities_of(const ProblemTable& table) {
  std::vector<std::string> parts;
  for (const MethodRow& row : table.rows) {
    if (row.refuted > 0) {
      parts.push_back(fmt::format("{} ({} of {})", row.method, row.refuted, row.looked_at()));
    }
  }
  return parts.empty() ? std::string()
                       : fmt::format(" Singular inside the input box: {}.", fmt::join(parts, ", "));
}

}  // namespace

std::string reading_of(const ProblemTable& table) {
  if (!table.has_best()) {
    return "No method gave a formula in more than half of its cells." + failures_of(table);
  }
  const MethodRow& best = table.rows.front();
  std::string text = fmt::format("{} has the smallest median error ({}).", best.method,
                                 figure(best.mae_test.middle));
  const auto equal = methods_with(table, Standing::equivalent);
  if (!equal.empty()) {
    text += fmt::format(" {} {} within 1 % of it: no practical difference.", list_of(equal),
                        is_are(equal));
  }
  const auto unclear = methods_with(table, Standing::not_distinguishable);
  if (!unclear.empty()) {
    text += fmt::format(" {} {} not distinguishable from it with {}.", list_of(unclear),
                        is_are(unclear), counted(table.seeds, "seed"));
  }
  const auto untested = methods_with(table, Standing::behind_untested);
  if (!untested.empty()) {
    text += fmt::format(" {} {} behind on every seed, but {}.", list_of(untested), is_are(untested),
                        too_few(table));
  }
  const auto behind = methods_with(table, Standing::behind);
  if (!behind.empty()) {
    text += fmt::format(" {} {} worse (signed-rank test, Holm-adjusted, 5 %).", list_of(behind),
                        is_are(behind));
  }
  return text + singularities_of(table) + failures_of(table);
}

namespace {

// What the seeds could have shown and did not.
std::string seen_text(const MethodRow& row) {
  if (!std::isfinite(row.seen_ratio)) return counted(row.pairs, "seed") + " can show nothing";
  return fmt::format("x{} would be seen", ratio_figure(row.seen_ratio));
}

}  // namespace

std::string certainty_of(const ProblemTable& table) {
  if (!table.has_best()) return "nothing to place";
  if (table.rows.size() == 1) return "only method";
  const auto equal = methods_with(table, Standing::equivalent);
  const auto unclear = methods_with(table, Standing::not_distinguishable);
  if (!equal.empty() || !unclear.empty()) {
    std::string text;
    if (!equal.empty()) text = fmt::format("as good (1 %): {}", fmt::join(equal, ", "));
    if (!unclear.empty()) {
      std::vector<std::string> each;
      for (const MethodRow& row : table.rows) {
        if (row.standing != Standing::not_distinguishable) continue;
        each.push_back(fmt::format("{} ({})", row.method, seen_text(row)));
      }
      text +=
          fmt::format("{}not distinguishable: {}", text.empty() ? "" : "; ", fmt::join(each, ", "));
    }
    return text;
  }
  if (methods_with(table, Standing::failed).size() + 1 == table.rows.size()) {
    return "the others gave no formula";
  }
  if (!methods_with(table, Standing::behind_untested).empty()) {
    return "ahead on every seed, " + too_few(table);
  }
  return "clearly (5 %)";
}

std::string reading_of(const Ranking& ranking) {
  const FriedmanTest& test = ranking.test;
  if (ranking.methods.size() < 2 || test.blocks < 2) {
    return "Ranks over problems need two problems and two methods at least.";
  }
  std::string text = fmt::format(
      "Mean ranks over {} problems; Friedman's test gives p = {}; ranks closer than {} (Nemenyi, "
      "5 %) are not distinguishable",
      test.blocks, figure(test.p), figure(test.critical_difference));
  std::vector<std::string> tied;
  for (std::size_t i = 1; i < ranking.methods.size(); ++i) {
    if (test.mean_ranks[i] - test.mean_ranks[0] < test.critical_difference) {
      tied.push_back(ranking.methods[i]);
    }
  }
  text += tied.empty() ? fmt::format(": {} is ahead of all.", ranking.methods[0])
                       : fmt::format(": {} leads, not distinguishable from {}.", ranking.methods[0],
                                     list_of(tied));
  if (!ranking.left_out.empty()) {
    text += fmt::format(" Left out, because some problem lacks them: {}.",
                        fmt::join(ranking.left_out, ", "));
  }
  return text;
}

std::string standing_text(const MethodRow& row) {
  switch (row.standing) {
    case Standing::best:
      return "best";
    case Standing::equivalent:
      return "within 1 %";
    case Standing::not_distinguishable:
      return fmt::format("not distinguishable (x{}; {})", ratio_figure(row.ratio), seen_text(row));
    case Standing::behind_untested:
      return fmt::format("x{} on {}{}", ratio_figure(row.ratio), row.pairs == 1 ? "" : "all ",
                         counted(row.pairs, "seed"));
    case Standing::behind:
      return fmt::format("x{} (p {})", ratio_figure(row.ratio), figure(row.p, 2));
    default:
      return "failed";
  }
}

std::string yardstick_ratio_text(const YardstickRatio& ratio) {
  if (!std::isfinite(ratio.middle)) return "-";
  const bool percent = ratio.middle < 2;
  const auto text = [percent](double value) {
    return percent ? fmt::format("{:+.1f}", 100 * (value - 1)) : ratio_figure(value);
  };
  std::string all = percent ? text(ratio.middle) + " %" : "x" + text(ratio.middle);
  if (!std::isnan(ratio.interval.low)) {
    all += fmt::format(" ({} .. {})", text(ratio.interval.low), text(ratio.interval.high));
  }
  return all;
}

std::string yardsticks_text(const ProblemTable& table) {
  if (std::isnan(table.mae_ceiling)) return {};
  std::string text = fmt::format("Noise ceiling {}", figure(table.mae_ceiling));
  if (!std::isnan(table.mae_law)) {
    text += fmt::format("; the true law's error {}", figure(table.mae_law));
  }
  if (!std::isnan(table.mae_refitted)) {
    text += fmt::format(", {} with its constants fitted to the training rows",
                        figure(table.mae_refitted));
  }
  return text + ".";
}

}  // namespace tribench
