// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "algorithms/diagnosis/ceiling.hpp"
#include "algorithms/diagnosis/findings.hpp"
#include "algorithms/diagnosis/held_out.hpp"
#include "algorithms/diagnosis/rich_model.hpp"
#include "algorithms/diagnosis/search.hpp"
#include "algorithms/inference/bursts.hpp"
#include "foundation/error.hpp"
#include "foundation/parallel_for.hpp"
#include "foundation/suggestion.hpp"
#include "problems/preparation/canonical.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kFewMovements = 40;     // a fifth of them is too few to judge by
constexpr std::size_t kWantedMovements = 30;  // R9
constexpr std::size_t kPiecesOfOneMovement = 5;
// Movements are left out in at least so many turns; in more, one movement each, where the rows of
// all turns together stay below the second figure.
constexpr std::size_t kFewestTurns = 10;
constexpr std::size_t kRowsOfAllTurns = 60'000;

std::vector<EffectFamily> chosen_families(const DiagnosisOptions& options) {
  std::vector<EffectFamily> all = builtin_effects();
  for (const EffectFamily& family : options.learned) {
    if (std::ranges::count(all, family.name, &EffectFamily::name) > 0) {
      throw_bad_input(fmt::format("there are two effects named '{}'", family.name), "--learned",
                      "give the one in the file another name");
    }
    all.push_back(family);
  }
  if (options.families.empty()) return all;
  std::vector<std::string> names;
  for (const EffectFamily& family : all) names.push_back(family.name);
  std::vector<EffectFamily> chosen;
  for (const std::string& wanted : options.families) {
    const auto found = std::ranges::find(all, wanted, &EffectFamily::name);
    if (found == all.end()) {
      throw_bad_input(fmt::format("there is no effect '{}'", wanted), {},
                      did_you_mean(wanted, names, "see: tribench list effects"));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

// Rows of the movements in (or not in) `test`, without those masked and without movements that
// are too short to say anything.
std::vector<char> rows_of(const Observations& data, const std::vector<int>& test, bool in_test,
                          const std::vector<char>& masked) {
  std::vector<char> keep(data.rows(), 0);
  std::vector<std::size_t> counts(data.movement_names.size() + 1, 0);
  for (const int m : data.movement) {
    const auto at = static_cast<std::size_t>(m);
    if (at >= counts.size()) counts.resize(at + 1, 0);
    ++counts[at];
  }
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool is_test = std::ranges::binary_search(test, data.movement[i]);
    const bool long_enough =
        counts[static_cast<std::size_t>(data.movement[i])] >= kFewestRowsOfMovement;
    keep[i] = is_test == in_test && long_enough && (masked.empty() || masked[i] == 0) ? 1 : 0;
  }
  return keep;
}

void check_enough(const Observations& train, const BaseModel& base) {
  if (train.rows() == 0) {
    throw_bad_input(fmt::format("no movement has the {} rows it takes to tell noise from effects",
                                kFewestRowsOfMovement),
                    train.target_name,
                    "give the recorded rows, not a mean a movement; without a 'movement' column a "
                    "file is one movement");
  }
  const std::size_t parameters =
      base.linear_terms.size() + base.formula.constant_positions().size();
  if (train.rows() >= 3 * parameters + 10) return;
  throw_bad_input(fmt::format("{} rows are too few to fit {} parameters of the base model",
                              train.rows(), parameters),
                  train.target_name, "record more movements (R9: at least 30)");
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "NONE";
    case Verdict::effects:
      return "EFFECTS";
    case Verdict::unknown:
      return "UNKNOWN";
    case Verdict::cannot_tell:
      return "CANNOT_TELL";
  }
  return "NONE";
}

namespace {

// Bursts are events: listed by movement and time, their rows left out of every fit.
void find_events(Diagnosis& out, const Observations& data, const Eigen::VectorXd& residual,
                 RandomStream random) {
  std::vector<double> speed;
  if (const Signal* v = data.find("v")) {
    for (const double x : v->values) speed.push_back(std::abs(x));
  }
  const std::vector<Burst> bursts = find_bursts(data.movement, speed, residual, random);
  for (const Burst& burst : bursts) {
    const int movement = data.movement[burst.begin];
    out.events.push_back({movement,
                          data.movement_names.empty()
                              ? std::to_string(movement)
                              : data.movement_names[static_cast<std::size_t>(movement)],
                          data.time[burst.begin], data.time[burst.end - 1], burst.peak});
  }
  out.masked = rows_about(bursts, data.movement);
}

// The procedure on the rows of the training movements; nothing is held out here.
Diagnosis diagnose_training(const Observations& data, const std::vector<int>& test,
                            const BaseMaker& make_base, const DiagnosisOptions& options,
                            RandomStream random) {
  Diagnosis out;
  out.options = options;
  out.families = chosen_families(options);
  out.test_movements = test;
  const std::vector<char> train_rows = rows_of(data, test, false, {});
  if (std::ranges::count(train_rows, 1) == 0) check_enough(data.select(train_rows), {});
  const BaseModel base = make_base(data.select(train_rows));
  const Eigen::VectorXd rich = rich_residual(data, train_rows, base, out.families, options);
  out.masked.assign(data.rows(), 0);
  if (options.has("bursts")) {
    find_events(out, data, rich, random.split("events"));
  }
  const std::vector<char> kept = rows_of(data, test, false, out.masked);
  const Observations train = data.select(kept);
  check_enough(train, base);
  Eigen::VectorXd train_rich(static_cast<Eigen::Index>(train.rows()));
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (kept[i] != 0) train_rich[next++] = rich[static_cast<Eigen::Index>(i)];
  }
  const Clusters uncut = make_clusters(train.movement, 1);
  out.correlation_rows = correlation_time(train_rich, uncut.movements);
  Clusters clusters = make_clusters(train.movement, out.correlation_rows);
  if (options.has("weights")) clusters.weight = movement_weights(train_rich, clusters);
  out.rows = train.rows();
  out.stretches = clusters.stretches.size();
  out.movements = clusters.movements.size();
  const RandomStream own = random.split("search");
  const Campaign campaign(train, out.families, options, clusters, own.split("flips"));
  write_findings(out, search(base, campaign, own), campaign);
  return out;
}

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

// What the models fitted without them make of the movements left out, in rows of all data.
struct LeftOut {
  Eigen::VectorXd before;
  Eigen::VectorXd after;
  Eigen::VectorXd corrected;  // as `after` where no bounds are asked for
};

LeftOut left_out_predictions(const Observations& data, const Diagnosis& fitted,
                             const std::vector<int>& left, RandomStream random) {
  LeftOut out{predict(fitted.before, data), predict(fitted.after, data), {}};
  out.corrected = out.after;
  if (!fitted.options.ceiling) return out;
  out.corrected += smooth_correction(data, rows_of(data, left, false, fitted.masked),
                                     target_vector(data) - out.after, random);
  return out;
}

// Errors on the rows with judged[i] != 0. unit: of those rows.
ErrorFinding judge_rows(const Observations& data, const std::vector<char>& judged,
                        const LeftOut& models, std::span<const int> unit, bool ceiling,
                        RandomStream random) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    if (judged[i] != 0) rows.push_back(static_cast<Eigen::Index>(i));
  }
  const Observations part = data.select(judged);
  const Eigen::VectorXd before = models.before(rows);
  const Eigen::VectorXd after = models.after(rows);
  ErrorFinding error = judge(part, before, after, unit, random.split("bootstrap"));
  if (ceiling) {
    const auto y = target_vector(part);
    bound_ceiling(error, part, y - before, y - after, y - models.corrected(rows), unit,
                  random.split("ceiling"));
  }
  return error;
}

// How often searches on parts of the data choose the same effects.
class ChosenShares {
 public:
  void count(const Diagnosis& part) {
    ++searches_;
    for (const EffectFinding& effect : part.effects) ++times_[effect.family];
  }
  void write(Diagnosis& whole) const {
    if (searches_ == 0) return;
    for (EffectFinding& effect : whole.effects) {
      const auto found = times_.find(effect.family);
      effect.chosen_share = found == times_.end() ? 0 : found->second / searches_;
    }
  }

 private:
  double searches_ = 0;
  std::map<std::string, double> times_;
};

// The searches without the movements of each set, in their order.
std::vector<Diagnosis> search_without(const Observations& data,
                                      const std::vector<std::vector<int>>& sets,
                                      const BaseMaker& base, const DiagnosisOptions& options,
                                      const RandomStream& random) {
  std::vector<Diagnosis> all(sets.size());
  std::size_t ended = 1;  // the search with all of them
  std::mutex mutex;
  const auto tell = [&] {
    const std::lock_guard lock(mutex);
    if (options.progress) options.progress(ended++, sets.size() + 1);
  };
  tell();
  parallel_for(sets.size(), options.threads, [&](std::size_t k) {
    all[k] = diagnose_training(data, sets[k], base, options, random.split(k));
    tell();
  });
  return all;
}

// Many movements: the search again without a tenth of the training movements in turn.
void search_again(const Observations& data, const BaseMaker& base, Diagnosis& whole,
                  RandomStream random) {
  if (whole.effects.empty()) return;
  const std::vector<char> training = rows_of(data, whole.test_movements, false, {});
  std::vector<std::vector<int>> sets = left_out_together(data.select(training));
  for (std::vector<int>& left : sets) {
    left.insert(left.end(), whole.test_movements.begin(), whole.test_movements.end());
    std::ranges::sort(left);
  }
  ChosenShares shares;
  for (const Diagnosis& part : search_without(data, sets, base, whole.options, random)) {
    shares.count(part);
  }
  shares.write(whole);
}

// Few movements: the whole procedure again for each, without it, and all of them judged together.
// Says of each effect how many of them choose it too.
ErrorFinding judge_in_turn(const Observations& data, const BaseMaker& base, Diagnosis& whole,
                           RandomStream random) {
  ChosenShares shares;
  const std::vector<char> usable = rows_of(data, {}, false, whole.masked);
  LeftOut all;
  for (Eigen::VectorXd* one : {&all.before, &all.after, &all.corrected}) {
    one->setZero(static_cast<Eigen::Index>(data.rows()));
  }
  const std::vector<std::vector<int>> sets = left_out_together(data);
  const std::vector<Diagnosis> parts = search_without(data, sets, base, whole.options, random);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    shares.count(parts[k]);
    const LeftOut models =
        left_out_predictions(data, parts[k], sets[k], random.split(k).split("smooth"));
    const std::vector<char> rows = rows_of(data, sets[k], true, {});
    for (std::size_t i = 0; i < data.rows(); ++i) {
      if (rows[i] == 0) continue;
      const auto at = static_cast<Eigen::Index>(i);
      all.before[at] = models.before[at];
      all.after[at] = models.after[at];
      all.corrected[at] = models.corrected[at];
    }
  }
  shares.write(whole);
  const std::vector<int> unit = pieces(data.select(usable), whole.correlation_rows);
  return judge_rows(data, usable, all, unit, whole.options.ceiling, random);
}

// One recording: five pieces of it stand for movements.
Observations cut_in_pieces(const Observations& data) {
  Observations out = data;
  out.movement_names.clear();
  out.group.clear();
  for (std::size_t i = 0; i < data.rows(); ++i) {
    out.movement[i] = static_cast<int>(i * kPiecesOfOneMovement / data.rows());
  }
  for (std::size_t k = 0; k < kPiecesOfOneMovement; ++k) {
    out.movement_names.push_back(fmt::format("piece {}", k + 1));
  }
  // Within one movement everything that grows with it passes for the campaign's time.
  for (const char* name : {"t", "T"}) out.withheld.push_back({name, "there is one movement"});
  return out;
}

Diagnosis diagnose_canonical(const Observations& data, const BaseMaker& base,
                             const DiagnosisOptions& options) {
  const RandomStream random(key_of("diagnosis"));
  const std::size_t movements = data.movements().size();
  const bool hold_out = options.test_share > 0;
  if (hold_out && (movements < kFewMovements || !data.group.empty())) {
    const bool single = movements == 1;
    const Observations cut = single ? cut_in_pieces(data) : data;
    Diagnosis out = diagnose_training(cut, {}, base, options, random);
    out.error = judge_in_turn(cut, base, out, random.split("in turn"));
    if (single) out.error.judged_on = JudgedOn::pieces_of_one_movement;
    out.error.how = single ? "pieces of the one movement left out in turn"
                    : cut.group.empty()
                        ? (movements > turns_for(data) ? "a tenth of the movements left out in turn"
                                                       : "each movement left out in turn")
                        : fmt::format("movements of one '{}' left out in turn", cut.group_name);
    out.error.confirmed = out.effects.empty() || out.error.difference_low > 0;
    if (single) {
      out.notes.push_back(
          "there is one movement: nothing that differs between movements (temperature, drift, "
          "repeatability) can be tested");
    } else if (movements < kWantedMovements) {
      out.notes.push_back(
          fmt::format("there are {} movements: what differs between movements (temperature, drift, "
                      "repeatability) can hardly be tested; {} are wanted",
                      movements, kWantedMovements));
    }
    return out;
  }
  const std::vector<int> test = choose_test_movements(data, options.test_share);
  Diagnosis out = diagnose_training(data, test, base, options, random);
  out.error.judged_on = JudgedOn::rows_of_the_fit;
  out.error.how = "none held out";
  const std::vector<char> judged = rows_of(data, test, true, out.masked);
  if (std::ranges::count(judged, 1) > 0) {
    const LeftOut models = left_out_predictions(data, out, test, random.split("smooth"));
    out.error =
        judge_rows(data, judged, models, data.select(judged).movement, options.ceiling, random);
    out.error.how = "held out";
    if (options.resample) search_again(data, base, out, random.split("again"));
    out.error.confirmed = out.effects.empty() || out.error.difference_low > 0;
  }
  return out;
}

}  // namespace

Diagnosis diagnose(const Observations& data, const BaseMaker& base, const DiagnosisOptions& options,
                   std::uint64_t seed) {
  const Canonical told = canonical(data);
  Diagnosis out = diagnose_canonical(told.data, base, options);
  out.masked = told.as_told(out.masked);
  out.seed = seed;
  return out;
}

}  // namespace tribench::loop
