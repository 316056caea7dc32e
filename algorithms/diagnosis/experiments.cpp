// SPDX-License-Identifier: MIT
#include "algorithms/diagnosis/experiments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>

namespace tribench::loop {
namespace {

constexpr std::size_t kRows = 60;
constexpr double kTwoToneRatio = 1.9;  // of the second tone's frequency to the first's

struct Rival {
  LoopModel model;
  std::string between;
};

// The rivals of the final model: each near alias in the place of its effect, refitted.
std::vector<Rival> rivals_of(const Diagnosis& diagnosis, const Observations& train,
                             const Clusters& clusters) {
  std::vector<Rival> all;
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
  x << angle.sin().matrix(), angle.cos().matrix(), Eigen::VectorXd::Ones(n);
  return x.colPivHouseholderQr().solve(Eigen::Map<const Eigen::VectorXd>(g->values.data(), n));
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
  const double rate = std::abs(movement.velocity) / std::max(1e-12, 0.5 * std::abs(stroke));
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
  double distance = 0;
  double before = 0;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double part = (static_cast<double>(i) + 0.5) / kRows;
    double v = movement.velocity;
    double a = 0;
    double q = v > 0 ? movement.from + stroke * part : movement.to - stroke * part;
    if (movement.kind == "two_tone") {
      const double w = rate;
      const double time = 2 * std::numbers::pi / w * part * 3;
      const double second = kTwoToneRatio * w * time;
      v = movement.velocity * (0.6 * std::cos(w * time) + 0.4 * std::cos(second));
      a = -movement.velocity * w *
          (0.6 * std::sin(w * time) + 0.4 * kTwoToneRatio * std::sin(second));
      q = 0.5 * (movement.from + movement.to) +
          0.5 * stroke * (0.6 * std::sin(w * time) + 0.4 / kTwoToneRatio * std::sin(second));
    }
    const double step = std::abs(stroke) / kRows;
    distance = v * before < 0 ? 0 : distance + step;
    before = v;
    const double g =
        movement.load_factor * (gravity[0] * std::sin(q) + gravity[1] * std::cos(q)) + gravity[2];
    const double sign = v > 0 ? 1 : -1;
    set("v", i, v);
    set("sgn_v", i, sign);
    set("a", i, a);
    set("q", i, q);
    set("d", i, distance);
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
  const double centre = 0.5 * (low + high);
  const bool loaded = data.find("g") != nullptr;
  for (const double part : {0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
    for (const double factor : {1.0, 1.5, 0.5}) {
      if (!loaded && factor != 1.0) continue;
      for (const double direction : {1.0, -1.0}) {
        all.push_back({"constant", direction * part * top, low, high, factor, 0, {}});
        all.push_back({"constant", direction * part * top, low, centre, factor, 0, {}});
      }
      if (data.find("a") != nullptr && q != nullptr) {
        all.push_back({"two_tone", part * top, low, high, factor, 0, {}});
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
    keep[i] =
        !masked && !std::ranges::binary_search(diagnosis.test_movements, data.movement[i]) ? 1 : 0;
  }
  const Observations train = data.select(keep);
  const Clusters clusters = make_clusters(train.movement, 1, RandomStream(diagnosis.seed));
  const std::vector<Rival> rivals = rivals_of(diagnosis, train, clusters);
  const Eigen::Vector3d gravity = gravity_of_position(train);
  const double variance = diagnosis.noise.within_sd * diagnosis.noise.within_sd;
  std::vector<ProposedMovement> all;
  for (ProposedMovement movement : candidates(train)) {
    const Observations seen = simulate(movement, train, gravity);
    const Eigen::VectorXd ours = predict(diagnosis.after, seen);
    for (const Rival& rival : rivals) {
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

std::string movements_csv(const std::vector<ProposedMovement>& movements) {
  std::string text = "order,kind,velocity,from,to,load_factor,separation,between\n";
  for (std::size_t i = 0; i < movements.size(); ++i) {
    const ProposedMovement& m = movements[i];
    const auto place = [](double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : ""; };
    text += fmt::format("{},{},{:.6g},{},{},{:.3g},{:.4g},{}\n", i + 1, m.kind, m.velocity,
                        place(m.from), place(m.to), m.load_factor, m.separation, m.between);
  }
  return text;
}

}  // namespace tribench::loop
