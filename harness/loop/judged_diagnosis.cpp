// SPDX-License-Identifier: MIT
#include "harness/loop/judged_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/effects/effect_library.hpp"
#include "algorithms/loop_model/model_fit.hpp"
#include "foundation/parallel_for.hpp"
#include "harness/loop/bristles_of.hpp"
#include "harness/loop/determined_rows.hpp"
#include "harness/loop/noise_bounds.hpp"
#include "harness/loop/nothing_missing.hpp"
#include "harness/loop/searches_on_parts.hpp"
#include "problems/preparation/canonical.hpp"
#include "problems/preparation/test_movements.hpp"
#include "reports/record/loop_record.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kFewMovements = 40;     // a fifth of them is too few to judge by
constexpr std::size_t kWantedMovements = 30;  // R9
constexpr std::size_t kFewestToLeaveOut = 3;  // movements: of fewer, pieces are left out
// Movements are left out in at least so many turns; in more, one movement each, where the rows of
// all turns together stay below the second figure.
constexpr std::size_t kFewestTurns = 10;
constexpr std::size_t kRowsOfAllTurns = 60'000;

// Pieces of each movement, as independent of one another as rows ten correlation times apart.
std::vector<int> pieces(const Observations& data, double correlation_rows) {
  const Clusters clusters = make_clusters(data.movement, correlation_rows);
  std::vector<int> unit(data.rows());
  for (std::size_t c = 0; c < clusters.stretches.size(); ++c) {
    for (std::size_t i = clusters.stretches[c].begin; i < clusters.stretches[c].end; ++i) {
      unit[i] = static_cast<int>(c);
    }
  }
  return unit;
}

std::size_t turns_for(const Observations& data) {
  return std::max(kFewestTurns, kRowsOfAllTurns / std::max<std::size_t>(1, data.rows()));
}

// The movements that are left out at once, each set in ascending order: those of a group, or single
// ones, or where they are many, a tenth of them.
std::vector<std::vector<int>> left_out_together(const Observations& data) {
  std::map<int, std::size_t> place;  // of a group's number, in the order of their first movements
  std::vector<std::vector<int>> all;
  const auto turns = static_cast<int>(turns_for(data));
  int turn = 0;
  for (const int m : data.movements()) {
    const int number =
        data.group.empty() ? turn++ % turns : data.group[static_cast<std::size_t>(m)];
    const auto [known, is_new] = place.try_emplace(number, all.size());
    if (is_new) all.emplace_back();
    all[known->second].push_back(m);
  }
  for (std::vector<int>& movements : all) std::ranges::sort(movements);
  return all;
}

// "there is one movement"
std::string few_movements(const Observations& data) {
  const std::size_t count = data.movements().size();
  return count == 1 ? "there is one movement" : fmt::format("there are {} movements", count);
}

// Too few movements to leave one out: as many pieces of all of them as there are turns at least, or
// one more, stand for movements; fewer where they would be too short for one. None holds rows of
// two.
Observations cut_in_pieces(const Observations& data) {
  Observations out = data;
  out.movement_names.clear();
  out.group.clear();
  const std::size_t wanted =
      std::clamp(data.rows() / kFewestRowsOfMovement, std::size_t{1}, kFewestTurns);
  for (const RowRange& movement : make_clusters(data.movement, 1).movements) {
    const std::size_t share = (movement.size() * wanted + data.rows() - 1) / data.rows();
    const std::size_t first = out.movement_names.size();
    for (std::size_t i = movement.begin; i < movement.end; ++i) {
      out.movement[i] = static_cast<int>(first + (i - movement.begin) * share / movement.size());
    }
    for (std::size_t k = 0; k < share; ++k) {
      out.movement_names.push_back(fmt::format("piece {}", first + k + 1));
    }
  }
  // Within a movement everything that grows with it passes for the campaign's time.
  for (const char* name : {"t", "T"}) out.withheld.push_back({name, few_movements(data)});
  return out;
}

// Whether without one of them the others determine the base in any of its rows.
bool foretell_one_another(const Observations& data, const Diagnosis& diagnosis) {
  return std::ranges::any_of(data.movements(), [&](int movement) {
    const std::vector<char> others = usable_rows(data, {movement}, false, diagnosis.masked);
    const std::vector<char> determined =
        determined_rows(diagnosis.before, data, others, diagnosis.correlation_rows);
    for (std::size_t i = 0; i < data.rows(); ++i) {
      if (data.movement[i] == movement && determined[i] != 0) return true;
    }
    return false;
  });
}

// What the models fitted without them make of the movements left out, in rows of all data.
struct LeftOut {
  Eigen::VectorXd before;
  Eigen::VectorXd after;
  Eigen::VectorXd with_state;  // as `after` where there are no bristles
  Eigen::VectorXd corrected;   // as `after` where no bounds are asked for
  std::vector<char> determined;

  explicit LeftOut(std::size_t rows)
      : before(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows))),
        after(before),
        with_state(before),
        corrected(before),
        determined(rows, 0) {}
};

// Whether a model that was fitted without it can be judged in any of the rows.
bool has_determined_row(const std::vector<char>& rows, const LeftOut& models) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] != 0 && models.determined[i] != 0) return true;
  }
  return false;
}

// Of the rows those that can be judged; all where none can. Says which movements hold the others.
std::vector<char> judged_rows(std::vector<char> rows, const LeftOut& models,
                              const Observations& data, std::vector<std::string>& notes) {
  constexpr std::size_t kNamed = 3;
  std::set<int> movements;
  std::size_t undetermined = 0;
  std::vector<char> kept = rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] == 0 || models.determined[i] != 0) continue;
    kept[i] = 0;
    ++undetermined;
    movements.insert(data.movement[i]);
  }
  if (undetermined == 0 || std::ranges::count(kept, 1) == 0) return rows;
  std::vector<std::string> names;
  for (const int m : movements) {
    if (names.size() == kNamed) break;
    names.push_back(fmt::format("'{}'", data.movement_names[static_cast<std::size_t>(m)]));
  }
  notes.push_back(fmt::format(
      "{} rows of {} movements ({}{}) are not judged: the other movements do not determine "
      "the base model there",
      undetermined, movements.size(), fmt::join(names, ", "),
      movements.size() > names.size() ? ", ..." : ""));
  return kept;
}

// One recording, in its canonical order, and what is asked of it.
class LoopJudge {
 public:
  LoopJudge(const Observations& data, const BaseMaker& base, const DiagnosisOptions& options,
            const JudgingOptions& judging)
      : data_(data), base_(base), options_(options), judging_(judging) {}

  JudgedDiagnosis with_held_out(const std::vector<int>& test);
  JudgedDiagnosis in_turn();

 private:
  // bristles: of `fitted`. Writes to the rows alone that it has not seen.
  void add_predictions(LeftOut& all, const Diagnosis& fitted,
                       const std::optional<Bristles>& bristles, const RandomStream& random) const;
  // Errors on the rows with rows[i] != 0. unit: of those rows.
  ErrorFinding judged(const std::vector<char>& rows, const LeftOut& models,
                      std::span<const int> unit) const;
  void point_at_unused_columns(JudgedDiagnosis& whole) const;

  const Observations& data_;
  const BaseMaker& base_;
  const DiagnosisOptions& options_;
  const JudgingOptions& judging_;
  RandomStream random_{key_of("judge")};
};

// Of the rows that a diagnosis has not seen.
void LoopJudge::add_predictions(LeftOut& all, const Diagnosis& fitted,
                                const std::optional<Bristles>& bristles,
                                const RandomStream& random) const {
  const Eigen::VectorXd before = predict(fitted.before, data_);
  const Eigen::VectorXd after = predict(fitted.after, data_);
  const Eigen::VectorXd with_state = bristles ? predict(*bristles, data_) : after;
  const std::vector<char> train = usable_rows(data_, fitted.held_out, false, fitted.masked);
  const std::vector<char> determined =
      determined_rows(fitted.before, data_, train, fitted.correlation_rows);
  Eigen::VectorXd corrected = after;
  if (judging_.bounds) {
    corrected +=
        smooth_correction(data_, train, target_vector(data_) - after, random.split("smooth"));
  }
  for (std::size_t i = 0; i < data_.rows(); ++i) {
    if (!std::ranges::binary_search(fitted.held_out, data_.movement[i])) continue;
    const auto at = static_cast<Eigen::Index>(i);
    all.before[at] = before[at];
    all.after[at] = after[at];
    all.with_state[at] = with_state[at];
    all.corrected[at] = corrected[at];
    all.determined[i] = determined[i];
  }
}

ErrorFinding LoopJudge::judged(const std::vector<char>& rows, const LeftOut& models,
                               std::span<const int> unit) const {
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < data_.rows(); ++i) {
    if (rows[i] != 0) kept.push_back(static_cast<Eigen::Index>(i));
  }
  const Observations part = data_.select(rows);
  const Eigen::VectorXd before = models.before(kept);
  const Eigen::VectorXd after = models.after(kept);
  ErrorFinding error = judge(part, before, after, unit, random_.split("bootstrap"));
  if (!kept.empty()) {
    error.mae_state = (target_vector(part) - models.with_state(kept)).cwiseAbs().mean();
  }
  if (judging_.bounds) {
    const auto y = target_vector(part);
    bound_noise(error, part, y - before, y - after, y - models.corrected(kept), unit,
                random_.split("bounds"));
  }
  return error;
}

void LoopJudge::point_at_unused_columns(JudgedDiagnosis& whole) const {
  if (!judging_.bounds || data_.unused.empty()) return;
  const std::vector<char> rows = usable_rows(data_, {}, false, whole.masked);
  const Observations part = data_.select(rows);
  const RandomStream random = random_.split("unused columns");
  Eigen::VectorXd residual = target_vector(part) - predict(whole.after, part);
  // What goes with time or with the movement nobody can say the cause of: there a column is a
  // rival.
  Observations rivals = part;
  const LeftoverFinding& left = whole.leftover;
  if (left.varying || std::ranges::count(left.signals, "t") > 0) {
    std::erase_if(rivals.signals, [](const Signal& signal) { return signal.name == "t"; });
  }
  residual -= smooth_correction(rivals, std::vector<char>(part.rows(), 1), residual, random);
  whole.unused_columns = unused_columns_that_explain(part, residual, random);
}

// Few movements: the whole procedure again for each, without it, and all of them judged together.
// Says of each effect how many of them choose it too.
JudgedDiagnosis LoopJudge::in_turn() {
  SearchesOnParts searches(data_, base_, options_, judging_, {}, left_out_together(data_));
  searches.search_all();
  std::vector<std::string> needed = searches.name_the_stable();
  const std::size_t turns = searches.parts().size();
  // The error is that of what is named: where nothing is, a part's own effects are none.
  LeftOut all(data_.rows());
  parallel_for(turns, judging_.threads, [&](std::size_t k) {
    Diagnosis& part = searches.parts()[k];
    if (searches.whole().effects.empty()) part.after = part.before;
    add_predictions(all, part, bristles_of(part, data_), random_.split(k));
  });
  JudgedDiagnosis whole{std::move(searches.whole()), {}, {}, {}};
  whole.bristles = bristles_of(whole, data_);
  std::vector<char> rows = usable_rows(data_, {}, false, whole.masked);
  if (!has_determined_row(rows, all)) doubt_undetermined(whole);
  rows = judged_rows(std::move(rows), all, data_, whole.notes);
  whole.error = judged(rows, all, pieces(data_.select(rows), whole.correlation_rows));
  point_at_unused_columns(whole);
  whole.error.how =
      !data_.group.empty() ? fmt::format("movements of one '{}' left out in turn", data_.group_name)
      : data_.movements().size() > turns ? fmt::format("the movements left out in {} turns", turns)
                                         : "each movement left out in turn";
  doubt_nothing_missing(whole, std::move(needed));
  return whole;
}

JudgedDiagnosis LoopJudge::with_held_out(const std::vector<int>& test) {
  std::vector<std::vector<int>> parts;
  if (judging_.resample) {
    parts = left_out_together(data_.select(usable_rows(data_, test, false, {})));
  }
  SearchesOnParts searches(data_, base_, options_, judging_, test, parts);
  searches.search_until_none();
  std::vector<std::string> needed = searches.name_the_stable();
  JudgedDiagnosis whole{std::move(searches.whole()), {}, {}, {}};
  whole.bristles = bristles_of(whole, data_);
  whole.error.judged_on = JudgedOn::rows_of_the_fit;
  whole.error.how = "none held out";
  std::vector<char> rows = usable_rows(data_, test, true, whole.masked);
  if (std::ranges::count(rows, 1) == 0) return whole;
  LeftOut models(data_.rows());
  add_predictions(models, whole, whole.bristles, random_);
  if (!has_determined_row(rows, models)) doubt_undetermined(whole);
  rows = judged_rows(std::move(rows), models, data_, whole.notes);
  whole.error = judged(rows, models, data_.select(rows).movement);
  point_at_unused_columns(whole);
  whole.error.how = "held out";
  doubt_nothing_missing(whole, std::move(needed));
  return whole;
}

JudgedDiagnosis judge_canonical(const Observations& data, const BaseMaker& base,
                                const DiagnosisOptions& options, const JudgingOptions& judging) {
  const std::size_t movements = data.movements().size();
  if (movements >= kFewMovements && data.group.empty()) {
    return LoopJudge(data, base, options, judging)
        .with_held_out(held_out_movements(data, judging.test_share));
  }
  if (movements == 1 || (movements < kFewestToLeaveOut && data.group.empty())) {
    const Observations pieces = cut_in_pieces(data);
    JudgedDiagnosis out = LoopJudge(pieces, base, options, judging).in_turn();
    out.error.judged_on = JudgedOn::pieces_of_movements;
    out.error.how = "pieces of the movements left out in turn";
    if (movements > 1 && !foretell_one_another(data, out)) doubt_undetermined(out);
    out.notes.push_back(few_movements(data) +
                        ": nothing that differs between movements (temperature, drift, "
                        "repeatability) can be tested");
    return out;
  }
  JudgedDiagnosis out = LoopJudge(data, base, options, judging).in_turn();
  if (movements < kWantedMovements) {
    out.notes.push_back(
        fmt::format("there are {} movements: what differs between movements (temperature, drift, "
                    "repeatability) can hardly be tested; {} are wanted",
                    movements, kWantedMovements));
    doubt_few_movements(out, movements);
  }
  return out;
}

}  // namespace

std::vector<int> held_out_movements(const Observations& data, double share) {
  const bool few = data.movements().size() < kFewMovements;
  return few || !data.group.empty() ? std::vector<int>() : choose_test_movements(data, share);
}

JudgedDiagnosis diagnose_and_judge(const Observations& data, const BaseMaker& base,
                                   const DiagnosisOptions& options, const JudgingOptions& judging) {
  const Canonical told = canonical(data);
  JudgedDiagnosis out = judge_canonical(told.data, base, options, judging);
  out.masked = told.as_told(out.masked);
  if (!out.bristles) out.error.mae_state = std::numeric_limits<double>::quiet_NaN();
  // Without a row to judge by there is nothing against them.
  const bool judged = out.error.judged_on != JudgedOn::rows_of_the_fit;
  out.error.confirmed = !judged || out.effects.empty() || out.error.difference_low > 0;
  for (EffectFinding& effect : out.effects) {
    effect.provisional = effect.provisional || !out.error.confirmed;
  }
  return out;
}

}  // namespace tribench::loop
