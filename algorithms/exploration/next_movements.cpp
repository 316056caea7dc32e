// SPDX-License-Identifier: MIT
#include "algorithms/exploration/next_movements.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "algorithms/loop_model/model_fit.hpp"
#include "foundation/elementary.hpp"
#include "foundation/pivoted_qr.hpp"
#include "problems/preparation/derived_channels.hpp"

namespace tribench::loop {
namespace {

constexpr std::size_t kRows = 600;  // enough for what happens just after a reversal
constexpr double kLongest = 120;    // s; nobody records a longer one by the dozen

struct AliasModel {
  LoopModel model;
  std::string between;
};

// The rivals of the final model: each near alias in the place of its effect, refitted.
std::vector<AliasModel> alias_models(const Diagnosis& diagnosis, const Observations& train,
                                     const Clusters& clusters) {
  std::vector<AliasModel> all;
  for (const EffectFinding& effect : diagnosis.effects) {
    for (const AliasFinding& alias : effect.aliases) {
      const auto family = std::ranges::find(diagnosis.families, alias.family, &EffectFamily::name);
      if (family == diagnosis.families.end()) continue;
      LoopModel model = diagnosis.after;
      for (std::size_t k = model.atoms.size(); k-- > 0;) {
        if (diagnosis.families[model.atoms[k].family].name == effect.family) model.remove(k);
      }
      std::vector<std::string> missing;
      const std::vector<Atom> atoms =
          instantiate(*family, static_cast<std::size_t>(family - diagnosis.families.begin()), train,
                      gear_ratios_for(train, diagnosis.options.gear_ratios), missing);
      if (atoms.empty()) continue;
      LoopModel best;
      double least = 1e300;
      for (const Atom& atom : atoms) {
        LoopModel trial = model;
        trial.add(atom);
        fit_model(trial, train, clusters, diagnosis.noise, FitScope::linear);
        const double sum = (target_vector(train) - predict(trial, train)).squaredNorm();
        if (sum < least) {
          least = sum;
          best = std::move(trial);
        }
      }
      all.push_back({std::move(best), effect.family + " | " + alias.family});
    }
  }
  if (all.empty() && !diagnosis.effects.empty()) {
    all.push_back({diagnosis.before, "the effects found | nothing"});
  }
  return all;
}

// Gravity over the position as one sinusoid and an offset, so that it can be predicted elsewhere.
Eigen::Vector3d gravity_of_position(const Observations& data) {
  const Signal* q = data.find("q");
  const Signal* g = data.find("g");
  if (q == nullptr || g == nullptr) return Eigen::Vector3d::Zero();
  const auto n = static_cast<Eigen::Index>(data.rows());
  const Eigen::Map<const Eigen::ArrayXd> angle(q->values.data(), n);
  Eigen::MatrixXd x(n, 3);
  x << angle.unaryExpr(&elementary::sin).matrix(), angle.unaryExpr(&elementary::cos).matrix(),
      Eigen::VectorXd::Ones(n);
  return PivotedQr(x).solve(Eigen::Map<const Eigen::VectorXd>(g->values.data(), n));
}

double middle_of(const Signal& signal) {
  double sum = 0;
  for (const double x : signal.values) sum += x;
  return sum / static_cast<double>(signal.values.size());
}

// What the robot would see at `rows` instants of the movement; signals that the movement does not
// set stand at their mean.
Observations simulate(const ProposedMovement& movement, const Observations& data,
                      const Eigen::Vector3d& gravity) {
  Observations out;
  out.movement_names = {"proposed"};
  const double stroke = movement.to - movement.from;
  const double middle = 0.5 * (movement.from + movement.to);
  for (const Signal& signal : data.signals) {
    Signal copy{signal.name, signal.channel, signal.unit, signal.role, signal.recipe, {}};
    copy.values.assign(kRows, middle_of(signal));
    out.signals.push_back(std::move(copy));
  }
  const auto set = [&](std::string_view name, std::size_t row, double value) {
    for (Signal& signal : out.signals) {
      if (signal.name == name) signal.values[row] = value;
    }
  };
  const std::vector<LateChannel> channels = LateChannel::all();
  std::vector<std::variant<TimeLag, SettlingSign>> memories;
  for (const LateChannel& late : channels) memories.push_back(late.memory());
  double distance = 0;
  double v_before = 0;
  double q_before = movement.kind == "two_tone" ? middle : movement.from;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double part = (static_cast<double>(i) + 0.5) / kRows;
    double v = movement.velocity;
    double a = 0;
    double q = movement.from + stroke * part;
    if (movement.kind == "two_tone") {
      v = 0;
      q = middle;
      for (const Tone& tone : movement.tones) {
        const double w = 2 * std::numbers::pi * tone.frequency;
        const double angle = w * movement.duration * part;
        q += tone.amplitude * elementary::sin(angle);
        v += tone.amplitude * w * elementary::cos(angle);
        a -= tone.amplitude * w * w * elementary::sin(angle);
      }
    }
    distance = v * v_before < 0 ? 0 : distance + std::abs(q - q_before);
    v_before = v;
    q_before = q;
    const double g =
        movement.load_factor * (gravity[0] * elementary::sin(q) + gravity[1] * elementary::cos(q)) +
        gravity[2];
    const double sign = v > 0 ? 1 : -1;
    set("v", i, v);
    set("sgn_v", i, sign);
    set("a", i, a);
    set("q", i, q);
    if (std::isfinite(distance)) {
      set("d", i, distance);
      set(kSeenDistance, i, distance);
    }
    for (std::size_t k = 0; k < channels.size(); ++k) {
      const double dt_s = movement.duration / kRows;
      set(channels[k].name(), i,
          std::visit([&](auto& memory) { return memory.next(v, dt_s); }, memories[k]));
    }
    if (gravity.norm() > 0) {
      set("g", i, g);
      set("sgn_g", i, g > 0 ? 1 : -1);
    }
  }
  out.target.assign(kRows, 0);
  out.movement.assign(kRows, 0);
  out.time.assign(kRows, 0);
  return out;
}

std::vector<ProposedMovement> candidates(const Observations& data) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double top = signal_scale(data, "v");
  const Signal* q = data.find("q");
  double low = kNone;
  double high = kNone;
  if (q != nullptr) {
    const auto range = std::ranges::minmax(q->values);
    low = range.min;
    high = range.max;
  }
  std::vector<ProposedMovement> all;
  const auto add = [&](const PlannedMovement& movement) {
    if (!(movement.duration > kLongest)) all.push_back({movement, 0, {}});
  };
  const double centre = 0.5 * (low + high);
  const double narrow = 0.0625 * (high - low);
  const bool loaded = data.find("g") != nullptr;
  for (const double part : {0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
    for (const double factor : {1.0, 1.5, 0.5}) {
      if (!loaded && factor != 1.0) continue;
      for (const double direction : {1.0, -1.0}) {
        add(constant_movement(direction * part * top, low, high, factor));
        add(constant_movement(direction * part * top, low, centre, factor));
        add(constant_movement(direction * part * top, centre - narrow, centre + narrow, factor));
      }
      if (data.find("a") != nullptr && q != nullptr) {
        add(two_tone_movement(part * top, low, high, factor));
        add(two_tone_movement(part * top, centre - narrow, centre + narrow, factor));
      }
    }
  }
  return all;
}

// The same movement for the question asked: a load that tells nothing more is no other movement.
bool alike(const ProposedMovement& a, const ProposedMovement& b) {
  const bool says_the_same = std::abs(a.separation - b.separation) < 0.01 * a.separation;
  return a.kind == b.kind && (a.load_factor == b.load_factor || says_the_same) &&
         std::abs(a.velocity - b.velocity) < 0.3 * std::abs(a.velocity);
}

}  // namespace

std::vector<ProposedMovement> propose_movements(const Diagnosis& diagnosis,
                                                const Observations& data, std::size_t count) {
  std::vector<char> keep(data.rows());
  for (std::size_t i = 0; i < data.rows(); ++i) {
    const bool masked = i < diagnosis.masked.size() && diagnosis.masked[i] != 0;
    keep[i] = !masked && !std::ranges::binary_search(diagnosis.held_out, data.movement[i]) ? 1 : 0;
  }
  const Observations train = data.select(keep);
  const Clusters clusters = make_clusters(train.movement, 1);
  const std::vector<AliasModel> rivals = alias_models(diagnosis, train, clusters);
  const Eigen::Vector3d gravity = gravity_of_position(train);
  const double variance = diagnosis.noise.within_sd * diagnosis.noise.within_sd;
  std::vector<ProposedMovement> all;
  for (ProposedMovement movement : candidates(train)) {
    const Observations seen = simulate(movement, train, gravity);
    const Eigen::VectorXd ours = predict(diagnosis.after, seen);
    for (const AliasModel& rival : rivals) {
      const double apart = (ours - predict(rival.model, seen)).squaredNorm() / kRows / variance;
      if (!std::isfinite(apart) || apart <= movement.separation) continue;
      movement.separation = apart;
      movement.between = rival.between;
    }
    if (movement.separation > 0) all.push_back(std::move(movement));
  }
  std::ranges::stable_sort(
      all, [](const auto& a, const auto& b) { return a.separation > b.separation; });
  std::vector<ProposedMovement> chosen;
  for (const ProposedMovement& movement : all) {
    if (chosen.size() >= count) break;
    const bool known =
        std::ranges::any_of(chosen, [&](const auto& one) { return alike(one, movement); });
    if (!known) chosen.push_back(movement);
  }
  return chosen;
}

std::string movements_csv(const std::vector<ProposedMovement>& movements,
                          const Observations& data) {
  const auto unit = [&](std::string_view signal) {
    const Signal* found = data.find(signal);
    return found == nullptr ? std::string() : found->unit;
  };
  std::vector<std::string> extra = {"separation,between"};
  for (const ProposedMovement& one : movements) {
    extra.push_back(fmt::format("{:.4g},{}", one.separation, one.between));
  }
  return movements_text({movements.begin(), movements.end()}, unit("q"), unit("v"), extra);
}

}  // namespace tribench::loop
